"use strict";
// Draws one moment of a run: the report's replay and the live view share it.

// Okabe and Ito's colours, which the colour-blind tell apart; robots beyond the eighth differ by number and dash.
const COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c8c8c", "#b8a500"];
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3]];
const colourOf = robot => COLOURS[robot % COLOURS.length];
const dashOf = robot => DASHES[Math.floor(robot / COLOURS.length) % DASHES.length];
const themeColour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

class Scene {
  // `layout`: see `layout` in run_data.rs. `bounds`: [x0, y0, x1, y1] in metres that must fit.
  constructor(canvas, layout, bounds) {
    Object.assign(this, { canvas, layout, bounds, followed: null, frame: null });
    new ResizeObserver(() => this.fit()).observe(canvas);
    this.fit();
  }

  fit() {
    const width = this.canvas.clientWidth || 320;
    const [x0, y0, x1, y1] = this.bounds;
    const height = Math.max(180, Math.min(width * (y1 - y0) / (x1 - x0), 620));
    const dots = window.devicePixelRatio || 1;
    this.canvas.style.height = `${height}px`;
    this.canvas.width = Math.round(width * dots);
    this.canvas.height = Math.round(height * dots);
    Object.assign(this, { width, height, dots });
    if (this.frame) this.draw(this.frame);
  }

  // The view: everything, or three times nearer around the robot that is followed.
  look() {
    const [x0, y0, x1, y1] = this.bounds;
    let scale = Math.min(this.width / (x1 - x0), this.height / (y1 - y0));
    let centre = [(x0 + x1) / 2, (y0 + y1) / 2];
    const robot = this.followed === null ? null : this.frame.robots[this.followed];
    if (robot) {
      scale = Math.min(scale * 3, this.width / 12);
      centre = [robot.x, robot.y];
    }
    this.scale = scale;
    this.toX = x => this.width / 2 + (x - centre[0]) * scale;
    this.toY = y => this.height / 2 - (y - centre[1]) * scale;
  }

  draw(frame) {
    this.frame = frame;
    this.look();
    const pen = this.canvas.getContext("2d");
    this.pen = pen;
    pen.setTransform(this.dots, 0, 0, this.dots, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    this.text = themeColour("--text");
    this.drawObstacles();
    frame.robots.forEach((robot, i) => this.drawSetPoint(i));
    frame.robots.forEach((robot, i) => this.drawPath(robot.trail, colourOf(i), 1.2, 0.6, []));
    frame.robots.forEach((robot, i) => this.drawPlan(robot, i));
    frame.robots.forEach((robot, i) => this.drawLines(robot, i));
    frame.robots.forEach((robot, i) => this.drawRobot(robot, i));
    this.drawScale();
  }

  circle(x, y, radius) {
    this.pen.beginPath();
    this.pen.arc(this.toX(x), this.toY(y), Math.max(1, radius * this.scale), 0, 2 * Math.PI);
  }

  drawObstacles() {
    for (const shape of this.layout.shapes) this.drawShape(shape);
    const pen = this.pen;
    pen.beginPath();
    for (const { at: [x, y], radius } of this.layout.obstacles) {
      const [left, middle, r] = [this.toX(x), this.toY(y), Math.max(1, radius * this.scale)];
      pen.moveTo(left + r, middle);
      pen.arc(left, middle, r, 0, 2 * Math.PI);
    }
    this.hatch("nonzero");
  }

  // Polygons are filled; of walls, which have no inside, the chain is drawn as wide as they are thick.
  drawShape(shape) {
    const pen = this.pen;
    pen.beginPath();
    for (const ring of shape.rings) {
      pen.moveTo(this.toX(ring[0][0]), this.toY(ring[0][1]));
      for (const [x, y] of ring.slice(1)) pen.lineTo(this.toX(x), this.toY(y));
      pen.closePath();
    }
    if (shape.radius === 0) return this.hatch("evenodd");
    pen.save();
    pen.lineJoin = pen.lineCap = "round";
    pen.lineWidth = Math.max(1, 2 * shape.radius * this.scale);
    pen.strokeStyle = themeColour("--muted");
    pen.stroke();
    pen.restore();
  }

  // Fills the path with hatching.
  hatch(rule) {
    const pen = this.pen;
    pen.save();
    pen.fillStyle = themeColour("--grid");
    pen.fill(rule);
    pen.strokeStyle = themeColour("--muted");
    pen.stroke();
    pen.clip(rule);
    pen.beginPath();
    for (let shift = -this.height; shift < this.width; shift += 6) {
      pen.moveTo(shift, this.height);
      pen.lineTo(shift + this.height, 0);
    }
    pen.stroke();
    pen.restore();
  }

  drawSetPoint(i) {
    const robot = this.layout.robots[i], pen = this.pen;
    const [x, y] = robot.setPoint;
    this.circle(x, y, robot.radius);
    pen.globalAlpha = 0.7;
    pen.strokeStyle = colourOf(i);
    pen.lineWidth = 1;
    pen.setLineDash([2, 2]);
    pen.stroke();
    pen.setLineDash([]);
    pen.globalAlpha = 1;
    this.circle(x, y, 0.08);
    pen.fillStyle = colourOf(i);
    pen.fill();
  }

  drawPath(points, colour, width, alpha, dash) {
    if (points.length < 4) return;
    const pen = this.pen;
    pen.beginPath();
    for (let n = 0; n < points.length; n += 2) pen.lineTo(this.toX(points[n]), this.toY(points[n + 1]));
    Object.assign(pen, { strokeStyle: colour, lineWidth: width, globalAlpha: alpha });
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  drawPlan(robot, i) {
    this.drawPath(robot.plan, colourOf(i), 1.6, 0.9, dashOf(i));
    const size = Math.min(2, 0.07 * this.scale);
    this.pen.fillStyle = colourOf(i);
    for (let n = 2; n < robot.plan.length; n += 2) {
      this.pen.fillRect(this.toX(robot.plan[n]) - size, this.toY(robot.plan[n + 1]) - size, 2 * size, 2 * size);
    }
  }

  // A row keeps the predicted state of its step on one side of a line: the part of it next to that state.
  drawLines(robot, i) {
    for (const line of robot.lines) {
      const at = 2 * Math.min(line.step, robot.plan.length / 2 - 1);
      const [nx, ny] = [Math.cos(line.angle), Math.sin(line.angle)];
      const gap = nx * robot.plan[at] + ny * robot.plan[at + 1] - line.offset;
      const [x, y] = [robot.plan[at] - gap * nx, robot.plan[at + 1] - gap * ny];
      const half = 0.75 * this.layout.minSeparation;
      const ends = [x - ny * half, y + nx * half, x + ny * half, y - nx * half];
      this.drawPath(ends, this.text, 3.4, 0.8, []);
      this.drawPath(ends, colourOf(i), 1.8, 1, []);
    }
  }

  drawRobot(robot, i) {
    const pen = this.pen, radius = this.layout.robots[i].radius;
    this.circle(robot.x, robot.y, radius);
    pen.fillStyle = colourOf(i);
    pen.globalAlpha = 0.9;
    pen.fill();
    pen.globalAlpha = 1;
    pen.lineWidth = i === this.followed ? 3 : 1;
    pen.strokeStyle = i === this.followed || robot.rows > 0 ? this.text : colourOf(i);
    pen.stroke();
    const label = robot.horizon ? `${i} [${robot.horizon}]` : `${i}`;
    const size = Math.max(9, Math.min(15, radius * this.scale * 0.6));
    const [x, y] = [this.toX(robot.x), this.toY(robot.y)];
    pen.font = `600 ${size}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    // A label that does not fit into its disc stands out from its surroundings by a rim.
    pen.lineWidth = 2.5;
    pen.lineJoin = "round";
    pen.strokeStyle = "#ffffff";
    pen.strokeText(label, x, y);
    pen.fillStyle = "#101010";
    pen.fillText(label, x, y);
  }

  drawScale() {
    const metres = [1, 2, 5, 10, 20, 50, 100].find(length => length * this.scale > 40) || 200;
    const pen = this.pen, y = this.height - 8;
    pen.fillStyle = pen.strokeStyle = this.text;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(8, y);
    pen.lineTo(8 + metres * this.scale, y);
    pen.stroke();
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "left";
    pen.textBaseline = "bottom";
    pen.fillText(`${metres} m`, 8, y - 3);
  }

  // The robot at a place of the canvas (CSS pixels), or null.
  pick(x, y) {
    let best = null, least = Infinity;
    this.frame.robots.forEach((robot, i) => {
      const distance = Math.hypot(this.toX(robot.x) - x, this.toY(robot.y) - y);
      if (distance < Math.max(14, this.layout.robots[i].radius * this.scale) && distance < least) {
        [best, least] = [i, distance];
      }
    });
    return best;
  }
}

// Bounds in metres of all points given, with a margin of two radii.
function boundsOf(layout, positions) {
  const xs = [], ys = [];
  const add = (x, y) => { xs.push(x); ys.push(y); };
  layout.robots.forEach(robot => { add(...robot.start); add(...robot.setPoint); });
  layout.obstacles.forEach(obstacle => {
    const [[x, y], r] = [obstacle.at, obstacle.radius];
    add(x - r, y - r);
    add(x + r, y + r);
  });
  for (const { rings, radius: r } of layout.shapes) {
    for (const [x, y] of rings.flat()) {
      add(x - r, y - r);
      add(x + r, y + r);
    }
  }
  for (let n = 0; n < positions.length; n += 2) add(positions[n], positions[n + 1]);
  const least = all => all.reduce((a, b) => Math.min(a, b)), most = all => all.reduce((a, b) => Math.max(a, b));
  const margin = layout.minSeparation;
  return [least(xs) - margin, least(ys) - margin, most(xs) + margin, most(ys) + margin];
}

"use strict";
// Charts as SVG: axes with units, lines, and rasters of one row per robot.

const SVG = "http://www.w3.org/2000/svg";
function shape(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

// Round numbers between `from` and `to`, about `wanted` of them.
function roundSteps(from, to, wanted) {
  const rough = (to - from) / wanted || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= rough);
  const steps = [];
  for (let value = Math.ceil(from / step) * step; value <= to + step / 1e6; value += step) steps.push(+value.toPrecision(10));
  return steps;
}

class Chart {
  // `options`: title, xLabel, yLabel, x: [from, to], y: [from, to], equal (same scale on both axes), yTicks.
  constructor(parent, options) {
    const figure = document.createElement("figure");
    const heading = document.createElement("h3");
    heading.textContent = options.title;
    figure.append(heading);
    parent.append(figure);
    Object.assign(this, options, { figure, series: [] });
    this.width = Math.max(280, figure.clientWidth - 20);
    this.height = options.height || 210;
    this.left = 52;
    this.plot = { x0: 52, x1: this.width - 10, y0: 8, y1: this.height - 36 };
    if (options.equal) this.fitEqual();
    this.svg = shape(figure, "svg", { viewBox: `0 0 ${this.width} ${this.height}`, role: "img", "aria-label": options.title });
    this.drawAxes();
  }

  // Same metres per pixel on both axes.
  fitEqual() {
    const width = this.plot.x1 - this.plot.x0;
    const wide = this.x[1] - this.x[0], high = this.y[1] - this.y[0];
    const height = Math.max(140, Math.min(width * high / wide, 480));
    this.height = height + 44;
    this.plot.y1 = this.plot.y0 + height;
    const scale = Math.max(wide / width, high / height);
    const grow = (range, pixels) => {
      const spare = (pixels * scale - (range[1] - range[0])) / 2;
      return [range[0] - spare, range[1] + spare];
    };
    this.x = grow(this.x, width);
    this.y = grow(this.y, height);
  }

  toX(value) { return this.plot.x0 + (value - this.x[0]) / (this.x[1] - this.x[0]) * (this.plot.x1 - this.plot.x0); }
  toY(value) { return this.plot.y1 - (value - this.y[0]) / (this.y[1] - this.y[0]) * (this.plot.y1 - this.plot.y0); }

  drawAxes() {
    const { x0, x1, y0, y1 } = this.plot;
    for (const value of roundSteps(...this.x, this.width / 90)) {
      const x = this.toX(value);
      shape(this.svg, "line", { class: "grid", x1: x, x2: x, y1: y0, y2: y1 });
      shape(this.svg, "text", { x, y: y1 + 15, "text-anchor": "middle" }, value);
    }
    for (const value of this.yTicks || roundSteps(...this.y, (y1 - y0) / 40)) {
      const y = this.toY(value);
      shape(this.svg, "line", { class: "grid", x1: x0, x2: x1, y1: y, y2: y });
      shape(this.svg, "text", { x: x0 - 5, y: y + 4, "text-anchor": "end" }, value);
    }
    shape(this.svg, "line", { class: "axis", x1: x0, x2: x1, y1, y2: y1 });
    shape(this.svg, "line", { class: "axis", x1: x0, x2: x0, y1: y0, y2: y1 });
    shape(this.svg, "text", { x: (x0 + x1) / 2, y: y1 + 31, "text-anchor": "middle" }, this.xLabel);
    const middle = (y0 + y1) / 2;
    shape(this.svg, "text", { x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})` }, this.yLabel);
  }

  // `values`: [x0, y0, x1, y1, ...]; values that are not numbers break the line.
  line(values, attributes, robot) {
    let path = "", begun = false;
    for (let n = 0; n < values.length; n += 2) {
      if (!Number.isFinite(values[n + 1])) { begun = false; continue; }
      path += `${begun ? "L" : "M"}${this.toX(values[n]).toFixed(1)} ${this.toY(values[n + 1]).toFixed(1)}`;
      begun = true;
    }
    const element = shape(this.svg, "path", { d: path, fill: "none", "stroke-width": 1.4, ...attributes });
    if (robot !== undefined) this.series[robot] = element;
    return element;
  }

  limit(value, kind, text) {
    const y = this.toY(value);
    shape(this.svg, "line", { class: kind, x1: this.plot.x0, x2: this.plot.x1, y1: y, y2: y, "stroke-width": 1.6 });
    shape(this.svg, "text", { x: this.plot.x1 - 2, y: y - 3, "text-anchor": "end" }, text);
  }

  // One row per robot, equal neighbours in time as one bar. `look(value)`: fill and opacity, or null.
  raster(ticks, count, valueAt, look) {
    const height = Math.abs(this.toY(1) - this.toY(0));
    for (let robot = 0; robot < count; robot++) {
      const group = shape(this.svg, "g", {});
      this.series[robot] = group;
      for (let from = 0, tick = 1; tick <= ticks; tick++) {
        const value = valueAt(from, robot);
        if (tick < ticks && valueAt(tick, robot) === value) continue;
        const style = look(value);
        if (style) {
          const x = this.toX(this.timeOf(from)), width = this.toX(this.timeOf(tick)) - x;
          const y = this.toY(robot + 0.5) + 0.5;
          shape(group, "rect", { x: x.toFixed(1), y: y.toFixed(1), width: Math.max(width, 0.6).toFixed(1),
            height: Math.max(1, height - 1).toFixed(1), ...style });
        }
        from = tick;
      }
    }
  }

  follow(robot) {
    this.series.forEach((element, i) => element.classList.toggle("dim", robot !== null && i !== robot));
  }

  // A line at the present time, where the chart has one.
  mark(seconds) {
    if (this.equal) return;
    const x = this.toX(Math.min(seconds, this.x[1]));
    this.now ??= shape(this.svg, "line", { class: "now", y1: this.plot.y0, y2: this.plot.y1 });
    this.now.setAttribute("x1", x);
    this.now.setAttribute("x2", x);
  }

  legend(entries) {
    const list = document.createElement("ul");
    list.className = "legend";
    for (const [colour, text] of entries) {
      const item = document.createElement("li"), swatch = document.createElement("i");
      swatch.style.background = colour;
      item.append(swatch, text);
      list.append(item);
    }
    this.figure.append(list);
  }
}

"use strict";
// Takes the data of a run apart: long columns come as base64 of little-endian numbers.

function decode(text, Type) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let n = 0; n < raw.length; n++) bytes[n] = raw.charCodeAt(n);
  return new Type(bytes.buffer);
}

// Index at which each entry of a column of lengths begins, and the total at the end.
function starts(lengths) {
  const all = new Uint32Array(lengths.length + 1);
  for (let n = 0; n < lengths.length; n++) all[n + 1] = all[n] + lengths[n];
  return all;
}

class Run {
  constructor(data) {
    Object.assign(this, { layout: data.layout, about: data.about, summary: data.summary, folder: data.folder });
    this.ticks = data.ticks;
    this.count = data.layout.robots.length;
    this.positions = decode(data.positions, Float32Array);
    this.inputs = decode(data.inputs, Float32Array);
    for (const name of ["horizons", "rows", "levels", "statuses"]) this[name] = decode(data[name], Uint8Array);
    this.separation = decode(data.separation, Float32Array);
    this.tickMs = decode(data.tickMs, Float32Array);
    this.stepUs = decode(data.stepUs, Float32Array);
    this.grid = data.plans.grid;
    this.planLengths = decode(data.plans.lengths, Uint8Array);
    this.planStarts = starts(this.planLengths);
    this.moves = decode(data.plans.moves, Int8Array);
    this.lineStarts = starts(decode(data.lines.counts, Uint8Array));
    this.lineSteps = decode(data.lines.steps, Uint8Array);
    this.lineAngles = decode(data.lines.angles, Float32Array);
    this.lineOffsets = decode(data.lines.offsets, Float32Array);
  }

  // One value of a column with a value per tick and robot.
  at(column, tick, robot) { return column[tick * this.count + robot]; }

  position(tick, robot) {
    const at = 2 * (tick * this.count + robot);
    return [this.positions[at], this.positions[at + 1]];
  }

  // Predicted path [x0, y0, x1, y1, ...] from the robot's place at `tick`.
  plan(tick, robot) {
    const index = tick * this.count + robot;
    let [x, y] = this.position(tick, robot);
    const points = [x, y];
    for (let step = this.planStarts[index]; step < this.planStarts[index + 1]; step++) {
      x += this.moves[2 * step] * this.grid;
      y += this.moves[2 * step + 1] * this.grid;
      points.push(x, y);
    }
    return points;
  }

  lines(tick, robot) {
    const index = tick * this.count + robot;
    const found = [];
    for (let n = this.lineStarts[index]; n < this.lineStarts[index + 1]; n++) {
      found.push({ step: this.lineSteps[n], angle: this.lineAngles[n], offset: this.lineOffsets[n] });
    }
    return found;
  }

  // What is to be seen at `time`, in ticks, with a fraction: places in between, plans of the tick begun.
  frame(time) {
    const tick = Math.min(Math.floor(time), Math.max(0, this.ticks - 1));
    const part = this.ticks ? Math.min(1, time - tick) : 0;
    const robots = [];
    for (let robot = 0; robot < this.count; robot++) {
      const from = this.position(tick, robot);
      const to = this.ticks ? this.position(tick + 1, robot) : from;
      const planned = this.ticks > 0;
      robots.push({
        x: from[0] + (to[0] - from[0]) * part, y: from[1] + (to[1] - from[1]) * part,
        horizon: planned ? this.at(this.horizons, tick, robot) : 0,
        rows: planned ? this.at(this.rows, tick, robot) : 0,
        plan: planned ? this.plan(tick, robot) : [],
        lines: planned ? this.lines(tick, robot) : [],
        trail: this.trail(tick, robot),
      });
    }
    return { tick, robots };
  }

  trail(tick, robot) {
    const points = [];
    for (let k = Math.max(0, tick - TRAIL); k <= tick; k++) points.push(...this.position(k, robot));
    return points;
  }

  // Smallest separation of the whole team in a tick; null when there is nothing to meet.
  nearest(tick) {
    let least = Infinity;
    for (let robot = 0; robot < this.count; robot++) {
      const found = this.at(this.separation, tick, robot);
      if (found >= 0 && found < least) least = found;
    }
    return least === Infinity ? null : least;
  }

  name() {
    const about = this.about;
    return `${about.scenario} · ${about.profile} · ${about.horizon}`;
  }
}

const TRAIL = 60; // ticks of trail behind a robot

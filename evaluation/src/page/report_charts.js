"use strict";
// The charts of a run. Charts of the same kind share their scales, so that runs side by side compare.

const LEVELS = ["closed form", "structured solver", "Clarabel", "fallback", "baseline (no MPC)"];
const LEVEL_COLOURS = ["#56b4e9", "#0072b2", "#e69f00", "#d55e00", "#8c8c8c"];
const stroke = robot => ({ stroke: colourOf(robot), "stroke-dasharray": dashOf(robot).join(" ") });
const largest = values => values.reduce((a, b) => Math.max(a, b), 0);

// [time, value] of one robot's column, as steps held over the tick.
function held(run, valueAt) {
  const points = [], h = run.layout.sampleTime;
  for (let tick = 0; tick < run.ticks; tick++) points.push(tick * h, valueAt(tick), (tick + 1) * h, valueAt(tick));
  return points;
}

// Scales that fit all runs.
function scalesOf(runs) {
  const all = run => run.nearestOverTime = Float32Array.from({ length: run.ticks }, (_, tick) => run.nearest(tick) ?? NaN);
  const speeds = runs.map(run => run.layout.maxSpeed);
  return {
    time: [0, Math.max(...runs.map(run => run.ticks * run.layout.sampleTime), 1)],
    speed: [-1.1 * Math.max(...speeds), 1.1 * Math.max(...speeds)],
    horizon: [0, Math.max(10, ...runs.map(run => largest(run.horizons)))],
    separation: [0, Math.max(...runs.map(run => Math.max(largest(all(run).filter(Number.isFinite)), 2 * run.layout.minSeparation)))],
    tickMs: [0, 1.1 * Math.max(0.1, ...runs.map(run => largest(run.tickMs)))],
    stepUs: [0, 1.1 * Math.max(10, ...runs.map(run => largest(run.stepUs)))],
  };
}

function chartsOf(run, scales, bounds, place) {
  const h = run.layout.sampleTime, charts = [];
  const over = (title, yLabel, y, more) => {
    const chart = new Chart(place, { title, xLabel: "time (s)", yLabel, x: scales.time, y, timeOf: tick => tick * h, ...more });
    charts.push(chart);
    return chart;
  };
  const perRobot = (chart, valueAt) => {
    for (let i = 0; i < run.count; i++) chart.line(held(run, tick => valueAt(tick, i)), stroke(i), i);
  };
  charts.push(motion(run, bounds, place));
  horizons(run, scales, over, perRobot);
  perRobot(over("Control input, x", "ux (m/s)", scales.speed), (tick, i) => run.inputs[2 * (tick * run.count + i)]);
  perRobot(over("Control input, y", "uy (m/s)", scales.speed), (tick, i) => run.inputs[2 * (tick * run.count + i) + 1]);

  const rowScale = rowsOf(run);
  const mostRows = Math.max(1, largest(run.rows));
  const activations = over("Constraint activations", "robot", null, rowScale);
  activations.raster(run.ticks, run.count, (tick, i) => run.at(run.rows, tick, i),
    rows => rows ? { fill: "#d55e00", opacity: 0.3 + 0.7 * rows / mostRows } : null);
  activations.legend([["#d55e00", `collision rows, the darker the more (most: ${largest(run.rows)})`]]);

  const separation = over("Separation (least of the team, between samples too)", "separation (m)", scales.separation);
  separation.line(held(run, tick => run.nearestOverTime[tick]), { stroke: "#0072b2" });
  separation.limit(run.layout.minSeparation, "limit", `r_min ${run.layout.minSeparation} m`);
  separation.limit(run.layout.collisionDistance, "collision", `collision ${run.layout.collisionDistance} m`);

  const levels = over("Solver level", "robot", null, rowScale);
  levels.raster(run.ticks, run.count, (tick, i) => run.at(run.levels, tick, i), level => ({ fill: LEVEL_COLOURS[level] }));
  const used = LEVELS.map((name, level) => [LEVEL_COLOURS[level], name]).filter((_, level) => run.levels.includes(level));
  levels.legend(used);

  if (run.tickMs.length) {
    over("Latency of a tick (all robots)", "tick (ms)", scales.tickMs).line(held(run, tick => run.tickMs[tick]), { stroke: "#009e73" });
    const solve = over("Time from messages to plan", "planning (µs)", scales.stepUs);
    perRobot(solve, (tick, i) => run.at(run.stepUs, tick, i));
  }
  return charts;
}

// Axis with one row per robot.
const rowsOf = run => ({ y: [-0.6, run.count - 0.4], height: Math.max(170, 60 + 9 * run.count),
  yTicks: roundSteps(0, run.count - 1, Math.min(run.count, 10)).filter(Number.isInteger) });

// Lines for few robots; more would hide each other: then a row per robot, light where the horizon is long.
function horizons(run, scales, over, perRobot) {
  const horizon = (tick, i) => run.at(run.horizons, tick, i);
  if (run.count <= 4) return perRobot(over("Prediction horizon", "horizon N (ticks)", scales.horizon), horizon);
  const chart = over("Prediction horizon", "robot", null, rowsOf(run));
  chart.raster(run.ticks, run.count, horizon, value => ({ fill: cividis(value / 49) }));
  chart.legend([1, 10, 20, 30, 40, 49].map(value => [cividis(value / 49), `N = ${value}`]));
}

// Nunez, Anderton and Renslow's scale from dark blue to yellow, even for the colour-blind; 0 <= part <= 1.
const CIVIDIS = [[0, 32, 77], [49, 68, 107], [102, 105, 112], [149, 143, 120], [203, 186, 105], [255, 234, 70]];
function cividis(part) {
  const at = Math.min(part, 1) * (CIVIDIS.length - 1), low = Math.min(Math.floor(at), CIVIDIS.length - 2);
  return `rgb(${CIVIDIS[low].map((from, n) => Math.round(from + (CIVIDIS[low + 1][n] - from) * (at - low)))})`;
}

function motion(run, [x0, y0, x1, y1], place) {
  const chart = new Chart(place, { title: "Motion", xLabel: "x (m)", yLabel: "y (m)", x: [x0, x1], y: [y0, y1], equal: true });
  const radius = metres => Math.abs(chart.toX(metres) - chart.toX(0));
  for (const { rings, radius: r } of run.layout.shapes) {
    const d = rings.map(ring => `M${ring.map(([x, y]) => `${chart.toX(x)} ${chart.toY(y)}`).join("L")}Z`).join("");
    const look = r > 0 ? { fill: "none", stroke: "#8c8c8c", "stroke-width": 2 * radius(r), "stroke-linejoin": "round" }
      : { fill: "#8c8c8c", "fill-rule": "evenodd" };
    shape(chart.svg, "path", { d, opacity: 0.6, ...look });
  }
  for (const { at: [x, y], radius: r } of run.layout.obstacles) {
    shape(chart.svg, "circle", { cx: chart.toX(x), cy: chart.toY(y), r: radius(r), fill: "#8c8c8c", opacity: 0.6 });
  }
  run.layout.robots.forEach((robot, i) => {
    const points = [];
    for (let tick = 0; tick <= run.ticks; tick++) points.push(...run.position(tick, i));
    chart.line(points, stroke(i), i);
    const [sx, sy] = robot.start, [gx, gy] = robot.setPoint;
    shape(chart.svg, "circle", { cx: chart.toX(sx), cy: chart.toY(sy), r: 3, fill: colourOf(i) });
    shape(chart.svg, "circle", { cx: chart.toX(gx), cy: chart.toY(gy), r: Math.max(4, radius(robot.radius)), fill: "none", stroke: colourOf(i) });
    shape(chart.svg, "text", { x: chart.toX(sx) + 5, y: chart.toY(sy) - 4 }, i);
  });
  return chart;
}

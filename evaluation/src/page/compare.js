"use strict";
// The page of a comparison: bars by family and controller, and the table.

const { comparison, runs, minSeparation } = JSON.parse(document.getElementById("data").textContent);
const find = id => document.getElementById(id);
const make = (name, className, text) => {
  const element = document.createElement(name);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  return element;
};
const median = values => {
  const sorted = [...values].sort((a, b) => a - b), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
};
const MOST_DOTS = 60; // single runs drawn on a bar
const FAILED = "#c1121f", DONE = "#0072b2";

// One bar per controller; `valueOf(run)`: null where a run has no such value. `limits`: [[value, text, class], ...].
function bars(place, title, unit, rows, valueOf, limits = []) {
  const figure = make("figure");
  figure.append(make("h3", "", title));
  place.append(figure);
  const width = Math.max(280, figure.clientWidth - 20), row = 34, left = 6, right = width - 70, top = 4;
  const values = rows.map(({ runs }) => {
    const good = runs.filter(run => run.success), counted = good.length ? good : runs;
    return { all: runs.map(valueOf).filter(Number.isFinite), counted: counted.map(valueOf).filter(Number.isFinite) };
  });
  const most = Math.max(...values.flatMap(({ all }) => all), ...limits.map(([value]) => value), 1e-9);
  const toX = value => left + value / most * (right - left);
  const bottom = top + row * rows.length;
  const svg = shape(figure, "svg", { viewBox: `0 0 ${width} ${bottom + 34}`, role: "img", "aria-label": `${title} (${unit})` });
  for (const value of roundSteps(0, most, width / 90)) {
    shape(svg, "line", { class: "grid", x1: toX(value), x2: toX(value), y1: top, y2: bottom });
    shape(svg, "text", { x: toX(value), y: bottom + 14, "text-anchor": "middle" }, value);
  }
  shape(svg, "text", { x: (left + right) / 2, y: bottom + 30, "text-anchor": "middle" }, unit);
  rows.forEach(({ controller, runs }, n) => {
    const y = top + n * row, { all, counted } = values[n];
    const successes = runs.filter(run => run.success).length, failed = successes < runs.length;
    shape(svg, "text", { x: left, y: y + 12 }, `${controller}${failed ? ` ✕ ${successes} of ${runs.length}` : ""}`);
    if (!counted.length) return;
    const value = median(counted);
    shape(svg, "rect", { x: left, y: y + 16, width: Math.max(1, toX(value) - left), height: 13, fill: failed ? FAILED : DONE,
      class: failed ? "failed" : "completed" });
    all.slice(0, MOST_DOTS).forEach(one => shape(svg, "circle", { cx: toX(one), cy: y + 22.5, r: 2, fill: "#8c8c8c", stroke: "#ffffff", "stroke-width": 0.5 }));
    shape(svg, "text", { x: Math.max(toX(value), ...all.map(toX)) + 5, y: y + 27 }, value.toPrecision(4));
  });
  for (const [value, text, kind] of limits) {
    shape(svg, "line", { class: kind, x1: toX(value), x2: toX(value), y1: top, y2: bottom, "stroke-width": 1.6 });
    shape(svg, "title", {}, text);
  }
}

function drawFamilies() {
  find("families").replaceChildren();
  for (const family of new Set(comparison.rows.map(row => row.family))) {
    const section = make("section"), place = make("div", "charts");
    section.append(make("h2", "", family), place);
    find("families").append(section);
    const rows = comparison.rows.map((row, n) => ({ ...row, n })).filter(row => row.family === family)
      .map(({ controller, n }) => ({ controller, runs: runs.filter(run => run.row === n) }));
    bars(place, "Path cost", "path (m)", rows, run => run.path);
    bars(place, "Completion time", "time (s)", rows, run => run.success ? run.time : null);
    bars(place, "Computation time of a robot's tick", "mean (µs)", rows, run => run.stepUs);
    bars(place, `Smallest separation (r_min ${minSeparation} m dashed)`, "separation (m)", rows, run => run.separation,
      [[minSeparation, "r_min", "limit"]]);
  }
}

const number = (value, digits) => value == null ? "–" : value.toFixed(digits);
const interval = (value, digits) => value ? `${number(value.median, digits)} [${number(value.low, digits)}, ${number(value.high, digits)}]` : "–";
const COLUMNS = [
  ["scenario", row => row.family], ["controller", row => row.controller],
  ["succeeded", row => `${row.successes} of ${row.runs}`],
  ["path / straight", row => interval(row.ratio, 4)], ["ticks", row => interval(row.ticks, 0)],
  ["time (s)", row => interval(row.time_s, 1)], ["min separation (m)", row => number(row.min_separation, 3)],
  ["runs below r_min", row => row.runs_below], ["collided pairs", row => row.collisions],
  ["step p50 (µs)", row => number(row.step_p50_us, 1)],
];
const table = find("figures"), head = table.createTHead().insertRow(), body = table.createTBody();
COLUMNS.forEach(([name]) => head.append(make("th", "", name)));
// One family is its own total.
const totals = comparison.rows.length > comparison.totals.length ? comparison.totals : [];
for (const row of [...comparison.rows, ...totals]) {
  const line = body.insertRow();
  COLUMNS.forEach(([, text]) => { line.insertCell().textContent = text(row); });
}
find("about").textContent = comparison.command.slice(1).join(" ");
let drawnFor = 0;
new ResizeObserver(() => {
  const width = find("families").clientWidth;
  if (width !== drawnFor) drawFamilies();
  drawnFor = width;
}).observe(find("families"));

"use strict";
// Bars of a comparison: one per controller, with the single runs as dots.

function make(parent, name, className, text) {
  const element = document.createElement(name);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

const median = values => {
  const sorted = [...values].sort((a, b) => a - b), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
};
const MOST_DOTS = 60; // single runs drawn on a bar
const FAILED = "#c1121f", DONE = "#0072b2";

// One bar per row for its `own` runs; `valueOf(run)`: null where a run has no such value. `limits`: [[value, text, class], ...].
function bars(place, title, unit, rows, valueOf, limits = []) {
  const figure = make(place, "figure");
  make(figure, "h3", "", title);
  const width = Math.max(280, figure.clientWidth - 20), row = 34, left = 6, right = width - 70, top = 4;
  const values = rows.map(({ own: runs }) => {
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
  rows.forEach(({ name, own: runs }, n) => {
    const y = top + n * row, { all, counted } = values[n];
    const successes = runs.filter(run => run.success).length, failed = successes < runs.length;
    shape(svg, "text", { x: left, y: y + 12 }, `${name}${failed ? ` ✕ ${successes} of ${runs.length}` : ""}`);
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

"use strict";
// The page of a comparison: a table with a row per family and controller, and a section per family that is
// filled when it is opened: bars, and its layouts one by one.

const { comparison, layouts, runs, minSeparation } = JSON.parse(document.getElementById("data").textContent);
const find = id => document.getElementById(id);
const OPEN_AT_FIRST = 3; // sections of so few families are open
const MOST_LAYOUTS = 300; // listed in a section

// The families in order, each with its rows, and each row with its own runs.
const families = new Map();
comparison.rows.forEach(row => {
  if (!families.has(row.family)) families.set(row.family, []);
  const best = row.best_of ? ` (best of ${row.best_of.variants})` : "";
  families.get(row.family).push({ ...row, name: row.controller + best, own: [] });
});
const rowOf = [...families.values()].flat();
runs.forEach(run => rowOf[run.row].own.push(run));

const number = (value, digits) => value == null ? "–" : value.toFixed(digits);
const interval = (value, digits) => value ? `${number(value.median, digits)} [${number(value.low, digits)}, ${number(value.high, digits)}]` : "–";
const bestOf = ({ variants, variant, best_in, layouts }) => layouts > 1
  ? `best of ${variants} in each layout, mostly ${variant} (${best_in} of ${layouts})` : `best of ${variants}: ${variant}`;
const succeeded = (cell, successes, count) => {
  cell.textContent = `${successes} of ${count}`;
  cell.classList.toggle("failures", successes < count);
};
const COLUMNS = [
  ["family", () => {}],
  ["controller", (cell, row) => {
    cell.textContent = row.controller;
    if (row.best_of) make(cell, "small", "", `best of ${row.best_of.variants} in each layout`).title = bestOf(row.best_of);
  }],
  ["succeeded", (cell, row) => succeeded(cell, row.successes, row.runs)],
  ["path / straight", (cell, row) => { cell.textContent = interval(row.ratio, 3); }],
  ["time (s)", (cell, row) => { cell.textContent = interval(row.time_s, 1); }],
  ["separation (m)", (cell, row) => { cell.textContent = number(row.min_separation, 3); }],
  ["below r_min", (cell, row) => { cell.textContent = row.runs_below; }],
  ["collided", (cell, row) => { cell.textContent = row.collisions; }],
  ["step p50 (µs)", (cell, row) => { cell.textContent = number(row.step_p50_us, 1); }],
];

function head(table, names) {
  const row = table.createTHead().insertRow();
  names.forEach(name => make(row, "th", "", name));
  return table.createTBody();
}

// The rows of one family; its name stands in the first.
function addRows(body, rows, name, className) {
  rows.forEach((row, n) => {
    const line = body.insertRow();
    line.className = `${className} ${n ? "" : "first"}`;
    COLUMNS.forEach(([, fill]) => fill(line.insertCell(), row));
    if (!n) line.cells[0].append(name);
  });
}

// The layouts of a family, a row for each and controller.
function listLayouts(place, rows) {
  const byLayout = new Map();
  rows.forEach(row => row.own.forEach(run => {
    if (!byLayout.has(run.layout)) byLayout.set(run.layout, new Map());
    const own = byLayout.get(run.layout);
    own.set(row.name, [...own.get(row.name) || [], run]);
  }));
  const table = make(make(place, "div", "table"), "table");
  const body = head(table, ["layout", "controller", "succeeded", "path / straight", "time (s)", "separation (m)"]);
  for (const [layout, own] of [...byLayout].slice(0, MOST_LAYOUTS)) {
    let first = true;
    for (const [name, runs] of own) {
      const line = body.insertRow(), good = runs.filter(run => run.success);
      const middle = (valueOf, digits) => good.length ? number(median(good.map(valueOf)), digits) : "–";
      line.className = first ? "first" : "";
      line.insertCell().textContent = first ? layouts[layout] : "";
      make(line.insertCell(), "span", "", name);
      if (runs[0].variant) make(line.cells[1], "small", "", runs[0].variant);
      succeeded(line.insertCell(), good.length, runs.length);
      line.insertCell().textContent = middle(run => run.ratio, 3);
      line.insertCell().textContent = middle(run => run.time, 1);
      const separations = runs.map(run => run.separation).filter(Number.isFinite);
      line.insertCell().textContent = separations.length ? number(Math.min(...separations), 3) : "–";
      first = false;
    }
  }
  const more = byLayout.size - MOST_LAYOUTS;
  if (more > 0) make(place, "p", "muted", `${more} more layouts: runs.csv holds them all`);
}

function drawBars(place, rows) {
  place.replaceChildren();
  bars(place, "Path cost", "path (m)", rows, run => run.path);
  bars(place, "Completion time", "time (s)", rows, run => run.success ? run.time : null);
  bars(place, "Computation time of a robot's tick", "mean (µs)", rows, run => run.stepUs);
  bars(place, `Smallest separation (r_min ${minSeparation} m dashed)`, "separation (m)", rows, run => run.separation,
    [[minSeparation, "r_min", "limit"]]);
}

// A section that draws its bars when it is opened, and anew when its width has changed.
function addSection(name, rows, number, open) {
  const section = make(find("families"), "details", "family");
  section.id = `family-${number}`;
  const summary = make(section, "summary"), count = new Set(rows.flatMap(row => row.own.map(run => run.layout))).size;
  make(summary, "h3", "", name);
  make(summary, "span", "muted", count > 1 ? `${count} layouts` : "");
  rows.filter(row => row.successes < row.runs)
    .forEach(row => make(summary, "small", "failures", `✕ ${row.controller}: ${row.successes} of ${row.runs}`));
  rows.filter(row => row.best_of).forEach(row => make(section, "p", "muted", `${row.controller}: ${bestOf(row.best_of)}`));
  const place = make(section, "div", "charts");
  let drawnFor = 0;
  new ResizeObserver(() => {
    if (section.open && place.clientWidth !== drawnFor) drawBars(place, rows);
    if (section.open) drawnFor = place.clientWidth;
  }).observe(place);
  if (count > 1) {
    const list = make(section, "details", "layouts");
    make(list, "summary", "", `${count} layouts one by one`);
    list.addEventListener("toggle", () => listLayouts(list, rows), { once: true });
  }
  section.open = open;
  return section;
}

const body = head(find("figures"), COLUMNS.map(([name]) => name));
const several = families.size > 1;
// One family is its own total.
const totals = several ? comparison.totals : [];
addRows(body, totals, "all", "total");
const link = (name, number) => {
  const anchor = document.createElement("a");
  anchor.href = `#family-${number}`;
  make(anchor, "span", "", name);
  return anchor;
};
const shown = [...families].map(([name, rows], number) => {
  const before = body.rows.length, failing = rows.some(row => row.successes < row.runs);
  addRows(body, rows, link(name, number), "");
  const entry = make(find("index").querySelector("ul"), "li"), anchor = link(name, number);
  entry.append(anchor);
  if (failing) make(anchor, "span", "failures", "✕").title = "some runs failed";
  const section = addSection(name, rows, number, families.size <= OPEN_AT_FIRST);
  return { name: name.toLowerCase(), failing, parts: [entry, section, ...[...body.rows].slice(before)] };
});

function filter() {
  const words = find("filter").value.toLowerCase(), failing = find("failing").checked;
  let count = 0;
  for (const family of shown) {
    const wanted = family.name.includes(words) && (family.failing || !failing);
    family.parts.forEach(part => { part.hidden = !wanted; });
    count += wanted;
  }
  find("index").firstElementChild.textContent = count < shown.length ? `${count} of ${shown.length} families` : `${count} families`;
}
find("filter").addEventListener("input", filter);
find("failing").addEventListener("change", filter);
filter();

// Who follows a link wants to see what is there.
const openTarget = () => {
  const section = /^#family-\d+$/.test(location.hash) && document.querySelector(location.hash);
  if (!section) return;
  section.open = true;
  // Its bars are drawn in the next frame: before that the page may be too short to scroll so far.
  requestAnimationFrame(() => requestAnimationFrame(() => section.scrollIntoView()));
};
addEventListener("hashchange", openTarget);
openTarget();

document.querySelector(".indexed").classList.toggle("alone", !several);
if (innerWidth <= 800) find("index").open = false;
find("about").textContent = `${layouts.length} layouts, ${comparison.totals.length} controllers, ${runs.length} runs`;
find("command").textContent = comparison.command.join(" ");

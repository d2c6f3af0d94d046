"use strict";
// The report: cards, the player that moves all replays together, charts.

const data = JSON.parse(document.getElementById("data").textContent);
const runs = data.runs.map(run => new Run(run));
const find = id => document.getElementById(id);
const make = (name, className, text) => {
  const element = document.createElement(name);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  return element;
};

function cardsOf(run) {
  const s = run.summary, metres = value => value == null ? "–" : `${value.toFixed(3)} m`;
  if (!s) return [["ended", "the record was cut", "bad"], ["ticks", run.ticks]];
  const arrived = s.robots.filter(robot => robot.arrived_tick != null).length;
  const safe = s.ticks_below_min_separation === 0;
  return [
    ["success", s.success ? "yes" : "no", s.success ? "good" : "bad"],
    ["arrived", `${arrived} of ${s.robots.length}`],
    ["completion time", s.completion_time == null ? "–" : `${s.completion_time.toFixed(1)} s`],
    ["ticks", s.ticks],
    ["path", `${s.path_cost.toFixed(2)} m`],
    ["path / straight line", s.path_ratio == null ? "–" : s.path_ratio.toFixed(4)],
    ["min separation", metres(s.min_separation), safe ? "good" : "bad"],
    ["ticks below r_min", s.ticks_below_min_separation, safe ? "good" : "bad"],
    ["collided pairs", s.collisions, s.collisions ? "bad" : "good"],
    ["collision rows", s.activations],
    ["fallbacks", s.statuses.shifted + s.statuses.stopped],
    ["tick p50", `${(s.tick_latency.p50_us / 1e3).toFixed(2)} ms`],
    ["longest tick", `${(s.tick_latency.max_us / 1e3).toFixed(2)} ms`],
    ["guarantee", s.guarantee, "", "wide"],
    ...(s.absences || []).map(({ name, state, tick, why, until }) => [
      "absent", `${name} ${state} at tick ${tick}: it ${why}${until == null ? "" : `; back at tick ${until}`}`, "bad", "wide"]),
    ...policyCards(s.policy),
  ];
}

function policyCards(policy) {
  if (!policy) return [];
  const shown = 6, more = policy.versions.length - shown;
  const versions = policy.versions.slice(0, shown).map(({ version, sha256, from_tick, to_tick }) =>
    `${version} (sha256 ${sha256.slice(0, 12)}), ticks ${from_tick} to ${to_tick}`);
  if (more > 0) versions.push(`${more} more in policy.csv`);
  const us = value => `${value.toFixed(0)} µs`;
  const cards = [
    ["policy", `${policy.source}: ${versions.join("; ")}`, "", "wide"],
    ["policy answers", `${policy.answered} in time, ${policy.late} late (horizons held ${policy.held} ticks, default `
      + `${policy.default_used}); inference p50 ${us(policy.inference.p50_us)}, longest ${us(policy.inference.max_us)}`, "", "wide"],
  ];
  const shadow = policy.shadow;
  if (shadow) {
    cards.push(["shadow", `${shadow.source}: differs in ${(100 * shadow.differing / Math.max(shadow.compared, 1)).toFixed(1)} % `
      + `of ${shadow.compared} horizons, by ${shadow.mean_distance.toFixed(2)} steps on average, at most ${shadow.max_distance}`,
      "", "wide"]);
  }
  return cards;
}

for (const run of runs) {
  const place = make("div"), list = make("dl", "cards");
  place.append(make("h3", "", run.name()));
  for (const [name, value, kind, wide] of cardsOf(run)) {
    const card = make("div", wide ? "card wide" : "card");
    card.append(make("dt", "", name), make("dd", kind || "", value));
    list.append(card);
  }
  place.append(list, make("p", "muted", `${run.folder} · seed ${run.about.seed} · ${run.about.exchange} exchange`));
  find("cards").append(place);
}
find("cards").className = runs.length > 1 ? "columns" : "";

// One scale for all places, so that runs side by side are comparable.
const join = (a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
const bounds = runs.map(run => boundsOf(run.layout, run.positions)).reduce(join);
const scenes = runs.map(run => {
  const figure = make("figure"), canvas = make("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `Replay of ${run.name()}`);
  if (runs.length > 1) figure.append(make("h3", "", run.name()));
  figure.append(canvas);
  find("scenes").append(figure);
  return new Scene(canvas, run.layout, bounds);
});

const scales = scalesOf(runs);
find("charts").className = runs.length > 1 ? "columns" : "";
const places = runs.map(() => {
  const place = make("div", runs.length > 1 ? "stack" : "charts");
  find("charts").append(place);
  return place;
});
let charts = [];

// Charts are drawn for the width they have, so a new width draws them anew.
function drawCharts() {
  // Keeps the reader's place while the charts are away.
  find("charts").style.minHeight = `${find("charts").offsetHeight}px`;
  charts = runs.flatMap((run, n) => {
    places[n].replaceChildren();
    if (runs.length > 1) places[n].append(make("h3", "", run.name()));
    return chartsOf(run, scales, bounds, places[n]);
  });
  find("charts").style.minHeight = "";
  charts.forEach(chart => chart.follow(player.followed));
  charts.forEach(chart => chart.mark(player.time * sampleTime));
}

const lastTick = Math.max(...runs.map(run => run.ticks));
const sampleTime = runs[0].layout.sampleTime;
const player = { time: 0, playing: false, followed: null, before: 0 };
find("scrub").max = lastTick;

function show() {
  runs.forEach((run, n) => scenes[n].draw(run.frame(Math.min(player.time, run.ticks))));
  const tick = Math.floor(player.time);
  find("scrub").value = tick;
  find("time").textContent = `tick ${tick} / ${lastTick} · ${(player.time * sampleTime).toFixed(1)} s`;
  charts.forEach(chart => chart.mark(player.time * sampleTime));
}

function move(now) {
  if (!player.playing) return;
  player.time += (now - player.before) / 1000 / sampleTime * Number(find("speed").value);
  player.before = now;
  if (player.time >= lastTick) {
    player.time = lastTick;
    setPlaying(false);
  }
  show();
  requestAnimationFrame(move);
}

function setPlaying(playing) {
  if (playing && player.time >= lastTick) player.time = 0;
  const begins = playing && !player.playing;
  player.playing = playing;
  find("play").textContent = playing ? "Pause" : "Play";
  find("play").setAttribute("aria-pressed", playing);
  if (begins) requestAnimationFrame(now => { player.before = now; move(now); });
}

function goTo(tick) {
  setPlaying(false);
  player.time = Math.max(0, Math.min(lastTick, tick));
  show();
}

function follow(robot) {
  player.followed = robot;
  scenes.forEach(scene => { scene.followed = robot; });
  charts.forEach(chart => chart.follow(robot));
  find("followed").textContent = robot === null ? "" : `following robot ${robot}`;
  show();
}

find("play").onclick = () => setPlaying(!player.playing);
find("scrub").oninput = event => goTo(Number(event.target.value));
scenes.forEach(scene => {
  scene.canvas.onclick = event => follow(scene.pick(event.offsetX, event.offsetY));
});
function changeSpeed(by) {
  const speed = find("speed");
  speed.selectedIndex = Math.max(0, Math.min(speed.options.length - 1, speed.selectedIndex + by));
}
const KEYS = {
  " ": () => setPlaying(!player.playing),
  ArrowLeft: () => goTo(Math.ceil(player.time) - 1),
  ArrowRight: () => goTo(Math.floor(player.time) + 1),
  Home: () => goTo(0),
  End: () => goTo(lastTick),
  "+": () => changeSpeed(1),
  "-": () => changeSpeed(-1),
  Escape: () => follow(null),
};
document.addEventListener("keydown", event => {
  const key = KEYS[event.key];
  if (!key || event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
  event.preventDefault();
  key();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
let drawnFor = 0;
new ResizeObserver(() => {
  const width = find("charts").clientWidth;
  if (width !== drawnFor) drawCharts();
  drawnFor = width;
}).observe(find("charts"));
show();

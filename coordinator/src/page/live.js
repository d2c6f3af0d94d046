"use strict";
// The live page: draws the newest frame that came, at most one per repaint.

const { layout, horizons } = JSON.parse(document.getElementById("data").textContent);
const find = id => document.getElementById(id);
const scene = new Scene(find("scene"), layout, boundsOf(layout, []));
const live = { newest: null, held: false, frames: 0, trails: layout.robots.map(() => []) };

function cards(frame) {
  const separation = frame.minSeparation === null ? "–" : `${frame.minSeparation.toFixed(3)} m`;
  const entries = [
    ["tick", `${frame.tick + 1} of ${layout.maxTicks}`],
    ["time", `${((frame.tick + 1) * layout.sampleTime).toFixed(1)} s`],
    ["arrived", `${frame.arrived} of ${frame.robots.length}`],
    ["min separation", separation],
    ["tick time", `${frame.tickMs.toFixed(2)} ms`],
    ["fallbacks", frame.fallbacks],
    ["horizons", horizons],
  ];
  for (const absent of frame.absent) entries.push(["absent", absent, "wide"]);
  if (frame.policy !== null) entries.push(["policy", frame.policy, "wide"]);
  find("cards").replaceChildren(...entries.map(([name, value, wide]) => {
    const card = document.createElement("div"), term = document.createElement("dt"), text = document.createElement("dd");
    card.className = wide ? "card wide" : "card";
    term.textContent = name;
    text.textContent = value;
    card.append(term, text);
    return card;
  }));
}

function table(frame) {
  find("robots").replaceChildren(...frame.robots.map((robot, i) => {
    const [x, y] = layout.robots[i].setPoint;
    const distance = Math.hypot(robot.x - x, robot.y - y).toFixed(2);
    const row = document.createElement("tr");
    for (const value of [i, distance, robot.horizon, robot.rows, robot.solveUs.toFixed(1), robot.level, robot.status]) {
      row.insertCell().textContent = value;
    }
    return row;
  }));
}

function show() {
  const frame = live.newest;
  live.newest = null;
  frame.robots.forEach((robot, i) => {
    const trail = live.trails[i];
    trail.push(robot.x, robot.y);
    trail.splice(0, Math.max(0, trail.length - 2 * TRAIL));
    robot.trail = trail;
  });
  scene.draw(frame);
  cards(frame);
  table(frame);
  live.frames++;
}

const source = new EventSource("frames");
source.onmessage = event => {
  if (live.held) return;
  find("state").textContent = "live";
  const waiting = live.newest !== null;
  live.newest = JSON.parse(event.data);
  if (!waiting) requestAnimationFrame(show);
};
source.addEventListener("end", () => {
  source.close();
  find("state").textContent = "the run has ended";
});
source.onerror = () => {
  source.close();
  find("state").textContent = "the connection to the run is lost";
};

function hold() {
  live.held = !live.held;
  find("play").textContent = live.held ? "Continue" : "Pause";
  find("play").setAttribute("aria-pressed", !live.held);
}
find("play").onclick = hold;
find("scene").onclick = event => {
  if (!scene.frame) return;
  scene.followed = scene.pick(event.offsetX, event.offsetY);
  find("followed").textContent = scene.followed === null ? "" : `following robot ${scene.followed}`;
  scene.draw(scene.frame);
};
document.addEventListener("keydown", event => {
  if (event.key !== " " || event.target.tagName === "BUTTON") return;
  event.preventDefault();
  hold();
});

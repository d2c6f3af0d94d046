//! A recorded run as the data of its page: JSON with long columns in base64.

use super::base64::{encode, floats};
use super::recorded::Recorded;
use super::rows::rows;
use crate::view::Frame;
use agent::layout::Layout;
use agent::vodca::memory::ConflictMemory;
use serde_json::{Value, json};
use shared::Position;
use shared::metrics::Disc;
use shared::params::Params;
use shared::scenario::Scenario;
use shared::separation::separation;
use shared::step::Step;

/// What does not change during a run: names, sizes, places, limits. Metres, seconds, m/s.
pub fn layout(scenario: &Scenario, params: &Params) -> Value {
    let half = params.model.min_separation / 2.0;
    let point = |at: Position| json!([at.x, at.y]);
    let robots: Vec<Value> = scenario
        .robots
        .iter()
        .map(|robot| {
            json!({
                "name": robot.name, "radius": robot.radius.unwrap_or(half),
                "start": point(robot.start), "setPoint": point(robot.set_point),
            })
        })
        .collect();
    let obstacles: Vec<Value> = scenario
        .obstacles
        .iter()
        .map(|obstacle| {
            json!({ "name": obstacle.name, "at": point(obstacle.position), "radius": obstacle.radius.unwrap_or(half) })
        })
        .collect();
    json!({
        "scenario": scenario.name, "robots": robots, "obstacles": obstacles,
        "maxTicks": scenario.max_ticks, "sampleTime": params.model.sample_time, "maxSpeed": params.model.max_speed,
        "minSeparation": params.model.min_separation,
        "collisionDistance": params.episode.collision_factor * params.model.min_separation,
    })
}

/// The run as its page reads it (`data.js` takes it apart).
pub fn run(recorded: &Recorded) -> Value {
    let Recorded { scenario, params, ticks, .. } = recorded;
    let steps = || ticks.iter().flatten();
    let last = ticks.last().map(|steps| steps.iter().map(|step| step.next_position).collect::<Vec<_>>());
    let last = last.unwrap_or_else(|| scenario.robots.iter().map(|robot| robot.start).collect());
    let positions = steps().map(|step| step.position).chain(last);
    let has_latency = recorded.tick_ns.len() == ticks.len();
    let step_us = steps().filter(|_| has_latency).map(|step| step.step_ns as f64 / 1e3);
    json!({
        "folder": recorded.folder.display().to_string(),
        "about": recorded.about,
        "summary": recorded.summary,
        "layout": layout(scenario, params),
        "ticks": ticks.len(),
        "positions": floats(positions.flat_map(|at| [at.x, at.y])),
        "inputs": floats(steps().flat_map(|step| [step.input.x, step.input.y])),
        "horizons": bytes(steps().map(|step| step.horizon.steps())),
        "rows": bytes(steps().map(|step| step.rows as usize)),
        "levels": bytes(steps().map(|step| step.level as usize)),
        "statuses": bytes(steps().map(|step| step.status as usize)),
        "separation": floats(separations(scenario, params, ticks)),
        "tickMs": floats(recorded.tick_ns.iter().filter(|_| has_latency).map(|&ns| ns as f64 / 1e6)),
        "stepUs": floats(step_us),
        "plans": plans(params, ticks),
        "lines": lines(scenario, params, ticks),
    })
}

fn bytes(values: impl Iterator<Item = usize>) -> String {
    encode(&values.map(|value| value.min(255) as u8).collect::<Vec<u8>>())
}

/// Plans as moves of whole `grid` metres, one signed byte per axis and step; what is rounded off goes into
/// the next move, so that no point is off by more than half a grid.
fn plans(params: &Params, ticks: &[Vec<Step>]) -> Value {
    let grid = params.model.max_speed * params.model.sample_time / 120.0;
    let (mut lengths, mut moves) = (Vec::new(), Vec::new());
    for step in ticks.iter().flatten() {
        let states = step.plan.states();
        lengths.push(states.len() - 1);
        let mut at = step.position;
        for &state in &states[1..] {
            for axis in 0..2 {
                let cells = ((state[axis] - at[axis]) / grid).round().clamp(-127.0, 127.0);
                at[axis] += cells * grid;
                moves.push(cells as i8 as u8);
            }
        }
    }
    json!({ "grid": grid, "lengths": bytes(lengths.into_iter()), "moves": encode(&moves) })
}

/// Active collision rows: how many per tick and robot, then step, normal's angle (rad) and offset (m) of each.
fn lines(scenario: &Scenario, params: &Params, ticks: &[Vec<Step>]) -> Value {
    let layout = Layout::of(scenario, params.model.min_separation);
    let mut found = Vec::new();
    let mut counts = vec![0; ticks.first().map_or(0, Vec::len)];
    let mut memories = vec![ConflictMemory::default(); counts.len()];
    for (tick, pair) in ticks.windows(2).enumerate() {
        for robot in 0..pair[1].len() {
            let memory = memories[robot];
            // Only the rows are asked of it, which traffic ahead does not change.
            memories[robot].remember(&params.aim, &params.vodca, pair[1][robot].rows as usize, 0.0);
            let rows = rows(params, &layout, robot, &memory, tick as u64 + 1, &pair[0], &pair[1]);
            counts.push(rows.len());
            found.extend(rows);
        }
    }
    json!({
        "counts": bytes(counts.into_iter()),
        "steps": bytes(found.iter().map(|row| row.step)),
        "angles": floats(found.iter().map(|row| row.normal.y.atan2(row.normal.x))),
        "offsets": floats(found.iter().map(|row| row.offset)),
    })
}

/// Smallest separation of every robot to anything in every tick, m, between samples too and with radii
/// beyond min_separation / 2 taken off; -1 when there is nothing else.
pub fn separations(scenario: &Scenario, params: &Params, ticks: &[Vec<Step>]) -> Vec<f64> {
    let discs = scenario.discs(params.model.min_separation);
    let extra = |robot: usize| scenario.extra_radius(robot, params.model.min_separation);
    let mut all = Vec::new();
    for steps in ticks {
        let motion = |robot: usize| (steps[robot].position, steps[robot].next_position);
        for robot in 0..steps.len() {
            let others = (0..steps.len()).filter(|&other| other != robot);
            let to_robots = others.map(|other| separation(motion(robot), motion(other)) - extra(other));
            let to_discs =
                discs.iter().map(|disc: &Disc| separation(motion(robot), (disc.centre, disc.centre)) - disc.extra);
            let least = to_robots.chain(to_discs).fold(f64::INFINITY, f64::min) - extra(robot);
            all.push(if least.is_finite() { least } else { -1.0 });
        }
    }
    all
}

/// One moment of a running team as the live page reads it.
pub fn live_frame(frame: &Frame, params: &Params, layout: &Layout) -> Value {
    let cm = |metres: f64| (metres * 100.0).round() / 100.0;
    let robots: Vec<Value> = (0..frame.steps.len())
        .map(|robot| {
            let step = &frame.steps[robot];
            let rows = match frame.before.len() {
                0 => Vec::new(),
                _ => rows(params, layout, robot, &frame.memories[robot], frame.tick, &frame.before, &frame.steps),
            };
            let lines: Vec<Value> = rows
                .iter()
                .map(|row| json!({ "step": row.step, "angle": row.normal.y.atan2(row.normal.x), "offset": row.offset }))
                .collect();
            let plan: Vec<f64> = step.plan.states().iter().flat_map(|at| [cm(at.x), cm(at.y)]).collect();
            json!({
                "x": step.position.x, "y": step.position.y, "horizon": step.horizon, "rows": step.rows,
                "level": step.level, "status": step.status, "solveUs": step.solve_ns as f64 / 1e3,
                "plan": plan, "lines": lines,
            })
        })
        .collect();
    let separation = Some(frame.min_separation).filter(|separation| separation.is_finite());
    json!({
        "tick": frame.tick, "tickMs": frame.duration.as_secs_f64() * 1e3, "arrived": frame.arrived,
        "minSeparation": separation, "fallbacks": frame.fallbacks, "robots": robots,
        "policy": frame.acting.map(|acting| acting.to_string()),
    })
}

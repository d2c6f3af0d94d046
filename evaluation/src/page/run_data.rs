//! A recorded run as the data of its page: JSON with long columns in base64.

use super::recorded::Recorded;
use coordinator::page::scene::layout;
use policy::encoding::base64;
use serde_json::{Value, json};
use std::sync::Arc;
use vodca::explain::Explainer;
use vodca::layout::Layout;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::separation::separation;
use vodca::step::Step;

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
        "plans": plans(scenario, params, ticks),
        "lines": lines(scenario, params, ticks),
    })
}

fn bytes(values: impl Iterator<Item = usize>) -> String {
    base64(&values.map(|value| value.min(255) as u8).collect::<Vec<u8>>())
}

/// Plans as moves of whole `grid` metres, one signed byte per axis and step; what is rounded off goes into
/// the next move, so that no point is off by more than half a grid.
fn plans(scenario: &Scenario, params: &Params, ticks: &[Vec<Step>]) -> Value {
    let grid = scenario.fastest(params.model.max_speed) * params.model.sample_time / 120.0;
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
    json!({ "grid": grid, "lengths": bytes(lengths.into_iter()), "moves": base64(&moves) })
}

/// Single-precision numbers, little-endian.
fn floats(values: impl IntoIterator<Item = f64>) -> String {
    let bytes: Vec<u8> = values.into_iter().flat_map(|value| (value as f32).to_le_bytes()).collect();
    base64(&bytes)
}

/// Active collision rows: how many per tick and robot, then step, normal's angle (rad) and offset (m) of each.
fn lines(scenario: &Scenario, params: &Params, ticks: &[Vec<Step>]) -> Value {
    let layout = Layout::of(scenario, &params.model);
    let mut explainer = Explainer::new(Arc::new(params.clone()), Arc::new(layout));
    let (mut found, mut counts) = (Vec::new(), Vec::new());
    for (tick, steps) in ticks.iter().enumerate() {
        explainer.observe(tick as u64, steps);
        for robot in 0..steps.len() {
            let rows = explainer.rows(robot).unwrap_or_default();
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
    let obstacles = scenario.standing(params.model.min_separation);
    let extra = |robot: usize| scenario.extra_radius(robot, params.model.min_separation);
    let mut all = Vec::new();
    for steps in ticks {
        let motion = |robot: usize| (steps[robot].position, steps[robot].next_position);
        for robot in 0..steps.len() {
            let others = (0..steps.len()).filter(|&other| other != robot);
            let to_robots = others.map(|other| separation(motion(robot), motion(other)) - extra(other));
            let to_discs =
                obstacles.discs().iter().map(|disc| separation(motion(robot), (disc.centre, disc.centre)) - disc.extra);
            let (from, to) = motion(robot);
            let to_shapes = obstacles.separations(from, to, f64::INFINITY).map(|(_, separation)| separation);
            let least = to_robots.chain(to_discs).chain(to_shapes).fold(f64::INFINITY, f64::min) - extra(robot);
            all.push(if least.is_finite() { least } else { -1.0 });
        }
    }
    all
}

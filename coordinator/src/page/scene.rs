//! What a page draws the team from, as JSON.

use crate::view::Frame;
use serde_json::{Value, json};
use vodca::Position;
use vodca::params::Params;
use vodca::scenario::Scenario;

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
    // What is no disc: closed chains of points, filled by the even-odd rule, and drawn so much wider on all sides.
    let shapes: Vec<Value> = (scenario.shapes.iter())
        .map(|shape| {
            let rings: Vec<Vec<Value>> =
                shape.rings().iter().map(|ring| ring.iter().map(|at| point(*at)).collect()).collect();
            json!({ "name": shape.name(), "rings": rings, "radius": shape.radius() })
        })
        .collect();
    json!({
        "scenario": scenario.name, "robots": robots, "obstacles": obstacles, "shapes": shapes,
        "maxTicks": scenario.max_ticks, "sampleTime": params.model.sample_time, "maxSpeed": scenario.fastest(params.model.max_speed),
        "minSeparation": params.model.min_separation,
        "collisionDistance": params.episode.collision_factor * params.model.min_separation,
    })
}

/// One moment of a running team as the live page reads it.
pub fn frame(frame: &Frame) -> Value {
    let cm = |metres: f64| (metres * 100.0).round() / 100.0;
    let robots: Vec<Value> = (frame.explainer.steps().iter().enumerate())
        .map(|(robot, step)| {
            let rows = frame.explainer.rows(robot).unwrap_or_default();
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
        "absent": frame.absent,
        "policy": frame.acting.map(|acting| acting.to_string()),
    })
}

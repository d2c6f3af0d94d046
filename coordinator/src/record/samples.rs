//! Small made-up runs for tests.

use shared::horizon::Horizon;
use shared::prediction::Prediction;
use shared::scenario::{Obstacle, Robot, Scenario};
use shared::step::{Level, Status, Step};
use shared::{Input, Position};

/// `robots` robots 10 m apart that travel 5 m to the right.
pub(crate) fn scenario(robots: usize) -> Scenario {
    let robot = |i: usize| Robot {
        name: format!("r{i}"),
        start: Position::new(10.0 * i as f64, 0.0),
        set_point: Position::new(10.0 * i as f64 + 5.0, 0.5),
        radius: None,
    };
    Scenario {
        name: "sample".into(),
        robots: (0..robots).map(robot).collect(),
        obstacles: vec![Obstacle { name: "rock".into(), position: Position::new(0.0, 9.0), radius: Some(1.0) }],
        max_ticks: 100,
        seed: 5,
        allow_close_start: false,
        params: toml::Table::new(),
    }
}

/// What they do in `tick`.
pub(crate) fn steps(robots: usize, tick: u64) -> Vec<Step> {
    let input = Input::new(1.5, 0.25);
    let step = |i: usize| {
        let start = Position::new(10.0 * i as f64, 0.0);
        let position = (0..tick).fold(start, |at, _| at + input * 0.2);
        Step {
            position,
            input,
            next_position: position + input * 0.2,
            horizon: Horizon::saturating(3),
            rows: 0,
            level: Level::ClosedForm,
            status: Status::Solved,
            shielded: false,
            plan: Prediction::roll_out(position, start + Position::new(5.0, 0.5), 0.2, &[input; 3]),
            detect_ns: 300,
            solve_ns: 400,
            step_ns: 1_000,
        }
    };
    (0..robots).map(step).collect()
}

/// A real run of a team in this process, recorded in `folder`, with horizons from `random:3`.
pub(crate) fn record_run(folder: &std::path::Path, scenario: &str, params: &shared::params::Params) {
    record_ticks(folder, scenario, params, 120);
}

/// The same, stopped after `max_ticks` ticks, which may be none.
pub(crate) fn record_ticks(folder: &std::path::Path, scenario: &str, params: &shared::params::Params, max_ticks: u64) {
    use crate::record::about::{Machine, Versions};
    use crate::record::{About, RunFolder};
    use crate::tick_parts::TickTimes;
    let mut scenario = Scenario::resolve(Some(scenario), None).unwrap();
    scenario.max_ticks = 120;
    let about = About {
        version: 1,
        scenario: scenario.name.clone(),
        robots: scenario.robots.len(),
        profile: "sample".into(),
        horizon: "random:3".into(),
        seed: scenario.seed,
        exchange: "none".into(),
        real_time: false,
        command: vec![],
        versions: Versions::here(),
        machine: Machine::here(),
    };
    let folder = RunFolder::at(folder).unwrap();
    let mut session = crate::session::Session::start(folder, &scenario, params, about).unwrap();
    let horizon = |robot, tick| Horizon::random(3, robot, tick);
    let driven = Scenario { max_ticks, ..scenario.clone() };
    crate::in_process::run_team(&driven, params, horizon, |tick, steps| {
        session.tick(tick, steps, &TickTimes { duration_ns: 5_000, ..TickTimes::default() }).map(|_| ())
    })
    .unwrap();
    session.finish(crate::summary::End::OutOfTicks, None).unwrap();
}

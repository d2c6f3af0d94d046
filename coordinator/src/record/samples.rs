//! Small made-up runs for the tests of this crate and of those that read records.

use vodca::horizon::Horizon;
use vodca::prediction::Prediction;
use vodca::scenario::{Obstacle, Robot, Scenario};
use vodca::step::{Level, Status, Step};
use vodca::{Input, Position};

/// `robots` robots 10 m apart that travel 5 m to the right.
pub fn scenario(robots: usize) -> Scenario {
    let robot = |i: usize| Robot {
        name: format!("r{i}"),
        start: Position::new(10.0 * i as f64, 0.0),
        set_point: Position::new(10.0 * i as f64 + 5.0, 0.5),
        radius: None,
        max_speed: None,
    };
    Scenario {
        name: "sample".into(),
        robots: (0..robots).map(robot).collect(),
        obstacles: vec![Obstacle { name: "rock".into(), position: Position::new(0.0, 9.0), radius: Some(1.0) }],
        shapes: Vec::new(),
        max_ticks: 100,
        seed: 5,
        allow_close_start: false,
        params: toml::Table::new(),
    }
}

/// What they do in `tick`.
pub fn steps(robots: usize, tick: u64) -> Vec<Step> {
    let input = Input::new(1.5, 0.25);
    let step = |i: usize| {
        let start = Position::new(10.0 * i as f64, 0.0);
        let position = (0..tick).fold(start, |at, _| at + input * 0.2);
        Step {
            position,
            measured: position,
            input,
            next_position: position + input * 0.2,
            next_measured: position + input * 0.2,
            horizon: Horizon::saturating(3),
            rows: 0,
            level: Level::ClosedForm,
            status: Status::Solved,
            filtered: false,
            plan: Prediction::roll_out(position, start + Position::new(5.0, 0.5), 0.2, &[input; 3]),
            detect_ns: 300,
            solve_ns: 400,
            step_ns: 1_000,
        }
    };
    (0..robots).map(step).collect()
}

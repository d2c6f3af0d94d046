//! A robot that takes part in the exchange and does nothing else: the tick without a QP.

use agent::run::{Drive, Launch, RunError, run};
use shared::stop::StopFlag;
use std::path::Path;
use vodca::horizon::Horizon;
use vodca::neighbour_estimates::NeighbourEstimates;
use vodca::prediction::Prediction;
use vodca::step::{Level, Status, Step};
use vodca::{Input, Position};

struct Still {
    position: Position,
    set_point: Position,
    states: Vec<Position>,
}

impl Drive for Still {
    fn measured(&self) -> Position {
        self.position
    }

    fn restart(&mut self, _: u64, at: Position) {
        self.position = at;
    }

    fn step(&mut self, _: u64, horizon: Horizon, _: &NeighbourEstimates) -> Step {
        Step {
            position: self.position,
            measured: self.position,
            input: Input::zeros(),
            next_position: self.position,
            next_measured: self.position,
            horizon,
            rows: 0,
            level: Level::Baseline,
            status: Status::Solved,
            filtered: false,
            plan: Prediction::from_states(&self.states[..=horizon.steps()], self.set_point),
            detect_ns: 0,
            solve_ns: 0,
            step_ns: 0,
        }
    }
}

/// Takes part as robot `robot` of the run in `folder`.
pub(super) fn drive(folder: &Path, robot: usize, parent: Option<u32>, stop: &StopFlag) -> Result<(), RunError> {
    run(Launch { run: folder, robot, parent }, stop, |setup, robot| {
        let here = &setup.scenario.robots[robot];
        let states = vec![here.start; Horizon::MAX.steps() + 1];
        Still { position: here.start, set_point: here.set_point, states }
    })
}

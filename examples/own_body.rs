//! A body of your own in a robot's process. `./run.sh 2 --by-hand` prints the robots' commands; start this program in
//! place of `agent` with the same arguments.

use agent::run::{Launch, run};
use shared::stop::StopFlag;
use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use vodca::body::Body;
use vodca::layout::Layout;
use vodca::robot::Robot;
use vodca::vodca_controller::VodcaController;
use vodca::{Input, Position};

/// A driver of real wheels would stand here: this one only counts.
struct Wheels {
    /// Where odometry believes to be, m.
    odometry: Position,
    /// Sample time, s.
    hold: f64,
}

impl Body for Wheels {
    fn measure(&mut self, _tick: u64) -> Position {
        self.odometry // a real body: its newest pose, carried on by the input it was given last
    }

    fn apply(&mut self, input: Input) {
        self.odometry += input * self.hold; // a real body: sends the velocity to its motors
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let stop = StopFlag::install()?;
    let argument = |name: &str| std::env::args().skip_while(|word| word != name).nth(1);
    let folder = PathBuf::from(argument("--run").ok_or("--run FOLDER is missing")?);
    let robot = argument("--robot").ok_or("--robot NUMBER is missing")?.parse()?;
    run(Launch { run: &folder, robot, parent: None }, &stop, |setup, robot| {
        let layout = Arc::new(Layout::of(&setup.scenario, &setup.params.model));
        let wheels = Wheels { odometry: setup.scenario.robots[robot].start, hold: setup.params.model.sample_time };
        Robot::of(Box::new(wheels), Box::new(VodcaController::new(robot, &setup.params, &layout)))
    })?;
    Ok(())
}

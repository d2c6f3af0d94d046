//! `agent`: one robot's process in a run that is under way.

use crate::exit::{Ending, Failure, Outcome};
use agent::run::{Launch, run as drive, simulated};
use shared::stop::StopFlag;
use std::path::PathBuf;

/// Arguments of `agent`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example, for a robot that was lost at tick 41:
  ./run.sh agent --run runs/20260131-120000-ex14_d-14 --robot 3
It is admitted to the run, measures itself, hears the others and drives on; it ends with the run.")]
pub struct Args {
    /// Folder of the run
    #[arg(long, value_name = "RUN")]
    run: PathBuf,
    /// Number of the robot, from 0
    #[arg(long)]
    robot: usize,
}

/// Drives the robot until the run ends.
pub fn run(args: &Args) -> Ending {
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let launch = Launch { run: &args.run, robot: args.robot, parent: None };
    drive(launch, &stop, simulated).map_err(Failure::broken)?;
    Ok(Outcome::Done)
}

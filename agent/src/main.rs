//! One robot of a team, as a process. The coordinator starts it; by hand: `agent --run DIR --robot I`.

use agent::run::{Launch, run, simulated};
use clap::Parser;
use shared::stop::StopFlag;
use std::path::PathBuf;
use std::process::ExitCode;

/// One robot of a team. Everything but its number is in the folder of the run.
#[derive(Parser)]
#[command(version)]
struct Args {
    /// Folder of the run (written by the coordinator)
    #[arg(long)]
    run: PathBuf,
    /// Number of the robot, from 0
    #[arg(long)]
    robot: usize,
    /// End together with this process
    #[arg(long, value_name = "PID")]
    parent: Option<u32>,
}

fn main() -> ExitCode {
    let done = StopFlag::install().map_err(anyhow::Error::from).and_then(|stop| {
        let args = Args::parse();
        let launch = Launch { run: &args.run, robot: args.robot, parent: args.parent };
        Ok(run(launch, &stop, simulated)?)
    });
    if let Err(error) = done {
        eprintln!("error: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

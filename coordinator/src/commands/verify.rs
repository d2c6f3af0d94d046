//! `verify`: checks a recorded run from its CSV alone.

use crate::exit::{Ending, Failure, Outcome};
use std::path::PathBuf;

/// Arguments of `verify`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  ./run.sh verify runs/20260131-120000-ex14_d-14
Recomputes separation between samples, arrival, input bounds and the model from trajectory.csv, scenario.toml
and params.toml, with code of its own, and compares with summary.json. Exit code 1 and the place if anything is off.")]
pub struct Args {
    /// Folder of a recorded run
    run: PathBuf,
}

/// Checks the run.
pub fn run(args: Args) -> Ending {
    let report = crate::verify::verify(&args.run).map_err(Failure::broken)?;
    for finding in &report.findings {
        println!("{finding}");
    }
    if !report.findings.is_empty() {
        println!("{}: {} checks failed", args.run.display(), report.findings.len());
        return Ok(Outcome::Failed);
    }
    println!(
        "{}: {} ticks of {} robots follow the model within their input bounds; minimum separation {:.6} m; {} arrived; \
         the summary is right",
        args.run.display(),
        report.ticks,
        report.robots,
        report.min_separation,
        report.arrived
    );
    Ok(Outcome::Done)
}

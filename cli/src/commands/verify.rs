//! `verify`: checks a recorded run from its CSV alone.

use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
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
    let report = evaluation::verify::verify(&args.run).map_err(Failure::broken)?;
    for finding in &report.findings {
        stdout::line(finding)?;
    }
    if !report.findings.is_empty() {
        stdout::line(format_args!("{}: {} checks failed", args.run.display(), report.findings.len()))?;
        return Ok(Outcome::Failed);
    }
    let summary = match (report.cut, report.ticks) {
        (false, _) => "the summary is right".into(),
        (true, 0) => "the record was cut before the end of tick 0 and has no summary".into(),
        (true, ticks) => format!("the record was cut after tick {} and has no summary", ticks - 1),
    };
    stdout::line(format_args!(
        "{}: {} ticks of {} robots follow the model within their input bounds; minimum separation {:.6} m; {} arrived; \
         {summary}",
        args.run.display(),
        report.ticks,
        report.robots,
        report.min_separation,
        report.arrived
    ))?;
    Ok(Outcome::Done)
}

//! `replay`: repeats a recorded run from its own folder and compares it byte for byte.

use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use evaluation::replay::{Repetition, repeat};
use std::path::PathBuf;

/// Arguments of `replay`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh replay runs/20260131-120000-ex14_d-14
  ./run.sh replay --check-solver runs/20260131-120000-ex14_d-14
Runs the recorded scenario with the recorded parameters and horizons in this process and compares trajectory.csv
byte for byte; says the first tick and robot that differ. Exit code 1 if any does.")]
pub struct Args {
    /// Folder of a recorded run
    run: PathBuf,
    /// Solve every QP a second time with Clarabel and tell the largest difference of an input
    #[arg(long)]
    check_solver: bool,
}

/// Repeats the run and says whether it is the same.
pub fn run(args: Args) -> Ending {
    let (repetition, check) = repeat(&args.run, args.check_solver).map_err(Failure::broken)?;
    let checked = match check {
        Some(check) => {
            stdout::line(format_args!("{}: {check}", args.run.display()))?;
            check.passed()
        }
        None => true,
    };
    let outcome = report(&args, repetition)?;
    Ok(if checked { outcome } else { Outcome::Failed })
}

fn report(args: &Args, repetition: Repetition) -> Ending {
    match repetition {
        Repetition { difference: Some(difference), .. } => {
            stdout::line(format_args!("{}: {difference}", args.run.display()))?;
            Ok(Outcome::Failed)
        }
        Repetition { ticks, whole: true, .. } => {
            stdout::line(format_args!("{}: {ticks} ticks repeated, every byte equal", args.run.display()))?;
            Ok(Outcome::Done)
        }
        Repetition { ticks, .. } => {
            stdout::line(format_args!(
                "{}: the record was cut; its {ticks} ticks repeated, every byte equal",
                args.run.display()
            ))?;
            Ok(Outcome::Done)
        }
    }
}

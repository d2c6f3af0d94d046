//! `golden`: checks files of reference results in this process.

use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use evaluation::golden::{Deviation, Verdict, check_folder};
use std::path::PathBuf;

/// Arguments of `golden`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  ./run.sh golden tests/golden
One line per case that deviates: first tick, robot, deviation and what is allowed. Exit code 1 if any does.")]
pub struct Args {
    /// Folder with reference files (*.json); every file of a known format is checked
    folder: PathBuf,
}

/// Checks the folder.
pub fn run(args: Args) -> Ending {
    let verdicts = check_folder(&args.folder).map_err(Failure::broken)?;
    let mut bad = 0;
    for Verdict { case, deviation } in &verdicts {
        if let Some(Deviation { tick, robot, what, deviation, allowed }) = deviation {
            bad += 1;
            stdout::line(format_args!(
                "{case}: tick {tick}, robot {robot}: {what} deviates by {deviation:.3e}, allowed {allowed:.3e}"
            ))?;
        }
    }
    stdout::line(format_args!("{} cases, {bad} bad", verdicts.len()))?;
    Ok(if bad == 0 { Outcome::Done } else { Outcome::Failed })
}

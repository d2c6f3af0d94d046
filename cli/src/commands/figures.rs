//! `figures`: runs and draws the paper's figures anew.

use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use coordinator::record::folder::replace;
use evaluation::figures;
use std::path::PathBuf;

/// Arguments of `figures`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  ./run.sh figures
Runs the paper's tasks in this process (two, four and fourteen robots) and writes one SVG per figure. Each file names
the command that repeats its run in its description. Variable horizons are those of policies/two_setpoint,
policies/four_gate and policies/exchange_14 where these folders are there, otherwise the best of twenty random runs.")]
pub struct Args {
    /// Folder of the figures; what is there is written over
    #[arg(long, value_name = "DIR", default_value = "figures")]
    out: PathBuf,
}

/// Draws them.
pub fn run(args: Args) -> Ending {
    std::fs::create_dir_all(&args.out).map_err(Failure::usage)?;
    let figures = figures::all(|what| {
        let _ = stdout::line(format_args!("{what}: done")); // an error comes again with the last line
    })
    .map_err(Failure::broken)?;
    for (name, text) in &figures {
        replace(&args.out.join(name), text.as_bytes()).map_err(Failure::broken)?;
    }
    stdout::line(format_args!("{} figures in {}", figures.len(), args.out.display()))?;
    Ok(Outcome::Done)
}

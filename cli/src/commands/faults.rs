//! `faults`: kills robots' processes at random moments, run after run, and counts what that costs the others.

use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Progress;
use crate::stdout;
use evaluation::faults::{kill, sums, table};
use shared::stop::StopFlag;
use std::path::PathBuf;

/// Arguments of `faults`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh faults --kills 30
  ./run.sh faults --kills 1000 --out results/faults/kills.csv
Each run has fourteen processes, of which one is killed (SIGKILL) at a random moment of a random tick; every second time it
is started anew. Exit code 1: another robot was lost, a pair came below r_min, a living robot did not arrive although
its set-point was free, or a file was left.")]
pub struct Args {
    /// How many
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..))]
    kills: u64,
    /// Number of the first; everything random in a run follows from its number
    #[arg(long, value_name = "N", default_value_t = 0)]
    first: u64,
    /// File for a row per kill
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Kills and counts.
pub fn run(args: &Args) -> Ending {
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let progress = Progress::of_work(args.kills as usize);
    let mut kills = Vec::new();
    for number in args.first..args.first + args.kills {
        if stop.is_set() {
            break;
        }
        kills.push(kill(number, &stop).map_err(Failure::broken)?);
        progress.advance();
    }
    progress.finish();
    if let Some(out) = &args.out {
        if let Some(folder) = out.parent() {
            std::fs::create_dir_all(folder).map_err(Failure::broken)?;
        }
        std::fs::write(out, table(&kills).csv()).map_err(Failure::broken)?;
    }
    let bad: Vec<_> = kills.iter().filter(|kill| !kill.is_good()).cloned().collect();
    stdout::text(sums(&kills).aligned())?;
    if !bad.is_empty() {
        stdout::text(format!("\nnot good:\n{}", table(&bad).aligned()))?;
    }
    Ok(if bad.is_empty() { Outcome::Done } else { Outcome::Failed })
}

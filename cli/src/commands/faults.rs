//! `faults`: kills robots' processes at random moments, run after run, and counts what that costs the others.

use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Progress;
use crate::{stdout, whole_file};
use evaluation::faults::{Cost, kill, sums, table};
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

/// The rows cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}; name another file with --out", path.display())]
struct WriteError {
    path: PathBuf,
    source: std::io::Error,
}

/// Kills and counts.
pub fn run(args: &Args) -> Ending {
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let progress = Progress::of_work(args.kills as usize);
    let (mut kills, mut broken) = (Vec::new(), None);
    for number in args.first..args.first.saturating_add(args.kills) {
        if stop.is_set() {
            break;
        }
        match kill(number, &stop) {
            Ok(kill) => kills.push(kill),
            Err(error) => {
                broken = Some(Failure::broken(error));
                break;
            }
        }
        progress.advance();
    }
    progress.finish();
    if let Some(out) = &args.out {
        whole_file::write(out, &table(&kills).csv())
            .map_err(|source| Failure::broken(WriteError { path: out.clone(), source }))?;
    }
    let bad: Vec<_> = kills.iter().filter(|kill| !kill.is_good()).cloned().collect();
    stdout::text(sums(&kills.iter().map(Cost::from).collect::<Vec<_>>()).aligned())?;
    if !bad.is_empty() {
        stdout::text(format!("\nnot good:\n{}", table(&bad).aligned()))?;
    }
    if let Some(broken) = broken {
        return Err(broken);
    }
    Ok(if bad.is_empty() { Outcome::Done } else { Outcome::Failed })
}

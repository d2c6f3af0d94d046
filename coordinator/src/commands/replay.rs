//! `replay`: repeats a recorded run from its own folder and compares it byte for byte.

use crate::exit::{Ending, Failure, Outcome};
use crate::in_process::run_team;
use crate::record::{PARAMS_FILE, SCENARIO_FILE, horizons, trajectory};
use shared::horizon_source::{HorizonSource, HorizonSpec};
use shared::params::Params;
use shared::scenario::Scenario;
use shared::step::Step;
use std::path::{Path, PathBuf};

/// Arguments of `replay`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  ./run.sh replay runs/20260131-120000-ex14_d-14
Runs the recorded scenario with the recorded parameters and horizons in this process and compares trajectory.csv
byte for byte; says the first tick and robot that differ. Exit code 1 if any does.")]
pub struct Args {
    /// Folder of a recorded run
    run: PathBuf,
}

/// Why a run cannot be repeated.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// A file of the run cannot be read.
    #[error("cannot read {}: {source}; give the folder of a recorded run", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file of the run is not what it should be.
    #[error("{} cannot be repeated: {reason}", folder.display())]
    Malformed {
        /// The run.
        folder: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// The first difference between a record and its repetition.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line} (tick {tick}, robot {robot}) differs: recorded {recorded:?}, repeated {repeated:?}")]
pub struct Difference {
    /// Line of trajectory.csv, from 1.
    pub line: usize,
    /// k, as the repetition has it.
    pub tick: u64,
    /// Robot number.
    pub robot: usize,
    /// The line in the record; empty when missing.
    pub recorded: String,
    /// The line as it should be; empty when there should be none.
    pub repeated: String,
}

/// Repeats the run and says whether it is the same.
pub fn run(args: Args) -> Ending {
    match replay(&args.run).map_err(Failure::broken)? {
        Repetition { difference: Some(difference), .. } => {
            println!("{}: {difference}", args.run.display());
            Ok(Outcome::Failed)
        }
        Repetition { ticks, whole: true, .. } => {
            println!("{}: {ticks} ticks repeated, every byte equal", args.run.display());
            Ok(Outcome::Done)
        }
        Repetition { ticks, .. } => {
            println!("{}: the record was cut; its {ticks} ticks repeated, every byte equal", args.run.display());
            Ok(Outcome::Done)
        }
    }
}

/// What came of repeating a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Repetition {
    /// Ticks that were compared.
    pub ticks: u64,
    /// Whether the record has its last rows.
    pub whole: bool,
    /// The first difference.
    pub difference: Option<Difference>,
}

/// Repeats the run in `folder` for as many ticks as it recorded and compares.
pub fn replay(folder: &Path) -> Result<Repetition, ReplayError> {
    let read = |name: &str| {
        let path = folder.join(name);
        std::fs::read_to_string(&path).map_err(|source| ReplayError::Unreadable { path, source })
    };
    let malformed = |reason: String| ReplayError::Malformed { folder: folder.to_owned(), reason };
    let mut scenario = Scenario::from_toml(&read(SCENARIO_FILE)?, "recorded", SCENARIO_FILE)
        .map_err(|error| malformed(error.to_string()))?;
    let params = Params::from_toml(&read(PARAMS_FILE)?, PARAMS_FILE).map_err(|error| malformed(error.to_string()))?;
    let recorded = read(trajectory::FILE)?;
    // One line of horizons per tick below the header. A cut or interrupted run ends before the team arrived.
    let ticks = read(horizons::FILE)?.lines().count().saturating_sub(1) as u64;
    scenario.max_ticks = ticks;
    let mut text = format!("{}\n", trajectory::HEADER);
    let mut positions: Vec<_> = scenario.robots.iter().map(|robot| robot.start).collect();
    if ticks > 0 {
        // What was recorded is what came out of the jitter.
        let script = HorizonSpec::Script(folder.join(horizons::FILE));
        let source = HorizonSource::new(&script, scenario.robots.len(), scenario.seed, 0)
            .map_err(|error| malformed(error.to_string()))?;
        let append = |tick: u64, steps: &[Step]| {
            trajectory::push_tick(&mut text, tick, steps);
            positions.iter_mut().zip(steps).for_each(|(position, step)| *position = step.next_position);
            Ok::<(), std::convert::Infallible>(())
        };
        match run_team(&scenario, &params, |robot, tick| source.horizon(robot, tick), append) {
            Ok(_) => {}
            Err(never) => match never {},
        }
    }
    let whole = recorded.len() > text.len() || recorded.ends_with(",,,,,,\n");
    if whole {
        trajectory::push_end(&mut text, ticks, &positions);
    }
    let robots = scenario.robots.len();
    Ok(Repetition { ticks, whole, difference: first_difference(&recorded, &text, robots) })
}

/// The first line that differs in any byte, line ends included.
fn first_difference(recorded: &str, repeated: &str, robots: usize) -> Option<Difference> {
    if recorded == repeated {
        return None;
    }
    let mut lines = (recorded.split_inclusive('\n'), repeated.split_inclusive('\n'));
    for line in 1usize.. {
        let pair = (lines.0.next(), lines.1.next());
        if pair.0 != pair.1 {
            let row = line.saturating_sub(2);
            return Some(Difference {
                line,
                tick: (row / robots) as u64,
                robot: row % robots,
                recorded: pair.0.unwrap_or_default().to_owned(),
                repeated: pair.1.unwrap_or_default().to_owned(),
            });
        }
        if pair == (None, None) {
            break;
        }
    }
    None
}

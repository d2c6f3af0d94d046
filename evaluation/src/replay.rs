//! Repeats a recorded run from its own folder and compares it byte for byte.

use crate::in_process::drive_whole;
use crate::roll::Roll;
use coordinator::record::{PARAMS_FILE, SCENARIO_FILE, horizons, membership, set_points, trajectory};
use coordinator::solver_check::SolverCheck;
use std::path::{Path, PathBuf};
use vodca::horizon_source::{HorizonSource, HorizonSpec};
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;
use vodca::team::Team;

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
    Ok(repeat(folder, false)?.0)
}

/// [`replay`]; `check`: solves every QP of the repetition a second time with Clarabel and compares.
/// Without a difference in the trajectory these are the QPs of the recorded run.
pub fn repeat(folder: &Path, check: bool) -> Result<(Repetition, Option<SolverCheck>), ReplayError> {
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
    let build = if check { Team::checked } else { Team::new };
    let mut team = build(&scenario, &params, scenario.seed);
    let mut positions: Vec<_> = scenario.robots.iter().map(|robot| robot.start).collect();
    let read_if_there = |name: &str| match read(name) {
        Ok(text) => Ok(Some(text)),
        Err(ReplayError::Unreadable { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    };
    let line_of = |file: &'static str| move |line| malformed(format!("{file}, line {line}"));
    let changes = read_if_there(membership::FILE)?.map(|text| membership::read(&text)).transpose();
    let changes = changes.map_err(line_of(membership::FILE))?.unwrap_or_default();
    let assigned =
        read_if_there(set_points::FILE)?.map(|text| set_points::read(&text, scenario.robots.len())).transpose();
    let assigned = assigned.map_err(line_of(set_points::FILE))?.unwrap_or_default();
    if let Some(change) = changes.iter().find(|change| change.robot >= scenario.robots.len()) {
        return Err(malformed(format!("there is no robot {}, which {} names", change.robot, membership::FILE)));
    }
    let mut roll = Roll::new(scenario.robots.len(), changes);
    if ticks > 0 {
        // What was recorded is what came out of the jitter.
        let script = HorizonSpec::Script(folder.join(horizons::FILE));
        let source = HorizonSource::new(&script, scenario.robots.len(), scenario.seed, 0)
            .map_err(|error| malformed(error.to_string()))?;
        let mut tick = 0;
        let mut note = |steps: &[Step]| {
            trajectory::push_tick(&mut text, tick, steps);
            positions.iter_mut().zip(steps).for_each(|(position, step)| *position = step.next_position);
            tick += 1;
        };
        if roll.is_full() && assigned.is_empty() {
            drive_whole(&mut team, &scenario, &params, &source, note);
        } else {
            for tick in 0..ticks {
                let horizons: Vec<_> = (0..scenario.robots.len()).map(|robot| source.horizon(robot, tick)).collect();
                let of_now: Vec<_> = assigned.iter().filter(|given| given.tick == tick).copied().collect();
                team.assign(&of_now);
                note(if roll.is_full() {
                    team.step(&horizons)
                } else {
                    team.step_without(&horizons, &roll.tick(tick))
                });
            }
        }
    }
    let whole = recorded.len() > text.len() || recorded.ends_with(",,,,,,\n");
    if whole {
        trajectory::push_end(&mut text, ticks, &positions);
    }
    let robots = scenario.robots.len();
    let repetition = Repetition { ticks, whole, difference: first_difference(&recorded, &text, robots) };
    Ok((repetition, check.then(|| SolverCheck::from(team.comparison().unwrap_or_default()))))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;
    use std::fs;

    fn recorded() -> tempfile::TempDir {
        let place = tempfile::tempdir().unwrap();
        samples::record_run(place.path(), "ring:5", &Params::safe());
        place
    }

    #[test]
    fn a_run_repeats_to_the_last_byte() {
        let repetition = replay(recorded().path()).unwrap();
        assert_eq!((repetition.difference, repetition.whole), (None, true));
        assert!(repetition.ticks > 20);
    }

    #[test]
    fn the_qps_of_a_run_can_be_checked() {
        let (repetition, check) = repeat(recorded().path(), true).unwrap();
        let check = check.unwrap();
        assert_eq!(repetition.difference, None);
        assert!(check.problems >= 5 * repetition.ticks && check.passed(), "{check}");
    }

    #[test]
    fn a_changed_byte_is_found_with_its_tick_and_robot() {
        let place = recorded();
        let path = place.path().join(trajectory::FILE);
        let original = fs::read(&path).unwrap();
        // Bytes all over the file; never the header, which has no tick.
        for at in (trajectory::HEADER.len() + 1..original.len()).step_by(original.len() / 50) {
            let mut bytes = original.clone();
            bytes[at] = if bytes[at] == b'7' { b'8' } else { b'7' };
            fs::write(&path, &bytes).unwrap();
            let line = original[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
            let difference = replay(place.path()).unwrap().difference.unwrap();
            assert_eq!(difference.line, line);
            assert_eq!((difference.tick, difference.robot), (((line - 2) / 5) as u64, (line - 2) % 5));
        }
    }

    #[test]
    fn missing_and_added_lines_are_found() {
        let place = recorded();
        let path = place.path().join(trajectory::FILE);
        let original = fs::read_to_string(&path).unwrap();
        fs::write(&path, format!("{original}x")).unwrap();
        assert!(replay(place.path()).unwrap().difference.is_some());
        let lines: Vec<&str> = original.split_inclusive('\n').collect();
        fs::write(&path, lines[..lines.len() - 1].concat()).unwrap();
        assert!(replay(place.path()).unwrap().difference.is_some());
    }

    #[test]
    fn a_cut_record_is_repeated_as_far_as_it_goes() {
        let place = recorded();
        let (path, script) = (place.path().join(trajectory::FILE), place.path().join(horizons::FILE));
        let lines = |path: &Path, count: usize| -> String {
            fs::read_to_string(path).unwrap().split_inclusive('\n').take(count).collect()
        };
        let (rows, horizons) = (lines(&path, 1 + 10 * 5), lines(&script, 1 + 10));
        fs::write(&path, rows).unwrap();
        fs::write(&script, horizons).unwrap();
        assert_eq!(replay(place.path()).unwrap(), Repetition { ticks: 10, whole: false, difference: None });
    }

    #[test]
    fn a_folder_without_a_run_says_which_file_is_missing() {
        let place = tempfile::tempdir().unwrap();
        let message = replay(place.path()).unwrap_err().to_string();
        assert!(message.contains("scenario.toml") && message.contains("recorded run"), "{message}");
    }
}

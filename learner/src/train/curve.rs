//! How a training went, round by round: `train.csv`, and TensorBoard's event file.

use super::score::Score;
use super::state::State;
use crate::Losses;
use crate::tensorboard::{Curves, CurvesError};
use policy::session::RoundReport;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// One round.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Its number.
    pub round: u64,
    /// Training episodes so far.
    pub episodes: u64,
    /// Ticks so far.
    pub ticks: u64,
    /// Updates so far.
    pub updates: u64,
    /// Mean return of its episodes, played with random actions around the policy's.
    pub total: f64,
    /// Share of its episodes that succeeded.
    pub success: f64,
    /// Mean path of those, m.
    pub path: Option<f64>,
    /// Ticks per second while it played.
    pub ticks_per_second: f64,
    /// Updates per second while it learnt.
    pub updates_per_second: f64,
    /// Of its last update.
    pub losses: Option<Losses>,
    /// Of the actor at its end, without randomness.
    pub evaluation: Option<Score>,
    /// How long all of it took, s.
    pub seconds: f64,
}

impl Point {
    /// Sums up a round. `learnt`: updates and how long they took.
    #[allow(clippy::too_many_arguments)] // each is one column's source
    pub fn new(
        round: u64,
        state: &State,
        updates: u64,
        learnt: (u64, Duration),
        played: &RoundReport,
        losses: Option<Losses>,
        evaluation: Option<Score>,
        took: Duration,
    ) -> Self {
        let score = Score::of(&played.episodes);
        Self {
            round,
            episodes: state.episodes,
            ticks: state.ticks,
            updates,
            total: score.total,
            success: score.successes as f64 / score.episodes.max(1) as f64,
            path: score.path,
            ticks_per_second: played.ticks() as f64 / played.seconds.max(1e-9),
            updates_per_second: learnt.0 as f64 / learnt.1.as_secs_f64().max(1e-9),
            losses,
            evaluation,
            seconds: took.as_secs_f64(),
        }
    }

    /// Every number by name; what is not there is NaN.
    pub fn scalars(&self) -> Vec<(&'static str, f64)> {
        let loss = |get: fn(&Losses) -> f64| self.losses.as_ref().map_or(f64::NAN, get);
        let evaluated = |get: fn(&Score) -> f64| self.evaluation.as_ref().map_or(f64::NAN, get);
        vec![
            ("rollout/return", self.total),
            ("rollout/success", self.success),
            ("rollout/path", self.path.unwrap_or(f64::NAN)),
            ("evaluation/return", evaluated(|score| score.total)),
            ("evaluation/success", evaluated(|score| score.successes as f64 / score.episodes.max(1) as f64)),
            ("evaluation/path", evaluated(|score| score.path.unwrap_or(f64::NAN))),
            ("evaluation/ticks", evaluated(|score| score.ticks as f64)),
            ("loss/critic", loss(|losses| losses.critic)),
            ("loss/actor", loss(|losses| losses.actor)),
            ("sac/temperature", loss(|losses| losses.temperature)),
            ("sac/entropy", loss(|losses| losses.entropy)),
            ("sac/value", loss(|losses| losses.value)),
            ("speed/ticks_per_second", self.ticks_per_second),
            ("speed/updates_per_second", self.updates_per_second),
            ("speed/round_seconds", self.seconds),
        ]
    }
}

/// The curves cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum CurveError {
    /// The table.
    #[error("cannot write {}: {source}; the checkpoints stay usable: free some space and --resume", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The event file.
    #[error(transparent)]
    Events(#[from] CurvesError),
}

/// The files of the curves.
#[derive(Debug)]
pub struct Curve {
    path: PathBuf,
    table: File,
    events: Curves,
}

impl Curve {
    /// Opens the curves in the folder `out`, to go on after `rounds` rounds: rows of later ones, which a
    /// killed training wrote after its newest checkpoint, go, for these rounds are played again.
    pub fn open(out: &Path, rounds: u64) -> Result<Self, CurveError> {
        let path = out.join("train.csv");
        let failed = |source| CurveError::Table { path: path.clone(), source };
        let before = match std::fs::read_to_string(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            read => read.map_err(failed)?,
        };
        let names: Vec<&str> = empty().scalars().iter().map(|(name, _)| *name).collect();
        let mut text = format!("round,episodes,ticks,updates,{}\n", names.join(","));
        let earlier = |line: &&str| {
            let round = line.split(',').next().and_then(|round| round.parse::<u64>().ok());
            line.ends_with('\n') && round.is_some_and(|round| round < rounds)
        };
        text.extend(before.split_inclusive('\n').filter(earlier));
        // Beside and renamed: a full disk takes nothing away.
        let beside = out.join(".train.csv");
        std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, &path)).map_err(failed)?;
        let file = OpenOptions::new().append(true).open(&path).map_err(failed)?;
        Ok(Self { path, table: file, events: Curves::create(out)? })
    }

    /// Adds a round.
    pub fn add(&mut self, point: &Point) -> Result<(), CurveError> {
        let number = |value: f64| if value.is_finite() { format!("{value}") } else { String::new() };
        let numbers: Vec<String> = point.scalars().iter().map(|(_, value)| number(*value)).collect();
        let Point { round, episodes, ticks, updates, .. } = point;
        let line = format!("{round},{episodes},{ticks},{updates},{}\n", numbers.join(","));
        let failed = |source| CurveError::Table { path: self.path.clone(), source };
        self.table.write_all(line.as_bytes()).map_err(failed)?;
        Ok(self.events.scalars(point.updates, &point.scalars())?)
    }
}

fn empty() -> Point {
    Point {
        round: 0,
        episodes: 0,
        ticks: 0,
        updates: 0,
        total: 0.0,
        success: 0.0,
        path: None,
        ticks_per_second: 0.0,
        updates_per_second: 0.0,
        losses: None,
        evaluation: None,
        seconds: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_has_one_header_and_a_row_per_round() {
        let place = tempfile::tempdir().unwrap();
        for round in 0..2 {
            let mut curve = Curve::open(place.path(), round).unwrap();
            curve.add(&Point { round, updates: 5, ..empty() }).unwrap();
        }
        let text = std::fs::read_to_string(place.path().join("train.csv")).unwrap();
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(rows.len(), 3);
        assert!(rows[0].starts_with("round,episodes,ticks,updates,rollout/return"));
        assert_eq!(rows[1].split(',').count(), rows[0].split(',').count());
        assert!(rows[2].starts_with("1,0,0,5,0,"));
    }

    #[test]
    fn rounds_after_the_checkpoint_and_rows_that_were_cut_off_are_forgotten() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("train.csv");
        let mut curve = Curve::open(place.path(), 0).unwrap();
        (0..3).for_each(|round| curve.add(&Point { round, ..empty() }).unwrap());
        let all = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, format!("{all}3,1")).unwrap();
        Curve::open(place.path(), 4).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), all);
        Curve::open(place.path(), 2).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap().lines().count(), 3);
    }
}

//! What a training keeps on the disk: its plan, and checkpoints from which it goes on exactly.

use super::config::{TrainingConfig, TrainingConfigError};
use super::score::Score;
use crate::Learner;
use crate::checkpoint::CheckpointError;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// The plan's file in the folder of a training.
pub const PLAN_FILE: &str = "train.toml";
const CHECKPOINTS: &str = "checkpoints";
const LEARNER_FILE: &str = "learner.safetensors";
const STATE_FILE: &str = "state.json";
const LOCK_FILE: &str = ".lock";
/// Checkpoints that are kept.
const KEPT: usize = 2;

/// How far a training has come, beside what the learner knows itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Rounds played.
    pub round: u64,
    /// Training episodes played, less the warm-up.
    pub episodes: u64,
    /// Ticks played, with the warm-up.
    pub ticks: u64,
    /// Of the newest round: what the next updates are counted by.
    pub ticks_of_last_round: u64,
    /// The part of an update that is owed.
    pub owed: f64,
    /// The best actor so far.
    pub best: Option<Best>,
    /// Positions the next published actor is checked at, m.
    pub reference: Vec<Vec<f64>>,
}

/// The best actor so far: it stands in the folder `best`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Its evaluation.
    pub score: Score,
    /// Rounds played when it was published.
    pub round: u64,
    /// Updates done when it was published.
    pub updates: u64,
}

/// Why a training cannot be kept or resumed.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The system refused.
    #[error("cannot {what} {} of the training: {source}; is the place writable, and is there space left?", path.display())]
    Io {
        /// What was tried.
        what: &'static str,
        /// With what.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Something is there already.
    #[error("{} is not empty: a training is never overwritten; give a new folder with --out, or --resume it", .0.display())]
    NotEmpty(PathBuf),
    /// No checkpoint.
    #[error("{} holds no checkpoint of a training; begin one in a new folder with `./run.sh train --out`", .0.display())]
    None(PathBuf),
    /// Another process trains there.
    #[error("{} is being trained in by another process; end that one first, or give another folder with --out", .0.display())]
    Busy(PathBuf),
    /// A file of the checkpoint.
    #[error("{}: {reason}; remove this checkpoint to resume from the one before", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The plan.
    #[error(transparent)]
    TrainingConfig(#[from] TrainingConfigError),
    /// The learner.
    #[error(transparent)]
    Learner(#[from] CheckpointError),
}

fn io(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> StateError {
    let path = path.to_owned();
    move |source| StateError::Io { what, path, source }
}

/// Keeps other processes from training in a folder, until it is dropped or its process ends in any way.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock of the training in `out`.
    pub fn take(out: &Path) -> Result<Self, StateError> {
        let path = out.join(LOCK_FILE);
        if !out.is_dir() {
            return Err(StateError::None(out.to_owned()));
        }
        let file = File::create(&path).map_err(io("write", &path))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { _file: file }),
            Err(TryLockError::WouldBlock) => Err(StateError::Busy(out.to_owned())),
            Err(TryLockError::Error(source)) => Err(io("lock", &path)(source)),
        }
    }
}

/// Makes the folder of a training, which must be new or empty, and writes its plan there.
pub fn prepare(out: &Path, plan: &TrainingConfig) -> Result<Lock, StateError> {
    fs::create_dir_all(out).map_err(io("make", out))?;
    if fs::read_dir(out).map_err(io("list", out))?.next().is_some() {
        return Err(StateError::NotEmpty(out.to_owned()));
    }
    let lock = Lock::take(out)?;
    let path = out.join(PLAN_FILE);
    fs::write(&path, plan.to_toml()).map_err(io("write", &path))?;
    Ok(lock)
}

/// How many sessions have been started in `folder`: each has two folders there.
pub fn number_of_sessions(folder: &Path) -> usize {
    let entries = fs::read_dir(folder)
        .map_or(0, |entries| entries.filter(|entry| entry.as_ref().is_ok_and(|entry| entry.path().is_dir())).count());
    entries.div_ceil(2)
}

/// Writes a checkpoint beside the earlier ones and renames it into place; older ones beyond two go.
pub fn save(out: &Path, learner: &Learner, state: &State) -> Result<(), StateError> {
    let folder = out.join(CHECKPOINTS);
    let (beside, place) = (folder.join(".part"), folder.join(format!("{:08}", state.round)));
    if place.is_dir() {
        return Ok(()); // this very round
    }
    let _ = fs::remove_dir_all(&beside); // what a killed process left
    fs::create_dir_all(&beside).map_err(io("make", &beside))?;
    learner.save(&beside.join(LEARNER_FILE))?;
    let path = beside.join(STATE_FILE);
    // Numbers and lists only: cannot fail.
    let text = serde_json::to_string_pretty(state).unwrap_or_default();
    fs::write(&path, text).map_err(io("write", &path))?;
    fs::rename(&beside, &place).map_err(io("write", &place))?;
    let all = checkpoints(out);
    for old in all.iter().take(all.len().saturating_sub(KEPT)) {
        fs::remove_dir_all(old).map_err(io("remove", old))?;
    }
    Ok(())
}

/// Reads the newest checkpoint in `out`.
pub fn load(out: &Path) -> Result<(TrainingConfig, Learner, State), StateError> {
    let plan = TrainingConfig::read(&out.join(PLAN_FILE)).map_err(|error| match error {
        TrainingConfigError::File { .. } => StateError::None(out.to_owned()),
        other => StateError::TrainingConfig(other),
    })?;
    let newest = checkpoints(out).pop().ok_or_else(|| StateError::None(out.to_owned()))?;
    let learner = Learner::load(&newest.join(LEARNER_FILE))?;
    let path = newest.join(STATE_FILE);
    let text = fs::read_to_string(&path).map_err(io("read", &path))?;
    let state =
        serde_json::from_str(&text).map_err(|error| StateError::Malformed { path, reason: error.to_string() })?;
    Ok((plan, learner, state))
}

/// All checkpoints, oldest first.
fn checkpoints(out: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(out.join(CHECKPOINTS)) else { return Vec::new() };
    let mut found: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().parse::<u64>().is_ok()))
        .collect();
    found.sort();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Settings;

    #[test]
    fn the_newest_two_checkpoints_stay_and_the_newest_is_read() {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("training");
        let lock = prepare(&out, &TrainingConfig::default()).unwrap();
        assert!(matches!(prepare(&out, &TrainingConfig::default()), Err(StateError::NotEmpty(_))));
        assert!(matches!(load(&out), Err(StateError::None(_))));
        let settings = Settings { hidden: 4, batch: 4, replay_rows: 8, ..Settings::default() };
        let learner = Learner::new(4, 2, settings, 1);
        for round in [3, 10, 20] {
            save(&out, &learner, &State { round, owed: 0.25, ..State::default() }).unwrap();
        }
        assert_eq!(checkpoints(&out).len(), 2);
        let (plan, _, state) = load(&out).unwrap();
        assert_eq!((plan, state.round, state.owed), (TrainingConfig::default(), 20, 0.25));
        assert!(matches!(Lock::take(&out), Err(StateError::Busy(_))));
        drop(lock);
        Lock::take(&out).unwrap();
    }

    #[test]
    fn a_checkpoint_that_was_cut_off_is_named() {
        let place = tempfile::tempdir().unwrap();
        let message = || load(place.path()).unwrap_err().to_string();
        assert!(matches!(Lock::take(&place.path().join("none")), Err(StateError::None(_))));
        let _lock = prepare(place.path(), &TrainingConfig::default()).unwrap();
        let settings = Settings { hidden: 4, batch: 4, replay_rows: 8, ..Settings::default() };
        save(place.path(), &Learner::new(4, 2, settings, 1), &State::default()).unwrap();
        fs::write(place.path().join("checkpoints/00000000/state.json"), "{").unwrap();
        assert!(message().contains("remove this checkpoint to resume from the one before"), "{}", message());
    }
}

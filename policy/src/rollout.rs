//! Recorded rollouts: transitions of whole episodes, what a learner learns from, one safetensors file per shard.
//!
//! Rows are transitions in order of episode and tick. In Python:
//! `safetensors.numpy.load_file("000000.safetensors")["observation"]`.

use crate::reward::Terms;
use crate::tensor_file::{Data, TensorFile, TensorFileError};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Ending of a shard's name.
pub const ENDING: &str = "safetensors";

/// What a shard's rows are rows of; JSON in its header.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// `vodca/rollout/1`.
    pub schema: String,
    /// Name of the scenario or family.
    pub scenario: String,
    /// n.
    pub robots: usize,
    /// Name of the profile.
    pub profile: String,
    /// Where the horizons came from: `policy`, or a horizon source.
    pub horizons: String,
    /// Seed of episode 0; [`vodca::random::episode_seed`] gives the others'.
    pub seed: u64,
    /// How far starts are moved per axis, m.
    pub start_jitter: f64,
    /// K.
    pub max_ticks: u64,
    /// SHA-256 of the policy that acted, hexadecimal; empty without one.
    pub policy_sha256: String,
}

/// The schema that is written and read.
pub const SCHEMA: &str = "vodca/rollout/1";

/// [`About::horizons`] of rollouts whose horizons a policy chose.
pub const POLICY: &str = "policy";

/// One transition (s, a, r, s').
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// Number of the episode.
    pub episode: u64,
    /// k.
    pub tick: u64,
    /// s: measured positions, x and y of robot 0, of robot 1, ..., m.
    pub observation: &'a [f32],
    /// a: the raw tanh value per robot in [-1, 1].
    pub action: &'a [f32],
    /// N_i^k.
    pub horizon: &'a [u8],
    /// The terms of R.
    pub terms: Terms,
    /// Whether a collision ended the episode here.
    pub terminated: bool,
    /// Whether the episode was cut off here: there is a future, it just was not played.
    pub truncated: bool,
    /// s', m: `observation` of the next row of the episode.
    pub next_observation: &'a [f32],
}

/// Transitions by column.
#[derive(Clone, Debug, PartialEq)]
pub struct Shard {
    /// What they are.
    pub about: About,
    episode: Vec<u64>,
    tick: Vec<u64>,
    observation: Vec<f32>,
    action: Vec<f32>,
    horizon: Vec<u8>,
    /// R, then its five terms as in [`Terms`].
    reward: [Vec<f32>; 6],
    terminated: Vec<u8>,
    truncated: Vec<u8>,
    next_observation: Vec<f32>,
}

/// Columns of the reward in the file.
const REWARD: [&str; 6] =
    ["reward", "reward_progress", "reward_horizon", "reward_collision", "reward_arrival", "reward_variance"];

/// A shard cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RolloutError {
    /// The file.
    #[error(transparent)]
    File(#[from] TensorFileError),
    /// Its header.
    #[error("{}: its header is not that of a rollout ({reason}); record it again with `./run.sh rollout`", path.display())]
    About {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A folder without shards, or one that cannot be read.
    #[error("no rollouts in {}: {reason}; record some with `./run.sh rollout --out {}`", path.display(), path.display())]
    None {
        /// The folder.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

impl Shard {
    /// A shard without rows.
    pub fn new(about: About) -> Self {
        Self {
            about,
            episode: Vec::new(),
            tick: Vec::new(),
            observation: Vec::new(),
            action: Vec::new(),
            horizon: Vec::new(),
            reward: Default::default(),
            terminated: Vec::new(),
            truncated: Vec::new(),
            next_observation: Vec::new(),
        }
    }

    /// Number of transitions.
    pub fn rows(&self) -> usize {
        self.tick.len()
    }

    /// Appends a transition; `row`'s slices have 2 n or n numbers.
    pub fn push(&mut self, row: &Row<'_>) {
        let robots = self.about.robots;
        assert!(row.observation.len() == 2 * robots && row.next_observation.len() == 2 * robots, "positions of all");
        assert!(row.action.len() == robots && row.horizon.len() == robots, "an action and a horizon per robot");
        self.episode.push(row.episode);
        self.tick.push(row.tick);
        self.observation.extend_from_slice(row.observation);
        self.action.extend_from_slice(row.action);
        self.horizon.extend_from_slice(row.horizon);
        let Terms { progress, horizon, collision, arrival, variance } = row.terms;
        let numbers = [row.terms.total(), progress, horizon, collision, arrival, variance];
        for (column, number) in self.reward.iter_mut().zip(numbers) {
            column.push(number as f32);
        }
        self.terminated.push(u8::from(row.terminated));
        self.truncated.push(u8::from(row.truncated));
        self.next_observation.extend_from_slice(row.next_observation);
    }

    /// Row `row`, 0-based.
    pub fn row(&self, row: usize) -> Row<'_> {
        let robots = self.about.robots;
        let (pairs, singles) = (row * 2 * robots..(row + 1) * 2 * robots, row * robots..(row + 1) * robots);
        let term = |column: usize| f64::from(self.reward[column][row]);
        Row {
            episode: self.episode[row],
            tick: self.tick[row],
            observation: &self.observation[pairs.clone()],
            action: &self.action[singles.clone()],
            horizon: &self.horizon[singles],
            terms: Terms {
                progress: term(1),
                horizon: term(2),
                collision: term(3),
                arrival: term(4),
                variance: term(5),
            },
            terminated: self.terminated[row] != 0,
            truncated: self.truncated[row] != 0,
            next_observation: &self.next_observation[pairs],
        }
    }

    /// All rows.
    pub fn iter(&self) -> impl Iterator<Item = Row<'_>> {
        (0..self.rows()).map(|row| self.row(row))
    }

    /// Writes the shard, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), RolloutError> {
        let about =
            |reason: serde_json::Error| RolloutError::About { path: path.to_owned(), reason: reason.to_string() };
        let (rows, robots) = (self.rows(), self.about.robots);
        let mut file = TensorFile { about: serde_json::to_string(&self.about).map_err(about)?, ..Default::default() };
        file.put("episode", &[rows], Data::U64(self.episode.clone()));
        file.put("tick", &[rows], Data::U64(self.tick.clone()));
        file.put("observation", &[rows, 2 * robots], Data::F32(self.observation.clone()));
        file.put("action", &[rows, robots], Data::F32(self.action.clone()));
        file.put("horizon", &[rows, robots], Data::U8(self.horizon.clone()));
        for (name, column) in REWARD.iter().zip(&self.reward) {
            file.put(name, &[rows], Data::F32(column.clone()));
        }
        file.put("terminated", &[rows], Data::U8(self.terminated.clone()));
        file.put("truncated", &[rows], Data::U8(self.truncated.clone()));
        file.put("next_observation", &[rows, 2 * robots], Data::F32(self.next_observation.clone()));
        Ok(file.write(path)?)
    }

    /// Reads a shard.
    pub fn read(path: &Path) -> Result<Self, RolloutError> {
        let mut file = TensorFile::read(path)?;
        let failed = |reason: String| RolloutError::About { path: path.to_owned(), reason };
        let about: About = serde_json::from_str(&file.about).map_err(|error| failed(error.to_string()))?;
        if about.schema != SCHEMA {
            return Err(failed(format!("schema `{}` is not `{SCHEMA}`", about.schema)));
        }
        let robots = about.robots;
        let rows = file.tensors.get("tick").and_then(|tensor| tensor.shape.first().copied()).unwrap_or(0);
        let mut reward: [Vec<f32>; 6] = Default::default();
        for (column, name) in reward.iter_mut().zip(REWARD) {
            *column = file.take_f32(path, name, &[rows])?;
        }
        Ok(Self {
            episode: file.take_u64(path, "episode", &[rows])?,
            tick: file.take_u64(path, "tick", &[rows])?,
            observation: file.take_f32(path, "observation", &[rows, 2 * robots])?,
            action: file.take_f32(path, "action", &[rows, robots])?,
            horizon: file.take_u8(path, "horizon", &[rows, robots])?,
            reward,
            terminated: file.take_u8(path, "terminated", &[rows])?,
            truncated: file.take_u8(path, "truncated", &[rows])?,
            next_observation: file.take_f32(path, "next_observation", &[rows, 2 * robots])?,
            about,
        })
    }
}

/// The shards in `folder`, in order of their names.
pub fn shards(folder: &Path) -> Result<Vec<PathBuf>, RolloutError> {
    let failed = |reason: String| RolloutError::None { path: folder.to_owned(), reason };
    let entries = std::fs::read_dir(folder).map_err(|error| failed(error.to_string()))?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == ENDING))
        .filter(|path| !path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.')))
        .collect();
    paths.sort();
    if paths.is_empty() { Err(failed(format!("it has no .{ENDING} file"))) } else { Ok(paths) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shard() -> Shard {
        let mut shard = Shard::new(About {
            schema: SCHEMA.into(),
            scenario: "two_setpoint".into(),
            robots: 2,
            profile: "paper".into(),
            horizons: "policy".into(),
            seed: 3,
            start_jitter: 0.25,
            max_ticks: 350,
            policy_sha256: "ab".into(),
        });
        for tick in 0..5u64 {
            let here = [tick as f32, 0.5, -1.0, 2.0];
            let next = [tick as f32 + 1.0, 0.5, -1.0, 2.0];
            shard.push(&Row {
                episode: 7,
                tick,
                observation: &here,
                action: &[-1.0, 0.25],
                horizon: &[1, 31],
                terms: Terms { progress: 1.0, horizon: 2.0, collision: 0.0, arrival: 4.0, variance: 8.0 },
                terminated: tick == 4,
                truncated: false,
                next_observation: &next,
            });
        }
        shard
    }

    #[test]
    fn a_shard_survives_its_file() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("000000.safetensors");
        shard().write(&path).unwrap();
        let read = Shard::read(&path).unwrap();
        assert_eq!(read, shard());
        let row = read.row(4);
        assert_eq!((row.episode, row.tick, row.terminated, row.truncated), (7, 4, true, false));
        assert_eq!((row.observation[0], row.next_observation[0]), (4.0, 5.0));
        assert_eq!(row.terms.total(), 1.0 - 2.0 + 4.0 - 8.0);
        assert_eq!(shards(place.path()).unwrap(), [path]);
    }

    #[test]
    fn what_is_no_rollout_is_refused_with_its_name() {
        let place = tempfile::tempdir().unwrap();
        assert!(shards(place.path()).unwrap_err().to_string().contains("it has no .safetensors file"));
        let path = place.path().join("x.safetensors");
        TensorFile::default().write(&path).unwrap();
        let message = Shard::read(&path).unwrap_err().to_string();
        assert!(message.contains("x.safetensors: its header is not that of a rollout"), "{message}");
        let mut other = shard();
        other.about.schema = "vodca/rollout/9".into();
        other.write(&path).unwrap();
        assert!(Shard::read(&path).unwrap_err().to_string().contains("`vodca/rollout/9` is not `vodca/rollout/1`"));
    }
}

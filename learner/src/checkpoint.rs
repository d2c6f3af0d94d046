//! Checkpoints: everything a learner is, in one safetensors file.
//!
//! A loaded learner goes on exactly: n + m updates are n updates, save, load, m updates.

use crate::adam::Adam;
use crate::network::Network;
use crate::sac::Learner;
use crate::settings::Settings;
use policy::tensor_file::{Data, TensorFile, TensorFileError};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The format that is read and written.
const FORMAT: &str = "vodca/learner/1";

/// What is not a tensor, as JSON in the file's header.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    format: String,
    observations: usize,
    actions: usize,
    /// As text: numbers of some JSON readers end at 2^53.
    seed: String,
    /// The position of every generator: all draws depend on seed and update only.
    updates: u64,
    /// Steps of Adam: actor, both critics, temperature.
    adam_steps: [u64; 4],
    rows: usize,
    position: usize,
    favoured: usize,
    settings: Settings,
}

/// Why a checkpoint cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file, or a tensor in it.
    #[error(transparent)]
    File(#[from] TensorFileError),
    /// Not one of our checkpoints.
    #[error("{} is no checkpoint of the learner: {reason}; name a checkpoint that `./run.sh learn` wrote", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

impl Learner {
    /// Writes everything to `path`, beside it first and then by rename: a crash leaves the old file.
    pub fn save(&self, path: &Path) -> Result<(), CheckpointError> {
        let [first, second] = &self.critics.pair;
        let header = Header {
            format: FORMAT.into(),
            observations: self.actor.observations(),
            actions: self.actor.actions(),
            seed: self.seed.to_string(),
            updates: self.updates,
            adam_steps: [&self.actor_adam, &first.adam, &second.adam, &self.temperature.adam].map(|adam| adam.steps),
            rows: self.replay.len(),
            position: self.replay.position,
            favoured: self.replay.favoured(),
            settings: self.settings.clone(),
        };
        let about = serde_json::to_string(&header)
            .map_err(|error| CheckpointError::Content { path: path.to_owned(), reason: error.to_string() })?;
        let mut file = TensorFile { about, ..TensorFile::default() };
        put_network(&mut file, "actor", self.actor.network(), &self.actor_adam);
        for (name, critic) in ["critic1", "critic2"].iter().zip(&self.critics.pair) {
            put_network(&mut file, name, &critic.online, &critic.adam);
            put(&mut file, &format!("{name}.target"), critic.target.parameters());
        }
        put(&mut file, "temperature.logarithm", &[self.temperature.logarithm]);
        put_adam(&mut file, "temperature", &self.temperature.adam);
        let (replay, rows) = (&self.replay, self.replay.len());
        let table = |numbers: &[f32], width| (vec![rows, width], Data::F32(numbers.to_vec()));
        let (wide, narrow) = (self.actor.observations(), self.actor.actions());
        let flags = |flags: &[bool]| (vec![rows], Data::U8(flags.iter().map(|flag| u8::from(*flag)).collect()));
        let favoured: Vec<u64> = replay.favoured_slots().iter().map(|slot| u64::from(*slot)).collect();
        for (name, (shape, data)) in [
            ("replay.observation", table(&replay.observation, wide)),
            ("replay.action", table(&replay.action, narrow)),
            ("replay.next_observation", table(&replay.next_observation, wide)),
            ("replay.reward", (vec![rows], Data::F32(replay.reward.clone()))),
            ("replay.terminated", flags(&replay.terminated)),
            ("replay.truncated", flags(&replay.truncated)),
            ("replay.favoured", (vec![favoured.len()], Data::U64(favoured))),
        ] {
            file.put(name, &shape, data);
        }
        Ok(file.write(path)?)
    }

    /// Reads what [`Learner::save`] wrote.
    pub fn load(path: &Path) -> Result<Self, CheckpointError> {
        let content = |reason: String| CheckpointError::Content { path: path.to_owned(), reason };
        let file = TensorFile::read(path)?;
        let header: Header = serde_json::from_str(&file.about).map_err(|error| content(error.to_string()))?;
        if header.format != FORMAT {
            return Err(content(format!("its format is `{}`, not `{FORMAT}`", header.format)));
        }
        header.settings.validate().map_err(|error| content(error.to_string()))?;
        let (rows, position, most) = (header.rows, header.position, header.settings.replay_rows);
        if rows > most || (position != 0 && position >= rows) {
            return Err(content(format!("it has {rows} rows and goes on at {position}; allowed: {most} rows")));
        }
        let seed = header.seed.parse().map_err(|_| content(format!("its seed is `{}`", header.seed)))?;
        let mut learner = Learner::new(header.observations, header.actions, header.settings.clone(), seed);
        learner.updates = header.updates;
        learner.take(&header, Tensors { file, path })?;
        Ok(learner)
    }

    /// Takes everything but settings, seed and updates out of `tensors`.
    fn take(&mut self, header: &Header, mut tensors: Tensors) -> Result<(), CheckpointError> {
        tensors.network("actor", self.actor.network_mut(), &mut self.actor_adam)?;
        for (name, critic) in ["critic1", "critic2"].iter().zip(&mut self.critics.pair) {
            tensors.network(name, &mut critic.online, &mut critic.adam)?;
            tensors.fill(&format!("{name}.target"), critic.target.parameters_mut())?;
        }
        tensors.fill("temperature.logarithm", std::slice::from_mut(&mut self.temperature.logarithm))?;
        tensors.adam("temperature", &mut self.temperature.adam)?;
        let [first, second] = &mut self.critics.pair;
        let adams = [&mut self.actor_adam, &mut first.adam, &mut second.adam, &mut self.temperature.adam];
        adams.into_iter().zip(header.adam_steps).for_each(|(adam, steps)| adam.steps = steps);
        let (replay, rows) = (&mut self.replay, header.rows);
        replay.position = header.position;
        replay.observation = tensors.floats("replay.observation", &[rows, header.observations])?;
        replay.action = tensors.floats("replay.action", &[rows, header.actions])?;
        replay.next_observation = tensors.floats("replay.next_observation", &[rows, header.observations])?;
        replay.reward = tensors.floats("replay.reward", &[rows])?;
        replay.terminated = tensors.flags("replay.terminated", rows)?;
        replay.truncated = tensors.flags("replay.truncated", rows)?;
        let favoured = tensors.file.take_u64(tensors.path, "replay.favoured", &[header.favoured])?;
        replay.set_favoured(&favoured).ok_or_else(|| CheckpointError::Content {
            path: tensors.path.to_owned(),
            reason: format!("a favoured row is not among its {rows} rows, or there twice"),
        })
    }
}

fn put(file: &mut TensorFile, name: &str, numbers: &[f32]) {
    file.put(name, &[numbers.len()], Data::F32(numbers.to_vec()));
}

fn put_adam(file: &mut TensorFile, name: &str, adam: &Adam) {
    put(file, &format!("{name}.first"), &adam.first);
    put(file, &format!("{name}.second"), &adam.second);
}

fn put_network(file: &mut TensorFile, name: &str, network: &Network, adam: &Adam) {
    put(file, &format!("{name}.parameters"), network.parameters());
    put_adam(file, name, adam);
}

/// The tensors of an open checkpoint.
struct Tensors<'a> {
    file: TensorFile,
    path: &'a Path,
}

impl Tensors<'_> {
    fn floats(&mut self, name: &str, shape: &[usize]) -> Result<Vec<f32>, TensorFileError> {
        self.file.take_f32(self.path, name, shape)
    }

    fn flags(&mut self, name: &str, count: usize) -> Result<Vec<bool>, TensorFileError> {
        Ok(self.file.take_u8(self.path, name, &[count])?.into_iter().map(|flag| flag != 0).collect())
    }

    fn fill(&mut self, name: &str, numbers: &mut [f32]) -> Result<(), TensorFileError> {
        numbers.copy_from_slice(&self.floats(name, &[numbers.len()])?);
        Ok(())
    }

    fn adam(&mut self, name: &str, adam: &mut Adam) -> Result<(), TensorFileError> {
        self.fill(&format!("{name}.first"), &mut adam.first)?;
        self.fill(&format!("{name}.second"), &mut adam.second)
    }

    fn network(&mut self, name: &str, network: &mut Network, adam: &mut Adam) -> Result<(), TensorFileError> {
        self.fill(&format!("{name}.parameters"), network.parameters_mut())?;
        self.adam(name, adam)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::replay::Transition;
    use crate::sac::Losses;

    fn settings() -> Settings {
        Settings { hidden: 16, batch: 8, replay_rows: 40, favoured_share: 0.25, ..Settings::default() }
    }

    fn learner(settings: Settings) -> Learner {
        let mut learner = Learner::new(4, 2, settings, u64::MAX - 5);
        for number in 0..50 {
            let x = (number as f32).sin();
            let (s, n) = ([x, -x, 0.5 * x, 1.0], [x + 0.1, 0.0, x, 1.0]);
            let row = Transition {
                observation: &s,
                action: &[x, -x],
                reward: 10.0 * x,
                terminated: number % 7 == 0,
                next_observation: &n,
            };
            if number % 10 == 9 {
                learner.remember_truncated(row)
            } else {
                learner.remember(row)
            }
            if number == 35 {
                learner.favour_newest(6);
            }
        }
        learner
    }

    fn run(learner: &mut Learner, updates: usize) -> Vec<Losses> {
        (0..updates).map(|_| learner.update()).collect()
    }

    /// The bytes of its checkpoint: everything that it is.
    fn bytes(learner: &Learner) -> Vec<u8> {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("all.safetensors");
        learner.save(&path).unwrap();
        std::fs::read(path).unwrap()
    }

    #[test]
    fn a_loaded_learner_goes_on_exactly() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("checkpoint.safetensors");
        let mut whole = learner(settings());
        run(&mut whole, 13);
        whole.save(&path).unwrap();
        let mut resumed = Learner::load(&path).unwrap();
        assert_eq!(resumed.updates(), 13);
        assert_eq!(bytes(&resumed), bytes(&whole));
        // The buffer is full and turns over; both must forget the same rows.
        for learner in [&mut whole, &mut resumed] {
            let row = Transition {
                observation: &[9.0; 4],
                action: &[0.1; 2],
                reward: 1.0,
                terminated: false,
                next_observation: &[8.0; 4],
            };
            learner.remember(row);
        }
        let losses = run(&mut whole, 17);
        assert_eq!(run(&mut resumed, 17), losses);
        assert_eq!(bytes(&resumed), bytes(&whole));
    }

    #[test]
    fn one_seed_gives_one_result_with_one_thread_or_two() {
        let (mut first, mut second) = (learner(settings()), learner(Settings { threads: 2, ..settings() }));
        assert_eq!(run(&mut first, 20), run(&mut second, 20));
        second.settings.threads = 1;
        assert_eq!(bytes(&first), bytes(&second));
        let mut other = Learner::new(4, 2, settings(), 1);
        other.replay = first.replay.clone();
        assert_ne!(run(&mut other, 20), run(&mut first, 20));
    }

    #[test]
    fn what_is_no_checkpoint_is_refused_with_its_name() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("x.safetensors");
        let message = || Learner::load(&path).unwrap_err().to_string();
        assert!(message().contains("x.safetensors"), "{}", message());
        TensorFile::default().write(&path).unwrap();
        assert!(message().contains("x.safetensors is no checkpoint of the learner"), "{}", message());
        learner(settings()).save(&path).unwrap();
        let good = TensorFile::read(&path).unwrap();
        let mut short = good.clone();
        short.tensors.remove("critic2.target");
        short.write(&path).unwrap();
        assert!(message().contains("`critic2.target`"), "{}", message());
        let mut wrong = good.clone();
        wrong.put("replay.favoured", &[6], Data::U64(vec![1, 2, 3, 4, 5, 99]));
        wrong.write(&path).unwrap();
        assert!(message().contains("favoured row"), "{}", message());
        let about = good.about.replace("\"position\":10", "\"position\":77");
        assert_ne!(about, good.about);
        TensorFile { about, ..good }.write(&path).unwrap();
        assert!(message().contains("goes on at 77"), "{}", message());
    }
}

//! Recorded rollouts into a learner's memory: positions scaled, successful episodes favoured.

use crate::replay::Transition;
use crate::reward_weights::RewardWeights;
use crate::sac::Learner;
use policy::contract::{Contract, Observation};
use policy::rollout::{About, RolloutError, Row, Shard, shards};
use std::path::{Path, PathBuf};

/// Why rollouts cannot be learnt from.
#[derive(Debug, thiserror::Error)]
pub enum RolloutsError {
    /// A shard or a folder of shards.
    #[error(transparent)]
    Shard(#[from] RolloutError),
    /// Different teams.
    #[error("{} was recorded with {has} robots and this training is for {wanted}; name rollouts of one team size", path.display())]
    Robots {
        /// The shard.
        path: PathBuf,
        /// Its robots.
        has: usize,
        /// The training's.
        wanted: usize,
    },
    /// Nothing to learn from.
    #[error("the rollouts have no rows; record longer ones with `./run.sh rollout`")]
    NoRows,
}

/// What a first look at rollouts tells.
#[derive(Clone, Debug)]
pub struct Survey {
    /// All shards, in order of their folders and names.
    pub shards: Vec<PathBuf>,
    /// What the first one says about itself.
    pub about: About,
    /// Number of transitions.
    pub rows: u64,
    /// Smallest and largest x and y, m.
    pub bounds: [[f64; 2]; 2],
}

/// Looks at every shard in `folders`.
pub fn survey(folders: &[PathBuf]) -> Result<Survey, RolloutsError> {
    let mut found: Option<Survey> = None;
    let mut paths = Vec::new();
    for folder in folders {
        paths.extend(shards(folder)?);
    }
    for path in &paths {
        let shard = Shard::read(path)?;
        let bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let survey = found.get_or_insert(Survey { shards: Vec::new(), about: shard.about.clone(), rows: 0, bounds });
        fits(path, &shard, survey.about.robots)?;
        survey.rows += shard.rows() as u64;
        for position in shard.iter().flat_map(|row| row.observation.as_chunks::<2>().0) {
            for (axis, metres) in position.iter().map(|metres| f64::from(*metres)).enumerate() {
                survey.bounds[0][axis] = survey.bounds[0][axis].min(metres);
                survey.bounds[1][axis] = survey.bounds[1][axis].max(metres);
            }
        }
    }
    let survey = found.filter(|survey| survey.rows > 0).ok_or(RolloutsError::NoRows)?;
    Ok(Survey { shards: paths, ..survey })
}

impl Survey {
    /// The contract whose observation scales the box of all positions to [-1, 1] on each axis.
    pub fn contract(&self) -> Contract {
        let [low, high] = self.bounds;
        Contract { observation: Observation::over(low, high), ..Contract::standard(self.about.robots, true) }
    }
}

/// Reads every shard of `paths` into `learner`. Returns the number of successful episodes.
pub fn remember(
    learner: &mut Learner,
    contract: &Contract,
    weights: &RewardWeights,
    paths: &[PathBuf],
) -> Result<u64, RolloutsError> {
    let mut successes = 0;
    for path in paths {
        successes += remember_shard(learner, contract, weights, path, &Shard::read(path)?)?;
    }
    Ok(successes)
}

/// Takes `shard`, read from `path`, into `learner`: positions scaled as `contract` says, rewards weighted.
/// Successful episodes (every robot at its set-point at the last recorded tick, no collision) are favoured;
/// returns their number.
pub fn remember_shard(
    learner: &mut Learner,
    contract: &Contract,
    weights: &RewardWeights,
    path: &Path,
    shard: &Shard,
) -> Result<u64, RolloutsError> {
    fits(path, shard, contract.robots)?;
    let robots = contract.robots;
    let (mut successes, mut length) = (0, 0);
    let (mut observation, mut next) = (vec![0.0; 2 * robots], vec![0.0; 2 * robots]);
    let mut rows = shard.iter().peekable();
    while let Some(row) = rows.next() {
        scale(&contract.observation, row.observation, &mut observation);
        scale(&contract.observation, row.next_observation, &mut next);
        let transition = Transition {
            observation: &observation,
            action: row.action,
            reward: weights.reward(&row.terms, robots, metres_driven(&row)) as f32,
            terminated: row.terminated,
            next_observation: &next,
        };
        if row.truncated {
            learner.remember_truncated(transition)
        } else {
            learner.remember(transition)
        }
        length += 1;
        if rows.peek().is_none_or(|next| next.episode != row.episode) {
            // R_term is 150 for every robot at its set-point.
            if !row.terminated && row.terms.arrival >= 150.0 * robots as f64 {
                learner.favour_newest(length);
                successes += 1;
            }
            length = 0;
        }
    }
    Ok(successes)
}

/// By all robots in one tick, m.
fn metres_driven(row: &Row<'_>) -> f64 {
    let (from, to) = (row.observation.as_chunks::<2>().0, row.next_observation.as_chunks::<2>().0);
    from.iter().zip(to).map(|(a, b)| f64::from((b[0] - a[0]).hypot(b[1] - a[1]))).sum()
}

/// Positions (m) as the actor takes them.
fn scale(observation: &Observation, metres: &[f32], scaled: &mut [f32]) {
    for (at, (scaled, metres)) in scaled.iter_mut().zip(metres).enumerate() {
        *scaled = observation.scaled(at % 2, f64::from(*metres));
    }
}

fn fits(path: &Path, shard: &Shard, robots: usize) -> Result<(), RolloutsError> {
    let has = shard.about.robots;
    if has == robots { Ok(()) } else { Err(RolloutsError::Robots { path: path.to_owned(), has, wanted: robots }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use policy::reward::Terms;

    /// Two episodes of three ticks: the first one arrives, the second one collides.
    fn write(folder: &Path, name: &str, robots: usize) -> PathBuf {
        let mut shard = Shard::new(About {
            schema: "vodca/rollout/1".into(),
            scenario: "two_setpoint".into(),
            robots,
            profile: "paper".into(),
            horizons: "policy".into(),
            seed: 3,
            start_jitter: 0.0,
            max_ticks: 3,
            policy_sha256: String::new(),
        });
        for number in 0..6u64 {
            let (episode, last) = (number / 3, number % 3 == 2);
            let here: Vec<f32> = (0..2 * robots).map(|at| (10 * at) as f32 + number as f32).collect();
            let next: Vec<f32> = here.iter().map(|x| x + 1.0).collect();
            let arrival = if episode == 0 && last { 150.0 * robots as f64 } else { 0.0 };
            shard.push(&Row {
                episode,
                tick: number % 3,
                observation: &here,
                action: &vec![0.5; robots],
                horizon: &vec![37; robots],
                terms: Terms { progress: number as f64, arrival, ..Terms::default() },
                terminated: episode == 1 && last,
                truncated: episode == 0 && last,
                next_observation: &next,
            });
        }
        let path = folder.join(name);
        shard.write(&path).unwrap();
        path
    }

    #[test]
    fn rollouts_are_scaled_into_the_unit_box_and_successes_favoured() {
        let place = tempfile::tempdir().unwrap();
        write(place.path(), "000000.safetensors", 2);
        write(place.path(), "000001.safetensors", 2);
        let survey = survey(&[place.path().to_owned()]).unwrap();
        assert_eq!((survey.rows, survey.shards.len(), survey.bounds), (12, 2, [[0.0, 10.0], [25.0, 35.0]]));
        let contract = survey.contract();
        let mut learner = Learner::new(4, 2, Settings::default(), 1);
        assert_eq!(remember(&mut learner, &contract, &RewardWeights::default(), &survey.shards).unwrap(), 2);
        let replay = learner.replay();
        assert_eq!((replay.len(), replay.favoured()), (12, 6));
        assert_eq!(replay.observation[..2], [-1.0, -1.0]);
        assert_eq!(replay.observation[22..24], [1.0, 1.0]);
        assert_eq!(replay.reward[..3], [0.0, 1.0, 302.0]);
        assert_eq!(replay.terminated.iter().filter(|flag| **flag).count(), 2);
        assert_eq!(replay.truncated.iter().filter(|flag| **flag).count(), 2);
    }

    #[test]
    fn another_team_size_is_refused_with_the_name_of_the_shard() {
        let place = tempfile::tempdir().unwrap();
        write(place.path(), "a.safetensors", 2);
        write(place.path(), "b.safetensors", 3);
        let message = survey(&[place.path().to_owned()]).unwrap_err().to_string();
        assert!(message.contains("b.safetensors was recorded with 3 robots and this training is for 2"), "{message}");
    }
}

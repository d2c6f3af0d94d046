//! What is trained, on what, and how: `train.toml` in the folder of a training, and the plans that ship.

use crate::reward_weights::RewardWeights;
use crate::settings::{Settings, SettingsError};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrainingConfig {
    /// Scenario: built-in name, file, or family (`box:8:3:any`: every episode has a layout of its own).
    pub scenario: String,
    /// Parameter set of the robots.
    pub profile: String,
    /// Changes of the robots' parameters, `KEY=VALUE`.
    pub set: Vec<String>,
    /// Seed of everything random.
    pub seed: u64,
    /// Every start of a training episode is moved by up to so much per axis, m.
    pub start_jitter: f64,
    /// K; 0: the scenario's.
    pub max_ticks: u64,
    /// An episode is cut off (and bootstrapped) so many ticks after everybody has arrived; negative: at K,
    /// as in the paper.
    pub after_arrival: i64,
    /// Episodes with uniformly random horizons before the first round.
    pub warm_up_episodes: u64,
    /// Episodes of a round; played with the actor published at the end of the round before.
    pub round_episodes: u64,
    /// Updates per tick played.
    pub updates_per_tick: f64,
    /// Rounds between two evaluations.
    pub evaluate_every: u64,
    /// Episodes of an evaluation, always the same ones.
    pub evaluation_episodes: u64,
    /// Their starts are moved by up to so much per axis, m.
    pub evaluation_jitter: f64,
    /// An actor that needs more ticks counts as worse than one that does not.
    pub most_ticks: u64,
    /// Rounds between two checkpoints.
    pub checkpoint_every: u64,
    /// What of the paper's reward is learnt from.
    pub reward: RewardWeights,
    /// Soft actor-critic.
    pub settings: Settings,
}

impl Default for TrainingConfig {
    fn default() -> Self {
        Self {
            scenario: "two_setpoint".into(),
            profile: "paper".into(),
            set: Vec::new(),
            seed: 1,
            start_jitter: 0.0,
            max_ticks: 0,
            after_arrival: -1,
            warm_up_episodes: 4,
            round_episodes: 2,
            updates_per_tick: 1.0,
            evaluate_every: 1,
            evaluation_episodes: 1,
            evaluation_jitter: 0.0,
            most_ticks: 350,
            checkpoint_every: 20,
            reward: RewardWeights::default(),
            settings: Settings::default(),
        }
    }
}

/// Why a plan cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TrainingConfigError {
    /// The file.
    #[error("cannot read the training plan {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Its content.
    #[error("training plan {place}: {reason}")]
    Content {
        /// The file, or `--learn KEY=VALUE`.
        place: String,
        /// What is wrong, and where.
        reason: String,
    },
    /// The learner's settings.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}

impl TrainingConfig {
    /// Reads a plan.
    pub fn read(path: &Path) -> Result<Self, TrainingConfigError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| TrainingConfigError::File { path: path.to_owned(), source })?;
        let place = path.display().to_string();
        let plan: Self = toml::from_str(&text)
            .map_err(|error| TrainingConfigError::Content { place: place.clone(), reason: error.to_string() })?;
        plan.validate(&place)?;
        Ok(plan)
    }

    /// The same plan after `KEY=VALUE`: a key of the plan, `reward.KEY`, or a key of the learner's settings.
    pub fn with(&self, assignment: &str) -> Result<Self, TrainingConfigError> {
        let place = format!("--learn {assignment}");
        let refuse = |reason: String| TrainingConfigError::Content { place: place.clone(), reason };
        let (key, value) = assignment.split_once('=').ok_or_else(|| refuse("write KEY=VALUE".into()))?;
        let key = key.trim();
        let mut table = toml::Table::try_from(self).map_err(|error| refuse(error.to_string()))?;
        if !table.contains_key(key) && !key.contains('.') {
            return Ok(Self { settings: self.settings.with(assignment)?, ..self.clone() });
        }
        // A text needs no quotes.
        let parse = |value: &str| toml::from_str::<toml::Table>(&format!("value = {value}"));
        let value = parse(value.trim()).or_else(|_| parse(&format!("{:?}", value.trim())));
        let value = value.map_err(|error| refuse(error.message().to_owned()))?.remove("value");
        let value = value.ok_or_else(|| refuse("it has no value".into()))?;
        match key.split_once('.') {
            None => table.insert(key.into(), value),
            Some((section, key)) => table
                .get_mut(section)
                .and_then(toml::Value::as_table_mut)
                .ok_or_else(|| refuse(format!("there is no section `{section}`; the sections are: reward, settings")))?
                .insert(key.into(), value),
        };
        let plan: Self = table.try_into().map_err(|error: toml::de::Error| refuse(error.message().to_owned()))?;
        plan.validate(&place)?;
        Ok(plan)
    }

    /// As `train.toml`.
    pub fn to_toml(&self) -> String {
        // Numbers, texts and tables only: cannot fail.
        toml::to_string(self).unwrap_or_default()
    }

    fn validate(&self, place: &str) -> Result<(), TrainingConfigError> {
        let refuse = |key: &str, value: &dyn std::fmt::Display, allowed: &str| {
            Err(TrainingConfigError::Content {
                place: place.into(),
                reason: format!("{key} = {value} is not allowed; {allowed}"),
            })
        };
        if !(0.0..=10.0).contains(&self.start_jitter) {
            return refuse("start_jitter", &self.start_jitter, "0..=10 m");
        }
        if !(0.0..=10.0).contains(&self.evaluation_jitter) {
            return refuse("evaluation_jitter", &self.evaluation_jitter, "0..=10 m");
        }
        if !(0.0..=100.0).contains(&self.updates_per_tick) {
            return refuse("updates_per_tick", &self.updates_per_tick, "0..=100");
        }
        let counts = [
            ("warm_up_episodes", self.warm_up_episodes),
            ("round_episodes", self.round_episodes),
            ("evaluate_every", self.evaluate_every),
            ("evaluation_episodes", self.evaluation_episodes),
            ("checkpoint_every", self.checkpoint_every),
        ];
        for (key, count) in counts {
            if !(1..=1_000_000).contains(&count) {
                return refuse(key, &count, "1..=1000000");
            }
        }
        let RewardWeights { progress, horizon, collision, arrival, variance, baseline, per_metre } = self.reward;
        let weights = [
            ("reward.progress", progress),
            ("reward.horizon", horizon),
            ("reward.collision", collision),
            ("reward.arrival", arrival),
            ("reward.variance", variance),
            ("reward.baseline", baseline),
            ("reward.per_metre", per_metre),
        ];
        for (key, weight) in weights {
            if !weight.is_finite() {
                return refuse(key, &weight, "any finite number");
            }
        }
        Ok(self.settings.validate()?)
    }

    /// The arguments of `coordinator rollout` that all sessions share.
    pub fn session_arguments(&self) -> Vec<String> {
        let mut arguments =
            vec!["--scenario".to_owned(), self.scenario.clone(), "--profile".into(), self.profile.clone()];
        for set in &self.set {
            arguments.extend(["--set".into(), set.clone()]);
        }
        if self.max_ticks > 0 {
            arguments.extend(["--max-ticks".into(), self.max_ticks.to_string()]);
        }
        arguments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_survives_its_file() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("train.toml");
        let plan = TrainingConfig { set: vec!["vodca.rows=each".into()], ..TrainingConfig::default() };
        std::fs::write(&path, plan.to_toml()).unwrap();
        assert_eq!(TrainingConfig::read(&path).unwrap(), plan);
    }

    #[test]
    fn one_key_changes_the_plan_the_reward_or_the_settings() {
        let plan = TrainingConfig::default().with("scenario=ex14_d").unwrap().with("reward.variance=0").unwrap();
        let plan = plan.with("batch=64").unwrap().with("settings.discount=0.9").unwrap();
        assert_eq!((plan.scenario.as_str(), plan.reward.variance, plan.settings.batch), ("ex14_d", 0.0, 64));
        assert_eq!(plan.settings.discount, 0.9);
    }

    #[test]
    fn a_wrong_key_or_value_is_named() {
        let message = |assignment: &str| TrainingConfig::default().with(assignment).unwrap_err().to_string();
        assert!(message("round_episodes=0").contains("round_episodes = 0 is not allowed; 1..=1000000"));
        assert!(message("nothing=1").contains("nothing"), "{}", message("nothing=1"));
        assert!(message("reward.nothing=1").contains("nothing"));
        assert!(message("reward.variance=nan").contains("reward.variance = NaN is not allowed; any finite number"));
        assert!(message("rewart.variance=1").contains("there is no section `rewart`"));
        assert!(message("seed").contains("KEY=VALUE") || message("seed").contains("seed"));
    }
}

//! Every number of the learner, once, with its equation and allowed range.

use serde::{Deserialize, Serialize};

/// Settings of soft actor-critic. The defaults are the paper's, and where it is silent those of the
/// published algorithm (Haarnoja et al. 2018).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Neurons of each of the two hidden layers of every network (paper: 256), 1..=4096.
    pub hidden: usize,
    /// Rows of one update, 1..=65536.
    pub batch: usize,
    /// gamma of the soft target, 0..1.
    pub discount: f64,
    /// tau: how far the target critics move towards the critics in each update, above 0 and at most 1.
    pub target_rate: f64,
    /// Adam's step size for the actor, above 0 and at most 1.
    pub actor_rate: f64,
    /// Adam's step size for the critics, above 0 and at most 1.
    pub critic_rate: f64,
    /// Adam's step size for log alpha, above 0 and at most 1.
    pub temperature_rate: f64,
    /// H-bar, the entropy that the temperature aims at, nats per action vector. None: -N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_entropy: Option<f64>,
    /// alpha before the first update, above 0.
    pub temperature: f64,
    /// Whether alpha stays as it is instead of following the entropy.
    pub temperature_fixed: bool,
    /// What a remembered reward is multiplied with when it is drawn, above 0. None: 0.02 / N, at least 0.002.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reward_scale: Option<f64>,
    /// Largest Euclidean norm of each network's gradient; 0 leaves gradients as they are.
    pub gradient_clip: f64,
    /// The actor and alpha are updated at every so-manieth update, 1..=1000.
    pub actor_delay: u64,
    /// Lower bound of log sigma.
    pub log_std_min: f32,
    /// Upper bound of log sigma.
    pub log_std_max: f32,
    /// Rows that the replay buffer holds before it forgets the oldest, 1..=100000000.
    pub replay_rows: usize,
    /// Share of each batch that is drawn from favoured rows (successful episodes), 0..=1. The paper has none.
    pub favoured_share: f64,
    /// Threads of an update, 1..=2: with two, the critics run side by side. The result is the same.
    pub threads: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            hidden: 256,
            batch: 256,
            discount: 0.99,
            target_rate: 0.005,
            actor_rate: 3e-4,
            critic_rate: 3e-4,
            temperature_rate: 3e-4,
            target_entropy: None,
            temperature: 1.0,
            temperature_fixed: false,
            reward_scale: None,
            gradient_clip: 0.0,
            actor_delay: 1,
            log_std_min: -20.0,
            log_std_max: 2.0,
            replay_rows: 1_000_000,
            favoured_share: 0.0,
            threads: 1,
        }
    }
}

/// Why settings cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// A number out of its range.
    #[error("learner setting {field} = {value} is not allowed; allowed: {allowed}")]
    Range {
        /// Which one.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// Not `KEY=VALUE` or no such key.
    #[error("learner setting `{assignment}` cannot be used: {reason}")]
    Assignment {
        /// As given.
        assignment: String,
        /// Why.
        reason: String,
    },
}

impl Settings {
    /// Checks every field.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let range = |field, value: f64, ok: bool, allowed| {
            if ok { Ok(()) } else { Err(SettingsError::Range { field, value, allowed }) }
        };
        let count = |field, value: usize, most: usize, allowed| {
            range(field, value as f64, (1..=most).contains(&value), allowed)
        };
        let rate = |field, value: f64| range(field, value, value > 0.0 && value <= 1.0, "above 0, at most 1");
        let positive = |field, value: f64| range(field, value, value > 0.0 && value.is_finite(), "above 0");
        count("hidden", self.hidden, 4096, "1..=4096")?;
        count("batch", self.batch, 65_536, "1..=65536")?;
        count("replay_rows", self.replay_rows, 100_000_000, "1..=100000000")?;
        count("threads", self.threads, 2, "1..=2")?;
        count("actor_delay", self.actor_delay as usize, 1000, "1..=1000")?;
        range("discount", self.discount, (0.0..1.0).contains(&self.discount), "0..1, 1 excluded")?;
        rate("target_rate", self.target_rate)?;
        rate("actor_rate", self.actor_rate)?;
        rate("critic_rate", self.critic_rate)?;
        rate("temperature_rate", self.temperature_rate)?;
        positive("temperature", self.temperature)?;
        if let Some(scale) = self.reward_scale {
            positive("reward_scale", scale)?;
        }
        if let Some(entropy) = self.target_entropy {
            range("target_entropy", entropy, entropy.is_finite(), "a finite number")?;
        }
        let clip = self.gradient_clip;
        range("gradient_clip", clip, clip >= 0.0 && clip.is_finite(), "0 (off) or above")?;
        range("favoured_share", self.favoured_share, (0.0..=1.0).contains(&self.favoured_share), "0..=1")?;
        let (low, high) = (self.log_std_min, self.log_std_max);
        range("log_std_min", f64::from(low), low.is_finite() && (-40.0..high).contains(&low), "-40..log_std_max")?;
        range("log_std_max", f64::from(high), high <= 10.0, "log_std_min..=10")
    }

    /// H-bar for `actions` robots: what is set, otherwise -N.
    pub fn target_entropy(&self, actions: usize) -> f64 {
        self.target_entropy.unwrap_or(-(actions as f64))
    }

    /// Reward scale for `actions` robots: what is set, otherwise 0.02 / N, at least 0.002.
    pub fn reward_scale(&self, actions: usize) -> f64 {
        self.reward_scale.unwrap_or((0.02 / actions as f64).max(0.002))
    }

    /// The same settings after `KEY=VALUE`.
    pub fn with(&self, assignment: &str) -> Result<Self, SettingsError> {
        let refuse = |reason: String| SettingsError::Assignment { assignment: assignment.into(), reason };
        let (key, value) = assignment.split_once('=').ok_or_else(|| refuse("it is not KEY=VALUE".into()))?;
        let overlay: toml::Table = toml::from_str(&format!("{} = {}", key.trim(), value.trim()))
            .map_err(|error| refuse(error.message().to_string()))?;
        let mut table = toml::Table::try_from(self).map_err(|error| refuse(error.to_string()))?;
        table.extend(overlay);
        let changed: Self = table.try_into().map_err(|error: toml::de::Error| refuse(error.message().to_string()))?;
        changed.validate()?;
        Ok(changed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_scale_rewards_with_the_team() {
        let settings = Settings::default();
        settings.validate().unwrap();
        assert_eq!((settings.reward_scale(2), settings.reward_scale(14)), (0.01, 0.002));
        assert_eq!(settings.target_entropy(14), -14.0);
    }

    #[test]
    fn an_assignment_changes_one_setting() {
        let changed = Settings::default().with("batch=64").unwrap().with("target_entropy = -3.5").unwrap();
        assert_eq!(changed, Settings { batch: 64, target_entropy: Some(-3.5), ..Settings::default() });
        assert_eq!(Settings::default().with("discount=0").unwrap().discount, 0.0);
    }

    #[test]
    fn a_wrong_setting_is_refused_with_what_is_allowed() {
        let message = |assignment| Settings::default().with(assignment).unwrap_err().to_string();
        assert_eq!(message("batch=0"), "learner setting batch = 0 is not allowed; allowed: 1..=65536");
        assert!(message("bach=1").contains("unknown field `bach`"), "{}", message("bach=1"));
        assert!(message("batch").contains("KEY=VALUE"));
        assert!(message("discount=1.0").contains("discount = 1"));
        assert!(message("log_std_min=3").contains("log_std_min"));
        assert!(message("temperature=nan").contains("temperature"));
    }
}

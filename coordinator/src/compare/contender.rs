//! Who is compared: a controller, its parameters and where its horizons come from.

use shared::horizon_source::{HorizonSourceError, HorizonSpec};
use shared::params::{Profile, UnknownProfile};
use std::fmt;
use std::str::FromStr;

/// A controller with its settings: `safe:fixed:20`, `paper:random`, `orca`, `orca:5`, `orca-rh`.
#[derive(Clone, Debug)]
pub struct Contender {
    name: String,
    /// Parameters to start from.
    pub profile: Profile,
    /// What is changed in them, as for `--set`.
    pub sets: Vec<String>,
    /// Where horizons come from; a bare `random` takes the run's seed. ORCA ignores them.
    pub horizon: HorizonSpec,
}

/// Not a controller.
#[derive(Debug, thiserror::Error)]
#[error(
    "controller `{spec}`: {reason}; write PROFILE:HORIZON (safe:fixed:20, safe:random, paper:fixed:9,40), orca, orca:TAU or orca-rh"
)]
pub struct ContenderError {
    spec: String,
    reason: String,
}

impl FromStr for Contender {
    type Err = ContenderError;

    fn from_str(spec: &str) -> Result<Self, ContenderError> {
        let wrong = |reason: String| ContenderError { spec: spec.into(), reason };
        let (kind, rest) = spec.split_once(':').map_or((spec, None), |(kind, rest)| (kind, Some(rest)));
        let profile = kind.parse().map_err(|error: UnknownProfile| wrong(error.to_string()))?;
        let (mut sets, mut horizon) = (Vec::new(), "fixed:20");
        match (profile, rest) {
            (Profile::Orca | Profile::OrcaRh, Some(time_horizon)) => {
                time_horizon.parse::<f64>().map_err(|error| wrong(error.to_string()))?;
                sets.push(format!("orca.time_horizon={time_horizon}"));
            }
            (_, Some(rest)) => horizon = rest,
            (_, None) => {}
        }
        let horizon = horizon.parse().map_err(|error: HorizonSourceError| wrong(error.to_string()))?;
        Ok(Self { name: spec.into(), profile, sets, horizon })
    }
}

impl fmt::Display for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::params::{ControllerKind, Params};

    fn params(spec: &str) -> Params {
        let contender: Contender = spec.parse().unwrap();
        Params::resolve(contender.profile, "-", &toml::Table::new(), &contender.sets).unwrap()
    }

    #[test]
    fn each_name_stands_for_its_parameters() {
        assert_eq!(params("safe:random"), Params::safe());
        assert_eq!(params("paper:fixed:20"), Params::paper());
        assert_eq!(params("orca").controller.kind, ControllerKind::Orca);
        assert_eq!(params("orca:2").orca.time_horizon, 2.0);
        assert_eq!((params("orca-rh").orca.time_horizon, params("orca-rh").orca.aim), (1.0, 0.35));
    }

    #[test]
    fn anything_else_is_answered_with_examples() {
        for spec in ["orcas", "safe:fixed:99", "orca:fast"] {
            let message = spec.parse::<Contender>().unwrap_err().to_string();
            assert!(message.contains("safe:fixed:20"), "{message}");
        }
    }
}

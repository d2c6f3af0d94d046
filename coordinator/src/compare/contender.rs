//! Who is compared: a controller, its parameters and where its horizons come from.

use shared::horizon_source::HorizonSpec;
use shared::params::Profile;
use std::fmt;
use std::str::FromStr;

/// ORCA-RH: one second ahead, everybody aims 0.35 rad right of the set-point.
const ORCA_RH: [&str; 3] = ["controller.kind=orca", "orca.time_horizon=1.0", "orca.aim=0.35"];
const ORCA: [&str; 1] = ["controller.kind=orca"];

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
        let orca = |sets: &[&str]| Self {
            name: spec.into(),
            profile: Profile::Paper,
            sets: sets.iter().map(|set| set.to_string()).collect(),
            horizon: HorizonSpec::Fixed(vec![shared::horizon::Horizon::MIN]),
        };
        let (kind, rest) = spec.split_once(':').map_or((spec, None), |(kind, rest)| (kind, Some(rest)));
        match (kind, rest) {
            ("orca", None) => Ok(orca(&ORCA)),
            ("orca", Some(time_horizon)) => {
                time_horizon.parse::<f64>().map_err(|error| wrong(error.to_string()))?;
                Ok(orca(&[ORCA[0], &format!("orca.time_horizon={time_horizon}")]))
            }
            ("orca-rh", None) => Ok(orca(&ORCA_RH)),
            (profile, horizon) => Ok(Self {
                name: spec.into(),
                profile: profile.parse().map_err(|error: shared::params::UnknownProfile| wrong(error.to_string()))?,
                sets: Vec::new(),
                horizon: horizon
                    .unwrap_or("fixed:20")
                    .parse()
                    .map_err(|error: shared::horizon_source::HorizonSourceError| wrong(error.to_string()))?,
            }),
        }
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
        for spec in ["orcas", "safe:fixed:99", "orca:fast", "orca-rh:3"] {
            let message = spec.parse::<Contender>().unwrap_err().to_string();
            assert!(message.contains("safe:fixed:20"), "{message}");
        }
    }
}

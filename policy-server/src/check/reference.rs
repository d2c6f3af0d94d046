//! A reference set: observations with the answers that the trained actor gives.

use super::{CheckError, TryError};
use crate::actor::Answer;
use policy::contract::Contract;
use serde::{Deserialize, Serialize};
use vodca::horizon::Horizon;

/// Observations with the answers that the trained actor gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceSet {
    /// How far `mean` and `log_std` may differ, absolute.
    pub tolerance: f64,
    /// At most `MAX_CASES`.
    pub cases: Vec<Case>,
}

/// One observation and its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Positions [x0, y0, x1, y1, ...], m.
    pub observation: Vec<f64>,
    /// Mean of the raw action, per robot.
    pub mean: Vec<f64>,
    /// Its log_std, per robot; empty when the actor has none.
    #[serde(default)]
    pub log_std: Vec<f64>,
    /// Horizons chosen by the mean, per robot.
    pub horizon: Vec<Horizon>,
}

/// Most cases of a set.
const MAX_CASES: usize = 256;

impl ReferenceSet {
    /// Reads a set; `place` is named in errors.
    pub fn from_json(json: &[u8], place: &str, contract: &Contract) -> Result<Self, CheckError> {
        let refuse = |reason: String| CheckError::ReferenceFile { file: place.into(), reason };
        let set: Self = serde_json::from_slice(json).map_err(|error| refuse(error.to_string()))?;
        if !(set.tolerance.is_finite() && (0.0..=0.1).contains(&set.tolerance)) {
            return Err(refuse(format!("tolerance = {} is not allowed; allowed: 0..=0.1", set.tolerance)));
        }
        if set.cases.is_empty() || set.cases.len() > MAX_CASES {
            return Err(refuse(format!("it has {} cases; allowed: 1..={MAX_CASES}", set.cases.len())));
        }
        let robots = contract.robots;
        let spread = contract.outputs.log_std.as_ref().map_or(0, |_| robots);
        let fits = |case: &Case| {
            let log_std = case.log_std.len() == spread || case.log_std.is_empty();
            case.observation.len() == 2 * robots && case.mean.len() == robots && case.horizon.len() == robots && log_std
        };
        match set.cases.iter().position(|case| !fits(case)) {
            Some(case) => Err(refuse(format!("case {case} does not have the numbers of {robots} robots"))),
            None => Ok(set),
        }
    }
}

impl Case {
    /// Compares `answer` with this case, the `index`th of its set.
    pub fn compare(&self, answer: &Answer, contract: &Contract, tolerance: f64, index: usize) -> Result<(), TryError> {
        for robot in 0..self.mean.len() {
            let differs = |output: &str, got: f64, expected: f64, tolerance: f64| TryError::Reference {
                case: index,
                robot,
                output: output.into(),
                got,
                expected,
                tolerance,
            };
            let (got, expected) = (f64::from(answer.mean[robot]), self.mean[robot]);
            // Written so that NaN differs.
            let near = |got: f64, expected: f64| (got - expected).abs() <= tolerance;
            if !near(got, expected) {
                return Err(differs("mean", got, expected, tolerance));
            }
            if let (Some(&got), Some(&expected)) = (answer.log_std.get(robot), self.log_std.get(robot))
                && !near(f64::from(got), expected)
            {
                return Err(differs("log_std", f64::from(got), expected, tolerance));
            }
            // A mean within tolerance may lie on the other side of a rounding edge.
            let steps = |mean: f64| contract.horizon(contract.action(mean)).map_or(0, Horizon::steps);
            let allowed = steps(expected - tolerance)..=steps(expected + tolerance);
            let stated = self.horizon[robot].steps();
            for chosen in [steps(got), stated] {
                if !allowed.contains(&chosen) {
                    return Err(differs("horizon", steps(got) as f64, stated as f64, 0.0));
                }
            }
        }
        Ok(())
    }
}

//! Scenario and parameters of a run, from what the user typed, checked together.

use super::{Scenario, ScenarioError};
use crate::params::{OverlayError, Params, Profile};

/// Why a run cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// The scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The parameters.
    #[error(transparent)]
    Params(#[from] OverlayError),
}

/// Finds the scenario ([`Scenario::resolve`]), its effective parameters ([`Params::resolve`]) and checks
/// the layout's distances with them.
pub fn set_up(
    spec: Option<&str>,
    robots: Option<usize>,
    profile: Profile,
    sets: &[String],
) -> Result<(Scenario, Params), SetupError> {
    let scenario = Scenario::resolve(spec, robots)?;
    let params = Params::resolve(profile, &scenario.name, &scenario.params, sets)?;
    scenario.validate_distances(params.model.min_separation)?;
    Ok((scenario, params))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_checked_with_the_effective_parameters() {
        let (scenario, params) = set_up(Some("ex14_d"), Some(14), Profile::Safe, &[]).unwrap();
        assert_eq!((scenario.robots.len(), params), (14, Params::safe()));
        let wide = ["model.min_separation=3.5".to_string()];
        let message = set_up(Some("ex14_d"), Some(14), Profile::Safe, &wide).unwrap_err().to_string();
        assert!(message.contains("robot-0 starts 3.0000 m from robot-1, nearer than the 3.5000 m"), "{message}");
    }
}

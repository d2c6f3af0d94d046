//! Scenario and parameters of a run, from what the user typed, checked together.

use super::{Scenario, ScenarioError, is_file};
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
/// the layout's distances and that ways lead to all set-points with them.
pub fn set_up(
    spec: Option<&str>,
    robots: Option<usize>,
    profile: Profile,
    sets: &[String],
) -> Result<(Scenario, Params), SetupError> {
    let scenario = Scenario::resolve(spec, robots)?;
    // Errors name the file that the user gave and can correct; its scenario may be called otherwise.
    let place = spec.filter(|spec| is_file(spec)).unwrap_or(&scenario.name);
    let params = Params::resolve(profile, place, &scenario.params, sets)?;
    let min_separation = params.model.min_separation;
    scenario.validate_distances(min_separation).and_then(|()| scenario.validate_ways(min_separation)).map_err(
        // Its lines, as far as it can be read again.
        |error| match std::fs::read_to_string(place).ok().filter(|_| spec.is_some_and(is_file)) {
            Some(text) => error.in_file(place, &text),
            None => error.at(place),
        },
    )?;
    Ok((scenario, params))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_in_a_file_name_the_file() {
        let file = std::env::temp_dir().join(format!("vodca-setup-{}.toml", std::process::id()));
        let path = file.to_str().unwrap();
        let message = |text: &str| {
            std::fs::write(&file, text).unwrap();
            set_up(Some(path), None, Profile::Safe, &[]).unwrap_err().to_string()
        };
        let robot = |x: f64| format!("[[robot]]\nstart = [{x}, 0]\nset_point = [{x}, 9]\n");
        let close = message(&format!("version = 1\nname = \"cross\"\n{}{}", robot(0.0), robot(1.0)));
        let params = message(&format!("version = 1\n{}[params]\nvodca.rws = 1\n", robot(0.0)));
        std::fs::remove_file(&file).unwrap();
        assert!(
            close.starts_with(&format!("scenario {path}, line 3: robot-0 starts 1.0000 m from robot-1")),
            "{close}"
        );
        assert!(params.starts_with(&format!("scenario {path} [params]: section `vodca` has no")), "{params}");
    }

    #[test]
    fn distances_are_checked_with_the_effective_parameters() {
        let (scenario, params) = set_up(Some("ex14_d"), Some(14), Profile::Safe, &[]).unwrap();
        assert_eq!((scenario.robots.len(), params), (14, Params::safe()));
        let wide = ["model.min_separation=3.5".to_string()];
        let message = set_up(Some("ex14_d"), Some(14), Profile::Safe, &wide).unwrap_err().to_string();
        assert!(message.contains("robot-0 starts 3.0000 m from robot-1, nearer than the 3.5000 m"), "{message}");
    }
}

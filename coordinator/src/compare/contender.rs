//! Who is compared: a controller, its parameters and where its horizons come from.

use crate::commands::range::Numbers;
use shared::horizon_source::{HorizonSourceError, HorizonSpec};
use shared::params::{Profile, UnknownProfile};
use std::fmt;
use std::str::FromStr;

/// A controller with its settings: `safe:fixed:20`, `safe[vodca.turn=0]:random`, `safe:each:10,20,random`,
/// `orca`, `orca:5`, `orca-rh`.
#[derive(Clone, Debug)]
pub struct Contender {
    name: String,
    /// Parameters to start from.
    pub profile: Profile,
    /// What is changed in them, as for `--set`.
    pub sets: Vec<String>,
    /// Where horizons come from, one run for each; a bare `random` takes the run's seed. ORCA ignores them.
    pub horizons: Vec<HorizonSpec>,
}

/// Not a controller.
#[derive(Debug, thiserror::Error)]
#[error(
    "controller `{spec}`: {reason}; write PROFILE[KEY=VALUE,...]:HORIZON, for example safe:fixed:20, safe:random, \
     safe:each:10,20,30,49 (a run with each), paper[vodca.rows=each]:fixed:20, orca, orca:TAU or orca-rh"
)]
pub struct ContenderError {
    spec: String,
    reason: String,
}

/// Where nothing else is said.
const USUAL_HORIZON: &str = "fixed:20";

impl FromStr for Contender {
    type Err = ContenderError;

    fn from_str(spec: &str) -> Result<Self, ContenderError> {
        let wrong = |reason: String| ContenderError { spec: spec.into(), reason };
        let (profile, rest) = spec.split_at(spec.find(['[', ':']).unwrap_or(spec.len()));
        let profile = profile.parse().map_err(|error: UnknownProfile| wrong(error.to_string()))?;
        let (mut sets, rest) = overlay(rest).map_err(wrong)?;
        let horizons = match (profile, rest.strip_prefix(':')) {
            (_, None) if !rest.is_empty() => return Err(wrong(format!("`{rest}` after the `]`"))),
            (Profile::Orca | Profile::OrcaRh, Some(time_horizon)) => {
                let _: f64 = time_horizon.parse().map_err(|_| {
                    wrong(format!("ORCA has no prediction horizon, and `{time_horizon}` is not a time horizon in s"))
                })?;
                sets.push(format!("orca.time_horizon={time_horizon}"));
                horizons(USUAL_HORIZON)
            }
            (_, chosen) => horizons(chosen.unwrap_or(USUAL_HORIZON)),
        };
        Ok(Self { name: spec.into(), profile, sets, horizons: horizons.map_err(wrong)? })
    }
}

/// The settings of a leading `[KEY=VALUE,...]`, and what follows.
fn overlay(rest: &str) -> Result<(Vec<String>, &str), String> {
    let Some(inside) = rest.strip_prefix('[') else { return Ok((Vec::new(), rest)) };
    let (list, rest) = inside.split_once(']').ok_or("the `[` is not closed")?;
    let sets: Vec<String> = list.split(',').map(|set| set.trim().to_string()).collect();
    match sets.iter().find(|set| !set.contains('=')) {
        Some(set) => Err(format!("`{set}` is not KEY=VALUE")),
        None => Ok((sets, rest)),
    }
}

/// `each:` takes numbers, ranges of them and `random`; everything else is one source of horizons.
fn horizons(text: &str) -> Result<Vec<HorizonSpec>, String> {
    let one = |text: &str| text.parse::<HorizonSpec>().map_err(|error: HorizonSourceError| error.to_string());
    let Some(list) = text.strip_prefix("each:") else { return Ok(vec![one(text)?]) };
    let mut all = Vec::new();
    for item in list.split(',') {
        if item == "random" {
            all.push(HorizonSpec::Random(None));
            continue;
        }
        let Numbers(numbers) = item.parse().map_err(|error: crate::commands::range::NumbersError| error.to_string())?;
        for number in numbers {
            all.push(one(&format!("fixed:{number}"))?);
        }
    }
    Ok(all)
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

    fn horizons(spec: &str) -> Vec<String> {
        spec.parse::<Contender>().unwrap().horizons.iter().map(HorizonSpec::to_string).collect()
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
    fn an_overlay_changes_this_controller_only() {
        let plain = params("safe[vodca.turn=0, aim.angle=0]:fixed:20");
        assert_eq!((plain.vodca.turn, plain.aim.angle), (0.0, 0.0));
        assert_eq!(horizons("safe[vodca.turn=0]:random"), ["random"]);
        assert_eq!(params("orca[orca.push=0.3]:5").orca.push, 0.3);
    }

    #[test]
    fn each_is_a_run_per_horizon_and_a_plain_list_one_horizon_per_robot() {
        assert_eq!(horizons("safe:each:10,20,random"), ["fixed:10", "fixed:20", "random"]);
        assert_eq!(horizons("safe:each:3..5"), ["fixed:3", "fixed:4", "fixed:5"]);
        assert_eq!(horizons("safe:fixed:10,20"), ["fixed:10,20"]);
        assert_eq!(horizons("safe"), ["fixed:20"]);
    }

    #[test]
    fn anything_else_is_answered_with_the_reason_and_examples() {
        let cases = [
            ("orcas", "unknown profile `orcas`"),
            ("safe:fixed:99", "horizon 99 is outside 1..=49"),
            ("safe:each:10,x", "`x` is not a list of whole numbers"),
            ("safe:each:0", "horizon 0 is outside"),
            ("orca:fixed:20", "ORCA has no prediction horizon"),
            ("safe[vodca.turn=0:fixed:20", "the `[` is not closed"),
            ("safe[vodca.turn]:random", "`vodca.turn` is not KEY=VALUE"),
            ("safe[vodca.turn=0]random", "`random` after the `]`"),
        ];
        for (spec, reason) in cases {
            let message = spec.parse::<Contender>().unwrap_err().to_string();
            assert!(message.contains(reason) && message.contains("safe:each:10,20,30,49"), "{message}");
        }
    }
}

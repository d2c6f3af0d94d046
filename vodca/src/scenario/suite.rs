//! Named sets of scenarios for comparisons.

use super::builtin;

/// One of each kind, small enough for a coffee break.
pub const QUICK: &[&str] = &[
    "two_setpoint",
    "four_gate",
    "ex14_a",
    "ex14_d",
    "ex14_g",
    "antipodal8",
    "antipodal16",
    "rand8o3_s0",
    "rand16o0_s0",
    "rand16o3_s1",
    "rand32o0_s0",
    "segregate3x4_s0",
];

/// Hardly more room than the robots need: a layout of each kind for every seed of [`SEEDS`].
pub const TIGHT: &[&str] =
    &["park:16", "park:36", "tight_ring:24", "tight_ring:32", "tight_ring:40", "permute:16", "permute:36", "mixed:16"];

/// Walls, doors and obstacles, likewise.
pub const WALLS: &[&str] = &[
    "pocket:6",
    "door:6:3.4",
    "door:10:3.4",
    "door:10:5",
    "door:16:5",
    "corridor:10",
    "forest:15",
    "rooms:20",
    "warehouse:20",
];

/// Seeds of the layouts of a generated suite.
pub const SEEDS: std::ops::Range<u64> = 100..200;

/// The name of a suite that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no suite `{0}`; the suites are: suite:all (all built-in scenarios), suite:quick ({n} of them), suite:tight and suite:walls (generated)", n = QUICK.len())]
pub struct UnknownSuite(pub String);

/// The scenarios that `spec` stands for: those of `suite:all` or `suite:quick`, otherwise itself.
pub fn expand(spec: &str) -> Result<Vec<String>, UnknownSuite> {
    match spec {
        "suite:all" => Ok(builtin::names().map(String::from).collect()),
        "suite:quick" => Ok(QUICK.iter().map(|name| name.to_string()).collect()),
        "suite:tight" => Ok(seeded(TIGHT)),
        "suite:walls" => Ok(seeded(WALLS)),
        other if other.starts_with("suite:") => Err(UnknownSuite(other.into())),
        other => Ok(vec![other.into()]),
    }
}

fn seeded(forms: &[&str]) -> Vec<String> {
    forms.iter().flat_map(|form| SEEDS.map(move |seed| format!("{form}:{seed}"))).collect()
}

/// The family of a scenario: results of one family belong in one row of a table.
/// `rand8o3_s4` is of `rand8o3`, `segregate3x4_s0` of `segregate3x4`, `park:16:104` of `park:16`, all others are
/// their own.
pub fn family(name: &str) -> &str {
    let forms = || TIGHT.iter().chain(WALLS);
    let seeded = |form: &&&str| name.strip_prefix(**form).is_some_and(|seed| seed.starts_with(':'));
    if let Some(form) = forms().find(seeded) {
        return form;
    }
    match name.rsplit_once("_s") {
        Some((family, seed)) if !seed.is_empty() && seed.bytes().all(|c| c.is_ascii_digit()) => family,
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    #[test]
    fn suites_hold_scenarios_that_exist() {
        assert_eq!(expand("suite:all").unwrap().len(), 88);
        let quick = expand("suite:quick").unwrap();
        assert_eq!(quick.len(), 12);
        for (suite, families) in [("suite:tight", 8), ("suite:walls", 9)] {
            let all = expand(suite).unwrap();
            assert_eq!(all.len(), 100 * families);
            for name in all.iter().step_by(33) {
                Scenario::resolve(Some(name), None).unwrap().validate_distances(1.5).unwrap();
            }
        }
        for name in quick {
            assert!(Scenario::resolve(Some(&name), None).is_ok(), "{name}");
        }
    }

    #[test]
    fn other_names_stand_for_themselves_and_unknown_suites_are_refused() {
        assert_eq!(expand("ring:16"), Ok(vec!["ring:16".to_string()]));
        assert!(expand("suite:best").unwrap_err().to_string().contains("suite:all"));
    }

    #[test]
    fn families_are_names_without_their_seed() {
        assert_eq!(family("rand8o3_s4"), "rand8o3");
        assert_eq!(family("two_setpoint"), "two_setpoint");
        assert_eq!(family("antipodal8"), "antipodal8");
        assert_eq!((family("park:16:104"), family("door:10:3.4:7")), ("park:16", "door:10:3.4"));
    }
}

//! What is compared: a controller, its parameters and where its horizons come from.

use super::best::{ORCA_BEST, orca_variants};
use crate::range::{Numbers, NumbersError};
use std::fmt;
use std::str::FromStr;
use vodca::horizon_source::{HorizonSourceError, HorizonSpec};
use vodca::params::{Profile, UnknownProfile};

/// A controller with its settings, a row of the table: `safe:fixed:20`, `safe[vodca.turn=0]:random`,
/// `safe:each:10,20,random`, `paper:policy:NAME`, `orca`, `orca:5`, `orca-rh`, `orca-best`.
#[derive(Clone, Debug)]
pub struct ControllerSpec {
    name: String,
    /// As it was given, perhaps with others: `safe:fixed:10,20` for `safe:fixed:10`.
    pub given: String,
    /// Parameters to start from.
    pub profile: Profile,
    /// What is changed in them, as for `--set`.
    pub sets: Vec<String>,
    /// What else is changed, in one variant after the other; usually there is one that changes nothing. Only the
    /// best variant of a layout counts there.
    pub variants: Vec<Vec<String>>,
    /// Where horizons come from, one run for each. ORCA ignores them.
    pub horizons: Vec<HorizonPart>,
}

/// Where the horizons of a controller's run come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HorizonPart {
    /// A table that is known before the run; a bare `random` takes the run's seed.
    Table(HorizonSpec),
    /// A policy, asked at every tick: an ONNX file, a policies folder, or the name of one in `policies/`.
    Policy(String),
}

/// One or several controllers: `safe:fixed:5,10,...,49` is one for each horizon.
#[derive(Clone, Debug)]
pub struct ControllerSpecs(pub Vec<ControllerSpec>);

/// Not a controller.
#[derive(Debug, thiserror::Error)]
#[error(
    "controller `{spec}`: {reason}; write PROFILE[KEY=VALUE,...]:HORIZON, for example safe:fixed:20, safe:random, \
     paper:fixed:5,10,...,49 (a row for each), paper:random:0..19 (a row for each sequence), safe:each:10,20,30,49 (a \
     run with each, all in one row), paper:policy:NAME, paper[vodca.rows=each]:fixed:20, orca, orca:TAU, orca-rh or \
     orca-best; without a PROFILE it is safe"
)]
pub struct ControllerSpecError {
    spec: String,
    reason: String,
}

/// Where nothing else is said.
const USUAL_HORIZON: &str = "fixed:20";
/// What a HORIZON may start with. A spec that starts so has left its PROFILE out.
const KINDS: [&str; 5] = ["fixed", "random", "each", "policy", "script"];

impl FromStr for ControllerSpecs {
    type Err = ControllerSpecError;

    fn from_str(spec: &str) -> Result<Self, ControllerSpecError> {
        read(spec).map_err(|reason| ControllerSpecError { spec: spec.into(), reason })
    }
}

fn read(spec: &str) -> Result<ControllerSpecs, String> {
    let (word, rest) = spec.split_at(spec.find(['[', ':']).unwrap_or(spec.len()));
    if KINDS.contains(&word) {
        return rows(ControllerSpec::plain(spec, Profile::Safe), spec);
    }
    let (profile, variants) = match word {
        ORCA_BEST => (Profile::Orca, orca_variants()),
        _ => (word.parse().map_err(|error: UnknownProfile| error.to_string())?, vec![Vec::new()]),
    };
    let (mut sets, rest) = overlay(rest)?;
    let tried = |set: &&String| {
        let key = |set: &String| set.split('=').next().unwrap_or_default().trim().to_string();
        variants.iter().flatten().any(|own| key(own) == key(set))
    };
    if let Some(set) = sets.iter().find(tried) {
        return Err(format!("{word} chooses the parameter of `{set}` itself"));
    }
    let after = match rest.strip_prefix(':') {
        None if !rest.is_empty() => return Err(format!("`{rest}` after the `]`")),
        after => after,
    };
    let horizon = match (profile, after) {
        (Profile::Orca | Profile::OrcaRh, Some(_)) if variants.len() > 1 => {
            return Err(format!("{ORCA_BEST} chooses its time horizon itself"));
        }
        (Profile::Orca | Profile::OrcaRh, Some(time_horizon)) => {
            let _: f64 = time_horizon.parse().map_err(|_| {
                format!("ORCA has no prediction horizon, and `{time_horizon}` is not a time horizon in s")
            })?;
            sets.push(format!("orca.time_horizon={time_horizon}"));
            USUAL_HORIZON
        }
        (_, after) => after.unwrap_or(USUAL_HORIZON),
    };
    rows(ControllerSpec { sets, variants, ..ControllerSpec::plain(spec, profile) }, horizon)
}

impl ControllerSpec {
    /// `profile` as it is, with horizons from `horizon`.
    pub fn new(name: &str, profile: Profile, horizon: HorizonPart) -> Self {
        Self { horizons: vec![horizon], ..Self::plain(name, profile) }
    }

    fn plain(name: &str, profile: Profile) -> Self {
        let name = name.to_string();
        Self { given: name.clone(), name, profile, sets: Vec::new(), variants: vec![Vec::new()], horizons: Vec::new() }
    }
}

/// `controller` with the horizons that `horizon` stands for. One row is called as it was given; several have their own
/// HORIZON in its place.
fn rows(controller: ControllerSpec, horizon: &str) -> Result<ControllerSpecs, String> {
    let rows = horizons(horizon)?;
    let several = rows.len() > 1;
    let stem = controller.given.strip_suffix(horizon).unwrap_or_default().to_string();
    let named = |horizons: Vec<HorizonPart>| match (several, horizons.first()) {
        (true, Some(own)) => ControllerSpec { name: format!("{stem}{own}"), horizons, ..controller.clone() },
        _ => ControllerSpec { horizons, ..controller.clone() },
    };
    Ok(ControllerSpecs(rows.into_iter().map(named).collect()))
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

/// The rows that a HORIZON stands for. A list of numbers is always a list of runs: `fixed:` gives each horizon a row
/// of its own and `random:` each seed, `each:` puts all horizons into one row (and takes `random` among them).
fn horizons(text: &str) -> Result<Vec<Vec<HorizonPart>>, String> {
    match text.split_once(':') {
        Some(("policy", "")) => Err("`policy` needs a name, a folder or an ONNX file".into()),
        Some(("policy", name)) => Ok(vec![vec![HorizonPart::Policy(name.into())]]),
        Some(("fixed", list)) => Ok(fixed(list)?.into_iter().map(|one| vec![one]).collect()),
        Some(("random", list)) => {
            let Numbers(seeds) = list.parse().map_err(|error: NumbersError| error.to_string())?;
            Ok(seeds.into_iter().map(|seed| vec![HorizonPart::Table(HorizonSpec::Random(Some(seed)))]).collect())
        }
        Some(("each", list)) => {
            let (random, numbers): (Vec<&str>, Vec<&str>) = list.split(',').partition(|item| *item == "random");
            let mut row = if numbers.is_empty() { Vec::new() } else { fixed(&numbers.join(","))? };
            row.extend(random.iter().map(|_| HorizonPart::Table(HorizonSpec::Random(None))));
            Ok(vec![row])
        }
        _ => Ok(vec![vec![HorizonPart::Table(table(text)?)]]),
    }
}

/// One fixed horizon for each number of `list`.
fn fixed(list: &str) -> Result<Vec<HorizonPart>, String> {
    let Numbers(numbers) = list.parse().map_err(|error: NumbersError| error.to_string())?;
    numbers.into_iter().map(|number| Ok(HorizonPart::Table(table(&format!("fixed:{number}"))?))).collect()
}

fn table(text: &str) -> Result<HorizonSpec, String> {
    text.parse().map_err(|error: HorizonSourceError| error.to_string())
}

impl fmt::Display for HorizonPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table(spec) => spec.fmt(f),
            Self::Policy(name) => write!(f, "policy:{name}"),
        }
    }
}

impl fmt::Display for ControllerSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vodca::params::{ControllerKind, Params};

    fn all(spec: &str) -> Vec<ControllerSpec> {
        spec.parse::<ControllerSpecs>().unwrap().0
    }

    fn params(spec: &str) -> Params {
        let controller = all(spec).remove(0);
        Params::resolve(controller.profile, "-", &toml::Table::new(), &controller.sets).unwrap()
    }

    /// The horizons of the only controller.
    fn horizons(spec: &str) -> Vec<String> {
        let [only] = <[ControllerSpec; 1]>::try_from(all(spec)).unwrap();
        assert_eq!(only.to_string(), spec);
        only.horizons.iter().map(HorizonPart::to_string).collect()
    }

    /// All controllers by name.
    fn names(spec: &str) -> Vec<String> {
        let names = |controller: &ControllerSpec| {
            assert_eq!(controller.horizons.len(), 1);
            controller.to_string()
        };
        all(spec).iter().map(names).collect()
    }

    #[test]
    fn each_name_stands_for_its_parameters() {
        assert_eq!(params("safe:random"), Params::safe());
        assert_eq!(params("paper:fixed:20"), Params::paper());
        assert_eq!(params("orca").controller.kind, ControllerKind::Orca);
        assert_eq!(params("orca:2").orca.time_horizon, 2.0);
        assert_eq!((params("orca-rh").orca.time_horizon, params("orca-rh").orca.aim), (1.0, 0.35));
        assert_eq!((params("random"), params("policy:mine")), (Params::safe(), Params::safe()));
    }

    #[test]
    fn an_overlay_changes_this_controller_only() {
        let plain = params("safe[vodca.turn=0, aim.angle=0]:fixed:20");
        assert_eq!((plain.vodca.turn, plain.aim.angle), (0.0, 0.0));
        assert_eq!(horizons("safe[vodca.turn=0]:random"), ["random"]);
        assert_eq!(params("orca[orca.push=0.3]:5").orca.push, 0.3);
    }

    #[test]
    fn each_is_a_run_per_horizon_in_one_row() {
        assert_eq!(horizons("safe:each:10,20,random"), ["fixed:10", "fixed:20", "random"]);
        assert_eq!(horizons("each:random,3..5,10"), ["fixed:3", "fixed:4", "fixed:5", "fixed:10", "random"]);
    }

    #[test]
    fn a_list_is_a_contender_for_each_horizon() {
        assert_eq!(names("safe:fixed:10,20"), ["safe:fixed:10", "safe:fixed:20"]);
        assert_eq!(names("paper[vodca.rows=each]:fixed:5,6,...,8")[3], "paper[vodca.rows=each]:fixed:8");
        assert_eq!(names("fixed:5,10,...,49").len(), 10);
        assert_eq!(names("paper:random:0..2"), ["paper:random:0", "paper:random:1", "paper:random:2"]);
        assert!(all("paper:fixed:10,20").iter().all(|one| one.given == "paper:fixed:10,20"));
        assert_eq!((names("safe"), names("fixed:20")), (vec!["safe".into()], vec!["fixed:20".to_string()]));
    }

    #[test]
    fn the_best_orca_is_one_controller_with_variants() {
        let [best] = <[ControllerSpec; 1]>::try_from(all("orca-best[orca.fade=2]")).unwrap();
        assert_eq!((best.to_string().as_str(), best.variants.len()), ("orca-best[orca.fade=2]", 16));
        assert_eq!((best.sets, all("orca")[0].variants.len()), (vec!["orca.fade=2".to_string()], 1));
    }

    #[test]
    fn a_policy_is_named_by_a_name_a_folder_or_a_file() {
        assert_eq!(horizons("paper:policy:policies/ex14"), ["policy:policies/ex14"]);
        assert_eq!(horizons("safe[horizon.jitter=0]:policy:a:b.onnx"), ["policy:a:b.onnx"]);
        assert_eq!(horizons("policy:box"), ["policy:box"]);
    }

    #[test]
    fn anything_else_is_answered_with_the_reason_and_examples() {
        let cases = [
            ("orcas", "unknown profile `orcas`"),
            ("safe:fixed:99", "horizon 99 is outside 1..=49"),
            ("safe:each:10,x", "`10,x` is not a list of whole numbers"),
            ("safe:each:0", "horizon 0 is outside"),
            ("orca:fixed:20", "ORCA has no prediction horizon"),
            ("safe[vodca.turn=0:fixed:20", "the `[` is not closed"),
            ("safe[vodca.turn]:random", "`vodca.turn` is not KEY=VALUE"),
            ("safe[vodca.turn=0]random", "`random` after the `]`"),
            ("paper:policy:", "`policy` needs a name"),
            ("fixed:5,10,...,50", "horizon 50 is outside 1..=49"),
            ("orca-best[orca.push=0.1]", "chooses the parameter of `orca.push=0.1` itself"),
            ("orca-best:5", "orca-best chooses its time horizon itself"),
            ("paper:random:x", "is not a list of whole numbers"),
            ("fixed:", "is not a list of whole numbers"),
        ];
        for (spec, reason) in cases {
            let message = spec.parse::<ControllerSpecs>().unwrap_err().to_string();
            assert!(message.contains(reason) && message.contains("safe:each:10,20,30,49"), "{message}");
        }
    }
}

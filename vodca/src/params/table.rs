//! What is known about every parameter: one table for validation, listings and the documentation.

use super::Params;
use std::fmt;
use toml::{Table, Value};

/// What is known about one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// `section.field`, as in TOML and in `--set`.
    pub key: &'static str,
    /// Unit; `-` for none.
    pub unit: &'static str,
    /// Accepted values.
    pub allowed: Allowed,
    /// The paper's symbol or equation, or the page that defines it.
    pub source: &'static str,
    /// What a change does.
    pub effect: &'static str,
}

/// Accepted values of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    /// A finite number above the first and up to the second value.
    Above(f64, f64),
    /// A finite number between the two values, both included.
    Between(f64, f64),
    /// A whole number between the two values, both included.
    Whole(i64, i64),
    /// true or false.
    Switch,
    /// One of these words.
    OneOf(&'static [&'static str]),
}

/// A value that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("parameter {key} = {value} is not allowed; allowed: {allowed}{}", unit_note(.unit))]
pub struct Refusal {
    /// `section.field`.
    pub key: &'static str,
    /// The value as written.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
    /// Unit; `-` for none.
    pub unit: &'static str,
}

fn unit_note(unit: &str) -> String {
    if unit == "-" { String::new() } else { format!(" (unit: {unit})") }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Above(low, high) => write!(f, "a number above {low}, at most {high}"),
            Self::Between(low, high) => write!(f, "a number in {low}..={high}"),
            Self::Whole(low, high) => write!(f, "a whole number in {low}..={high}"),
            Self::Switch => f.write_str("true or false"),
            Self::OneOf(words) => f.write_str(&words.join(", ")),
        }
    }
}

impl Entry {
    /// `value` in the form this parameter has (a whole number where a number is wanted becomes one),
    /// or the reason why it is refused.
    pub fn check(&self, value: &Value) -> Result<Value, Refusal> {
        let accepted = match (self.allowed, value) {
            (Allowed::Above(low, high), Value::Float(x)) => (*x > low && *x <= high).then(|| value.clone()),
            (Allowed::Between(low, high), Value::Float(x)) => (low..=high).contains(x).then(|| value.clone()),
            (Allowed::Above(..) | Allowed::Between(..), Value::Integer(x)) => {
                return self.check(&Value::Float(*x as f64));
            }
            (Allowed::Whole(low, high), Value::Integer(x)) => (low..=high).contains(x).then(|| value.clone()),
            (Allowed::Switch, Value::Boolean(_)) => Some(value.clone()),
            (Allowed::OneOf(words), Value::String(word)) => words.contains(&word.as_str()).then(|| value.clone()),
            _ => None,
        };
        accepted.ok_or_else(|| Refusal {
            key: self.key,
            value: match value {
                Value::Float(x) => x.to_string(),
                Value::String(word) => format!("`{word}`"),
                other => other.to_string(),
            },
            allowed: self.allowed.to_string(),
            unit: self.unit,
        })
    }
}

const fn entry(
    key: &'static str,
    unit: &'static str,
    allowed: Allowed,
    source: &'static str,
    effect: &'static str,
) -> Entry {
    Entry { key, unit, allowed, source, effect }
}

use Allowed::{Above, Between, OneOf, Switch, Whole};

/// Every parameter, in the order of the structs. Sources: "paper" is Gupta, Kumar, Tripathy and Shah;
/// "rule N" is a rule of the safe profile and "guarantee" its proof, both in docs/ARCHITECTURE.md.
#[rustfmt::skip]
pub const ENTRIES: &[Entry] = &[
    entry("model.sample_time", "s", Above(0.0, 10.0), "paper: h, Table I", "length of a tick; a plan of N steps looks N h ahead"),
    entry("model.max_speed", "m/s", Above(0.0, 100.0), "paper: ub = -lb, Table I", "bound on the input, per axis"),
    entry("model.min_separation", "m", Above(0.0, 100.0), "paper: r_min, Table I", "centre distance that is kept; discs have half of it as radius; cell.separation follows it unless it is set itself"),
    entry("mpc.state_weight", "1/m^2", Above(0.0, 1e6), "paper: Q = q I, Table I", "larger: faster to the reference"),
    entry("mpc.input_weight", "s^2/m^2", Above(0.0, 1e6), "paper: W = w I, Table I", "larger: smoother and slower; 1 is worse in dense scenes"),
    entry("mpc.reference", "-", OneOf(&["set_point", "straight", "route"]), "paper: X^d; rules 1 and 12", "straight: no 45 degree start, no slow tail, and a free optimum without a QP; route: the same round obstacles and standing robots, deepest set-points first"),
    entry("vodca.rows", "-", OneOf(&["first", "each", "nearby"]), "paper: eq. er13", "first: one row as printed; each: one per conflicting hazard; nearby: all near ones at the first conflict"),
    entry("vodca.row_step", "-", OneOf(&["conflict", "before_conflict"]), "paper: k_c or k_c - 1", "prediction step on which a row acts"),
    entry("vodca.beyond_horizon", "-", OneOf(&["clamp", "skip", "limit"]), "paper: er13 is silent on k_c > N", "a conflict beyond the new horizon: row at its end, no row, or not looked for"),
    entry("vodca.first_compared_step", "step", Whole(1, 2), "paper: l = 1 is the present", "2 ignores conflicts that already exist"),
    entry("vodca.tie", "-", OneOf(&["nearest", "index"]), "ours", "which hazard `first` takes among equals"),
    entry("vodca.nearby_factor", "-", Between(1.0, 100.0), "Luis and Schoellig 2019", "reach of `nearby` as a multiple of model.min_separation"),
    entry("vodca.turn", "rad", Between(-1.5, 1.5), "rule 2: theta", "normals turned left: robots pass on the right; smaller: shorter dense paths, more segregation stalls"),
    entry("vodca.turn_lasting", "rad", Between(-1.5, 1.5), "ours: rule 7", "vodca.turn after a long conflict: what small angles leave stuck, large ones resolve"),
    entry("vodca.lasting_memory", "-", Above(0.0, 1.0), "ours: rule 7", "share of the newest tick in the memory of how long a conflict has lasted; smaller: the turn grows later"),
    entry("vodca.patience", "-", Between(0.0, 1.0), "ours: rule 9", "a robot whose conflict has lasted for this share of its memory lets everybody pass who has farther to go, wherever it is; 1 is off: some knots of robots near their set-points are never left"),
    entry("vodca.back_off", "-", Between(0.0, 1.0), "ours: rule 10", "a robot without patience whose conflict has lasted for this share walks off in a random direction now and then; 1 is off: robots that all wait for another one wait for ever; smaller: dense crowds dissolve later"),
    entry("vodca.softness", "-", OneOf(&["hard", "soft"]), "rule 2", "soft: rows have slack from the start, the QP is always feasible"),
    entry("vodca.infeasible", "-", OneOf(&["relax", "hold"]), "paper is silent", "hard rows without a solution: solve again with slack, or stand still (a trap)"),
    entry("vodca.slack_linear", "1/m", Between(0.0, 1e9), "ours: rho1", "exact penalty: with 1e3 rows that could hold are violated in 17 % of problems, with 1e4 never; smaller: shorter dense paths (the cells keep the separation), slower past obstacles"),
    entry("vodca.slack_quadratic", "1/m^2", Above(0.0, 1e9), "ours: rho2", "curvature of the penalty; keeps the QP strictly convex in the slack"),
    entry("aim.angle", "rad", Between(0.0, 1.5), "rule 4: phi", "right turn of the aim that a conflict asks for, and the least that traffic ahead asks for"),
    entry("aim.memory", "-", Above(0.0, 1.0), "rule 4: lambda", "share of the newest tick; 1 forgets at once and chatters"),
    entry("aim.fade_start", "m", Between(0.0, 1000.0), "rule 4: r", "nearer to the set-point than this nothing is turned"),
    entry("aim.fade_end", "m", Above(0.0, 1000.0), "rule 4: 3 r", "farther from the set-point than this the turn is full"),
    entry("aim.look_ahead", "step", Whole(0, 1000), "ours: rule 8", "whoever a straight walk will meet within this many steps is traffic ahead, whatever the horizons; 0 is off"),
    entry("aim.most", "rad", Between(0.0, 1.5), "ours: rule 8", "largest right turn that traffic ahead asks for; smaller: crowded centres jam, larger: wide ways through boxes"),
    entry("aim.price", "1/rad", Between(0.0, 1e6), "ours: rule 8", "a turn is taken where it spares more meetings than this times its size, if everybody takes it; smaller: quicker through crowded centres, longer paths in boxes"),
    entry("give_way.radius", "m", Between(0.0, 1000.0), "rule 3: r_y", "robots this near their set-point give way; 0 is off"),
    entry("give_way.clearance", "m", Between(0.0, 100.0), "rule 3: c_y", "added to min_separation while giving way"),
    entry("cell.enabled", "-", Switch, "rules 5 and 6", "the guarantee of separation; off: only the rows of vodca"),
    entry("cell.separation", "m", Above(0.0, 100.0), "rule 5: r_s", "separation guaranteed; left out, it is model.min_separation wherever that one is set; measurement noise of at most E per position needs min_separation + 3 E"),
    entry("cell.escape", "m/tick", Between(0.0, 10.0), "guarantee: kappa", "move away demanded where the distance is below cell.separation"),
    entry("cell.noise_bound", "m", Between(0.0, 10.0), "guarantee: E", "measuring errors of at most this leave cell.separation: cells keep 3 E more and demand E more escape"),
    entry("horizon.jitter", "step", Whole(0, 48), "ours: rule 11", "each horizon moves by a seeded draw of at most this, those of a script excepted; breaks limit cycles of fixed horizons"),
    entry("episode.arrival_tolerance", "m", Above(0.0, 100.0), "paper: e < 0.1", "a robot nearer to its set-point than this has arrived"),
    entry("episode.collision_factor", "-", Between(0.0, 1.0), "paper: 0.5 r_min", "share of min_separation below which two discs count as collided"),
    entry("controller.kind", "-", OneOf(&["vodca", "orca"]), "ours", "vodca: the MPC; orca: the baseline without plans and without guarantee"),
    entry("orca.time_horizon", "s", Above(0.0, 100.0), "van den Berg 2011: tau", "longer: earlier and wider avoidance, deadlocks in dense scenes"),
    entry("orca.neighbour_distance", "m", Above(0.0, 1000.0), "RVO2: neighborDist", "robots farther away are not seen"),
    entry("orca.max_neighbours", "robot", Whole(0, 200), "RVO2: maxNeighbors", "at most so many robots are seen, the nearest first"),
    entry("orca.aim", "rad", Between(0.0, 1.5), "ours: ORCA-RH 0.35", "every robot aims this far to the right of its set-point"),
    entry("orca.fade", "m", Above(0.0, 1000.0), "ours", "nearer to the set-point than this the aim fades linearly to none; longer: shorter paths"),
    entry("orca.push", "m/s", Between(0.0, 10.0), "ours", "seeded push of the wanted velocity, uniform over a disc, every tick; 0.3 breaks the deadlock of exact rings"),
    entry("disturbance.noise", "m", Between(0.0, 10.0), "ours", "largest error of a measured position, uniform over a disc"),
    entry("disturbance.plan_delay", "tick", Whole(0, 100), "ours", "plans arrive late; positions do not"),
    entry("disturbance.plan_loss", "-", Between(0.0, 1.0), "ours", "share of plans that get lost; positions do not"),
    entry("disturbance.position_loss", "-", Between(0.0, 1.0), "ours", "share of messages that get lost whole"),
];

/// The entry of `key`.
pub fn find(key: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|entry| entry.key == key)
}

/// The field names of `section`, in the order of the struct; empty for an unknown section.
pub fn fields(section: &str) -> Vec<&'static str> {
    ENTRIES
        .iter()
        .filter_map(|entry| entry.key.split_once('.'))
        .filter(|(s, _)| *s == section)
        .map(|(_, f)| f)
        .collect()
}

/// The names of the sections, in the order of the struct.
pub fn sections() -> Vec<&'static str> {
    let mut names: Vec<&str> = ENTRIES.iter().filter_map(|entry| entry.key.split_once('.')).map(|(s, _)| s).collect();
    names.dedup();
    names
}

/// `params` as the two-level TOML table that keys refer to.
pub(super) fn tree(params: &Params) -> Table {
    // Plain numbers, strings and booleans in two levels of tables always have a TOML form.
    Table::try_from(params).unwrap_or_default()
}

/// Every entry with its value in `params`.
pub fn values(params: &Params) -> impl Iterator<Item = (&'static Entry, Value)> {
    let tree = tree(params);
    ENTRIES.iter().filter_map(move |entry| {
        let (section, field) = entry.key.split_once('.')?;
        Some((entry, tree.get(section)?.get(field)?.clone()))
    })
}

/// All parameters as a table for the terminal: key, the values in `params`, unit, allowed, effect.
pub fn listing(params: &Params) -> String {
    values(params)
        .map(|(entry, value)| {
            let Entry { key, unit, allowed, source, effect } = entry;
            format!("{key} = {value}\n    unit {unit}; allowed: {allowed}; source: {source}\n    {effect}\n")
        })
        .collect()
}

/// All parameters as the Markdown table of docs/PARAMETERS.md, with the values of both profiles.
pub fn markdown() -> String {
    let mut text = String::from(
        "# Parameters\n\n\
         Written by `cargo run -p vodca --example parameters > docs/PARAMETERS.md` from `vodca/src/params/table.rs`.\n\
         Change one for a run with `--set KEY=VALUE`, or in a scenario under `[params]`.\n\n\
         | key | unit | allowed | paper | safe | source | effect |\n|---|---|---|---|---|---|---|\n",
    );
    let (paper, safe) = (Params::paper(), Params::safe());
    for ((entry, paper), (_, safe)) in values(&paper).zip(values(&safe)) {
        let Entry { key, unit, allowed, source, effect } = entry;
        text += &format!("| `{key}` | {unit} | {allowed} | {paper} | {safe} | {source} | {effect} |\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_exactly_one_entry() {
        let tree = tree(&Params::safe());
        let mut fields: Vec<String> = Vec::new();
        for (section, table) in &tree {
            fields.extend(table.as_table().unwrap().keys().map(|field| format!("{section}.{field}")));
        }
        let mut keys: Vec<&str> = ENTRIES.iter().map(|entry| entry.key).collect();
        fields.sort();
        keys.sort();
        assert_eq!(fields, keys);
    }

    #[test]
    fn the_page_of_parameters_is_what_this_table_says() {
        let page = include_str!("../../../docs/PARAMETERS.md");
        assert_eq!(page, markdown(), "write it anew: cargo run -p vodca --example parameters > docs/PARAMETERS.md");
    }

    #[test]
    fn the_listing_shows_every_key_with_its_value() {
        let listing = listing(&Params::safe());
        for entry in ENTRIES {
            assert!(listing.contains(&format!("{} = ", entry.key)), "{}", entry.key);
        }
        assert!(listing.contains("vodca.rows = \"each\""));
    }

    #[test]
    fn whole_numbers_are_accepted_as_numbers_but_not_the_other_way() {
        let turn = find("vodca.turn").unwrap();
        assert_eq!(turn.check(&Value::Integer(1)), Ok(Value::Float(1.0)));
        let jitter = find("horizon.jitter").unwrap();
        assert!(jitter.check(&Value::Float(2.0)).is_err());
    }

    #[test]
    fn words_in_the_table_are_the_words_the_structs_accept() {
        for entry in ENTRIES {
            if let OneOf(words) = entry.allowed {
                let (section, field) = entry.key.split_once('.').unwrap();
                for word in words {
                    let mut tree = tree(&Params::safe());
                    tree[section][field] = Value::String((*word).into());
                    assert!(tree.try_into::<Params>().is_ok(), "{} = {word}", entry.key);
                }
            }
        }
    }
}

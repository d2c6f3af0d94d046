//! Every constant of the method, once: name, unit, range, equation, effect.
//!
//! A run uses one [`Params`]: a profile (`paper`, `safe`), overlaid by the scenario's `[params]`
//! table, overlaid by `--set KEY=VALUE`. The effective values go into the run folder.
//! [`table`] holds what is known about each value: unit, range, source and effect.

mod file;
mod overlay;
mod profile;
pub mod table;

pub use file::ParamsFileError;
pub use overlay::OverlayError;
pub use profile::{Profile, UnknownProfile};

use serde::{Deserialize, Serialize};
use table::Refusal;

/// All parameters of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// The robot and its surroundings.
    pub model: Model,
    /// The quadratic cost.
    pub mpc: Mpc,
    /// Detection of conflicts and the rows they give.
    pub vodca: Vodca,
    /// Aim to the right while in conflict (ARCHITECTURE, rule 4).
    pub aim: Aim,
    /// Give way to robots that still travel (ARCHITECTURE, rule 3).
    pub give_way: GiveWay,
    /// Hard cell rows on the first step (ARCHITECTURE, rule 5).
    pub cell: Cell,
    /// Changes of the horizon after its source chose it.
    pub horizon: HorizonParams,
    /// When a run has arrived, collided or ended.
    pub episode: Episode,
    /// Which controller drives the robots.
    pub controller: Controller,
    /// The baseline ORCA.
    pub orca: Orca,
    /// What disturbs measuring and the exchange, on purpose.
    pub disturbance: Disturbance,
}

/// Which controller drives the robots.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Controller {
    /// Its kind.
    pub kind: ControllerKind,
}

/// The controllers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ControllerKind {
    /// Variable-horizon MPC with VODCA.
    Vodca,
    /// Optimal reciprocal collision avoidance (van den Berg et al. 2011), a baseline.
    Orca,
}

/// ORCA (van den Berg, Guy, Lin and Manocha 2011); speeds are bounded by norm there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Orca {
    /// tau, s: how far ahead velocities stay free of collision.
    pub time_horizon: f64,
    /// Robots farther away than this are not seen, m.
    pub neighbour_distance: f64,
    /// At most so many robots are seen, the nearest first.
    pub max_neighbours: usize,
    /// Angle to the right of the set-point at which a robot aims, rad (ORCA-RH: 0.35).
    pub aim: f64,
    /// Nearer to the set-point than this the aim fades linearly to none, m.
    pub fade: f64,
    /// Largest random push of the wanted velocity per tick, m/s; breaks exact symmetry, 0 is off.
    pub push: f64,
}

/// What disturbs measuring and the exchange, on purpose. All draws are seeded. What it does to
/// the guarantee: ARCHITECTURE, "What weakens the assumptions".
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disturbance {
    /// Largest error of a measured position, m; drawn uniformly from a disc.
    pub noise: f64,
    /// Plans arrive this many ticks late; positions do not.
    pub plan_delay: usize,
    /// Share of plans that get lost; positions do not.
    pub plan_loss: f64,
    /// Share of messages that get lost whole, with plan and position.
    pub position_loss: f64,
}

/// The robot and its surroundings (paper, Table I).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// h, s.
    pub sample_time: f64,
    /// Bound on the input per axis (ub = -lb), m/s.
    pub max_speed: f64,
    /// r_min, m: twice the radius of a disc.
    pub min_separation: f64,
}

/// The quadratic cost (paper, section III-B).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mpc {
    /// Q = q I, 1/m^2.
    pub state_weight: f64,
    /// W = w I, s^2/m^2.
    pub input_weight: f64,
    /// What the plan is drawn to.
    pub reference: Reference,
}

/// What the plan is drawn to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// The set-point at every step, zero input (the paper's X^d).
    SetPoint,
    /// A straight line to the set-point with the largest axis at full speed (ARCHITECTURE, rule 1).
    Straight,
    /// The shortest way to the set-point round obstacles and robots that stand, in turn where set-points close each
    /// other in, with the largest axis at full speed.
    Route,
}

/// VODCA: detection and rows (paper, section III-C).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vodca {
    /// Which conflicts become rows.
    pub rows: RowChoice,
    /// Where a row acts.
    pub row_step: RowStep,
    /// What happens to a conflict beyond the new horizon.
    pub beyond_horizon: BeyondHorizon,
    /// First prediction step that is compared: 1 (the present) or 2.
    pub first_compared_step: usize,
    /// Which of several hazards at the same smallest step `rows = "first"` takes.
    pub tie: Tie,
    /// `rows = "nearby"` takes every hazard within this many min_separation at the conflict step.
    pub nearby_factor: f64,
    /// Angle by which a row's normal is turned left, rad; both robots then pass on the right.
    pub turn: f64,
    /// The same after a long conflict, rad.
    pub turn_lasting: f64,
    /// Share of the newest tick in the memory of how long the conflict has lasted.
    pub lasting_memory: f64,
    /// How lasting a conflict (0..=1) costs a robot its patience; 1: nothing does.
    pub patience: f64,
    /// How lasting a conflict (0..=1) makes a robot without patience back off.
    pub back_off: f64,
    /// Hard rows, or soft rows with an exact penalty.
    pub softness: Softness,
    /// What a robot does when its hard rows are infeasible.
    pub infeasible: Infeasible,
    /// rho1, price of the first metre of violation, 1/m.
    pub slack_linear: f64,
    /// rho2, quadratic price of violation, 1/m^2.
    pub slack_quadratic: f64,
}

/// Which conflicts become rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RowChoice {
    /// One row: the smallest conflict step.
    First,
    /// One row per conflicting neighbour and obstacle, each at its own step.
    Each,
    /// At the smallest conflict step, every hazard nearby (Luis and Schoellig 2019).
    Nearby,
}

/// Where a row acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RowStep {
    /// At k_c.
    Conflict,
    /// At k_c - 1, never below 1.
    BeforeConflict,
}

/// What happens to a conflict beyond the new horizon N_i^k.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BeyondHorizon {
    /// The row acts on the last step.
    Clamp,
    /// No row.
    Skip,
    /// Steps beyond the new horizon are not compared.
    Limit,
}

/// Which of several hazards at the same smallest step is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tie {
    /// The nearest, then the lowest index (robots before obstacles).
    Nearest,
    /// The lowest index (robots before obstacles).
    Index,
}

/// Hard or soft rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Softness {
    /// The rows hold or the QP is infeasible.
    Hard,
    /// The rows have slack from the start.
    Soft,
}

/// What a robot does when its hard rows are infeasible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Infeasible {
    /// Solve again with slack.
    Relax,
    /// Stand still.
    Hold,
}

/// Aim to the right while in conflict (ARCHITECTURE, rule 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Aim {
    /// phi, rad: the turn of the set-point that a conflict asks for.
    pub angle: f64,
    /// lambda: share of the newest tick in the memory of the turn.
    pub memory: f64,
    /// Distance to the set-point up to which nothing is turned, m.
    pub fade_start: f64,
    /// Distance to the set-point from which the turn is full, m.
    pub fade_end: f64,
    /// Steps over which straight walks are compared: whoever will be met counts as conflict; 0 is off.
    pub look_ahead: usize,
    /// The largest turn that traffic ahead asks for, rad.
    pub most: f64,
    /// What a turn costs, meetings per rad: it is taken where it spares more meetings than that.
    pub price: f64,
}

impl Aim {
    /// Share of a turn that is left at `distance` (m) from the set-point, 0..=1.
    pub fn fade(&self, distance: f64) -> f64 {
        ((distance - self.fade_start) / (self.fade_end - self.fade_start)).clamp(0.0, 1.0)
    }
}

/// Give way to robots that still travel (ARCHITECTURE, rule 3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GiveWay {
    /// r_y, m: a robot this near its set-point gives way; 0 switches the rule off.
    pub radius: f64,
    /// c_y, m: clearance added to min_separation for the rows of this rule.
    pub clearance: f64,
}

/// Hard cell rows on the first step (ARCHITECTURE, rule 5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Whether the rule and the safety filter are on.
    pub enabled: bool,
    /// r_s, m: separation kept by the cells.
    pub separation: f64,
    /// kappa, m: move away demanded per tick where the distance is below the cells' separation.
    pub escape: f64,
    /// E, m: the cells keep `separation + 3 E` and demand `escape + E`, so that measuring errors of at
    /// most E per position leave `separation` (ARCHITECTURE, "What weakens the assumptions").
    pub noise_bound: f64,
}

/// Changes of the horizon after its source chose it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HorizonParams {
    /// Every horizon moves by a seeded draw from -jitter..=jitter (breaks limit cycles), those of a
    /// script excepted; 0 is off.
    pub jitter: u64,
}

/// When a run has arrived, collided or ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Episode {
    /// A robot has arrived when it is nearer to its set-point than this, m.
    pub arrival_tolerance: f64,
    /// Two discs collide when nearer than this share of min_separation (the paper's 0.5).
    pub collision_factor: f64,
}

impl Params {
    /// Checks every value against its range in [`table::ENTRIES`] and the few relations between values.
    pub fn validate(&self) -> Result<(), Refusal> {
        for (entry, value) in table::values(self) {
            entry.check(&value)?;
        }
        if self.aim.fade_end <= self.aim.fade_start {
            return Err(Refusal {
                key: "aim.fade_end",
                value: self.aim.fade_end.to_string(),
                allowed: format!("a number above aim.fade_start = {}", self.aim.fade_start),
                unit: "m",
            });
        }
        Ok(())
    }

    /// Settings that are allowed and probably not meant, one sentence each, for the log of a run.
    pub fn warnings(&self) -> Vec<String> {
        let (kept, wanted) = (self.cell.separation, self.model.min_separation);
        let mut warnings = Vec::new();
        if self.cell.enabled && kept < wanted {
            warnings.push(format!(
                "cell.separation = {kept} m is below model.min_separation = {wanted} m: only {kept} m are guaranteed; \
                 add --set cell.separation={wanted}"
            ));
        }
        if self.cell.enabled && self.disturbance.noise > self.cell.noise_bound {
            let noise = self.disturbance.noise;
            warnings.push(format!(
                "disturbance.noise = {noise} m is above cell.noise_bound = {} m: nothing is guaranteed; \
                 add --set cell.noise_bound={noise}",
                self.cell.noise_bound
            ));
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_profiles_are_valid() {
        for params in [Params::paper(), Params::safe()] {
            assert_eq!(params.validate(), Ok(()));
        }
    }

    #[test]
    fn a_value_out_of_range_is_named_with_its_range_and_unit() {
        let mut params = Params::safe();
        params.model.sample_time = -0.2;
        let message = params.validate().unwrap_err().to_string();
        assert_eq!(
            message,
            "parameter model.sample_time = -0.2 is not allowed; allowed: a number above 0, at most 10 (unit: s)"
        );
        params.model.sample_time = f64::NAN;
        assert!(params.validate().unwrap_err().to_string().contains("= NaN is not allowed"));
    }

    #[test]
    fn the_fade_must_end_after_it_starts() {
        let mut params = Params::safe();
        params.aim.fade_end = params.aim.fade_start;
        assert!(params.validate().unwrap_err().to_string().contains("above aim.fade_start = 2.2"));
    }

    #[test]
    fn settings_that_weaken_the_guarantee_are_warned_of() {
        let mut params = Params::safe();
        assert_eq!(params.warnings(), [""; 0]);
        params.model.min_separation = 2.0;
        params.disturbance.noise = 0.02;
        let warnings = params.warnings();
        assert!(warnings[0].ends_with("add --set cell.separation=2"), "{warnings:?}");
        assert!(warnings[1].ends_with("add --set cell.noise_bound=0.02"), "{warnings:?}");
        params.cell.enabled = false;
        assert!(params.warnings().is_empty());
    }
}

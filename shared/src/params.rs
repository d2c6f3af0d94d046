//! Every constant of the method, once: name, unit, range, equation, effect.
//!
//! A run uses one [`Params`]: a profile (`paper`, `safe`), overlaid by the scenario's `[params]`
//! table, overlaid by `--set KEY=VALUE`. The effective values go into the run folder.

use serde::{Deserialize, Serialize};

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
    /// Aim to the right while in conflict (safe.md, rule 4).
    pub aim: Aim,
    /// Give way to robots that still travel (safe.md, rule 3).
    pub give_way: GiveWay,
    /// Hard cell rows on the first step (safe.md, rule 5).
    pub cell: Cell,
    /// Changes of the horizon after its source chose it.
    pub horizon: HorizonParams,
    /// When a run has arrived, collided or ended.
    pub episode: Episode,
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
    /// A straight line to the set-point with the largest axis at full speed (safe.md, rule 1).
    Straight,
}

/// VODCA: detection and rows (method.md, section 3).
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

/// Aim to the right while in conflict (safe.md, rule 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Aim {
    /// phi, rad: the largest turn of the set-point; 0 switches the rule off.
    pub angle: f64,
    /// lambda: share of the newest tick in the memory of being in conflict.
    pub memory: f64,
    /// Distance to the set-point up to which nothing is turned, m.
    pub fade_start: f64,
    /// Distance to the set-point from which the turn is full, m.
    pub fade_end: f64,
}

/// Give way to robots that still travel (safe.md, rule 3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GiveWay {
    /// r_y, m: a robot this near its set-point gives way; 0 switches the rule off.
    pub radius: f64,
    /// c_y, m: clearance added to min_separation for the rows of this rule.
    pub clearance: f64,
}

/// Hard cell rows on the first step (safe.md, rule 5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Whether the rule and the last check are on.
    pub enabled: bool,
    /// r_s, m: separation kept by the cells.
    pub separation: f64,
    /// Move away demanded per tick where the distance is below `separation`, m.
    pub escape: f64,
}

/// Changes of the horizon after its source chose it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HorizonParams {
    /// Every horizon moves by a seeded draw from -jitter..=jitter (breaks limit cycles); 0 is off.
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

/// The named parameter sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// The paper's method, read as method.md says.
    Paper,
    /// Full separation by construction, and everyone arrives (safe.md).
    Safe,
}

impl Params {
    /// The paper's method (method.md, section 3).
    pub fn paper() -> Self {
        Self {
            model: Model { sample_time: 0.2, max_speed: 1.5, min_separation: 1.5 },
            mpc: Mpc { state_weight: 5.0, input_weight: 10.0, reference: Reference::SetPoint },
            vodca: Vodca {
                rows: RowChoice::First,
                row_step: RowStep::Conflict,
                beyond_horizon: BeyondHorizon::Clamp,
                first_compared_step: 1,
                tie: Tie::Nearest,
                nearby_factor: 1.5,
                turn: 0.0,
                softness: Softness::Hard,
                infeasible: Infeasible::Relax,
                slack_linear: 1e5,
                slack_quadratic: 1e3,
            },
            aim: Aim { angle: 0.0, memory: 0.1, fade_start: 1.5, fade_end: 4.5 },
            give_way: GiveWay { radius: 0.0, clearance: 0.1 },
            cell: Cell { enabled: false, separation: 1.5, escape: 0.0 },
            horizon: HorizonParams { jitter: 0 },
            episode: Episode { arrival_tolerance: 0.1, collision_factor: 0.5 },
        }
    }

    /// The safe controller (safe.md, section 1).
    pub fn safe() -> Self {
        let mut params = Self::paper();
        params.mpc.reference = Reference::Straight;
        params.vodca.rows = RowChoice::Each;
        params.vodca.turn = 0.35;
        params.vodca.softness = Softness::Soft;
        params.aim.angle = 0.35;
        params.give_way.radius = 1.5;
        params.cell.enabled = true;
        params
    }

    /// The parameters of a profile.
    pub fn of(profile: Profile) -> Self {
        match profile {
            Profile::Paper => Self::paper(),
            Profile::Safe => Self::safe(),
        }
    }
}

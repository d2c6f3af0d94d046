//! What remains of a run: the figures of `summary.json` and of every table.

use crate::step::{Level, Status};
use serde::{Deserialize, Serialize};

/// The figures of one run. Numbers are finite; `None` (null in JSON) where there is nothing to state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunSummary {
    /// All robots within the arrival tolerance at the end, nobody collided, and nobody lost.
    pub success: bool,
    /// Ticks run.
    pub ticks: u64,
    /// `ticks` in seconds when all robots have arrived, otherwise `None`.
    pub completion_time: Option<f64>,
    /// Sum of all paths, m.
    pub path_cost: f64,
    /// Sum of all straight lines from start to set-point, m.
    pub straight_line: f64,
    /// `path_cost / straight_line`; `None` when everyone starts at the set-point.
    pub path_ratio: Option<f64>,
    /// Smallest separation between samples too, m, radii beyond min_separation / 2 taken off; `None` for
    /// one robot without obstacles.
    pub min_separation: Option<f64>,
    /// Ticks in which some separation was more than 1e-6 m below min_separation.
    pub ticks_below_min_separation: u64,
    /// Pairs (of robots, or robot and obstacle) that were below min_separation at any time.
    pub pairs_below_min_separation: u64,
    /// Pairs that collided: separation below collision_factor times min_separation.
    pub collisions: u64,
    /// Ticks in which some pair collided.
    pub ticks_collided: u64,
    /// Robots in a collided pair.
    pub robots_collided: u64,
    /// Collision rows summed over robots and ticks.
    pub activations: u64,
    /// Robots that could not arrive, because a lost one stands where they wanted to be.
    #[serde(default)]
    pub shut_off: u64,
    /// What came of set-points at run time, in a run with them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tasks: Option<TaskSummary>,
    /// (Robot, tick) pairs with at least one row.
    pub ticks_with_rows: u64,
    /// (Robot, tick) pairs whose hard rows were infeasible (relaxed or held).
    pub infeasible: u64,
    /// (Robot, tick) pairs by the rung of the solver ladder.
    pub solver_levels: SolverLevels,
    /// (Robot, tick) pairs by outcome.
    pub statuses: Statuses,
    /// (Robot, tick) pairs whose input the safety filter changed.
    #[serde(alias = "shielded")]
    pub filtered: u64,
    /// One entry per robot, by number.
    pub robots: Vec<RobotSummary>,
}

/// The figures of a run in which set-points change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskSummary {
    /// Whether robots were always given another one: nobody has to have arrived at the end.
    pub endless: bool,
    /// Set-points that were reached and left for the next one, and those at which somebody stands at the end.
    pub arrivals: u64,
    /// Those per minute of the run.
    pub per_minute: Option<f64>,
    /// How long a robot that had arrived stood on average before its next set-point was given, s; `None`: none was.
    pub mean_wait: Option<f64>,
    /// All paths over all arrivals, m.
    pub path_per_arrival: Option<f64>,
}

/// The figures of one robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotSummary {
    /// Its name in the scenario.
    pub name: String,
    /// Start of its final stay within the arrival tolerance, in ticks: at time `arrived_tick * h` it had
    /// arrived for good. `None`: not there at the end.
    pub arrived_tick: Option<u64>,
    /// Path, m.
    pub path_length: f64,
    /// Straight line from start to set-point, m.
    pub straight_line: f64,
    /// Smallest separation to anything, m; `None` when there is nothing else.
    pub min_separation: Option<f64>,
    /// Whether it was in a collided pair.
    pub collided: bool,
    /// Collision rows summed over ticks.
    pub activations: u64,
    /// Ticks with at least one row.
    pub ticks_with_rows: u64,
    /// Ticks without a new plan: the shifted previous one or a stop.
    pub fallback_steps: u64,
    /// Ticks whose hard rows were infeasible.
    pub infeasible: u64,
    /// Ticks whose input the safety filter changed.
    #[serde(alias = "shielded")]
    pub filtered: u64,
}

/// Counts by [`Level`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolverLevels {
    /// Closed form.
    pub closed_form: u64,
    /// Structured solver.
    pub structured: u64,
    /// Clarabel.
    pub clarabel: u64,
    /// No solver.
    pub fallback: u64,
    /// Not an MPC.
    pub baseline: u64,
}

impl SolverLevels {
    pub(super) fn count(&mut self, level: Level) {
        *match level {
            Level::ClosedForm => &mut self.closed_form,
            Level::Structured => &mut self.structured,
            Level::Clarabel => &mut self.clarabel,
            Level::Fallback => &mut self.fallback,
            Level::Baseline => &mut self.baseline,
        } += 1;
    }
}

/// Counts by [`Status`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Statuses {
    /// Solved as posed.
    pub solved: u64,
    /// Solved with slack.
    pub relaxed: u64,
    /// Stood still: infeasible.
    pub held: u64,
    /// Previous plan, shifted.
    pub shifted: u64,
    /// Stood still: no plan at all.
    pub stopped: u64,
    /// Stood still: nothing of the robot counted in time.
    #[serde(default)]
    pub late: u64,
    /// Stood still: its process has ended.
    #[serde(default)]
    pub lost: u64,
}

impl Statuses {
    pub(super) fn count(&mut self, status: Status) {
        *match status {
            Status::Solved => &mut self.solved,
            Status::Relaxed => &mut self.relaxed,
            Status::Held => &mut self.held,
            Status::Shifted => &mut self.shifted,
            Status::Stopped => &mut self.stopped,
            Status::Late => &mut self.late,
            Status::Lost => &mut self.lost,
        } += 1;
    }
}

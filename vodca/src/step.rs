//! What one robot did in one tick: the unit that agents report, the coordinator records and all
//! metrics are computed from. In-process teams and agent processes produce the same values.

use crate::horizon::Horizon;
use crate::prediction::Prediction;
use crate::{Input, Position};
use serde::{Deserialize, Serialize};

/// Which rung of the solver ladder gave the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum Level {
    /// The bounds-only optimum in closed form satisfies every row.
    ClosedForm = 0,
    /// Our structured solver.
    Structured = 1,
    /// Clarabel.
    Clarabel = 2,
    /// No solver gave a plan: the previous plan, shifted, or standing still.
    Fallback = 3,
    /// Not an MPC (ORCA).
    Baseline = 4,
}

/// How the plan came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum Status {
    /// The QP as posed was solved.
    Solved = 0,
    /// Its hard rows were infeasible; solved again with slack.
    Relaxed = 1,
    /// Its hard rows were infeasible; the robot stands still.
    Held = 2,
    /// No solver finished; the previous plan, shifted by one step, is used.
    Shifted = 3,
    /// No solver finished and there was no previous plan: the robot stands still.
    Stopped = 4,
}

/// What one robot did in one tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Position at the start of the tick, m: the true one, of a body in the world the measured one.
    pub position: Position,
    /// Where the robot measured itself at the start of the tick, m: what it planned from.
    pub measured: Position,
    /// Input applied during the tick, m/s.
    pub input: Input,
    /// Position at the end of the tick, m, like `position`; of a simulated body `position + h input`.
    pub next_position: Position,
    /// Where the robot measures itself at the start of the next tick, m: what it will plan from.
    pub next_measured: Position,
    /// N_i^k.
    pub horizon: Horizon,
    /// Collision rows of the QP (soft or hard VODCA rows; cell rows are not counted).
    pub rows: u32,
    /// Rung of the ladder that gave the plan.
    pub level: Level,
    /// How the plan came about.
    pub status: Status,
    /// Whether the last check changed the input (ARCHITECTURE, rule 6).
    pub shielded: bool,
    /// The plan published at this tick.
    pub plan: Prediction,
    /// Time before the QP's solvers (conflicts, rows, reference, cell), ns; 0 for a controller without a
    /// QP. Not part of what is compared.
    pub detect_ns: u64,
    /// Time in the QP's solvers, ns; 0 for a controller without a QP. Not part of what is compared.
    pub solve_ns: u64,
    /// Time of the whole step, from having all messages to having moved, ns. Not part of what is compared.
    pub step_ns: u64,
}

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
    /// The robot did not take part: nothing of it counted in time. It stands still.
    Late = 5,
    /// The robot did not take part: its process has ended. It stands still.
    Lost = 6,
}

impl Level {
    /// All of them, by number.
    pub const ALL: [Level; 5] =
        [Level::ClosedForm, Level::Structured, Level::Clarabel, Level::Fallback, Level::Baseline];

    /// Its word in every file; serde writes the same.
    pub const fn word(self) -> &'static str {
        match self {
            Level::ClosedForm => "closed_form",
            Level::Structured => "structured",
            Level::Clarabel => "clarabel",
            Level::Fallback => "fallback",
            Level::Baseline => "baseline",
        }
    }

    /// The level of this word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.word() == word)
    }

    /// Its number in messages.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The level of this number.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }
}

impl Status {
    /// All of them, by number.
    pub const ALL: [Status; 7] =
        [Status::Solved, Status::Relaxed, Status::Held, Status::Shifted, Status::Stopped, Status::Late, Status::Lost];

    /// Its word in every file; serde writes the same.
    pub const fn word(self) -> &'static str {
        match self {
            Status::Solved => "solved",
            Status::Relaxed => "relaxed",
            Status::Held => "held",
            Status::Shifted => "shifted",
            Status::Stopped => "stopped",
            Status::Late => "late",
            Status::Lost => "lost",
        }
    }

    /// Whether the robot took part in the tick at all.
    pub const fn took_part(self) -> bool {
        !matches!(self, Status::Late | Status::Lost)
    }

    /// The status of this word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|status| status.word() == word)
    }

    /// Its number in messages.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The status of this number.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }
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
    /// Whether the safety filter changed the input (ARCHITECTURE, rule 6).
    pub filtered: bool,
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

impl Step {
    /// What is recorded of a robot that did not take part in a tick: it stands at `at` (m), measured there at its
    /// start and end.
    pub fn absent(
        at: Position,
        measured: [Position; 2],
        horizon: Horizon,
        set_point: Position,
        status: Status,
    ) -> Self {
        Self {
            position: at,
            measured: measured[0],
            input: Input::zeros(),
            next_position: at,
            next_measured: measured[1],
            horizon,
            rows: 0,
            level: Level::Fallback,
            status,
            filtered: false,
            plan: Prediction::standing(at, set_point),
            detect_ns: 0,
            solve_ns: 0,
            step_ns: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_numbers_lead_back_and_serde_writes_the_same_words() {
        for level in Level::ALL {
            assert_eq!(
                (Level::from_word(level.word()), Level::from_number(level.number())),
                (Some(level), Some(level))
            );
            assert_eq!(serde_json::to_value(level).unwrap(), level.word());
        }
        for status in Status::ALL {
            assert_eq!(Status::from_word(status.word()), Some(status));
            assert_eq!(Status::from_number(status.number()), Some(status));
            assert_eq!(serde_json::to_value(status).unwrap(), status.word());
        }
        assert_eq!((Level::from_number(5), Status::from_number(255)), (None, None));
        assert_eq!((Level::from_word("Structured"), Status::from_word("")), (None, None));
    }
}

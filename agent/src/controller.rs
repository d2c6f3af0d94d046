//! What every controller is: one robot, one tick, pure (no clock, no I/O, nothing allocated).

use shared::horizon::Horizon;
use shared::prediction::Prediction;
use shared::step::{Level, Status};
use shared::{Input, Position};

/// What a robot knows when it plans tick `k`.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// k.
    pub tick: u64,
    /// N_i^k.
    pub horizon: Horizon,
    /// Own measured position, m.
    pub position: Position,
    /// Every robot's prediction of tick `k - 1`, by robot number; own entry included and ignored.
    /// `None`: nothing was ever heard of it (at tick 0: of anybody).
    pub predictions: &'a [Option<Prediction>],
}

/// What a robot decides in a tick.
#[derive(Clone, Debug)]
pub struct Decision {
    /// u_i[0], m/s, within bounds.
    pub input: Input,
    /// The plan to publish; `plan.state(0)` is the measured position.
    pub plan: Prediction,
    /// Collision rows of the QP.
    pub rows: u32,
    /// Rung of the ladder that gave the plan.
    pub level: Level,
    /// How the plan came about.
    pub status: Status,
    /// Whether the last check changed the input.
    pub shielded: bool,
}

/// One robot's controller.
pub trait Controller: Send {
    /// Decides tick `view.tick`. Called once per tick, ticks in order.
    fn tick(&mut self, view: &View<'_>) -> Decision;
}

//! What every controller is: one robot, one tick, pure (no I/O, nothing allocated). Time is measured
//! and reported, but nothing is ever decided by it.

use crate::horizon::Horizon;
use crate::layout::Layout;
use crate::mpc::cross_check::Comparison;
use crate::prediction::Prediction;
use crate::step::{Level, Status};
use crate::{Input, Position};
use std::sync::Arc;

/// What a robot knows of another one: the newest it heard, with the tick it belongs to.
#[derive(Clone, Debug)]
pub struct Neighbour {
    /// Newest plan and the tick `k - 1` it was computed at. `None`: no plan was ever heard.
    pub plan: Option<(u64, Prediction)>,
    /// Newest broadcast position and the tick at whose start the robot was there.
    /// `None`: never heard.
    pub present: Option<(u64, Position)>,
    /// Where it wants to go.
    pub set_point: Position,
    /// Where it looks on its way there ([`Prediction::toward`]).
    pub toward: Position,
    /// Its process has ended: it stands at `present` until it comes back, and is an obstacle of the layout
    /// ([`crate::layout::Layout::with_lost`]).
    pub lost: bool,
}

impl Neighbour {
    /// What everybody knows of everybody before the first tick: the start and the set-point.
    pub fn at_start(start: Position, set_point: Position) -> Self {
        Self { plan: None, present: Some((0, start)), set_point, toward: set_point, lost: false }
    }
}

/// What a robot knows when it plans tick `k`.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// k.
    pub tick: u64,
    /// N_i^k.
    pub horizon: Horizon,
    /// Own measured position, m.
    pub position: Position,
    /// All robots by number; the own entry is included and ignored. In an undisturbed run every plan
    /// is of tick `k - 1` (Jacobi exchange: nobody sees a plan of tick `k`).
    pub neighbours: &'a [Neighbour],
}

/// What a robot decides in a tick.
#[derive(Clone, Debug)]
pub struct Decision {
    /// `u_i[0]`, m/s, within bounds.
    pub input: Input,
    /// The plan to publish; `plan.state(0)` is the measured position.
    pub plan: Prediction,
    /// Collision rows of the QP (cell rows are not counted).
    pub rows: u32,
    /// Rung of the ladder that gave the plan.
    pub level: Level,
    /// How the plan came about.
    pub status: Status,
    /// Whether the safety filter changed the input.
    pub filtered: bool,
    /// Time before the QP's solvers, ns; 0 for a controller without a QP.
    pub detect_ns: u64,
    /// Time in the QP's solvers, ns; 0 for a controller without a QP.
    pub solve_ns: u64,
}

/// One robot's controller.
pub trait Controller: Send {
    /// Decides tick `view.tick`. Called once per tick, ticks in order.
    fn tick(&mut self, view: &View<'_>) -> Decision;

    /// Forgets everything: the next tick comes after ticks in which the robot did not take part.
    fn restart(&mut self) {}

    /// From the next tick on `layout` holds: bodies of lost robots have become obstacles, or are gone.
    fn lay_out(&mut self, _layout: &Arc<Layout>) {}

    /// What solving every QP twice has found so far; `None`: that was not asked for, or there is no QP.
    fn comparison(&self) -> Option<Comparison> {
        None
    }
}

//! The collision rows of a recorded tick, found again from the recorded plans with the controller's own code.

use agent::controller::{Neighbour, View};
use agent::layout::Layout;
use agent::mpc::problem::Row;
use agent::right_of_way::regard_others;
use agent::standing::Standing;
use agent::vodca::memory::ConflictMemory;
use agent::vodca::rows::collision_rows;
use agent::vodca_controller::hazards;
use shared::params::{ControllerKind, Params};
use shared::step::Step;

/// The rows of robot `robot` in tick `tick`, from the plans of the tick before. Empty when they cannot be
/// found again in the number that was recorded (another controller, disturbed exchange). `memory` is
/// the robot's before that tick.
pub(super) fn rows(
    params: &Params,
    layout: &Layout,
    robot: usize,
    memory: &ConflictMemory,
    tick: u64,
    before: &[Step],
    now: &[Step],
) -> Vec<Row> {
    let mut rows = Vec::new();
    if now[robot].rows == 0 || params.controller.kind != ControllerKind::Vodca {
        return rows;
    }
    let heard = |(step, last): (&Step, &Step)| Neighbour {
        plan: Some((tick - 1, last.plan.clone())),
        present: Some((tick, step.position)),
        set_point: last.plan.set_point,
        toward: last.plan.toward,
    };
    let neighbours: Vec<Neighbour> = now.iter().zip(before).map(heard).collect();
    let view = View { tick, horizon: now[robot].horizon, position: now[robot].position, neighbours: &neighbours };
    let (mut standing, mut regards) = (Standing::with_capacity(0), Vec::new());
    regard_others(params, layout, robot, memory, &view, &mut standing, &mut regards);
    let hazards = hazards(params, layout, robot, &view, &regards);
    let turn = memory.turn(&params.vodca);
    let min_separation = params.model.min_separation;
    collision_rows(&params.vodca, min_separation, turn, &before[robot].plan, view.horizon, hazards, &mut rows);
    if rows.len() != now[robot].rows as usize {
        rows.clear();
    }
    rows
}

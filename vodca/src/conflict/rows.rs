//! From conflicts to collision rows, with every switch of the method.

use super::detection::{Conflict, Hazard, first_conflict};
use crate::geometry::{NO_DIRECTION, turned};
use crate::horizon::Horizon;
use crate::mpc::problem::Row;
use crate::params::{BeyondHorizon, RowChoice, RowStep, Softness, Tie, Vodca};
use crate::prediction::Prediction;

/// Appends the collision rows of one robot and tick to `rows`; returns how many.
///
/// `plan` is the robot's own prediction of tick k - 1 and `horizon` its N_i^k. `hazards` come robots
/// first (by number), then obstacles: ties go to the lower index. `turn` turns every normal left, rad.
pub fn collision_rows<'a>(
    vodca: &Vodca,
    min_separation: f64,
    turn: f64,
    plan: &Prediction,
    horizon: Horizon,
    hazards: impl Iterator<Item = Hazard<'a>> + Clone,
    rows: &mut Vec<Row>,
) -> usize {
    let before = rows.len();
    let window = match vodca.beyond_horizon {
        BeyondHorizon::Limit => horizon.steps(),
        BeyondHorizon::Clamp | BeyondHorizon::Skip => plan.horizon().steps(),
    };
    let conflict_with = |hazard: &Hazard<'_>| first_conflict(plan, hazard, vodca.first_compared_step, window);
    let mut push = |conflict: Conflict| rows.extend(row(vodca, turn, &conflict, horizon));
    match vodca.rows {
        RowChoice::Each => hazards.filter_map(|hazard| conflict_with(&hazard)).for_each(&mut push),
        RowChoice::First => {
            if let Some(first) = earliest(vodca.tie, hazards.filter_map(|hazard| conflict_with(&hazard))) {
                push(first);
            }
        }
        RowChoice::Nearby => {
            let conflicts = hazards.clone().filter_map(|hazard| conflict_with(&hazard));
            if let Some(first) = earliest(vodca.tie, conflicts) {
                let reach = vodca.nearby_factor * min_separation;
                hazards.filter_map(|hazard| nearby(plan, &hazard, first.step, reach)).for_each(&mut push);
            }
        }
    }
    rows.len() - before
}

/// The conflict with the smallest step; ties as `tie` says.
fn earliest(tie: Tie, conflicts: impl Iterator<Item = Conflict>) -> Option<Conflict> {
    conflicts.reduce(|best, next| {
        let nearer = tie == Tie::Nearest && next.step == best.step && next.distance < best.distance;
        if next.step < best.step || nearer { next } else { best }
    })
}

/// A hazard within `reach` at `step`, conflicting or not (Luis and Schoellig 2019).
fn nearby(plan: &Prediction, hazard: &Hazard<'_>, step: usize, reach: f64) -> Option<Conflict> {
    let (own, other) = (plan.state(step), hazard.at(step)?);
    let distance = (own - other).norm();
    (distance < reach).then_some(Conflict { step, distance, own, hazard: other, separation: hazard.separation })
}

/// The row of one conflict: b' x[p] >= c with b turned left by `turn`, normalised. With c = r |b| + b' o
/// the half plane touches the circle around the hazard; without turn that is the paper's
/// c = r d - d^2 + b' x^_i[k_c|k-1].
fn row(vodca: &Vodca, turn: f64, conflict: &Conflict, horizon: Horizon) -> Option<Row> {
    if conflict.distance < NO_DIRECTION {
        return None;
    }
    let last = horizon.steps();
    let wanted = match vodca.row_step {
        RowStep::Conflict => conflict.step,
        RowStep::BeforeConflict => (conflict.step - 1).max(1),
    };
    let step = match vodca.beyond_horizon {
        BeyondHorizon::Skip if wanted > last => return None,
        _ => wanted.min(last),
    };
    let normal = turned((conflict.own - conflict.hazard) / conflict.distance, turn);
    // Fused on one axis only: exact mirror images (two_setpoint) would stay mirror images for ever in
    // arithmetic that treats both axes alike; the last bit breaks the tie, as rounding did in the paper.
    let along = normal.x.mul_add(conflict.hazard.x, normal.y * conflict.hazard.y);
    let offset = conflict.separation + along;
    Some(Row { step, normal, offset, hard: vodca.softness == Softness::Hard })
}

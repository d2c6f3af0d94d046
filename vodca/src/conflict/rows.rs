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
    hazard.meeting(plan, step).filter(|meeting| {
        // A shape's nearest point is as near as the centre of a disc that lies behind it.
        let behind = if meeting.has_sides { 0.0 } else { hazard.separation - meeting.separation };
        meeting.distance + behind < reach
    })
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
    let turn = if conflict.has_sides { turn } else { 0.0 };
    let normal = turned((conflict.own - conflict.hazard) / conflict.distance, turn);
    // Fused on one axis only: exact mirror images (two_setpoint) would stay mirror images for ever in
    // arithmetic that treats both axes alike; the last bit breaks the tie, as rounding did in the paper.
    let along = normal.x.mul_add(conflict.hazard.x, normal.y * conflict.hazard.y);
    let offset = conflict.separation + along;
    Some(Row { step, normal, offset, hard: vodca.softness == Softness::Hard })
}

#[cfg(test)]
mod tests {
    use super::super::PredictedMotion;
    use super::*;
    use crate::Position;
    use crate::geometry::Disc;
    use crate::obstacles::{Obstacles, Solid};
    use crate::params::Params;
    use world::shape::{Obstacle, Shape};

    /// The rows of a robot that plans along the x axis, with normals turned by 0.3 rad.
    fn rows(obstacles: &Obstacles, mut states: Vec<(f64, f64)>) -> Vec<Row> {
        let vodca = &Params::safe().vodca;
        let states: Vec<Position> = states.drain(..).map(|(x, y)| Position::new(x, y)).collect();
        let plan = Prediction::from_states(&states, states[0]);
        let hazards = obstacles.near(states[0], 99.0).map(|solid| match solid {
            Solid::Disc(disc) => Hazard { course: PredictedMotion::Still(disc.centre), separation: 1.5 + disc.extra },
            Solid::Piece(..) => Hazard { course: PredictedMotion::Shape(solid), separation: 1.5 },
        });
        let mut rows = Vec::new();
        collision_rows(vodca, 1.5, 0.3, &plan, plan.horizon(), hazards, &mut rows);
        rows
    }

    fn wall() -> Obstacles {
        let points = vec![Position::new(-9.0, 1.0), Position::new(9.0, 1.0)];
        Obstacles::new(&[], &[Obstacle::new("wall", Shape::Wall { points, thickness: 0.2 }).unwrap()], 1.5)
    }

    #[test]
    fn a_wall_asks_for_the_half_plane_along_it_and_is_not_turned() {
        let rows = rows(&wall(), vec![(0.0, 0.0), (0.3, 0.1), (0.6, 0.3), (0.9, 0.4)]);
        assert_eq!(rows.len(), 1);
        assert!((rows[0].normal - Position::new(0.0, -1.0)).norm() < 1e-12);
        // Surface at y = 0.9, a radius of 0.75 off.
        assert!((rows[0].offset - -0.15).abs() < 1e-12, "{}", rows[0].offset);
    }

    #[test]
    fn a_plan_into_a_wall_is_led_out_the_way_that_is_nearest() {
        let rows = rows(&wall(), vec![(0.0, 0.95), (0.0, 0.95)]);
        assert!((rows[0].normal - Position::new(0.0, -1.0)).norm() < 1e-9);
        assert!((rows[0].offset - -0.15).abs() < 1e-9, "{}", rows[0].offset);
    }

    #[test]
    fn the_row_of_a_disc_touches_its_circle_turned_as_ever() {
        let disc = Obstacles::new(&[Disc { centre: Position::new(2.0, 0.0), extra: 0.0 }], &[], 1.5);
        let rows = rows(&disc, vec![(0.0, 0.0), (0.3, 0.0), (0.6, 0.0)]);
        let normal = turned(Position::new(-1.0, 0.0), 0.3);
        assert_eq!((rows.len(), rows[0].normal), (1, normal));
        assert!((rows[0].offset - (1.5 + 2.0 * normal.x)).abs() < 1e-12);
    }
}

//! The safety filter after ANY solver outcome (ARCHITECTURE, rule 6): a move that would leave the cell is
//! replaced by the nearest one that does not.

use super::cell::{Cell, CellRow};
use crate::Position;

/// A row counts as kept up to this violation, m: far above rounding (1e-15 m), far below what anyone
/// could measure. At most `ticks * TOLERANCE` of separation can be lost to it in a run.
pub const TOLERANCE: f64 = 1e-9;

/// The move nearest to `wanted` that stays in the cell, and whether it differs from `wanted`.
///
/// Standing still satisfies every row with `demand <= 0`, so an answer always exists; rows that demand
/// an escape (`demand > 0`) are kept where that is possible and never made worse. A move that is not
/// finite becomes standing still.
pub fn nearest_safe(wanted: Position, cell: &Cell) -> (Position, bool) {
    if !(wanted.x.is_finite() && wanted.y.is_finite()) {
        return (Position::zeros(), true);
    }
    if is_safe(wanted, cell, TOLERANCE) {
        return (wanted, false);
    }
    let shortened = if wanted.norm() > cell.reach { wanted * (cell.reach / wanted.norm()) } else { wanted };
    let mut best = (Position::zeros(), f64::INFINITY);
    let mut consider = |candidate: Position| {
        let away = (candidate - wanted).norm_squared();
        if away < best.1 && is_safe(candidate, cell, TOLERANCE) {
            best = (candidate, away);
        }
    };
    consider(shortened);
    // The nearest point of a polygon lies on an edge or in a corner.
    let edges = || {
        let side = |x: f64, y: f64| CellRow { normal: Position::new(x, y), demand: -cell.stride };
        let sides = [side(1.0, 0.0), side(-1.0, 0.0), side(0.0, 1.0), side(0.0, -1.0)];
        cell.rows.iter().copied().chain(sides)
    };
    for (i, edge) in edges().enumerate() {
        let foot = |from: Position| from + edge.normal * (edge.demand - edge.normal.dot(&from));
        consider(foot(wanted));
        consider(foot(shortened));
        for other in edges().skip(i + 1) {
            consider_corner(&edge, &other, &mut consider);
        }
    }
    if best.1.is_finite() {
        return (best.0, true);
    }
    (Position::zeros(), true)
}

fn consider_corner(a: &CellRow, b: &CellRow, consider: &mut impl FnMut(Position)) {
    let determinant = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
    if determinant.abs() > 1e-12 {
        let x = (a.demand * b.normal.y - b.demand * a.normal.y) / determinant;
        let y = (b.demand * a.normal.x - a.demand * b.normal.x) / determinant;
        consider(Position::new(x, y));
    }
}

/// Whether a move keeps every row of the cell, its reach and the bounds, up to `tolerance` metres.
pub fn is_safe(step: Position, cell: &Cell, tolerance: f64) -> bool {
    step.x.abs() <= cell.stride + tolerance
        && step.y.abs() <= cell.stride + tolerance
        && step.norm() <= cell.reach + tolerance
        && cell.rows.iter().all(|row| row.normal.dot(&step) >= row.demand - tolerance)
}

/// What every answer of [`nearest_safe`] is: safe, or standing still, because rows that demand an escape
/// (`demand > 0`, starts too close) can contradict each other and then no move keeps them all.
pub fn is_answer(step: Position, cell: &Cell, tolerance: f64) -> bool {
    step == Position::zeros() || is_safe(step, cell, tolerance)
}

#[cfg(test)]
mod tests {
    use super::super::cell::{Last, Present};
    use super::*;
    use crate::separation::separation;
    use proptest::prelude::*;

    const STRIDE: f64 = 0.3;

    fn cell(demands: &[(f64, f64)]) -> Cell {
        let mut cell = Cell::with_capacity(8, STRIDE);
        let row = |&(angle, demand): &(f64, f64)| CellRow { normal: Position::new(angle.cos(), angle.sin()), demand };
        cell.rows.extend(demands.iter().map(row));
        cell
    }

    #[test]
    fn a_safe_move_stays_as_it_is() {
        let wanted = Position::new(0.1, 0.2);
        assert_eq!(nearest_safe(wanted, &cell(&[(0.0, -0.1)])), (wanted, false));
    }

    #[test]
    fn a_move_over_an_edge_slides_along_it() {
        let (step, changed) = nearest_safe(Position::new(-0.2, 0.2), &cell(&[(0.0, -0.1)]));
        assert!(changed && (step - Position::new(-0.1, 0.2)).norm() < 1e-12);
    }

    #[test]
    fn a_move_into_a_corner_ends_there() {
        let (step, _) =
            nearest_safe(Position::new(-0.3, -0.3), &cell(&[(0.0, -0.1), (std::f64::consts::FRAC_PI_2, 0.0)]));
        assert!((step - Position::new(-0.1, 0.0)).norm() < 1e-12, "{step}");
    }

    #[test]
    fn not_a_number_stands_still() {
        assert_eq!(nearest_safe(Position::new(f64::NAN, 0.0), &cell(&[])), (Position::zeros(), true));
    }

    #[test]
    fn a_lost_neighbour_limits_the_length_of_the_move() {
        let mut cell = cell(&[]);
        let last = Last { position: Position::new(2.5, 0.0), age: 1, stride: STRIDE };
        cell.stay_near(Position::zeros(), &last, 1.5);
        let room = (2.5 - std::f64::consts::SQRT_2 * 0.3 - 1.5) / 2.0;
        assert!((cell.reach - room).abs() < 1e-15);
        let (step, _) = nearest_safe(Position::new(0.3, 0.3), &cell);
        assert!(step.norm() <= room + TOLERANCE && step.norm() > 0.9 * room);
    }

    #[test]
    fn escapes_that_contradict_each_other_stand_still() {
        let cell = cell(&[(0.0, 0.02), (std::f64::consts::PI, 0.02)]);
        assert_eq!(nearest_safe(Position::new(0.2, 0.1), &cell), (Position::zeros(), true));
        assert!(!is_safe(Position::zeros(), &cell, 2.0 * TOLERANCE));
        assert!(is_answer(Position::zeros(), &cell, 2.0 * TOLERANCE));
        assert!(!is_answer(Position::new(0.2, 0.1), &cell, 2.0 * TOLERANCE));
    }

    proptest! {
        #[test]
        fn demands_to_escape_are_kept_or_the_robot_stands_still(
            rows in prop::collection::vec((0.0f64..6.3, -0.4f64..0.2), 0..6),
            x in -0.5f64..0.5, y in -0.5f64..0.5,
        ) {
            let cell = cell(&rows);
            let (step, _) = nearest_safe(Position::new(x, y), &cell);
            prop_assert!(is_answer(step, &cell, 2.0 * TOLERANCE));
            let possible = (0..=3600).any(|i| {
                let at = |cell: i32| -0.3 + 0.01 * f64::from(cell);
                is_safe(Position::new(at(i % 61), at(i / 61 % 61)), &cell, 0.0)
            });
            prop_assert!(!possible || is_safe(step, &cell, 2.0 * TOLERANCE));
        }

        #[test]
        fn the_answer_is_safe_and_nearest(
            rows in prop::collection::vec((0.0f64..6.3, -0.4f64..0.0), 0..8),
            x in -0.5f64..0.5, y in -0.5f64..0.5,
        ) {
            let cell = cell(&rows);
            let wanted = Position::new(x, y);
            let (step, _) = nearest_safe(wanted, &cell);
            prop_assert!(is_safe(step, &cell, 2.0 * TOLERANCE));
            for i in 0..=60 { for j in 0..=60 {
                let other = Position::new(-0.3 + 0.01 * i as f64, -0.3 + 0.01 * j as f64);
                if is_safe(other, &cell, 0.0) {
                    prop_assert!((step - wanted).norm() <= (other - wanted).norm() + 1e-9);
                }
            }}
        }

        /// The guarantee itself: two robots and an obstacle, any wanted moves (any solver outcome).
        #[test]
        fn whatever_is_wanted_the_separation_is_kept(
            angle in 0.0f64..6.3, distance in 1.5f64..2.6, obstacle_angle in 0.0f64..6.3, room in 1.5f64..2.2,
            wants in prop::array::uniform4(-0.5f64..0.5),
        ) {
            let at = |angle: f64, d: f64| Position::new(angle.cos() * d, angle.sin() * d);
            let (own, other, obstacle) = (Position::zeros(), at(angle, distance), at(obstacle_angle, room));
            let mut cells = [cell(&[]), cell(&[])];
            cells[0].keep_away(own, &Present { position: other, separation: 1.5, moves: Some(STRIDE) }, 0.0, true);
            cells[1].keep_away(other, &Present { position: own, separation: 1.5, moves: Some(STRIDE) }, 0.0, false);
            cells[0].keep_away(own, &Present { position: obstacle, separation: 1.5, moves: None }, 0.0, true);
            for cell in &cells { prop_assert!(is_safe(Position::zeros(), cell, 0.0)); }
            let own_move = nearest_safe(Position::new(wants[0], wants[1]), &cells[0]).0;
            let other_move = nearest_safe(Position::new(wants[2], wants[3]), &cells[1]).0;
            for moved in [own_move, Position::zeros()] {
                for met in [other_move, Position::zeros()] {
                    prop_assert!(separation((own, own + moved), (other, other + met)) >= 1.5 - 2.0 * TOLERANCE - 1e-12);
                }
                prop_assert!(separation((own, own + moved), (obstacle, obstacle)) >= 1.5 - TOLERANCE - 1e-12);
            }
        }
    }
}

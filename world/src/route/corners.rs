//! Corners of the polygons round inflated shapes.

use super::ARC;
use crate::Position;
use crate::shape::{Obstacles, right_of};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// A turn of less than this is none, rad.
const STRAIGHT: f64 = 1e-9;

/// Where a way may bend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// m.
    pub at: Position,
    /// The vertex of the obstacle's ring that it goes round, m.
    pub(super) pivot: Position,
    /// The direction of the polygon's side that ends here, with the solid on its left.
    pub(super) before: Position,
    /// The direction of the side that begins here.
    pub(super) after: Position,
}

impl Corner {
    /// Whether a way that comes by `way` passes the corner's inflated shape on one side: else it runs into it,
    /// before the corner or behind. Where the way begins may be `tolerance` (m) on the wrong side of a side.
    pub(super) fn is_tangent(&self, way: Position, tolerance: f64) -> bool {
        let (after, before) = (way.perp(&self.after), -way.perp(&self.before));
        (after >= -tolerance && before >= -tolerance) || (after <= tolerance && before <= tolerance)
    }
}

/// The corners of one vertex: a run of a list of corners.
#[derive(Clone, Debug)]
pub(super) struct Arc {
    pub(super) corners: Range<usize>,
    pivot: Position,
    /// From the pivot to the farthest corner, m.
    out: f64,
}

/// Puts corners that follow each other round one vertex together.
pub(super) fn arcs(corners: &[Corner]) -> Vec<Arc> {
    let mut arcs: Vec<Arc> = Vec::new();
    for (i, corner) in corners.iter().enumerate() {
        let out = (corner.at - corner.pivot).norm();
        match arcs.last_mut().filter(|arc| arc.pivot == corner.pivot) {
            Some(arc) => (arc.corners.end, arc.out) = (i + 1, arc.out.max(out)),
            None => arcs.push(Arc { corners: i..i + 1, pivot: corner.pivot, out }),
        }
    }
    arcs
}

impl Arc {
    /// Whether some way between the two arcs could be tangent at a corner of one of them: all such ways are
    /// within an angle s of the line between the pivots, sin s = (out + out) / distance, and a corner is
    /// tangent to ways at most half of [`ARC`] from the right angle to its own direction from the pivot.
    pub(super) fn may_touch<'a>(&self, other: &Self) -> impl Fn(&'a Corner) -> bool + use<'a> {
        let between = other.pivot - self.pivot;
        let distance = between.norm();
        let spread = (self.out + other.out) / distance;
        let angle = if spread < 1.0 { spread.asin() + ARC / 2.0 + STRAIGHT } else { PI };
        let most = if angle < PI / 2.0 { distance * angle.sin() } else { f64::INFINITY };
        move |corner| {
            let out = corner.at - corner.pivot;
            out.dot(&between).abs() <= most * out.norm()
        }
    }
}

/// The corners round all obstacles for `clearance`, m, whether anything else is in their way or not.
pub(super) fn round_all(obstacles: &Obstacles, clearance: f64) -> Vec<Corner> {
    let mut corners = Vec::new();
    for obstacle in obstacles.list() {
        let radius = clearance + obstacle.radius();
        for ring in obstacle.rings() {
            let count = ring.len();
            if count == 1 {
                round_vertex(&mut corners, ring[0], Position::new(1.0, 0.0), TAU, radius);
                continue;
            }
            for (i, &vertex) in ring.iter().enumerate() {
                let into = (vertex - ring[(i + count - 1) % count]).normalize();
                let out = (ring[(i + 1) % count] - vertex).normalize();
                let turn = into.perp(&out).atan2(into.dot(&out));
                // The end of a wall turns right round; which way, rounding must not say.
                let turn = if turn.abs() > PI - STRAIGHT { PI } else { turn };
                if turn > STRAIGHT {
                    round_vertex(&mut corners, vertex, right_of(into), turn, radius);
                }
            }
        }
    }
    corners
}

/// The corners round discs of a centre and a radius (m), whether anything is in their way or not.
pub(super) fn round_discs(discs: &[(Position, f64)]) -> impl Iterator<Item = Corner> {
    discs.iter().flat_map(|(centre, radius)| {
        let mut corners = Vec::new();
        round_vertex(&mut corners, *centre, Position::new(1.0, 0.0), TAU, *radius);
        corners
    })
}

/// The corners round one vertex: between tangents to the circle of `radius` (m) whose normals turn, from
/// `normal`, by `turn` (rad) in equal steps of at most [`ARC`].
fn round_vertex(corners: &mut Vec<Corner>, pivot: Position, normal: Position, turn: f64, radius: f64) {
    let count = (turn / ARC - STRAIGHT).ceil().max(1.0);
    let step = turn / count;
    let out = radius / (step / 2.0).cos();
    for k in 0..count as usize {
        let from = turned(normal, step * k as f64);
        let at = pivot + turned(normal, step * (k as f64 + 0.5)) * out;
        corners.push(Corner { at, pivot, before: -right_of(from), after: -right_of(turned(from, step)) });
    }
}

/// `direction` turned counter-clockwise by `angle`, rad.
fn turned(direction: Position, angle: f64) -> Position {
    let (sin, cos) = angle.sin_cos();
    Position::new(cos * direction.x - sin * direction.y, sin * direction.x + cos * direction.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Obstacle, Shape};

    fn corners(shape: Shape, clearance: f64) -> Vec<Corner> {
        round_all(&Obstacles::new(vec![Obstacle::new("it", shape).unwrap()]), clearance)
    }

    #[test]
    fn a_disc_has_sixteen_a_right_angle_four_and_the_end_of_a_wall_eight() {
        let centre = Position::new(5.0, 1.0);
        let disc = corners(Shape::Disc { centre, radius: 0.5 }, 1.0);
        assert_eq!(disc.len(), 16);
        assert!(disc.iter().all(|c| ((c.at - centre).norm() - 1.5 / (ARC / 2.0).cos()).abs() < 1e-12));
        let l = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
        let l: Vec<Position> = l.iter().map(|(x, y)| Position::new(*x, *y)).collect();
        assert_eq!(corners(Shape::Polygon(l), 1.0).len(), 5 * 4, "the inner corner has none");
        let wall = Shape::Wall { points: vec![Position::zeros(), centre], thickness: 0.2 };
        assert_eq!(corners(wall, 1.0).len(), 16);
    }

    #[test]
    fn every_corner_lies_outside_and_its_sides_touch() {
        let points = vec![Position::zeros(), Position::new(4.0, 0.0), Position::new(4.0, 3.0)];
        let wall = Shape::Wall { points, thickness: 0.2 };
        let all = Obstacles::new(vec![Obstacle::new("wall", wall).unwrap()]);
        for corner in round_all(&all, 1.0) {
            let distance = all.nearest(corner.at, 9.0).unwrap().1.distance;
            assert!(distance > 1.0 - 1e-9 && distance < 1.1 / (ARC / 2.0).cos() - 0.1 + 1e-9, "{distance}");
            for (side, direction) in [(-0.1, corner.before), (0.1, corner.after)] {
                let touching = all.separation(corner.at, corner.at + direction * (side * 10.0), 9.0);
                assert!((touching - 1.0).abs() < 0.05, "{touching}");
            }
        }
    }

    #[test]
    fn a_way_past_a_corner_is_tangent_and_one_into_it_is_not() {
        // The solid lies below, so that it is on the left of who walks towards -x.
        let corner = Corner {
            at: Position::zeros(),
            pivot: Position::new(0.0, -1.0),
            before: Position::new(-1.0, 0.2),
            after: Position::new(-1.0, -0.2),
        };
        assert!(corner.is_tangent(Position::new(1.0, 0.0), 0.0) && corner.is_tangent(Position::new(-1.0, 0.1), 0.0));
        assert!(!corner.is_tangent(Position::new(0.0, 1.0), 0.5) && !corner.is_tangent(Position::new(1.0, -0.5), 0.0));
    }
}

//! Convex pieces: the one form in which everything that stands is measured.
//!
//! A piece is a convex core (a point, a straight line or a convex polygon) and everything within `radius` of
//! it: a disc is a point with its radius, a leg of a wall a line with half its thickness, a part of a polygon
//! a polygon with none. It is convex, because the Minkowski sum of convex sets is.
//!
//! # The half plane of the nearest point
//!
//! Let C be a convex piece, p a place outside it, q the point of C nearest to p, d = |p - q| and
//! n = (p - q) / d. A robot at p whose move m of one tick satisfies
//!
//! ```text
//! n . m >= r - d
//! ```
//!
//! is at least r from C at the end of the tick, and on the way at least min(d, r).
//!
//! *Proof.* q is the projection of p on a closed convex set, so n . (x - q) <= 0 for every x of C: else a point
//! of the line from q to x, which lies in C, would be nearer to p than q. At the share t of the tick, for every
//! x of C,
//!
//! ```text
//! |p + t m - x| >= n . (p + t m - x) = n . (p - q) + t n . m + n . (q - x) >= d + t (r - d)
//!                                                                          = (1 - t) d + t r,
//! ```
//!
//! which is r at t = 1 and never below min(d, r). Standing still, m = 0, is allowed whenever d >= r. ∎
//!
//! A non-convex obstacle is the union of its pieces: one half plane for each piece in reach keeps the robot
//! from all of it.

use super::Bounds;
use crate::Position;

/// Nearer than this to a core, a place has no direction from it, m.
const NO_DIRECTION: f64 = 1e-12;

/// A convex set: all that is within `radius` of a convex core.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    core: Box<[Position]>,
    radius: f64,
    bounds: Bounds,
    obstacle: usize,
}

/// Where a piece is nearest to a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The nearest point of the piece's border, m.
    pub point: Position,
    /// The unit vector from the border to the place: the normal of the half plane that the robot must keep to.
    pub normal: Position,
    /// How far the place is from the piece, m; negative inside it: how deep.
    pub distance: f64,
}

impl Piece {
    /// All that is within `radius` (m) of the convex hull of `core`: one point, two points, or the corners of a
    /// convex polygon counter-clockwise. `obstacle` is the number of the obstacle it belongs to.
    pub(crate) fn new(core: Vec<Position>, radius: f64, obstacle: usize) -> Self {
        let bounds = Bounds::of(&core).grown(radius);
        Self { core: core.into(), radius, bounds, obstacle }
    }

    /// The corners of the core, counter-clockwise, m: one for a disc, two for a leg of a wall.
    pub fn core(&self) -> &[Position] {
        &self.core
    }

    /// How far the piece reaches beyond its core, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The smallest upright rectangle round the piece. [`Bounds::distance`] is a cheap lower bound of
    /// [`Piece::distance`].
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The number of the obstacle it is a piece of.
    pub fn obstacle(&self) -> usize {
        self.obstacle
    }

    /// How far `place` is from the piece, m; negative inside: how deep.
    pub fn distance(&self, place: Position) -> f64 {
        self.nearest(place).distance
    }

    /// Whether `place` belongs to the piece, its border included.
    pub fn contains(&self, place: Position) -> bool {
        self.bounds.distance(place) <= 0.0 && self.distance(place) <= 0.0
    }

    /// The nearest point of the border, the direction from there and the signed distance.
    ///
    /// Within a polygon it is the nearest side's. On the very core of a disc or a wall all directions are
    /// alike: +x for the disc, the left of the line from its first end for the wall.
    pub fn nearest(&self, place: Position) -> Nearest {
        if let Some((normal, depth)) = self.nearest_side_from_inside(place) {
            let distance = -depth - self.radius;
            return Nearest { point: place - normal * distance, normal, distance };
        }
        let mut foot = self.core[0];
        let mut least = (place - foot).norm_squared();
        for (from, to) in self.sides() {
            let candidate = nearest_of_line(place, from, to);
            let squared = (place - candidate).norm_squared();
            if squared < least {
                (foot, least) = (candidate, squared);
            }
        }
        let apart = place - foot;
        let distance = apart.norm();
        let normal = if distance > NO_DIRECTION { apart / distance } else { self.any_normal() };
        Nearest { point: foot + normal * self.radius, normal, distance: distance - self.radius }
    }

    /// The least distance during the straight motion between two samples, m: exact. Where the motion meets the
    /// core itself it is minus the radius.
    pub fn separation(&self, from: Position, to: Position) -> f64 {
        if self.nearest_side_from_inside(from).is_some() || self.nearest_side_from_inside(to).is_some() {
            return -self.radius;
        }
        let mut squared = f64::INFINITY;
        for corner in &self.core {
            squared = squared.min((corner - nearest_of_line(*corner, from, to)).norm_squared());
        }
        for (a, b) in self.sides() {
            if cross_each_other(from, to, a, b) {
                return -self.radius;
            }
            squared = squared.min((from - nearest_of_line(from, a, b)).norm_squared());
            squared = squared.min((to - nearest_of_line(to, a, b)).norm_squared());
        }
        squared.sqrt() - self.radius
    }

    /// The least distance between two pieces, m; at most 0 where they overlap.
    pub fn distance_to(&self, other: &Self) -> f64 {
        let inside = other.nearest_side_from_inside(self.core[0]).is_some();
        let mut least = if inside { -other.radius } else { other.distance(self.core[0]) };
        for (from, to) in self.sides() {
            least = least.min(other.separation(from, to));
        }
        if self.nearest_side_from_inside(other.core[0]).is_some() {
            least = -other.radius;
        }
        least - self.radius
    }

    /// The sides of the core; a line has one, a point none.
    fn sides(&self) -> impl Iterator<Item = (Position, Position)> + '_ {
        let count = if self.core.len() < 3 { self.core.len() - 1 } else { self.core.len() };
        (0..count).map(|i| (self.core[i], self.core[(i + 1) % self.core.len()]))
    }

    /// Within a polygon: the outward normal of the nearest side and how deep the place lies behind it, m.
    fn nearest_side_from_inside(&self, place: Position) -> Option<(Position, f64)> {
        if self.core.len() < 3 {
            return None;
        }
        let mut nearest: Option<(Position, f64)> = None;
        for (from, to) in self.sides() {
            let along = to - from;
            let area = along.perp(&(place - from));
            if area < 0.0 {
                return None;
            }
            let depth = area / along.norm();
            if nearest.is_none_or(|(_, least)| depth < least) {
                nearest = Some((right_of(along).normalize(), depth));
            }
        }
        nearest
    }

    /// A direction for a place on a core without an inside.
    fn any_normal(&self) -> Position {
        match &*self.core {
            [from, to] if from != to => -right_of(to - from).normalize(),
            _ => Position::new(1.0, 0.0),
        }
    }
}

/// `along` turned by a right angle clockwise: out of a solid that lies to the left.
pub(crate) fn right_of(along: Position) -> Position {
    Position::new(along.y, -along.x)
}

/// The point nearest to `place` of the straight line between two points.
fn nearest_of_line(place: Position, from: Position, to: Position) -> Position {
    let along = to - from;
    let squared = along.norm_squared();
    if squared == 0.0 { from } else { from + along * ((place - from).dot(&along) / squared).clamp(0.0, 1.0) }
}

/// Whether two straight lines cross within both. Where it is a matter of rounding, an end of one is next to
/// the other, and their distance says the same.
fn cross_each_other(a: Position, b: Position, c: Position, d: Position) -> bool {
    let apart = |from: Position, to: Position, p: Position, q: Position| {
        ((to - from).perp(&(p - from)) > 0.0) != ((to - from).perp(&(q - from)) > 0.0)
    };
    apart(a, b, c, d) && apart(c, d, a, b)
}

#[cfg(test)]
mod tests;

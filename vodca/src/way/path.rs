//! A way as a chain of straight legs.

use crate::Position;
use crate::geometry::turned;

/// Nearer corners than this have been reached, m.
pub(super) const REACHED: f64 = 1e-6;

/// Bends of a way that a plan can reach.
const BENDS: usize = 6;

/// A way as a chain of straight legs.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    points: [Position; BENDS],
    count: usize,
    /// Its whole length, m.
    pub length: f64,
}

impl Path {
    /// A way without bends.
    pub fn straight(from: Position, to: Position) -> Self {
        Self { points: [to; BENDS], count: 1, length: (to - from).norm() }
    }

    /// The same as if it were `length` (m) long.
    pub(super) fn of_length(self, length: f64) -> Self {
        Self { length, ..self }
    }

    /// The ends of its legs, m. A way with more bends than are kept ends at one.
    pub fn points(&self) -> &[Position] {
        &self.points[..self.count]
    }

    /// The point as far off as the way is long, in the direction in which it begins.
    pub fn ahead(&self, from: Position) -> Position {
        let first = self.points[0] - from;
        if self.count == 1 { self.points[0] } else { from + first * (self.length / first.norm().max(REACHED)) }
    }

    /// The point that is `distance` (m) along the way from `from`.
    pub fn after(&self, mut from: Position, mut distance: f64) -> Position {
        for &to in self.points() {
            let leg = (to - from).norm();
            if leg > distance {
                return from + (to - from) * (distance / leg);
            }
            distance -= leg;
            from = to;
        }
        from
    }

    /// The same way, turned about `from` by `angle` to the left, rad.
    pub fn turned(mut self, from: Position, angle: f64) -> Self {
        if angle != 0.0 {
            self.points.iter_mut().for_each(|point| *point = from + turned(*point - from, angle));
        }
        self
    }

    pub(super) fn push(&mut self, point: Position) {
        if self.count < BENDS {
            self.points[self.count] = point;
            self.count += 1;
        }
    }
}

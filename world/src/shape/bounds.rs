//! Upright rectangles: what is out of reach without a closer look.

use crate::Position;

/// An upright rectangle, borders included, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Left lower corner, m.
    pub low: Position,
    /// Right upper corner, m.
    pub high: Position,
}

impl Bounds {
    /// Round nothing at all: grows to whatever is joined to it.
    pub const NOTHING: Self = Self {
        low: Position::new(f64::INFINITY, f64::INFINITY),
        high: Position::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The smallest rectangle round `points`.
    pub fn of(points: &[Position]) -> Self {
        points.iter().fold(Self::NOTHING, |bounds, point| bounds.joined(&Self { low: *point, high: *point }))
    }

    /// The smallest rectangle round both.
    pub fn joined(&self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// The same, `by` metres wider on every side.
    pub fn grown(&self, by: f64) -> Self {
        Self { low: self.low.add_scalar(-by), high: self.high.add_scalar(by) }
    }

    /// The middle, m.
    pub fn centre(&self) -> Position {
        (self.low + self.high) / 2.0
    }

    /// How far `place` is from the rectangle, m; 0 inside.
    pub fn distance(&self, place: Position) -> f64 {
        let x = (self.low.x - place.x).max(place.x - self.high.x).max(0.0);
        let y = (self.low.y - place.y).max(place.y - self.high.y).max(0.0);
        (x * x + y * y).sqrt()
    }

    /// Whether two rectangles have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }

    /// Whether the straight line between two points meets the rectangle grown by `reach`, m. May say yes to one
    /// that passes within rounding of a corner.
    pub fn meets_line(&self, from: Position, to: Position, reach: f64) -> bool {
        // Separating axes: x, y and the normal of the line.
        let (along, half) = (to - from, (self.high - self.low) / 2.0);
        let off = (from + to) / 2.0 - self.centre();
        let wide = half.add_scalar(reach);
        off.x.abs() <= wide.x + along.x.abs() / 2.0
            && off.y.abs() <= wide.y + along.y.abs() / 2.0
            && off.perp(&along).abs() <= (wide.x * along.y.abs() + wide.y * along.x.abs()) * (1.0 + 1e-12)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn place() -> impl Strategy<Value = Position> {
        prop::array::uniform2(-8.0f64..8.0).prop_map(|p| Position::new(p[0], p[1]))
    }

    #[test]
    fn the_distance_is_taken_to_sides_and_corners() {
        let bounds = Bounds { low: Position::new(0.0, 0.0), high: Position::new(2.0, 1.0) };
        assert_eq!(bounds.distance(Position::new(1.0, 3.0)), 2.0);
        assert_eq!(bounds.distance(Position::new(5.0, 5.0)), 5.0);
        assert_eq!(bounds.distance(Position::new(1.0, 0.5)), 0.0);
    }

    proptest! {
        #[test]
        fn a_line_that_comes_within_reach_is_never_missed(
            a in place(), b in place(), c in place(), d in place(), reach in 0.0f64..2.0,
        ) {
            let bounds = Bounds::of(&[c, d]);
            let least = (0..=200)
                .map(|s| bounds.distance(a + (b - a) * (f64::from(s) / 200.0)))
                .fold(f64::INFINITY, f64::min);
            if least <= reach {
                prop_assert!(bounds.meets_line(a, b, reach));
            }
            if least > (reach + 0.1) * std::f64::consts::SQRT_2 {
                prop_assert!(!bounds.meets_line(a, b, reach));
            }
        }
    }
}

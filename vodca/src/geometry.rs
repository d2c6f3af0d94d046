//! The plane geometry that several parts share.

use crate::Position;
use crate::random::{self, Use};

/// Distances below this have no direction, m.
pub const NO_DIRECTION: f64 = 1e-9;

/// A disc that may be hit: the separation it is owed beyond min_separation is `extra`, m
/// (its radius minus min_separation / 2).
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// Centre, m.
    pub centre: Position,
    /// Radius beyond min_separation / 2, m.
    pub extra: f64,
}

/// `vector` turned left (counter-clockwise) by `angle` rad.
pub fn turned(vector: Position, angle: f64) -> Position {
    if angle == 0.0 {
        return vector;
    }
    let (sin, cos) = angle.sin_cos();
    Position::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y)
}

/// The point reached from `from` towards `to` when the largest axis has moved `reach` metres;
/// `to` once it is within reach.
pub fn toward(from: Position, to: Position, reach: f64) -> Position {
    let way = to - from;
    let largest = way.x.abs().max(way.y.abs());
    if largest <= reach { to } else { from + way * (reach / largest) }
}

/// A draw from a disc of radius `radius` around the origin; nothing is drawn where it is 0.
pub(crate) fn in_disc(radius: f64, seed: u64, purpose: Use, robot: usize, tick: u64) -> Position {
    if radius == 0.0 {
        return Position::zeros();
    }
    let mut generator = random::stream(seed, purpose, robot as u64, tick);
    let length = radius * random::unit(&mut generator).sqrt();
    let (sin, cos) = (std::f64::consts::TAU * random::unit(&mut generator)).sin_cos();
    Position::new(cos, sin) * length
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_to_the_left_and_keeps_the_length() {
        let quarter = turned(Position::new(2.0, 0.0), std::f64::consts::FRAC_PI_2);
        assert!((quarter - Position::new(0.0, 2.0)).norm() < 1e-15);
        let vector = Position::new(0.1, -0.7);
        assert_eq!(turned(vector, 0.0), vector);
    }

    #[test]
    fn the_largest_axis_moves_by_the_reach_and_never_beyond_the_end() {
        let (from, to) = (Position::new(1.0, 1.0), Position::new(5.0, -1.0));
        assert_eq!(toward(from, to, 2.0), Position::new(3.0, 0.0));
        assert_eq!(toward(from, to, 4.0), to);
        assert_eq!(toward(to, to, 0.0), to);
    }

    #[test]
    fn draws_stay_in_their_disc_and_depend_on_who_draws() {
        let draw = |robot, tick| in_disc(0.5, 3, Use::Noise, robot, tick);
        assert!((0..200).all(|tick| draw(1, tick).norm() <= 0.5));
        assert_eq!(draw(1, 7), draw(1, 7));
        assert_ne!(draw(1, 7), draw(2, 7));
        assert_eq!(in_disc(0.0, 3, Use::Noise, 1, 7), Position::zeros());
    }
}

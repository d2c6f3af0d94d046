//! Backing off: what a robot does that patience, yielding and the way round have not freed.
//!
//! Robots that stand in each other's way so that every move of each needs a move of another first would stand
//! for ever, each in its own cell. Whoever has been in conflict for very long walks off in a random direction
//! for a while, as stations on a shared wire do, and tries again.

use crate::Position;
use crate::geometry::turned;
use crate::random::{self, Use};

/// Length of a try, or of a walk off, ticks.
const WINDOW: u64 = 20;
/// Share of the windows in which a robot walks off.
const SHARE: f64 = 0.5;

/// Where a robot at `from` that wishes to go on to `to` looks in this tick: there, or in a window drawn for
/// walking off `far` (m) away in any direction. Drawn by robot and window, the same in every run: robots
/// need only differ from each other.
pub fn aim(robot: usize, tick: u64, from: Position, to: Position, far: f64) -> Position {
    let mut generator = random::stream(0, Use::BackOff, robot as u64, tick / WINDOW);
    if random::unit(&mut generator) >= SHARE {
        return to;
    }
    let angle = std::f64::consts::TAU * random::unit(&mut generator);
    from + turned(Position::new(far, 0.0), angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn about_half_of_the_windows_are_walks_off_into_all_directions() {
        let (from, to) = (Position::new(1.0, 2.0), Position::new(9.0, 2.0));
        let aims: Vec<Position> = (0..1000).map(|window| aim(3, window * WINDOW, from, to, 3.0)).collect();
        let off: Vec<&Position> = aims.iter().filter(|aim| **aim != to).collect();
        // Five standard deviations of a binomial.
        assert!((420..=580).contains(&off.len()), "{}", off.len());
        assert!(off.iter().all(|aim| ((*aim - from).norm() - 3.0).abs() < 1e-12));
        let mean = off.iter().fold(Position::zeros(), |sum, aim| sum + (*aim - from)) / off.len() as f64;
        assert!(mean.norm() < 0.5, "{mean}");
    }

    #[test]
    fn a_window_is_kept_and_robots_differ() {
        let (from, to) = (Position::zeros(), Position::new(9.0, 2.0));
        let windows = |robot| (0..50).map(move |window| aim(robot, window * WINDOW, from, to, 3.0));
        assert!((0..50).all(|w| aim(3, w * WINDOW, from, to, 3.0) == aim(3, w * WINDOW + WINDOW - 1, from, to, 3.0)));
        assert!(windows(3).ne(windows(4)));
    }
}

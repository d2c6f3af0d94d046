//! The canary set: observations every actor must answer with finite numbers, fast enough.

use vodca::Position;
use vodca::random::{self, Use};

/// Observations of the set.
const CASES: u64 = 32;
/// Half the side of the square that positions are drawn from, m: wider than every built-in scenario.
const HALF_SIDE: f64 = 60.0;
const SEED: u64 = 4;

/// The positions of `robots` in every case: all at the origin, all far out, then seeded draws.
pub(super) fn positions(robots: usize) -> impl Iterator<Item = Vec<Position>> {
    let same = move |at: f64| vec![Position::new(at, -at); robots];
    let drawn = (0..CASES - 3).map(move |case| {
        let mut generator = random::stream(SEED, Use::Policy, case, robots as u64);
        let mut coordinate = || (2.0 * random::unit(&mut generator) - 1.0) * HALF_SIDE;
        (0..robots).map(|_| Position::new(coordinate(), coordinate())).collect()
    });
    [same(0.0), same(HALF_SIDE), same(-10.0 * HALF_SIDE)].into_iter().chain(drawn)
}

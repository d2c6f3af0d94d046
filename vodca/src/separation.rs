//! The one notion of separation: the smallest centre distance along straight motion between two
//! samples, used by the shield's tests, the recorder, the metrics and the offline check alike.

use crate::Position;

/// Smallest distance, in metres, between two discs' centres that move straight from `a.0` to `a.1`
/// and from `b.0` to `b.1` during the same sample interval. For an obstacle pass `(o, o)`.
pub fn separation(a: (Position, Position), b: (Position, Position)) -> f64 {
    let from = a.0 - b.0;
    let to = a.1 - b.1;
    let motion = to - from;
    let length_squared = motion.norm_squared();
    if length_squared == 0.0 {
        return from.norm();
    }
    let nearest = (-from.dot(&motion) / length_squared).clamp(0.0, 1.0);
    (from + motion * nearest).norm().min(from.norm()).min(to.norm())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(x: f64, y: f64) -> Position {
        Position::new(x, y)
    }

    #[test]
    fn robots_that_swap_places_meet_half_way() {
        assert_eq!(separation((at(0.0, 0.0), at(2.0, 0.0)), (at(2.0, 0.0), at(0.0, 0.0))), 0.0);
    }

    #[test]
    fn robots_at_rest_keep_their_distance() {
        assert_eq!(separation((at(0.0, 0.0), at(0.0, 0.0)), (at(3.0, 4.0), at(3.0, 4.0))), 5.0);
    }

    #[test]
    fn a_pass_is_seen_between_the_samples() {
        let d = separation((at(-1.0, 1.0), at(1.0, 1.0)), (at(0.0, 0.0), at(0.0, 0.0)));
        assert!((d - 1.0).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn it_is_the_minimum_over_dense_sampling(c in prop::array::uniform8(-5.0f64..5.0)) {
            let (a, b) = ((at(c[0], c[1]), at(c[2], c[3])), (at(c[4], c[5]), at(c[6], c[7])));
            let exact = separation(a, b);
            let sampled = (0..=1000).map(|s| {
                let t = s as f64 / 1000.0;
                ((a.0 + (a.1 - a.0) * t) - (b.0 + (b.1 - b.0) * t)).norm()
            }).fold(f64::INFINITY, f64::min);
            prop_assert!(exact <= sampled + 1e-12 && sampled - exact < 0.02);
            prop_assert_eq!(exact, separation(b, a));
        }
    }
}

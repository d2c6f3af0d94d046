//! What a robot will meet if everybody walks straight to the set-point: a look ahead that needs no plan.

use super::conflict::toward;
use shared::Position;
use shared::params::Aim;

/// A straight walk: what a robot wishes to do (safe.md, rule 3).
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Present position, m.
    pub from: Position,
    /// Set-point, m.
    pub to: Position,
}

/// The first of the next `steps` ticks at which two walks are nearer than `separation` (m). `stride` is
/// the largest move per tick and axis, m.
///
/// Nobody covers more than sqrt(2) `stride` a tick, so ticks that a distance rules out are not looked at.
pub fn meeting(own: Walk, other: Walk, separation: f64, stride: f64, steps: usize) -> Option<usize> {
    let approach = 2.0 * std::f64::consts::SQRT_2 * stride;
    let mut step = 1;
    while step <= steps {
        let reach = stride * step as f64;
        let distance = (toward(own.from, own.to, reach) - toward(other.from, other.to, reach)).norm();
        if distance < separation {
            return Some(step);
        }
        step += (((distance - separation) / approach) as usize).max(1);
    }
    None
}

/// How strongly the traffic ahead asks a robot to keep right: 0 when it will meet nobody, 1 when it will, and
/// `aim.traffic` more for every meeting beyond the first that is more than `aim.near` ticks away, up to
/// `aim.most`. Meetings at hand do not count as traffic: a crowd gets out of each other's way by its rows, and
/// walking round it only makes it larger.
pub fn traffic(aim: &Aim, meetings: impl Iterator<Item = usize>) -> f64 {
    let (mut any, mut far) = (false, 0);
    for step in meetings {
        any = true;
        far += usize::from(step > aim.near);
    }
    let more = aim.traffic * far.saturating_sub(1) as f64;
    if any { (1.0 + more).min(aim.most) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use shared::params::Params;

    const STRIDE: f64 = 0.3;

    fn walk(from: (f64, f64), to: (f64, f64)) -> Walk {
        Walk { from: Position::new(from.0, from.1), to: Position::new(to.0, to.1) }
    }

    #[test]
    fn head_on_walks_meet_when_the_way_between_them_is_used_up() {
        let (own, other) = (walk((0.0, 0.0), (10.0, 0.0)), walk((10.0, 0.0), (0.0, 0.0)));
        // 10 m less 0.6 m a tick are below 1.5 m from the 15th tick on.
        assert_eq!(meeting(own, other, 1.5, STRIDE, 25), Some(15));
        assert_eq!(meeting(own, other, 1.5, STRIDE, 14), None);
        assert_eq!(meeting(own, walk((10.0, 1.6), (0.0, 1.6)), 1.5, STRIDE, 25), None);
    }

    #[test]
    fn a_robot_at_its_set_point_is_met_by_who_walks_through_it() {
        let parked = walk((5.0, 0.1), (5.0, 0.1));
        assert_eq!(meeting(walk((0.0, 0.0), (9.0, 0.0)), parked, 1.5, STRIDE, 25), Some(12));
        assert_eq!(meeting(walk((0.0, 0.0), (3.0, 0.0)), parked, 1.5, STRIDE, 25), None);
    }

    #[test]
    fn more_meetings_far_ahead_ask_for_more_up_to_the_most() {
        let aim = Aim { traffic: 0.3, near: 10, most: 1.8, ..Params::safe().aim };
        let asked = |steps: &[usize]| traffic(&aim, steps.iter().copied());
        assert_eq!(asked(&[]), 0.0);
        assert_eq!((asked(&[20]), asked(&[2]), asked(&[2, 3, 4])), (1.0, 1.0, 1.0));
        assert!((asked(&[11, 12, 13, 10]) - 1.6).abs() < 1e-12);
        assert_eq!(asked(&[20; 9]), 1.8);
    }

    fn place() -> impl Strategy<Value = (f64, f64)> {
        (0.0..25.0, 0.0..25.0)
    }

    proptest! {
        #[test]
        fn ticks_that_are_not_looked_at_hold_no_meeting(a in place(), b in place(), c in place(), d in place()) {
            let (own, other) = (walk(a, b), walk(c, d));
            let near = |step: &usize| {
                let reach = STRIDE * *step as f64;
                (toward(own.from, own.to, reach) - toward(other.from, other.to, reach)).norm() < 1.5
            };
            prop_assert_eq!(meeting(own, other, 1.5, STRIDE, 49), (1..=49).find(near));
        }
    }
}

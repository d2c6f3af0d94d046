//! The reference that the cost draws a plan to (ARCHITECTURE, rules 1 and 4).

use crate::geometry::{toward, turned};
use crate::horizon::{Horizon, MAX_HORIZON};
use crate::mpc::problem::{Target, TargetKind};
use crate::params::Aim;
use crate::{Input, Position};

/// An empty target to be filled at every tick.
pub fn empty_target() -> Target {
    Target {
        kind: TargetKind::SetPoint,
        states: [Position::zeros(); MAX_HORIZON],
        inputs: [Input::zeros(); MAX_HORIZON],
    }
}

/// The paper's X^d: the set-point at every step, no input.
pub fn set_point(target: &mut Target, set_point: Position, horizon: Horizon) {
    target.kind = TargetKind::SetPoint;
    for l in 0..horizon.steps() {
        target.states[l] = set_point;
        target.inputs[l] = Input::zeros();
    }
}

/// The straight reference r_t = p + min(1, 1.5 h t / max-axis |g' - p|) (g' - p): the largest axis at
/// full speed until the set-point is reached. It is its own free optimum, so a robot that meets nobody
/// walks straight; a constant X^d saturates both axes and walks at 45 degrees first.
pub fn straight(target: &mut Target, from: Position, to: Position, horizon: Horizon, sample_time: f64, max_speed: f64) {
    target.kind = TargetKind::Feasible;
    let mut here = from;
    for l in 0..horizon.steps() {
        let next = toward(from, to, max_speed * sample_time * (l + 1) as f64);
        target.states[l] = next;
        target.inputs[l] = (next - here) / sample_time;
        here = next;
    }
}

/// The same along the legs of a way, `points` (m): the largest axis at full speed all along.
pub fn along(
    target: &mut Target,
    from: Position,
    points: &[Position],
    horizon: Horizon,
    sample_time: f64,
    max_speed: f64,
) {
    target.kind = TargetKind::Feasible;
    let (mut here, mut leg) = (from, 0);
    for l in 0..horizon.steps() {
        let before = here;
        let mut reach = max_speed * sample_time;
        while let Some(&to) = points.get(leg) {
            let length = (to - here).amax();
            here = toward(here, to, reach);
            if length > reach {
                break;
            }
            reach -= length;
            leg += 1;
        }
        target.states[l] = here;
        target.inputs[l] = (here - before) / sample_time;
    }
}

/// The set-point seen turned to the right: g' = p + R(-a)(g - p) with a = `turn` (phi s, rad) times
/// [`Aim::fade`].
pub fn aim(aim: &Aim, turn: f64, position: Position, set_point: Position) -> Position {
    let way = set_point - position;
    let angle = turn * aim.fade(way.norm());
    if angle == 0.0 { set_point } else { position + turned(way, -angle) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Params;

    #[test]
    fn the_straight_reference_obeys_the_model_and_ends_at_the_set_point() {
        let mut target = empty_target();
        let (from, to) = (Position::new(1.0, 2.0), Position::new(2.0, 1.5));
        straight(&mut target, from, to, Horizon::new(6).unwrap(), 0.2, 1.5);
        let mut here = from;
        for l in 0..6 {
            here += target.inputs[l] * 0.2;
            assert!((here - target.states[l]).norm() < 1e-14);
            assert!(target.inputs[l].amax() <= 1.5 + 1e-12);
        }
        assert_eq!(target.states[3], to);
        assert_eq!(target.inputs[5], Input::zeros());
    }

    #[test]
    fn a_reference_bends_round_corners_at_full_speed() {
        let mut target = empty_target();
        let from = Position::zeros();
        let points = [Position::new(0.4, 0.0), Position::new(0.4, 0.5)];
        along(&mut target, from, &points, Horizon::new(4).unwrap(), 0.2, 1.5);
        let expected = [(0.3, 0.0), (0.4, 0.2), (0.4, 0.5), (0.4, 0.5)];
        for (state, (x, y)) in target.states.iter().zip(expected) {
            assert!((state - Position::new(x, y)).norm() < 1e-12, "{state}");
        }
        assert!(target.inputs[..4].iter().all(|input| input.amax() <= 1.5 + 1e-12));
        let (mut alone, to) = (empty_target(), Position::new(3.0, -2.0));
        straight(&mut alone, from, to, Horizon::new(20).unwrap(), 0.2, 1.5);
        along(&mut target, from, &[to], Horizon::new(20).unwrap(), 0.2, 1.5);
        assert!(target.states.iter().zip(&alone.states).take(20).all(|(a, b)| (a - b).norm() < 1e-12));
    }

    #[test]
    fn aim_turns_right_far_from_the_set_point_only() {
        let params = Aim { angle: 0.35, fade_start: 1.5, fade_end: 4.5, ..Params::paper().aim };
        let here = Position::zeros();
        let far = Position::new(10.0, 0.0);
        let turned = aim(&params, 0.35, here, far);
        assert!((turned - Position::new(10.0 * 0.35f64.cos(), -10.0 * 0.35f64.sin())).norm() < 1e-12);
        assert_eq!(aim(&params, 0.0, here, far), far);
        assert_eq!(aim(&params, 0.35, here, Position::new(1.5, 0.0)), Position::new(1.5, 0.0));
    }
}

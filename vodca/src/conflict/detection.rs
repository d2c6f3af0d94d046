//! Detection: where two predictions, or a prediction and an obstacle, come too close.

use crate::Position;
use crate::geometry::toward;
use crate::obstacles::Solid;
use crate::prediction::Prediction;

/// What a hazard is expected to do.
#[derive(Clone, Copy, Debug)]
pub enum PredictedMotion<'a> {
    /// A neighbour follows its plan x^_j[l|k-1] as far as it reaches. A plan that is `age` ticks older
    /// than k - 1 is shifted: the neighbour is expected to stay where it ends.
    Plan {
        /// The newest plan heard.
        plan: &'a Prediction,
        /// Ticks by which it is late; 0 in an undisturbed run.
        age: usize,
    },
    /// It walks straight from a place to another with `stride` metres per step on its largest axis
    /// (how a neighbour would move if nobody were in its way; ARCHITECTURE, rule 3).
    Wish {
        /// Present position, m.
        from: Position,
        /// Set-point, m.
        to: Position,
        /// Largest move per step and axis, m: h times the largest speed.
        stride: f64,
    },
    /// It stays (a disc).
    Still(Position),
    /// It stays and is no disc: what is owed to it is owed to its nearest point.
    Shape(Solid<'a>),
}

/// A neighbour or an obstacle: what a robot must keep away from.
#[derive(Clone, Copy, Debug)]
pub struct Hazard<'a> {
    /// Where it will be.
    pub course: PredictedMotion<'a>,
    /// Separation owed to it, m (r_min plus radii beyond r_min / 2 plus clearance); to a shape as if it were a disc of the
    /// usual size.
    pub separation: f64,
}

impl Hazard<'_> {
    /// Where the hazard is at prediction step `step` of the plans of tick k - 1, for a robot that is at `own` (m) then,
    /// and the separation owed to it there, m; `None` beyond its plan.
    pub fn at(&self, step: usize, own: Position) -> Option<(Position, f64)> {
        let place = match self.course {
            PredictedMotion::Plan { plan, age } => {
                let last = plan.horizon().steps();
                (step <= last).then(|| plan.state(step.saturating_add(age).min(last)))?
            }
            PredictedMotion::Wish { from, to, stride } => toward(from, to, stride * step as f64),
            PredictedMotion::Still(position) => position,
            PredictedMotion::Shape(solid) => {
                let disc = solid.seen_from(own);
                return Some((disc.centre, self.separation + disc.extra));
            }
        };
        Some((place, self.separation))
    }

    /// Whether it is passed on one side as well as on the other, so that a rule may say on which. A shape is not: ways
    /// lead round it ([`crate::way`]), and along a wall a turned normal would brake who has it on its right.
    fn has_sides(&self) -> bool {
        !matches!(self.course, PredictedMotion::Shape(_))
    }

    /// Whether it is too far from `own` (m) to be in conflict, as far as that is known cheaply.
    fn is_beyond(&self, own: Position) -> bool {
        match self.course {
            PredictedMotion::Shape(Solid::Piece(piece, _)) => piece.bounds().distance(own) >= self.separation,
            _ => false,
        }
    }

    /// Its state at `step` beside the robot's own, `plan`'s: a conflict or none; `None` beyond its plan.
    pub(super) fn meeting(&self, plan: &Prediction, step: usize) -> Option<Conflict> {
        let own = plan.state(step);
        let (hazard, separation) = self.at(step, own)?;
        let distance = (own - hazard).norm();
        Some(Conflict { step, distance, own, hazard, separation, has_sides: self.has_sides() })
    }
}

/// A conflict: the first compared step at which the distance is below the separation owed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conflict {
    /// k_c, prediction step of the plans of tick k - 1.
    pub step: usize,
    /// d, m.
    pub distance: f64,
    /// Own x^_i[k_c|k-1], m.
    pub own: Position,
    /// The hazard's place at k_c, m.
    pub hazard: Position,
    /// Separation owed to the hazard, m.
    pub separation: f64,
    /// Whether the normal of its row may be turned.
    pub has_sides: bool,
}

/// Finds the first step in `from_step..=last_step` at which `plan` comes closer to `hazard` than the
/// separation owed to it.
///
/// `plan` is this robot's own prediction of tick k - 1. Horizons may differ: only the steps that both
/// sides predict are compared (N_min of the paper). `None` when no step conflicts.
pub fn first_conflict(plan: &Prediction, hazard: &Hazard<'_>, from_step: usize, last_step: usize) -> Option<Conflict> {
    let last_step = last_step.min(plan.horizon().steps());
    for step in from_step..=last_step {
        if hazard.is_beyond(plan.state(step)) {
            continue;
        }
        let meeting = hazard.meeting(plan, step)?;
        if meeting.distance < meeting.separation {
            return Some(meeting);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: f64, step: f64, horizon: usize) -> Prediction {
        let states: Vec<Position> = (0..=horizon).map(|l| Position::new(from + step * l as f64, 0.0)).collect();
        Prediction::from_states(&states, Position::zeros())
    }

    #[test]
    fn only_steps_that_both_predict_are_compared() {
        let (own, other) = (line(0.0, 0.3, 20), line(6.0, -0.3, 20));
        let hazard = Hazard { course: PredictedMotion::Plan { plan: &other, age: 0 }, separation: 1.5 };
        let conflict = first_conflict(&own, &hazard, 1, 49).unwrap();
        assert_eq!(conflict.step, 8);
        assert!((conflict.distance - 1.2).abs() < 1e-12);
        let short = line(6.0, -0.3, 7);
        assert_eq!(
            first_conflict(
                &own,
                &Hazard { course: PredictedMotion::Plan { plan: &short, age: 0 }, separation: 1.5 },
                1,
                49
            ),
            None
        );
        assert_eq!(first_conflict(&line(0.0, 0.3, 7), &hazard, 1, 49), None);
        assert_eq!(first_conflict(&own, &hazard, 1, 7), None);
    }

    #[test]
    fn a_late_plan_is_shifted_and_ends_where_it_ended() {
        let plan = line(0.0, 1.0, 3);
        let hazard = Hazard { course: PredictedMotion::Plan { plan: &plan, age: 2 }, separation: 1.0 };
        let late = |step| hazard.at(step, Position::zeros());
        assert_eq!(late(1), Some((Position::new(3.0, 0.0), 1.0)));
        assert_eq!(late(3), Some((Position::new(3.0, 0.0), 1.0)));
        assert_eq!(late(4), None);
    }

    #[test]
    fn the_separation_itself_is_no_conflict() {
        let still = Hazard { course: PredictedMotion::Still(Position::new(0.0, 1.5)), separation: 1.5 };
        assert_eq!(first_conflict(&line(0.0, 0.0, 3), &still, 1, 3), None);
    }

    #[test]
    fn a_wish_ends_at_the_set_point() {
        let (from, to) = (Position::zeros(), Position::new(1.0, -0.5));
        let wish = Hazard { course: PredictedMotion::Wish { from, to, stride: 0.3 }, separation: 1.0 };
        assert!((wish.at(1, from).unwrap().0 - Position::new(0.3, -0.15)).norm() < 1e-15);
        assert_eq!(wish.at(4, from), Some((to, 1.0)));
    }
}

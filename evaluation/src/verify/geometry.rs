//! Separations and paths, recomputed.

use super::outline::Outline;
use super::table::Table;
use std::collections::BTreeSet;
use vodca::params::Params;
use vodca::scenario::Scenario;

/// A separation that fell below what its pair had to keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Loss {
    pub(super) tick: usize,
    pub(super) robot: usize,
    /// Number of what was near: robots first, then obstacles.
    pub(super) hazard: usize,
    /// m, as [`PredictedMotion::min_separation`].
    pub(super) separation: f64,
    /// What the pair had to keep, m.
    pub(super) kept: f64,
}

/// What a trajectory shows.
#[derive(Clone, Debug)]
pub(super) struct PredictedMotion {
    /// Smallest separation of the run, m, radii beyond min_separation / 2 taken off; infinite alone.
    pub(super) min_separation: f64,
    /// The first loss of separation, see [`PredictedMotion::follow`].
    pub(super) loss: Option<Loss>,
    /// Ticks in which someone was nearer than min_separation (by more than rounding).
    pub(super) ticks_below: u64,
    /// Pairs that collided at any time.
    pub(super) pairs_collided: usize,
    /// Length of each robot's path, m.
    pub(super) path: Vec<f64>,
    /// What is left to each set-point, m.
    pub(super) distances: Vec<f64>,
}

impl PredictedMotion {
    /// Follows everybody through the run.
    ///
    /// A pair may not come nearer than `cell.separation`, and while it is still nearer than that (a close
    /// start) not nearer than it was at any sample before. Where positions are measured with noise this is
    /// asked of the samples only, because between them the proof says nothing.
    pub(super) fn follow(table: &Table, scenario: &Scenario, params: &Params) -> Self {
        let robots = scenario.robots.len();
        let limit = params.model.min_separation;
        let half = limit / 2.0;
        let extra = |radius: Option<f64>| radius.map_or(0.0, |radius| radius - half);
        let mut course = Self {
            min_separation: f64::INFINITY,
            loss: None,
            ticks_below: 0,
            pairs_collided: 0,
            path: vec![0.0; robots],
            distances: Vec::new(),
        };
        // Hazards are counted robots first, then obstacles.
        let mut collided = BTreeSet::new();
        let shapes: Vec<Outline> = scenario.shapes.iter().map(Outline::of).collect();
        let hazards = robots + scenario.obstacles.len() + shapes.len();
        let mut kept = vec![f64::NEG_INFINITY; robots * hazards];
        let at_samples = params.disturbance.noise > 0.0;
        // A run without a whole tick has its start: everybody stands there.
        for tick in 0..table.ticks.len().max(1) {
            let mut least = f64::INFINITY;
            let mut note = |[near, before, after]: [f64; 3], robot: usize, hazard: usize| {
                least = least.min(near);
                let kept = &mut kept[robot * hazards + hazard];
                *kept = kept.max(before.min(params.cell.separation));
                let separation = if at_samples { after } else { near };
                // Under noise a pair that is still nearer is pushed in a direction that is not quite right.
                let asked = !at_samples || *kept >= params.cell.separation;
                if asked && separation < *kept - super::TOUCH && course.loss.is_none() {
                    course.loss = Some(Loss { tick, robot, hazard, separation, kept: *kept });
                }
                if near < params.episode.collision_factor * limit {
                    collided.insert((robot, hazard));
                }
                course.min_separation = course.min_separation.min(near);
            };
            for i in 0..robots {
                let (from, to) = (table.position(tick, i), table.position(tick + 1, i));
                course.path[i] += (to[0] - from[0]).hypot(to[1] - from[1]);
                let own = extra(scenario.robots[i].radius);
                for j in i + 1..robots {
                    let (other_from, other_to) = (table.position(tick, j), table.position(tick + 1, j));
                    let both = own + extra(scenario.robots[j].radius);
                    note(between(minus(from, other_from), minus(to, other_to), both), i, j);
                }
                for (l, obstacle) in scenario.obstacles.iter().enumerate() {
                    let centre = [obstacle.position.x, obstacle.position.y];
                    note(between(minus(from, centre), minus(to, centre), own + extra(obstacle.radius)), i, robots + l);
                }
                for (l, shape) in shapes.iter().enumerate() {
                    // A surface at half of the separation counts as the centre of a disc at all of it.
                    let away = |from, to| shape.distance(from, to) + half - own;
                    let three = [away(from, to), away(from, from), away(to, to)];
                    note(three, i, robots + scenario.obstacles.len() + l);
                }
            }
            course.ticks_below += u64::from(tick < table.ticks.len() && least < limit - super::TOUCH);
        }
        course.pairs_collided = collided.len();
        course.distances = (0..robots)
            .map(|i| {
                let [x, y] = table.position(table.ticks.len(), i);
                (x - scenario.robots[i].set_point.x).hypot(y - scenario.robots[i].set_point.y)
            })
            .collect();
        course
    }
}

/// The separation in between, before and after, of a pair whose offset goes from `from` to `to`, m.
fn between(from: [f64; 2], to: [f64; 2], extra: f64) -> [f64; 3] {
    [nearest(from, to) - extra, from[0].hypot(from[1]) - extra, to[0].hypot(to[1]) - extra]
}

pub(super) fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Smallest distance from the origin to the segment from `a` to `b`: the height of the triangle over the
/// segment when its foot lies inside (both angles at the segment acute), the shorter side otherwise.
pub(super) fn nearest(a: [f64; 2], b: [f64; 2]) -> f64 {
    let along = minus(b, a);
    let at_a = a[0] * along[0] + a[1] * along[1];
    let at_b = b[0] * along[0] + b[1] * along[1];
    if at_a < 0.0 && at_b > 0.0 {
        (a[0] * b[1] - a[1] * b[0]).abs() / along[0].hypot(along[1])
    } else {
        a[0].hypot(a[1]).min(b[0].hypot(b[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn heights_and_sides_are_told_apart() {
        assert_eq!(nearest([-1.0, 1.0], [1.0, 1.0]), 1.0);
        assert_eq!(nearest([3.0, 4.0], [6.0, 8.0]), 5.0);
        assert_eq!(nearest([3.0, 4.0], [3.0, 4.0]), 5.0);
        assert_eq!(nearest([-1.0, 0.0], [1.0, 0.0]), 0.0);
    }

    proptest! {
        #[test]
        fn both_formulas_agree(c in prop::array::uniform4(-5.0f64..5.0)) {
            use vodca::Position;
            let still = (Position::zeros(), Position::zeros());
            let other = vodca::separation::separation((Position::new(c[0], c[1]), Position::new(c[2], c[3])), still);
            prop_assert!((nearest([c[0], c[1]], [c[2], c[3]]) - other).abs() < 1e-9);
        }
    }
}

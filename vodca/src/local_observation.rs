//! What one robot sees of the world from where it stands: the input of a policy that is one for all robots.
//!
//! Everything is in the robot's own frame: the origin is where it measures itself, the first axis leads to its
//! set-point, the second one to the left of it. Numbers are made small: lengths in units of 10 m, speeds of
//! `model.max_speed`, horizons of 49 steps; none is outside -10..=10.
//!
//! | numbers | what |
//! |---|---|
//! | 1 | distance to the set-point |
//! | 2 | own velocity of the last tick |
//! | 1 | own last horizon |
//! | 1 | collision rows of the last tick, 8 of them or more are 1 |
//! | 8 for each of the nearest neighbours | 1 where there is one; its place (2); what the distance has above the separation owed; closing speed, halved; how much farther it still has to go; its last horizon; how near the predicted conflict is, 1: in one step, 0: none |
//! | 4 for each of the nearest obstacles | 1 where there is one; its centre (2); what the distance has above the separation owed |
//!
//! Nearest is who has least above the separation owed. What is not there is all zeros; before the first tick nobody has
//! a velocity, a horizon or a conflict. A robot knows all of it from its own step and from what it has heard.

use crate::Position;
use crate::conflict::detection::first_conflict;
use crate::conflict::{Hazard, PredictedMotion};
use crate::controller::Neighbour;
use crate::geometry::{Disc, NO_DIRECTION};
use crate::horizon::MAX_HORIZON;
use crate::params::Params;
use crate::scenario::Scenario;
use crate::step::Step;

/// Numbers that are about the robot itself.
pub const OWN: usize = 5;
/// Numbers for each neighbour.
pub const PER_NEIGHBOUR: usize = 8;
/// Numbers for each obstacle.
pub const PER_OBSTACLE: usize = 4;
/// No number of an observation is larger than this, or smaller than its negative.
pub const BOUND: f32 = 10.0;
/// Most neighbours, and most obstacles, that are seen.
pub const MOST_SEEN: usize = 32;
/// The unit of length, m.
const LENGTH: f64 = 10.0;
/// So many collision rows, or more, are 1.
const MANY_ROWS: f64 = 8.0;

/// How many others a robot sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seen {
    /// Neighbours, at most [`MOST_SEEN`].
    pub neighbours: usize,
    /// Obstacles, at most [`MOST_SEEN`].
    pub obstacles: usize,
}

impl Default for Seen {
    fn default() -> Self {
        Self { neighbours: 4, obstacles: 2 }
    }
}

impl Seen {
    /// Numbers of an observation.
    pub fn width(self) -> usize {
        OWN + PER_NEIGHBOUR * self.neighbours + PER_OBSTACLE * self.obstacles
    }
}

/// Observes for every robot of a team; knows what does not change during a run.
#[derive(Clone, Debug)]
pub struct LocalObserver {
    seen: Seen,
    set_points: Vec<Position>,
    extra: Vec<f64>,
    obstacles: Vec<Disc>,
    min_separation: f64,
    max_speed: f64,
    sample_time: f64,
}

impl LocalObserver {
    /// For robots of `scenario`, each of which sees as many others as `seen` says ([`MOST_SEEN`] at most).
    pub fn new(scenario: &Scenario, params: &Params, seen: Seen) -> Self {
        let min_separation = params.model.min_separation;
        Self {
            seen: Seen { neighbours: seen.neighbours.min(MOST_SEEN), obstacles: seen.obstacles.min(MOST_SEEN) },
            set_points: scenario.robots.iter().map(|robot| robot.set_point).collect(),
            extra: scenario.robots.iter().map(|robot| robot.extra_radius(min_separation)).collect(),
            obstacles: scenario.discs(min_separation),
            min_separation,
            max_speed: params.model.max_speed,
            sample_time: params.model.sample_time,
        }
    }

    /// Numbers of an observation.
    pub fn width(&self) -> usize {
        self.seen.width()
    }

    /// Writes what `robot` sees at the start of tick `tick`, where it measures itself at `position` (m), into `out`
    /// ([`Self::width`] numbers). `last` is what it did in the tick before, `heard` what it has heard of everybody.
    pub fn observe(
        &self,
        robot: usize,
        tick: u64,
        position: Position,
        last: Option<&Step>,
        heard: &[Neighbour],
        out: &mut [f32],
    ) {
        out.fill(0.0);
        let frame = Frame::new(position, self.set_points[robot]);
        let own = last.map_or(Position::zeros(), |step| step.input);
        let (about_me, rest) = out.split_at_mut(OWN);
        about_me[0] = bounded(frame.way / LENGTH);
        (about_me[1], about_me[2]) = frame.vector(own / self.max_speed);
        if let Some(step) = last {
            about_me[3] = bounded(step.horizon.steps() as f64 / MAX_HORIZON as f64);
            about_me[4] = (f64::from(step.rows) / MANY_ROWS).min(1.0) as f32;
        }
        let (of_neighbours, of_obstacles) = rest.split_at_mut(PER_NEIGHBOUR * self.seen.neighbours);
        let gap = |at: Position, extra: f64| (at - position).norm() - self.min_separation - self.extra[robot] - extra;
        let others = heard.iter().enumerate().filter(|(other, _)| *other != robot);
        let others =
            others.filter_map(|(other, neighbour)| Some((gap(neighbour.present?.1, self.extra[other]), other)));
        for (numbers, (gap, other)) in
            of_neighbours.chunks_exact_mut(PER_NEIGHBOUR).zip(Nearest::of(others, self.seen.neighbours).iter())
        {
            self.neighbour(tick, &frame, (own, last), (&heard[other], self.owed(robot, other)), gap, numbers);
        }
        let discs = self.obstacles.iter().enumerate().map(|(index, disc)| (gap(disc.centre, disc.extra), index));
        for (numbers, (gap, index)) in
            of_obstacles.chunks_exact_mut(PER_OBSTACLE).zip(Nearest::of(discs, self.seen.obstacles).iter())
        {
            numbers[0] = 1.0;
            (numbers[1], numbers[2]) = frame.vector((self.obstacles[index].centre - position) / LENGTH);
            numbers[3] = bounded(gap / LENGTH);
        }
    }

    fn owed(&self, robot: usize, other: usize) -> f64 {
        self.min_separation + self.extra[robot] + self.extra[other]
    }

    fn neighbour(
        &self,
        tick: u64,
        frame: &Frame,
        (own, last): (Position, Option<&Step>),
        (neighbour, separation): (&Neighbour, f64),
        gap: f64,
        numbers: &mut [f32],
    ) {
        let Some((_, present)) = neighbour.present else { return };
        let offset = present - frame.origin;
        numbers[0] = 1.0;
        (numbers[1], numbers[2]) = frame.vector(offset / LENGTH);
        numbers[3] = bounded(gap / LENGTH);
        numbers[5] = bounded(((neighbour.set_point - present).norm() - frame.way) / LENGTH);
        let Some((at, plan)) = &neighbour.plan else { return };
        let velocity = (plan.state(1) - plan.state(0)) / self.sample_time;
        let direction = offset / offset.norm().max(NO_DIRECTION);
        numbers[4] = bounded((own - velocity).dot(&direction) / (2.0 * self.max_speed));
        numbers[6] = bounded(plan.horizon().steps() as f64 / MAX_HORIZON as f64);
        let age = tick.saturating_sub(1).saturating_sub(*at) as usize;
        let hazard = Hazard { course: PredictedMotion::Plan { plan, age }, separation };
        let conflict = last.and_then(|step| first_conflict(&step.plan, &hazard, 1, MAX_HORIZON));
        let near = |step: usize| (MAX_HORIZON + 1 - step) as f64 / MAX_HORIZON as f64;
        numbers[7] = bounded(conflict.map_or(0.0, |conflict| near(conflict.step)));
    }
}

/// The robot's own frame.
struct Frame {
    /// Where it is, m.
    origin: Position,
    /// Towards its set-point, of length 1.
    forward: Position,
    /// How far it has to go, m.
    way: f64,
}

impl Frame {
    fn new(origin: Position, set_point: Position) -> Self {
        let offset = set_point - origin;
        let way = offset.norm();
        let forward = if way > NO_DIRECTION { offset / way } else { Position::new(1.0, 0.0) };
        Self { origin, forward, way }
    }

    /// A vector of the world, as this robot sees it.
    fn vector(&self, world: Position) -> (f32, f32) {
        let left = Position::new(-self.forward.y, self.forward.x);
        (bounded(world.dot(&self.forward)), bounded(world.dot(&left)))
    }
}

fn bounded(number: f64) -> f32 {
    (number as f32).clamp(-BOUND, BOUND)
}

/// Those of some candidates with the smallest gaps, smallest first; of equals the one that came first.
struct Nearest {
    found: [(f64, usize); MOST_SEEN],
    count: usize,
}

impl Nearest {
    fn of(candidates: impl Iterator<Item = (f64, usize)>, most: usize) -> Self {
        let mut nearest = Self { found: [(f64::INFINITY, 0); MOST_SEEN], count: 0 };
        for (gap, index) in candidates.filter(|_| most > 0) {
            if nearest.count == most && gap >= nearest.found[most - 1].0 {
                continue;
            }
            let mut at = nearest.count.min(most - 1);
            while at > 0 && nearest.found[at - 1].0 > gap {
                nearest.found[at] = nearest.found[at - 1];
                at -= 1;
            }
            nearest.found[at] = (gap, index);
            nearest.count = (nearest.count + 1).min(most);
        }
        nearest
    }

    fn iter(&self) -> impl Iterator<Item = (f64, usize)> + '_ {
        self.found[..self.count].iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Team;
    use crate::horizon::Horizon;
    use crate::params::Profile;

    /// What every robot sees after `ticks` ticks with horizons of 20 steps.
    fn seen(scenario: &Scenario, seen: Seen, ticks: u64) -> Vec<Vec<f32>> {
        let params = Params::of(Profile::Paper);
        let observer = LocalObserver::new(scenario, &params, seen);
        let mut team = Team::new(scenario, &params, 0);
        let horizons = vec![Horizon::saturating(20); scenario.robots.len()];
        let mut last = Vec::new();
        for _ in 0..ticks {
            last = team.step(&horizons).to_vec();
        }
        (0..scenario.robots.len())
            .map(|robot| {
                let mut out = vec![f32::NAN; observer.width()];
                let position = team.measured()[robot];
                observer.observe(robot, team.tick(), position, last.get(robot), team.heard_by(robot), &mut out);
                out
            })
            .collect()
    }

    fn scenario(text: &str) -> Scenario {
        Scenario::from_toml(&format!("version = 1\n{text}"), "test", "test").unwrap()
    }

    const FACING: &str = "[[robot]]\nstart = [0, 0]\nset_point = [0, 20]\n[[robot]]\nstart = [0, 16]\nset_point = [0, 6]\n\
                          [[obstacle]]\nposition = [-3, 4]\nradius = 1.75\n";

    #[test]
    fn everything_is_in_the_robots_own_frame() {
        let all = seen(&scenario(FACING), Seen::default(), 0);
        let first = &all[0];
        assert_eq!(first.len(), 5 + 4 * 8 + 2 * 4);
        assert_eq!(first[..OWN], [2.0, 0.0, 0.0, 0.0, 0.0]);
        // 16 m ahead, 14.5 m above the separation owed, 10 m less to go, no plan yet.
        let expected = [1.0, 1.6, 0.0, 1.45, 0.0, -1.0, 0.0, 0.0];
        assert_eq!(first[OWN..OWN + 8], expected);
        assert_eq!(first[OWN + 8..OWN + 32], [0.0; 24]);
        // 4 m ahead and 3 m to the left; 5 m off, 1.5 + 1 m are owed.
        assert_eq!(first[OWN + 32..OWN + 36], [1.0, 0.4, 0.3, 0.25]);
        assert_eq!(first[OWN + 36..], [0.0; 4]);
    }

    #[test]
    fn plans_tell_speeds_horizons_and_conflicts() {
        let all = seen(&scenario(FACING), Seen::default(), 1);
        let (first, other) = (&all[0], &all[0][OWN..OWN + 8]);
        assert!(first[1] > 0.9 && (first[3] - 20.0 / 49.0).abs() < 1e-6, "{first:?}");
        assert!(other[4] > 0.9, "they close in at full speed: {other:?}");
        assert_eq!(other[6], first[3]);
        assert_eq!(other[7], 0.0, "{other:?}");
        let later = seen(&scenario(FACING), Seen::default(), 16);
        assert!(later[0][OWN + 7] > 0.5 && later[1][OWN + 7] > 0.5, "{:?}", later[0]);
        assert!((later[0][4] - 0.125).abs() < 1e-6, "one row: {:?}", later[0]);
    }

    #[test]
    fn the_nearest_are_seen_and_a_turned_world_looks_the_same() {
        let scenario = Scenario::resolve(Some("ex14_d"), None).unwrap();
        let mut turned = scenario.clone();
        let quarter = |p: Position| Position::new(-p.y, p.x);
        turned.robots.iter_mut().for_each(|robot| {
            (robot.start, robot.set_point) = (quarter(robot.start), quarter(robot.set_point));
        });
        turned.obstacles.iter_mut().for_each(|obstacle| obstacle.position = quarter(obstacle.position));
        for seen_of in [Seen::default(), Seen { neighbours: 13, obstacles: 3 }, Seen { neighbours: 0, obstacles: 0 }] {
            let (before, after) = (seen(&scenario, seen_of, 0), seen(&turned, seen_of, 0));
            for (before, after) in before.iter().zip(&after) {
                assert!(before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-5), "{before:?} {after:?}");
                let gaps: Vec<f32> = before[OWN..].as_chunks::<8>().0.iter().map(|numbers| numbers[3]).collect();
                assert!(gaps[..seen_of.neighbours].is_sorted(), "{gaps:?}");
            }
        }
    }

    #[test]
    fn no_number_leaves_its_bounds() {
        let far = scenario(
            "[[robot]]\nstart = [-1e6, 0]\nset_point = [1e6, 0]\n[[robot]]\nstart = [0, 0]\nset_point = [0, 0]\n",
        );
        for observation in seen(&far, Seen::default(), 2) {
            assert!(observation.iter().all(|number| number.abs() <= BOUND), "{observation:?}");
        }
    }
}

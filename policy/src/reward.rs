//! The reward R of the paper's section IV, term by term.
//!
//! R = sum over robots of (R_p - R_h - R_c + R_term) - R_v, once per tick. A tick leads from `x[k-1]` to
//! `x[k]` with the horizons N^{k-1}; De is how much nearer the set-point it brought the robot. The paper
//! prints the label of R_p twice; the second one is R_c.
//!
//! The paper's reward belongs to the team. What a robot earns for itself is either its share of that
//! ([`Share::total`]; R_v has no share) or the [`Share::objective`], which ranks as runs are ranked: by path and time.

use vodca::Position;
use vodca::horizon::Horizon;
use vodca::obstacles::Obstacles;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::separation::separation;
use vodca::step::Step;

/// R_p for coming no farther away.
const FORWARD: f64 = 25.0;
/// R_p per metre, 1/m.
const PER_METRE: f64 = 250.0;
/// lambda_h, R_h per step of the horizon.
const LAMBDA_H: f64 = 0.001;
/// R_c, to which the ticks that are left are added.
const COLLISION: f64 = 100.0;
/// R_term.
const ARRIVED: f64 = 150.0;
/// What a tick costs in the objective of a robot that has not arrived, m.
const TICK: f64 = 0.03;
/// What a tick in a collision costs in the objective, m.
const COLLIDED: f64 = 5.0;

/// What one tick was worth, summed over robots. The five terms have the paper's signs: progress and
/// arrival are gained, horizon, collision and variance are lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Terms {
    /// R_p, propagation.
    pub progress: f64,
    /// R_h, computation.
    pub horizon: f64,
    /// R_c, collision.
    pub collision: f64,
    /// R_term, termination.
    pub arrival: f64,
    /// R_v, the population variance of the horizons over the robots.
    pub variance: f64,
}

impl Terms {
    /// R, as the paper adds it up.
    pub fn total(&self) -> f64 {
        self.progress - self.horizon - self.collision + self.arrival - self.variance
    }
}

/// What one tick was worth to one robot. The paper's terms have its signs, as in [`Terms`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Share {
    /// R_p, propagation.
    pub progress: f64,
    /// R_h, computation.
    pub horizon: f64,
    /// R_c, collision.
    pub collision: f64,
    /// R_term, termination.
    pub arrival: f64,
    /// What it went farther than it came nearer, m; 0 on a straight line to the set-point.
    pub detour: f64,
}

impl Share {
    /// The robot's share of R: R_p - R_h - R_c + R_term.
    pub fn total(&self) -> f64 {
        self.progress - self.horizon - self.collision + self.arrival
    }

    /// Minus its detour, minus 0.03 m until it has arrived, minus 5 m in a collision. Over a run it adds up to how much
    /// longer than straight the path was, and to the time; nothing pays delay, as R_p and R_term do.
    pub fn objective(&self) -> f64 {
        let waiting = if self.arrived() { 0.0 } else { TICK };
        let collided = if self.collided() { COLLIDED } else { 0.0 };
        -self.detour - waiting - collided
    }

    /// Whether it is within the arrival tolerance of its set-point.
    pub fn arrived(&self) -> bool {
        self.arrival > 0.0
    }

    /// Whether its disc is in a collision.
    pub fn collided(&self) -> bool {
        self.collision > 0.0
    }
}

/// What a tick came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judgement {
    /// The terms of R.
    pub terms: Terms,
    /// Whether two discs are in collision: the episode terminates.
    pub collided: bool,
    /// Whether every robot is within the arrival tolerance of its set-point.
    pub arrived: bool,
}

/// Rewards the ticks of one episode.
#[derive(Clone, Debug)]
pub struct Reward {
    set_points: Vec<Position>,
    extra: Vec<f64>,
    obstacles: Obstacles,
    tolerance: f64,
    collision_distance: f64,
    max_ticks: u64,
}

impl Reward {
    /// For an episode of `scenario` with K = `scenario.max_ticks`.
    pub fn new(scenario: &Scenario, params: &Params) -> Self {
        let min_separation = params.model.min_separation;
        Self {
            set_points: scenario.robots.iter().map(|robot| robot.set_point).collect(),
            extra: scenario.robots.iter().map(|robot| robot.extra_radius(min_separation)).collect(),
            obstacles: scenario.standing(min_separation),
            tolerance: params.episode.arrival_tolerance,
            collision_distance: params.episode.collision_factor * min_separation,
            max_ticks: scenario.max_ticks,
        }
    }

    /// Rewards tick `tick` (from 0), in which robot i did `steps[i]`.
    pub fn tick(&self, tick: u64, steps: &[Step]) -> Judgement {
        let mut judgement = Judgement { arrived: true, ..Judgement::default() };
        for robot in 0..steps.len() {
            let share = self.share(tick, robot, steps);
            let terms = &mut judgement.terms;
            terms.progress += share.progress;
            terms.horizon += share.horizon;
            terms.collision += share.collision;
            terms.arrival += share.arrival;
            judgement.arrived &= share.arrived();
            judgement.collided |= share.collided();
        }
        judgement.terms.variance = variance(steps.iter().map(|step| step.horizon));
        judgement
    }

    /// What `robot` earns in tick `tick` (from 0), in which robot i did `steps[i]`.
    pub fn share(&self, tick: u64, robot: usize, steps: &[Step]) -> Share {
        let (step, set_point) = (&steps[robot], self.set_points[robot]);
        let (before, after) = ((set_point - step.position).norm(), (set_point - step.next_position).norm());
        let left = self.max_ticks.saturating_sub(tick + 1) as f64; // K - k, k counted after the move
        Share {
            progress: progress(before - after),
            horizon: LAMBDA_H * step.horizon.steps() as f64,
            collision: if self.collides(robot, steps) { COLLISION + left } else { 0.0 },
            arrival: if after < self.tolerance { ARRIVED } else { 0.0 },
            detour: (step.next_position - step.position).norm() - (before - after),
        }
    }

    /// Whether `robot` came nearer than the collision distance to anything during this tick.
    fn collides(&self, robot: usize, steps: &[Step]) -> bool {
        let motion = |step: &Step| (step.position, step.next_position);
        let own = motion(&steps[robot]);
        let near = |other, extra: f64| separation(own, other) - self.extra[robot] - extra < self.collision_distance;
        steps.iter().enumerate().any(|(j, step)| j != robot && near(motion(step), self.extra[j]))
            || self.obstacles.discs().iter().any(|disc| near((disc.centre, disc.centre), disc.extra))
            || self.hits_shape(robot, own)
    }

    fn hits_shape(&self, robot: usize, (from, to): (Position, Position)) -> bool {
        let limit = self.collision_distance + self.extra[robot];
        self.obstacles.separations(from, to, limit).any(|(_, separation)| separation < limit)
    }
}

/// R_p of one robot that came `nearer` metres nearer: 25 + 250 De, without the 25 when De < 0.
fn progress(nearer: f64) -> f64 {
    PER_METRE * nearer + if nearer >= 0.0 { FORWARD } else { 0.0 }
}

/// Population variance.
fn variance(horizons: impl Iterator<Item = Horizon> + Clone) -> f64 {
    let count = horizons.clone().count() as f64;
    let mean = horizons.clone().map(|horizon| horizon.steps() as f64).sum::<f64>() / count;
    horizons.map(|horizon| (horizon.steps() as f64 - mean).powi(2)).sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;
    use vodca::Input;
    use vodca::prediction::Prediction;
    use vodca::step::{Level, Status};

    fn step(from: [f64; 2], to: [f64; 2], horizon: u64) -> Step {
        let (position, next_position) = (Position::from(from), Position::from(to));
        Step {
            position,
            measured: position,
            input: Input::zeros(),
            next_position,
            next_measured: next_position,
            horizon: Horizon::new(horizon).unwrap(),
            rows: 0,
            level: Level::ClosedForm,
            status: Status::Solved,
            filtered: false,
            plan: Prediction::from_states(&[position, next_position], Position::zeros()),
            detect_ns: 0,
            solve_ns: 0,
            step_ns: 0,
        }
    }

    /// Two robots with set-points at (10, 0) and (0, 10), an obstacle at (5, 5), K = 350.
    fn reward() -> Reward {
        let text = "version = 1\n[[robot]]\nstart = [0, 0]\nset_point = [10, 0]\n\
                    [[robot]]\nstart = [0, 3]\nset_point = [0, 10]\n[[obstacle]]\nposition = [5, 5]\n";
        let scenario = Scenario::from_toml(text, "test", "test").unwrap();
        Reward::new(&scenario, &Params::paper())
    }

    #[test]
    fn the_terms_are_those_computed_by_hand() {
        // (moves, horizons) -> (R_p, R_h, R_c, R_term, R_v), all by hand from the paper's section IV.
        let still = ([0.0, 3.0], [0.0, 3.0]);
        type Move = ([f64; 2], [f64; 2]);
        let table: [(Move, Move, [u64; 2], [f64; 5]); 5] = [
            // 0.3 m nearer and standing still: 25 + 75 and 25.
            (([0.0, 0.0], [0.3, 0.0]), still, [20, 20], [125.0, 0.04, 0.0, 0.0, 0.0]),
            // 0.2 m away and standing still: -50 and 25; horizons 9 and 40: (31 / 2)^2.
            (([0.2, 0.0], [0.0, 0.0]), still, [9, 40], [-25.0, 0.049, 0.0, 0.0, 240.25]),
            // 0.05 m from its set-point after 0.25 m: 25 + 62.5 and 25, arrived.
            (([9.7, 0.0], [9.95, 0.0]), still, [1, 1], [112.5, 0.002, 0.0, 150.0, 0.0]),
            // 0.7 m apart, both collide: 2 (100 + 350 - 11).
            (([0.0, 2.3], [0.0, 2.3]), still, [1, 1], [50.0, 0.002, 878.0, 0.0, 0.0]),
            // Robot 0 passes 0.5 m beside the obstacle between two samples; one collision.
            (([4.0, 4.5], [6.0, 4.5]), still, [1, 1], [25.0 + 250.0 * 1.5, 0.002, 439.0, 0.0, 0.0]),
        ];
        for (first, second, horizons, expected) in table {
            let steps = [step(first.0, first.1, horizons[0]), step(second.0, second.1, horizons[1])];
            let Terms { progress, horizon, collision, arrival, variance } = reward().tick(10, &steps).terms;
            let found = [progress, horizon, collision, arrival, variance];
            let expected = if first.0 == [4.0, 4.5] {
                let nearer = (36.0f64 + 20.25).sqrt() - (16.0f64 + 20.25).sqrt();
                [50.0 + 250.0 * nearer, expected[1], expected[2], expected[3], expected[4]]
            } else {
                expected
            };
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{first:?}: {found} is not {expected}");
            }
        }
    }

    #[test]
    fn the_total_has_the_signs_of_the_paper() {
        let terms = Terms { progress: 1.0, horizon: 2.0, collision: 4.0, arrival: 8.0, variance: 16.0 };
        assert_eq!(terms.total(), 1.0 - 2.0 - 4.0 + 8.0 - 16.0);
    }

    #[test]
    fn the_team_earns_what_its_robots_earn_less_the_variance() {
        let steps = [step([9.7, 0.0], [9.95, 0.0], 9), step([0.0, 3.0], [0.4, 3.3], 40)];
        let Judgement { terms, .. } = reward().tick(10, &steps);
        let shares = [0, 1].map(|robot| reward().share(10, robot, &steps).total());
        assert_eq!(terms.total(), shares[0] + shares[1] - 15.5 * 15.5);
    }

    #[test]
    fn the_objective_adds_up_to_the_detour_and_the_time() {
        // Two moves of 0.5 m, off the straight line and back to it, then the last metre; 8 m are straight.
        let way = [[0.0, 0.0], [0.4, 0.3], [0.8, 0.0], [9.95, 0.0], [9.95, 0.0]];
        let apart = |from, to| [step(from, to, 1), step([0.0, 9.0], [0.0, 9.0], 1)];
        let all: f64 = way.windows(2).map(|move_| reward().share(0, 0, &apart(move_[0], move_[1])).objective()).sum();
        let detour = 0.5 + 0.5 + 9.15 - 9.95;
        assert!((all + detour + 2.0 * 0.03).abs() < 1e-9, "{all}");
        let close = [step([0.0, 0.0], [0.0, 0.0], 1), step([0.0, 0.74], [0.0, 0.74], 1)];
        assert!((reward().share(0, 0, &close).objective() + 5.03).abs() < 1e-9);
    }

    #[test]
    fn an_episode_knows_when_all_have_arrived_and_when_two_have_collided() {
        let there = [step([10.0, 0.0], [10.0, 0.05], 1), step([0.0, 10.0], [0.0, 10.0], 1)];
        let judgement = reward().tick(0, &there);
        assert!(judgement.arrived && !judgement.collided);
        let one = [step([10.0, 0.0], [10.0, 0.05], 1), step([0.0, 9.0], [0.0, 9.0], 1)];
        assert!(!reward().tick(0, &one).arrived);
        let close = [step([0.0, 0.0], [0.0, 0.0], 1), step([0.0, 0.74], [0.0, 0.74], 1)];
        assert!(reward().tick(0, &close).collided);
        let apart = [step([0.0, 0.0], [0.0, 0.0], 1), step([0.0, 0.76], [0.0, 0.76], 1)];
        assert!(!reward().tick(0, &apart).collided);
    }
}

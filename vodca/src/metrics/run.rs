//! The accumulator of a run's figures, used by the in-process team, the coordinator and offline.

use super::{RobotSummary, RunSummary, SEPARATION_TOLERANCE, SolverLevels, Statuses, TaskSummary};
use crate::Position;
use crate::obstacles::Obstacles;
use crate::params::Params;
use crate::scenario::Scenario;
use crate::separation::separation;
use crate::step::{Status, Step};
use crate::tasks::Assignment;

/// Larger than any rounding error of a distance between coordinates the scenario check accepts, m.
const ROUNDING: f64 = 1e-8;

/// Watches a run tick by tick. [`RunMetrics::observe`] allocates nothing.
#[derive(Clone, Debug)]
pub struct RunMetrics {
    sample_time: f64,
    arrival_tolerance: f64,
    limit: f64,
    /// What two usual discs keep, m.
    owed: f64,
    collision_distance: f64,
    obstacles: Obstacles,
    robots: Vec<Tally>,
    /// Own copy of this tick's motions, close together in memory.
    moves: Vec<(Position, Position)>,
    /// What each pair has done so far, `BELOW` and `COLLIDED`; row i holds robots, then obstacles.
    pairs: Vec<u8>,
    /// Whether any set-point has changed so far.
    has_tasks: bool,
    /// Nobody is ever done.
    endless: bool,
    ticks: u64,
    ticks_below: u64,
    ticks_collided: u64,
    levels: SolverLevels,
    statuses: Statuses,
}

const BELOW: u8 = 1;
const COLLIDED: u8 = 2;

#[derive(Clone, Debug)]
struct Tally {
    name: String,
    set_point: Position,
    straight_line: f64,
    extra: f64,
    /// Length of this tick's motion, m.
    travel: f64,
    path_length: f64,
    arrived_since: Option<u64>,
    /// Set-points that it has left again for the next one.
    done: u64,
    /// How long it stood at those, ticks.
    waited: u64,
    /// Its process has ended and nobody drives it.
    lost: bool,
    least: f64,
    activations: u64,
    ticks_with_rows: u64,
    fallback_steps: u64,
    infeasible: u64,
    filtered: u64,
}

impl RunMetrics {
    /// For a run of `scenario` (positions, radii) with `params` (h, min_separation, episode). What is
    /// already true at the start (arrived, separation) counts.
    pub fn new(scenario: &Scenario, params: &Params) -> Self {
        let min_separation = params.model.min_separation;
        let tolerance = params.episode.arrival_tolerance;
        let robots: Vec<Tally> = scenario
            .robots
            .iter()
            .map(|robot| {
                let straight_line = (robot.set_point - robot.start).norm();
                Tally {
                    name: robot.name.clone(),
                    set_point: robot.set_point,
                    straight_line,
                    extra: robot.extra_radius(min_separation),
                    travel: 0.0,
                    path_length: 0.0,
                    arrived_since: (straight_line < tolerance).then_some(0),
                    done: 0,
                    waited: 0,
                    lost: false,
                    least: f64::INFINITY,
                    activations: 0,
                    ticks_with_rows: 0,
                    fallback_steps: 0,
                    infeasible: 0,
                    filtered: 0,
                }
            })
            .collect();
        let obstacles = scenario.standing(min_separation);
        let mut metrics = Self {
            sample_time: params.model.sample_time,
            arrival_tolerance: tolerance,
            limit: min_separation - SEPARATION_TOLERANCE,
            owed: min_separation,
            collision_distance: params.episode.collision_factor * min_separation,
            moves: scenario.robots.iter().map(|robot| (robot.start, robot.start)).collect(),
            pairs: vec![0; robots.len() * (robots.len() + obstacles.count())],
            obstacles,
            robots,
            has_tasks: false,
            endless: false,
            ticks: 0,
            ticks_below: 0,
            ticks_collided: 0,
            levels: SolverLevels::default(),
            statuses: Statuses::default(),
        };
        metrics.observe_separations();
        metrics
    }

    /// The same of a run with tasks without end: it is a success although somebody is under way when it ends.
    #[must_use]
    pub fn endless(self) -> Self {
        Self { endless: true, ..self }
    }

    /// Takes in set-points that hold from the tick on that is observed next. The way to each counts from where its robot
    /// is.
    pub fn assign(&mut self, assignments: &[Assignment]) {
        for &Assignment { tick, robot, set_point } in assignments {
            let (at, robot) = (self.moves[robot].1, &mut self.robots[robot]);
            if let Some(arrived) = robot.arrived_since.take() {
                robot.done += 1;
                robot.waited += tick - arrived;
            } else {
                robot.straight_line -= (robot.set_point - at).norm(); // what it does not drive any more
            }
            robot.set_point = set_point;
            robot.straight_line += (set_point - at).norm();
            self.has_tasks = true;
        }
    }

    /// Takes in tick `tick`; `steps[i]` is robot i's. Call once per tick, ticks in order from 0.
    pub fn observe(&mut self, tick: u64, steps: &[Step]) {
        debug_assert_eq!(steps.len(), self.robots.len(), "one step per robot");
        self.ticks = tick + 1;
        for ((robot, motion), step) in self.robots.iter_mut().zip(&mut self.moves).zip(steps) {
            *motion = (step.position, step.next_position);
            robot.travel = (step.next_position - step.position).norm();
            robot.path_length += robot.travel;
            if (robot.set_point - step.next_position).norm() < self.arrival_tolerance {
                robot.arrived_since.get_or_insert(tick + 1);
            } else {
                robot.arrived_since = None;
            }
            robot.lost = step.status == Status::Lost;
            robot.activations += u64::from(step.rows);
            robot.ticks_with_rows += u64::from(step.rows > 0);
            robot.fallback_steps += u64::from(matches!(step.status, Status::Shifted | Status::Stopped));
            robot.infeasible += u64::from(matches!(step.status, Status::Relaxed | Status::Held));
            robot.filtered += u64::from(step.filtered);
            self.levels.count(step.level);
            self.statuses.count(step.status);
        }
        let least = self.observe_separations();
        self.ticks_below += u64::from(least < self.limit);
        self.ticks_collided += u64::from(least < self.collision_distance);
    }

    /// Separations of `self.moves`. Returns the least of them as far as it is below `limit` or
    /// `collision_distance`. A pair too far apart to matter costs one squared distance: the discs can
    /// close in by their travel at most.
    fn observe_separations(&mut self) -> f64 {
        let mut least = f64::INFINITY;
        let hazards = self.robots.len() + self.obstacles.count();
        let (limit, collision) = (self.limit, self.collision_distance);
        let broken = |found: f64| (BELOW * u8::from(found < limit)) | (COLLIDED * u8::from(found < collision));
        let interesting = limit.max(collision);
        for i in 0..self.robots.len() {
            let own = self.moves[i];
            let (head, tail) = self.robots.split_at_mut(i + 1);
            let robot = &mut head[i];
            for (j, other) in tail.iter_mut().enumerate() {
                let motion = self.moves[i + 1 + j];
                let extra = robot.extra + other.extra;
                let reach = interesting.max(robot.least).max(other.least) + robot.travel + other.travel + extra;
                if is_beyond(own.0 - motion.0, reach) {
                    continue;
                }
                let found = separation(own, motion) - extra;
                robot.least = robot.least.min(found);
                other.least = other.least.min(found);
                least = least.min(found);
                self.pairs[i * hazards + i + 1 + j] |= broken(found);
            }
            for (l, obstacle) in self.obstacles.discs().iter().enumerate() {
                let extra = robot.extra + obstacle.extra;
                let reach = interesting.max(robot.least) + robot.travel + extra;
                if is_beyond(own.0 - obstacle.centre, reach) {
                    continue;
                }
                let found = separation(own, (obstacle.centre, obstacle.centre)) - extra;
                robot.least = robot.least.min(found);
                least = least.min(found);
                self.pairs[i * hazards + self.moves.len() + l] |= broken(found);
            }
            let reach = interesting.max(robot.least) + robot.extra + ROUNDING;
            for (l, separation) in self.obstacles.separations(own.0, own.1, reach) {
                let found = separation - robot.extra;
                robot.least = robot.least.min(found);
                least = least.min(found);
                self.pairs[i * hazards + self.moves.len() + l] |= broken(found);
            }
        }
        least
    }

    /// Whether nobody is under way any more: everybody has arrived but lost robots, and those whose set-point a lost
    /// one closes ([`Self::shut_off`]). A run ends here.
    pub fn settled(&self) -> bool {
        (0..self.robots.len()).all(|robot| {
            let Tally { arrived_since, lost, .. } = self.robots[robot];
            lost || arrived_since.is_some() || self.is_shut_off(robot)
        })
    }

    /// Robots that drive and cannot arrive, because a lost one stands where they want to be.
    pub fn shut_off(&self) -> usize {
        (0..self.robots.len()).filter(|&robot| self.is_shut_off(robot)).count()
    }

    fn is_shut_off(&self, robot: usize) -> bool {
        let own = &self.robots[robot];
        !own.lost
            && self.robots.iter().zip(&self.moves).any(|(other, &(_, at))| {
                let owed = self.owed + own.extra + other.extra;
                other.lost && (own.set_point - at).norm() < owed - self.arrival_tolerance
            })
    }

    /// Robots that are lost now.
    pub fn lost(&self) -> usize {
        self.robots.iter().filter(|robot| robot.lost).count()
    }

    /// Whether every robot is within the arrival tolerance now.
    pub fn arrived_all(&self) -> bool {
        self.arrived() == self.robots.len()
    }

    /// Robots within the arrival tolerance now.
    pub fn arrived(&self) -> usize {
        self.robots.iter().filter(|robot| robot.arrived_since.is_some()).count()
    }

    /// Whether any two discs have collided so far.
    pub fn collided(&self) -> bool {
        self.pairs.iter().any(|pair| pair & COLLIDED != 0)
    }

    /// Smallest separation so far, m; `f64::INFINITY` when there is nothing to meet.
    pub fn min_separation(&self) -> f64 {
        self.robots.iter().map(|robot| robot.least).fold(f64::INFINITY, f64::min)
    }

    fn task_summary(&self) -> TaskSummary {
        let done: u64 = self.robots.iter().map(|robot| robot.done).sum();
        let arrivals = done + self.arrived() as u64;
        let share = |total: f64, count: u64| (count > 0).then(|| total / count as f64);
        let seconds = self.ticks as f64 * self.sample_time;
        let waited = self.robots.iter().map(|robot| robot.waited).sum::<u64>() as f64 * self.sample_time;
        TaskSummary {
            endless: self.endless,
            arrivals,
            per_minute: (seconds > 0.0).then(|| 60.0 * arrivals as f64 / seconds),
            mean_wait: share(waited, done),
            path_per_arrival: share(self.robots.iter().map(|robot| robot.path_length).sum(), arrivals),
        }
    }

    /// The figures so far.
    pub fn finish(&self) -> RunSummary {
        let hazards = self.robots.len() + self.obstacles.count();
        let pairs_with = |bit: u8| self.pairs.iter().filter(|&pair| pair & bit != 0).count() as u64;
        let in_collision = |i: usize| {
            let row = &self.pairs[i * hazards..(i + 1) * hazards];
            row.iter().any(|pair| pair & COLLIDED != 0) || (0..i).any(|j| self.pairs[j * hazards + i] & COLLIDED != 0)
        };
        let robots: Vec<RobotSummary> = self
            .robots
            .iter()
            .enumerate()
            .map(|(i, robot)| RobotSummary {
                name: robot.name.clone(),
                arrived_tick: robot.arrived_since,
                path_length: robot.path_length,
                straight_line: robot.straight_line,
                min_separation: finite(robot.least),
                collided: in_collision(i),
                activations: robot.activations,
                ticks_with_rows: robot.ticks_with_rows,
                fallback_steps: robot.fallback_steps,
                infeasible: robot.infeasible,
                filtered: robot.filtered,
            })
            .collect();
        let total = |figure: fn(&RobotSummary) -> u64| robots.iter().map(figure).sum::<u64>();
        let path_cost: f64 = robots.iter().map(|robot| robot.path_length).sum();
        let straight_line: f64 = robots.iter().map(|robot| robot.straight_line).sum();
        let collisions = pairs_with(COLLIDED);
        RunSummary {
            success: (self.arrived_all() || self.endless) && collisions == 0 && self.lost() == 0,
            ticks: self.ticks,
            completion_time: self.arrived_all().then_some(self.ticks as f64 * self.sample_time),
            path_cost,
            straight_line,
            path_ratio: (straight_line > 0.0).then(|| path_cost / straight_line),
            min_separation: finite(self.min_separation()),
            ticks_below_min_separation: self.ticks_below,
            pairs_below_min_separation: pairs_with(BELOW),
            collisions,
            ticks_collided: self.ticks_collided,
            robots_collided: total(|robot| u64::from(robot.collided)),
            activations: total(|robot| robot.activations),
            shut_off: self.shut_off() as u64,
            tasks: (self.has_tasks || self.endless).then(|| self.task_summary()),
            ticks_with_rows: total(|robot| robot.ticks_with_rows),
            infeasible: total(|robot| robot.infeasible),
            solver_levels: self.levels,
            statuses: self.statuses,
            filtered: total(|robot| robot.filtered),
            robots,
        }
    }
}

/// Whether `offset` is longer than `reach`, both in m, with certainty.
fn is_beyond(offset: Position, reach: f64) -> bool {
    let reach = (reach + ROUNDING).max(0.0);
    offset.norm_squared() > reach * reach
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
#[path = "run_tests.rs"]
mod tests;

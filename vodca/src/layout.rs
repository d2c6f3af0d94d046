//! What every robot knows for the whole run.

use crate::Position;
use crate::geometry::Disc;
use crate::obstacles::Obstacles;
use crate::params::Model;
use crate::scenario::{Obstacle, Scenario};
use crate::way::{Filling, Route, Ways};

/// Set-points, sizes, speeds and obstacles of a team.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Set-points by robot number, m.
    pub set_points: Vec<Position>,
    /// Radius of each robot beyond min_separation / 2, m.
    pub robot_extra: Vec<f64>,
    /// Bound on each robot's input per axis, m/s.
    pub max_speed: Vec<f64>,
    /// What stands.
    pub obstacles: Obstacles,
    /// Ways round the obstacles by robot number.
    pub routes: Vec<Route>,
    /// Ways to where a robot waits for its turn, by robot number.
    pub outside: Vec<Route>,
    /// Whose turn comes before whose.
    pub filling: Filling,
    /// By robot: how much more than the separation owed its set-point leaves to the nearest other set-point or
    /// obstacle, m.
    pub room: Vec<f64>,
}

impl Layout {
    /// The layout of a scenario; discs without a radius of their own have min_separation / 2, robots without a speed of
    /// their own `model.max_speed`.
    pub fn of(scenario: &Scenario, model: &Model) -> Self {
        let min_separation = model.min_separation;
        let set_points: Vec<Position> = scenario.robots.iter().map(|robot| robot.set_point).collect();
        let robot_extra: Vec<f64> = scenario.robots.iter().map(|robot| robot.extra_radius(min_separation)).collect();
        let obstacles = scenario.standing(min_separation);
        let owed: Vec<f64> = robot_extra.iter().map(|extra| min_separation + extra).collect();
        let places: Vec<Disc> =
            set_points.iter().zip(&robot_extra).map(|(&centre, &extra)| Disc { centre, extra }).collect();
        let room = (0..set_points.len())
            .map(|robot| {
                let left = |at: Position, extra: f64| (at - set_points[robot]).norm() - owed[robot] - extra;
                let others = (0..set_points.len()).filter(|&other| other != robot);
                let others = others.map(|other| left(set_points[other], robot_extra[other]));
                let near = obstacles.near(set_points[robot], 2.0 * owed[robot]);
                let discs = near.map(|solid| solid.seen_from(set_points[robot]));
                let all = others.chain(discs.map(|disc| left(disc.centre, disc.extra)));
                all.fold(f64::INFINITY, f64::min).max(0.0)
            })
            .collect::<Vec<f64>>();
        let max_speed = (0..set_points.len()).map(|robot| scenario.max_speed(robot, model.max_speed)).collect();
        let Ways { routes, outside, filling } = Ways::new(&places, &owed, &obstacles, min_separation);
        Self { set_points, robot_extra, max_speed, obstacles, routes, outside, filling, room }
    }

    /// The layout of a scenario in which lost robots stand: `lost` says where (m), by robot number. Their bodies are
    /// obstacles after the scenario's own.
    pub fn with_lost(scenario: &Scenario, model: &Model, lost: &[Option<Position>]) -> Self {
        let mut scenario = scenario.clone();
        for (robot, at) in scenario.robots.iter().zip(lost) {
            if let Some(position) = *at {
                scenario.obstacles.push(Obstacle { name: robot.name.clone(), position, radius: robot.radius });
            }
        }
        Self::of(&scenario, model)
    }

    /// Whether `robot` cannot make room at its set-point: two that stand side by side, each with a third of a
    /// separation to spare, let one through.
    pub fn is_tight(&self, robot: usize, min_separation: f64) -> bool {
        self.room[robot] < min_separation / 3.0 - 1e-6
    }

    /// The separation between `robot` and robot `other`, m, where two discs of the usual size keep `usual`.
    pub fn owed(&self, usual: f64, robot: usize, other: usize) -> f64 {
        usual + self.robot_extra[robot] + self.robot_extra[other]
    }

    /// The separation between `robot` and `obstacle`, m, where two discs of the usual size keep `usual`.
    pub fn owed_to_obstacle(&self, usual: f64, robot: usize, obstacle: &Disc) -> f64 {
        usual + self.robot_extra[robot] + obstacle.extra
    }
}

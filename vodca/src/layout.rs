//! What every robot knows for the whole run.

use crate::Position;
use crate::geometry::Disc;
use crate::scenario::{Obstacle, Scenario};
use crate::way::Filling;
use crate::way::Route;

/// Set-points, sizes and obstacles of a team.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Set-points by robot number, m.
    pub set_points: Vec<Position>,
    /// Radius of each robot beyond min_separation / 2, m.
    pub robot_extra: Vec<f64>,
    /// Obstacles with their radius beyond min_separation / 2, m.
    pub obstacles: Vec<Disc>,
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
    /// The layout of a scenario; discs without a radius of their own have min_separation / 2.
    pub fn of(scenario: &Scenario, min_separation: f64) -> Self {
        let set_points: Vec<Position> = scenario.robots.iter().map(|robot| robot.set_point).collect();
        let robot_extra: Vec<f64> = scenario.robots.iter().map(|robot| robot.extra_radius(min_separation)).collect();
        let obstacles = scenario.discs(min_separation);
        let owed: Vec<f64> = robot_extra.iter().map(|extra| min_separation + extra).collect();
        let places: Vec<Disc> =
            set_points.iter().zip(&robot_extra).map(|(&centre, &extra)| Disc { centre, extra }).collect();
        let room = (0..set_points.len())
            .map(|robot| {
                let left = |at: Position, extra: f64| (at - set_points[robot]).norm() - owed[robot] - extra;
                let others = (0..set_points.len()).filter(|&other| other != robot);
                let others = others.map(|other| left(set_points[other], robot_extra[other]));
                let all = others.chain(obstacles.iter().map(|disc| left(disc.centre, disc.extra)));
                all.fold(f64::INFINITY, f64::min).max(0.0)
            })
            .collect::<Vec<f64>>();
        let filling = Filling::new(&places, &obstacles, min_separation);
        let [routes, outside] = Route::of_team([&set_points, &filling.outside], &owed, &places, &obstacles);
        Self { set_points, robot_extra, obstacles, routes, outside, filling, room }
    }

    /// The layout of a scenario in which lost robots stand: `lost` says where (m), by robot number. Their bodies are
    /// obstacles after the scenario's own.
    pub fn with_lost(scenario: &Scenario, min_separation: f64, lost: &[Option<Position>]) -> Self {
        let mut scenario = scenario.clone();
        for (robot, at) in scenario.robots.iter().zip(lost) {
            if let Some(position) = *at {
                scenario.obstacles.push(Obstacle { name: robot.name.clone(), position, radius: robot.radius });
            }
        }
        Self::of(&scenario, min_separation)
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

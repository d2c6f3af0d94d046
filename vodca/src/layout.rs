//! What every robot knows for the whole run.

use crate::Position;
use crate::geometry::Disc;
use crate::route::Route;
use crate::scenario::Scenario;

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
}

impl Layout {
    /// The layout of a scenario; discs without a radius of their own have min_separation / 2.
    pub fn of(scenario: &Scenario, min_separation: f64) -> Self {
        let set_points: Vec<Position> = scenario.robots.iter().map(|robot| robot.set_point).collect();
        let robot_extra: Vec<f64> = scenario.robots.iter().map(|robot| robot.extra_radius(min_separation)).collect();
        let obstacles = scenario.discs(min_separation);
        let owed: Vec<f64> = robot_extra.iter().map(|extra| min_separation + extra).collect();
        let routes = Route::of_team(&set_points, &owed, &obstacles);
        Self { set_points, robot_extra, obstacles, routes }
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

//! What every robot knows for the whole run.

use shared::Position;
use shared::metrics::Disc;
use shared::scenario::Scenario;

/// Set-points, sizes and obstacles of a team.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Set-points by robot number, m.
    pub set_points: Vec<Position>,
    /// Radius of each robot beyond min_separation / 2, m.
    pub robot_extra: Vec<f64>,
    /// Obstacles with their radius beyond min_separation / 2, m.
    pub obstacles: Vec<Disc>,
}

impl Layout {
    /// The layout of a scenario; discs without a radius of their own have min_separation / 2.
    pub fn of(scenario: &Scenario, min_separation: f64) -> Self {
        Self {
            set_points: scenario.robots.iter().map(|robot| robot.set_point).collect(),
            robot_extra: scenario.robots.iter().map(|robot| robot.extra_radius(min_separation)).collect(),
            obstacles: scenario.discs(min_separation),
        }
    }
}

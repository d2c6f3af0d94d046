//! Where a robot looks: the shortest way round what stands, and who goes first on it (ARCHITECTURE, rules 12 to 15).
//!
//! A plan sees an obstacle only along its horizon and slides past on one side. Where another obstacle or a
//! robot that has arrived closes that side, it stays in the pocket for ever. The shortest way leads round.

mod chains;
mod corners;
mod filling;
mod ground;
mod lower_bound;
mod path;
pub mod right_of_way;
mod robot_set;
mod route;
mod standing;

pub use filling::Filling;
pub use lower_bound::LowerBound;
pub use path::Path;
pub use robot_set::RobotSet;
pub use route::{Rest, Route};
pub use standing::Standing;

use crate::Position;
use crate::geometry::Disc;
use crate::obstacles::Obstacles;
use corners::Corners;

/// The ways of a team.
#[derive(Clone, Debug)]
pub struct Ways {
    /// To the set-points, by robot.
    pub routes: Vec<Route>,
    /// To where a robot waits for its turn, by robot.
    pub outside: Vec<Route>,
    /// Whose turn comes before whose.
    pub filling: Filling,
}

impl Ways {
    /// The ways to `places` (set-points, with their robots' radii beyond min_separation / 2) past `obstacles`;
    /// `separations` are what each robot owes a disc of radius min_separation / 2, m.
    pub fn new(places: &[Disc], separations: &[f64], obstacles: &Obstacles, min_separation: f64) -> Self {
        let corners = Corners::of_team(separations, places, obstacles);
        let filling = Filling::new(places, &corners, min_separation);
        let ends: Vec<Position> = places.iter().map(|place| place.centre).collect();
        let routes = Route::of_team(&ends, separations, &corners);
        // Most wait for nobody.
        let outside = filling.outside.iter().enumerate().map(|(robot, &at)| {
            let waits = at != ends[robot];
            if waits {
                Route::new(robot, at, separations[robot], corners[robot].clone())
            } else {
                routes[robot].clone()
            }
        });
        let outside = outside.collect();
        Self { routes, outside, filling }
    }
}

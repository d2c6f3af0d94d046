//! What no team can be better than: the path and the time of robots that meet nobody.

use super::Route;
use super::corners::inscribed;
use crate::Position;
use crate::geometry::Disc;
use crate::params::Params;
use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;

/// Bounds of a layout from below, whatever the controllers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LowerBound {
    /// Sum of the shortest ways, m.
    pub path: f64,
    /// The slowest of these walks, s.
    pub time: f64,
}

impl LowerBound {
    /// The bounds of `scenario`: robots that arrive within `episode.arrival_tolerance`, with at most
    /// `model.max_speed` per axis, along ways round polygons that lie within what they owe the obstacles.
    pub fn of(scenario: &Scenario, params: &Params) -> Self {
        let (min_separation, speed) = (params.model.min_separation, params.model.max_speed);
        let tolerance = params.episode.arrival_tolerance;
        let inside = inscribed(scenario.obstacles.len());
        let obstacles: Vec<Disc> = (scenario.discs(min_separation).into_iter())
            .map(|disc| Disc { extra: disc.extra * inside, ..disc })
            .collect();
        let ends: Vec<Position> = scenario.robots.iter().map(|robot| robot.set_point).collect();
        let owed =
            (0..ends.len()).map(|robot| inside * (min_separation + scenario.extra_radius(robot, min_separation)));
        let [routes] = Route::of_team([&ends], &owed.collect::<Vec<f64>>(), &[], &obstacles);
        let walks = scenario.robots.iter().zip(&routes).map(|(robot, route)| {
            let (straight, length) = (robot.set_point - robot.start, route.path(robot.start).length);
            // A move is at most sqrt(2) times its largest axis long.
            let largest_axis = straight.amax().max(length / SQRT_2);
            ((length - tolerance).max(0.0), (largest_axis - tolerance).max(0.0) / speed)
        });
        walks.fold(Self { path: 0.0, time: 0.0 }, |bound, (length, time)| Self {
            path: bound.path + length,
            time: bound.time.max(time),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Profile;
    use crate::scenario::set_up;

    fn bound(name: &str) -> (LowerBound, Scenario) {
        let (scenario, params) = set_up(Some(name), None, Profile::Safe, &[]).unwrap();
        (LowerBound::of(&scenario, &params), scenario)
    }

    #[test]
    fn free_ways_are_straight_and_the_largest_axis_takes_the_time() {
        let (bound, scenario) = bound("two_setpoint");
        let slowest = scenario.robots.iter().map(|robot| ((robot.set_point - robot.start).amax() - 0.1) / 1.5);
        assert!((bound.path - (scenario.straight_line() - 0.2)).abs() < 1e-9);
        assert_eq!(bound.time, slowest.fold(0.0, f64::max));
    }

    #[test]
    fn round_an_obstacle_the_bound_is_just_below_two_tangents_and_an_arc() {
        let text = "version = 1\n[[robot]]\nstart = [-5, 0]\nset_point = [5, 0]\n[[obstacle]]\nposition = [0, 0]\n";
        let scenario = Scenario::from_toml(text, "test", "test").unwrap();
        let tangent = (25.0f64 - 1.5 * 1.5).sqrt();
        let shortest = 2.0 * tangent + 1.5 * 2.0 * (1.5f64 / 5.0).asin() - 0.1;
        let bound = LowerBound::of(&scenario, &Params::safe());
        assert!(bound.path <= shortest && bound.path > 0.98 * shortest, "{} of {shortest}", bound.path);
    }

    #[test]
    fn out_of_a_pocket_the_way_leads_round() {
        let (bound, scenario) = bound("pocket:6:0");
        assert!(bound.path > 1.3 * scenario.straight_line(), "{bound:?}");
    }
}

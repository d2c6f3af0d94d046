//! What no team can be better than: the path and the time of robots that meet nobody.

use crate::Position;
use crate::params::Params;
use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;
use std::sync::Arc;
use world::route::{ARC, Roadmap, Route};
use world::shape::{Obstacle, Obstacles, Shape};

/// Bounds of a layout from below, whatever the controllers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LowerBound {
    /// Sum of the shortest ways, m.
    pub path: f64,
    /// The slowest of these walks, s.
    pub time: f64,
}

impl LowerBound {
    /// The bounds of `scenario`: robots that arrive within `episode.arrival_tolerance`, with at most their speed per
    /// axis, along ways round polygons that lie within what they owe the obstacles.
    pub fn of(scenario: &Scenario, params: &Params) -> Self {
        let min_separation = params.model.min_separation;
        let tolerance = params.episode.arrival_tolerance;
        let obstacles = Arc::new(Obstacles::new(shrunk(scenario, min_separation)));
        let mut maps: Vec<(f64, Arc<Roadmap>)> = Vec::new();
        let walks = scenario.robots.iter().enumerate().map(|(number, robot)| {
            let clearance = INSIDE * robot.radius.unwrap_or(min_separation / 2.0);
            let known = maps.iter().find(|(size, _)| *size == clearance).map(|(_, map)| map.clone());
            let map = known.unwrap_or_else(|| {
                maps.push((clearance, Arc::new(Roadmap::new(obstacles.clone(), clearance))));
                maps[maps.len() - 1].1.clone()
            });
            let length = shortest(&map, robot.start, robot.set_point);
            // A move is at most sqrt(2) times its largest axis long.
            let largest_axis = (robot.set_point - robot.start).amax().max(length / SQRT_2);
            let speed = scenario.max_speed(number, params.model.max_speed);
            ((length - tolerance).max(0.0), (largest_axis - tolerance).max(0.0) / speed)
        });
        walks.fold(Self { path: 0.0, time: 0.0 }, |bound, (length, time)| Self {
            path: bound.path + length,
            time: bound.time.max(time),
        })
    }
}

/// The router walks round polygons whose corners are 1 / `INSIDE` as far from what they go round as its arcs are. With
/// all arcs smaller by this share the polygons lie within what is owed (they are convex, and their corners do), so
/// that no way that keeps everything is shorter than theirs.
const INSIDE: f64 = {
    // cos(ARC / 2) from below, by its Taylor series, as const functions have no cosine.
    let x2 = ARC * ARC / 4.0;
    1.0 - x2 / 2.0 + x2 * x2 / 24.0 - x2 * x2 * x2 / 720.0
};

/// What stands, with all round parts smaller by [`INSIDE`].
fn shrunk(scenario: &Scenario, min_separation: f64) -> Vec<Obstacle> {
    let discs = scenario.obstacles.iter().map(|disc| {
        let radius = disc.radius.unwrap_or(min_separation / 2.0);
        (disc.name.as_str(), Shape::Disc { centre: disc.position, radius: radius * INSIDE })
    });
    let shapes = scenario.shapes.iter().map(|shape| match shape.shape().clone() {
        Shape::Wall { points, thickness } => (shape.name(), Shape::Wall { points, thickness: thickness * INSIDE }),
        other => (shape.name(), other),
    });
    // What was checked at full size is still in order.
    discs.chain(shapes).filter_map(|(name, shape)| Obstacle::new(name, shape).ok()).collect()
}

/// The length of the shortest way; the straight line where a robot starts nearer than it should, or no way is found.
fn shortest(map: &Arc<Roadmap>, start: Position, set_point: Position) -> f64 {
    let straight = (set_point - start).norm();
    let way = || Route::new(map.clone(), set_point).ok()?.length(start);
    if map.is_open(start, map.clearance()) { way().unwrap_or(straight) } else { straight }
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
    fn the_polygons_lie_within_what_is_owed() {
        assert!(INSIDE <= (ARC / 2.0).cos() && INSIDE > (ARC / 2.0).cos() - 1e-6);
    }

    #[test]
    fn round_walls_and_polygons_no_way_is_shorter() {
        // Round a wall's end and past a corner: two tangents and an arc each, drawn by hand.
        let text = "version = 1\n[[robot]]\nstart = [-5, 0]\nset_point = [5, 0]\n\
                    [[obstacle]]\nwall = [[0, -99], [0, 0]]\nthickness = 0.5\n";
        let scenario = Scenario::from_toml(text, "test", "test").unwrap();
        let owed: f64 = 0.75 + 0.25;
        let shortest = 2.0 * (25.0 - owed * owed).sqrt() + owed * 2.0 * (owed / 5.0).asin() - 0.1;
        let bound = LowerBound::of(&scenario, &Params::safe());
        assert!(bound.path <= shortest && bound.path > 0.98 * shortest, "{} of {shortest}", bound.path);
        let text =
            text.replace("wall = [[0, -99], [0, 0]]\nthickness = 0.5", "polygon = [[-1, -99], [1, -99], [0, 0]]");
        let scenario = Scenario::from_toml(&text, "test", "test").unwrap();
        let shortest = 2.0 * (25.0 - 0.75f64 * 0.75).sqrt() + 0.75 * 2.0 * (0.75f64 / 5.0).asin() - 0.1;
        let bound = LowerBound::of(&scenario, &Params::safe());
        assert!(bound.path <= shortest && bound.path > 0.98 * shortest, "{} of {shortest}", bound.path);
    }

    #[test]
    fn slow_robots_take_their_time() {
        let (_, mut scenario) = bound("two_setpoint");
        let before = LowerBound::of(&scenario, &Params::safe());
        scenario.robots.iter_mut().for_each(|robot| robot.max_speed = Some(0.75));
        let after = LowerBound::of(&scenario, &Params::safe());
        assert_eq!((after.path, after.time), (before.path, 2.0 * before.time));
    }

    #[test]
    fn out_of_a_pocket_the_way_leads_round() {
        let (bound, scenario) = bound("pocket:6:0");
        assert!(bound.path > 1.3 * scenario.straight_line(), "{bound:?}");
    }
}

//! What no team can be better than: the path and the time of robots that meet nobody.

use crate::Position;
use crate::layout::Layout;

/// Bounds of a layout from below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Sum of the shortest ways, m.
    pub path: f64,
    /// The slowest of these walks, s.
    pub time: f64,
}

impl Bounds {
    /// The bounds of a team that starts at `starts` and whose speed is bounded by `max_speed` (m/s) per axis. Ways
    /// round obstacles run along polygons, up to 2 % longer than the arcs that are possible (10 % where obstacles
    /// are many); a free way counts as it is.
    pub fn of(layout: &Layout, starts: &[Position], max_speed: f64) -> Self {
        let walk = |(start, route): (&Position, &crate::route::Route)| {
            let path = route.path(*start);
            let from = std::iter::once(start).chain(path.points());
            let time: f64 = from.zip(path.points()).map(|(from, to)| (to - from).amax() / max_speed).sum();
            (path.length, time)
        };
        starts.iter().zip(&layout.routes).map(walk).fold(Self { path: 0.0, time: 0.0 }, |bounds, (length, time)| Self {
            path: bounds.path + length,
            time: bounds.time.max(time),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    fn bounds(name: &str) -> (Bounds, Scenario) {
        let scenario = Scenario::resolve(Some(name), None).unwrap();
        let starts: Vec<Position> = scenario.robots.iter().map(|robot| robot.start).collect();
        (Bounds::of(&Layout::of(&scenario, 1.5), &starts, 1.5), scenario)
    }

    #[test]
    fn free_ways_are_straight_and_the_largest_axis_takes_the_time() {
        let (bounds, scenario) = bounds("two_setpoint");
        let slowest = scenario.robots.iter().map(|robot| (robot.set_point - robot.start).amax() / 1.5);
        assert!((bounds.path - scenario.straight_line()).abs() < 1e-9);
        assert_eq!(bounds.time, slowest.fold(0.0, f64::max));
    }

    #[test]
    fn out_of_a_pocket_the_way_leads_round() {
        let (bounds, scenario) = bounds("pocket:6:0");
        assert!(bounds.path > 1.3 * scenario.straight_line(), "{bounds:?}");
    }
}

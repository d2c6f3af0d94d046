//! Ways round the obstacles: where a robot has to look to walk the shortest one to its set-point.
//!
//! A plan sees an obstacle only along its horizon and slides past on one side. Where another obstacle or a
//! robot that has arrived closes that side, it stays in the pocket for ever. The shortest way leads round.

use crate::Position;
use crate::geometry::Disc;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Corners of the polygon that is walked round an obstacle, fewest and most: 10 % and 2 % longer than its
/// circle.
const CORNERS: (usize, usize) = (6, 12);
/// Corners in all, where there are many obstacles: the work grows with their square times the obstacles.
const TOGETHER: usize = 600;
/// By how much a way may cut into a disc, as a share of its radius: robots slide along it.
const CUT: f64 = 1e-3;
/// Nearer corners than this have been reached, m.
const REACHED: f64 = 1e-6;

/// A disc that the centre of a robot must not enter.
#[derive(Clone, Copy, Debug)]
struct Closed {
    centre: Position,
    radius: f64,
}

/// The corners round a set of obstacles that robots of one size can reach, and who sees whom.
#[derive(Debug)]
struct Corners {
    closed: Vec<Closed>,
    at: Vec<Position>,
    /// By corner: the other corners in a straight line from it.
    seen: Vec<Vec<usize>>,
}

impl Corners {
    /// The corners round `obstacles`; `separation` is what is owed to a disc of radius min_separation / 2, m.
    fn new(obstacles: &[Disc], separation: f64) -> Self {
        let closed: Vec<Closed> =
            obstacles.iter().map(|disc| Closed { centre: disc.centre, radius: separation + disc.extra }).collect();
        let corners = (TOGETHER / closed.len().max(1)).clamp(CORNERS.0, CORNERS.1);
        let out = 1.0 / (PI / corners as f64).cos();
        let round = |disc: &Closed| {
            let (centre, radius) = (disc.centre, disc.radius * out);
            (0..corners).map(move |corner| {
                let (sin, cos) = (TAU * corner as f64 / corners as f64).sin_cos();
                centre + Position::new(cos, sin) * radius
            })
        };
        let at: Vec<Position> = closed.iter().flat_map(round).filter(|corner| is_open(&closed, *corner)).collect();
        let sees = |from: usize, to: usize| from != to && is_free(&closed, at[from], at[to]);
        let seen = (0..at.len()).map(|from| (0..at.len()).filter(|to| sees(from, *to)).collect()).collect();
        Self { closed, at, seen }
    }
}

/// All ways of one robot to its set-point.
#[derive(Clone, Debug)]
pub struct Route {
    set_point: Position,
    corners: Arc<Corners>,
    /// By corner: what is left from there to the set-point, m; infinite where no way leads on.
    left: Vec<f64>,
}

impl Route {
    /// The routes of a team past its obstacles. `set_points` and `separations` (what each robot owes a disc of
    /// radius min_separation / 2, m) are by robot.
    pub fn of_team(set_points: &[Position], separations: &[f64], obstacles: &[Disc]) -> Vec<Self> {
        let mut sizes: Vec<(f64, Arc<Corners>)> = Vec::new();
        let route = |(set_point, separation): (&Position, &f64)| {
            let known = sizes.iter().find(|(size, _)| size == separation).map(|(_, corners)| corners.clone());
            let corners = known.unwrap_or_else(|| {
                let corners = Arc::new(Corners::new(obstacles, *separation));
                sizes.push((*separation, corners.clone()));
                corners
            });
            Self::new(*set_point, corners)
        };
        set_points.iter().zip(separations).map(route).collect()
    }

    /// Shortest ways from every corner (Dijkstra 1959).
    fn new(set_point: Position, corners: Arc<Corners>) -> Self {
        let Corners { closed, at, seen } = &*corners;
        let straight = |from: &Position| {
            if is_free(closed, *from, set_point) { (set_point - from).norm() } else { f64::INFINITY }
        };
        let mut left: Vec<f64> = at.iter().map(straight).collect();
        let mut open: Vec<usize> = (0..at.len()).collect();
        while let Some(nearest) = (0..open.len()).min_by(|a, b| left[open[*a]].total_cmp(&left[open[*b]])) {
            let corner = open.swap_remove(nearest);
            for &other in &seen[corner] {
                left[other] = left[other].min(left[corner] + (at[other] - at[corner]).norm());
            }
        }
        Self { set_point, corners, left }
    }

    /// Where a robot at `from` (m) has to look: the set-point itself where nothing is between, else the next
    /// corner of the shortest way, as far off as that way is long. The set-point where no way leads out.
    pub fn aim(&self, from: Position) -> Position {
        let Corners { closed, at, .. } = &*self.corners;
        if is_free(closed, from, self.set_point) {
            return self.set_point;
        }
        let mut aim = self.set_point;
        let mut shortest = f64::INFINITY;
        for (corner, left) in at.iter().zip(&self.left) {
            let near = (corner - from).norm();
            let way = near + left;
            if near > REACHED && way < shortest && is_free(closed, from, *corner) {
                shortest = way;
                aim = from + (corner - from) * (way / near);
            }
        }
        aim
    }
}

/// Whether a robot can stand there.
fn is_open(closed: &[Closed], point: Position) -> bool {
    closed.iter().all(|disc| (point - disc.centre).norm() >= disc.radius * (1.0 - CUT))
}

/// Whether the straight way keeps out of every disc. One that starts inside may lead out, not deeper.
fn is_free(closed: &[Closed], from: Position, to: Position) -> bool {
    let way = to - from;
    let length_2 = way.norm_squared();
    closed.iter().all(|disc| {
        let along = (disc.centre - from).dot(&way);
        if along <= 0.0 {
            return true; // The disc lies behind.
        }
        let nearest = from + way * (along / length_2).min(1.0);
        (nearest - disc.centre).norm() >= disc.radius * (1.0 - CUT)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn route(set_point: (f64, f64), obstacles: &[(f64, f64)]) -> Route {
        let discs: Vec<Disc> =
            obstacles.iter().map(|(x, y)| Disc { centre: Position::new(*x, *y), extra: 0.0 }).collect();
        Route::of_team(&[Position::new(set_point.0, set_point.1)], &[1.5], &discs).remove(0)
    }

    /// Walks along the aim in small steps: (arrived, length of the way, least distance to an obstacle).
    fn walk(route: &Route, from: (f64, f64)) -> (bool, f64, f64) {
        const STEP: f64 = 0.02;
        let (mut here, mut length, mut least) = (Position::new(from.0, from.1), 0.0, f64::INFINITY);
        for _ in 0..10_000 {
            least = route.corners.closed.iter().map(|disc| (here - disc.centre).norm()).fold(least, f64::min);
            let rest = route.set_point - here;
            if rest.norm() <= STEP {
                return (true, length + rest.norm(), least);
            }
            here += (route.aim(here) - here).normalize() * STEP;
            length += STEP;
        }
        (false, length, least)
    }

    #[test]
    fn a_free_way_is_straight() {
        let route = route((10.0, 0.0), &[(5.0, 1.6)]);
        assert_eq!(route.aim(Position::zeros()), Position::new(10.0, 0.0));
    }

    #[test]
    fn round_one_obstacle_the_way_is_two_tangents_and_an_arc() {
        let (arrived, length, least) = walk(&route((10.0, 0.0), &[(5.0, 0.1)]), (0.0, 0.0));
        let tangent = (5.0f64 * 5.0 + 0.1 * 0.1 - 1.5 * 1.5).sqrt();
        let turn = 2.0 * (1.5f64 / 5.001).asin() - 2.0 * (0.1f64 / 5.0).atan();
        let shortest = 2.0 * tangent + 1.5 * turn;
        assert!(arrived && least > 1.49, "{least}");
        assert!(length > shortest - 0.05 && length < 1.02 * shortest, "{length} against {shortest}");
    }

    #[test]
    fn a_pocket_between_two_obstacles_is_walked_round() {
        // 2.4 m apart: too narrow for a robot that keeps 1.5 m from both.
        let (arrived, _, least) = walk(&route((10.0, 0.0), &[(5.0, 1.3), (5.0, -1.1)]), (0.0, 0.0));
        assert!(arrived && least > 1.49, "{least}");
    }

    #[test]
    fn who_is_shut_in_looks_at_the_set_point() {
        let ring: Vec<(f64, f64)> = (0..8).map(|k| (TAU * f64::from(k) / 8.0).sin_cos()).collect();
        let ring: Vec<(f64, f64)> = ring.iter().map(|(sin, cos)| (2.0 * cos, 2.0 * sin)).collect();
        assert_eq!(route((10.0, 0.0), &ring).aim(Position::zeros()), Position::new(10.0, 0.0));
    }

    #[test]
    fn robots_of_other_sizes_have_ways_of_their_own() {
        let discs = [Disc { centre: Position::new(5.0, 1.6), extra: 0.0 }];
        let goal = Position::new(10.0, 0.0);
        let routes = Route::of_team(&[goal; 3], &[1.5, 1.5, 2.0], &discs);
        assert_eq!(routes[1].aim(Position::zeros()), goal);
        assert!(routes[2].aim(Position::zeros()).y < 0.0);
        assert!(Arc::ptr_eq(&routes[0].corners, &routes[1].corners));
    }

    proptest! {
        #[test]
        fn every_way_is_free_and_ends_at_the_set_point(
            obstacles in prop::collection::vec((0.0..20.0, 0.0..20.0), 0..8),
        ) {
            // From corner to corner outside the box, so that a way always exists.
            let route = route((23.0, 23.0), &obstacles);
            let (arrived, _, least) = walk(&route, (-3.0, -3.0));
            prop_assert!(arrived);
            prop_assert!(least > 1.5 * (1.0 - CUT) - 0.02, "{}", least);
        }
    }
}

//! The shortest ways of one robot round what stands, from anywhere to its set-point.

use super::corners::{Closed, Corners, Leg, between};
use super::ground::Ground;
use super::path::{Path, REACHED};
use super::robot_set::RobotSet;
use crate::Position;
use std::f64::consts::TAU;
use std::sync::Arc;

/// All ways of one robot to its set-point.
#[derive(Clone, Debug)]
pub struct Route {
    set_point: Position,
    corners: Arc<Corners>,
    /// By corner: the set-points between it and the end of the way; `None`: an obstacle is.
    sees_end: Vec<Option<RobotSet>>,
    /// Places right before the set-point from which a robot gets in between those who stand beside it, and the
    /// set-points between there and the end, and between each corner and the end by that way.
    entry: Position,
    inwards: RobotSet,
    sees_entry: Vec<Option<RobotSet>>,
    /// The rest of the way while nobody stands.
    alone: Rest,
}

/// What is left of a robot's way from every corner while certain robots stand.
#[derive(Clone, Debug, Default)]
pub struct Rest {
    standing: RobotSet,
    /// By corner: what is left from there, m; infinite where no way leads on.
    left: Vec<f64>,
    /// By corner: where the way leads next.
    next: Vec<Next>,
    open: Vec<usize>,
}

/// Where a way leads from a corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Next {
    /// Straight to its end.
    #[default]
    End,
    /// To the entry, then to its end.
    Entry,
    /// To another corner.
    Corner(usize),
}

impl Rest {
    /// Room for `route`.
    pub fn of(route: &Route) -> Self {
        let corners = route.alone.left.len();
        Self { open: Vec::with_capacity(corners), ..route.alone.clone() }
    }
}

impl Route {
    /// The routes of a team to `ends` (m, by robot), each past what `corners` are round for its robot.
    pub(super) fn of_team(ends: &[Position], separations: &[f64], corners: &[Arc<Corners>]) -> Vec<Self> {
        let route =
            |(robot, end): (usize, &Position)| Self::new(robot, *end, separations[robot], corners[robot].clone());
        ends.iter().enumerate().map(route).collect()
    }

    pub(super) fn new(robot: usize, set_point: Position, separation: f64, corners: Arc<Corners>) -> Self {
        let Corners { ground, places, at, .. } = &*corners;
        let sees = |to: Position| -> Vec<Option<RobotSet>> {
            at.iter().map(|from| ground.is_free(*from, to).then(|| between_but(places, robot, *from, to))).collect()
        };
        let reach = 2.0 * places.get(robot).map_or(separation, |own| own.radius);
        let entry = entry(ground, places, robot, set_point, reach);
        let inwards = between_but(places, robot, entry, set_point);
        let sees_end = sees(set_point);
        let sees_entry = sees(entry).into_iter().map(|between| between.map(|between| between.with(inwards))).collect();
        let mut route =
            Self { set_point, corners: corners.clone(), sees_end, entry, inwards, sees_entry, alone: Rest::default() };
        let mut rest = Rest { left: vec![0.0; at.len()], next: vec![Next::End; at.len()], ..Rest::default() };
        route.walk_back(RobotSet::default(), &mut rest);
        route.alone = rest;
        route
    }

    /// Shortest ways from every corner while `standing` are in the way (Dijkstra 1959).
    fn walk_back(&self, standing: RobotSet, rest: &mut Rest) {
        let Corners { ground, at, fixed, seen, .. } = &*self.corners;
        let Rest { left, next, open, .. } = rest;
        let used = if standing.is_empty() { *fixed } else { at.len() };
        let clear = |between: &Option<RobotSet>| between.is_some_and(|between| !between.meets(&standing));
        let cost = |from: Position, to: Position| (to - from).norm() + ground.toll(from, to);
        let last = cost(self.entry, self.set_point);
        for (corner, (left, next)) in left.iter_mut().zip(next.iter_mut()).enumerate() {
            *next = Next::End;
            *left = if corner >= used {
                f64::INFINITY
            } else if clear(&self.sees_end[corner]) {
                cost(at[corner], self.set_point)
            } else if clear(&self.sees_entry[corner]) {
                *next = Next::Entry;
                cost(at[corner], self.entry) + last
            } else {
                f64::INFINITY
            };
        }
        open.clear();
        open.extend(0..used);
        while let Some(nearest) = (0..open.len()).min_by(|a, b| left[open[*a]].total_cmp(&left[open[*b]])) {
            let corner = open.swap_remove(nearest);
            if left[corner].is_infinite() {
                break;
            }
            for Leg { to, between, toll } in &seen[corner] {
                if *to < used && !between.meets(&standing) {
                    let way = left[corner] + (at[*to] - at[corner]).norm() + toll;
                    if way < left[*to] {
                        (left[*to], next[*to]) = (way, Next::Corner(corner));
                    }
                }
            }
        }
        rest.standing = standing;
    }

    /// What never moves, for its robot.
    pub(super) fn ground(&self) -> &Ground {
        &self.corners.ground
    }

    /// Where it ends, m.
    pub fn end(&self) -> Position {
        self.set_point
    }

    /// Where a robot at `from` (m) has to look while nobody stands: the set-point itself where nothing is between,
    /// else the next corner of the shortest way, as far off as that way is long. The set-point where no way leads out.
    pub fn aim(&self, from: Position) -> Position {
        self.path(from).ahead(from)
    }

    /// The shortest way from `from` while nobody stands.
    pub fn path(&self, from: Position) -> Path {
        let ground = &self.corners.ground;
        let straight = Path::straight(from, self.set_point);
        if !ground.is_free(from, self.set_point) {
            return self.path_past(from, RobotSet::default(), &self.alone).unwrap_or(straight);
        }
        let toll = ground.toll(from, self.set_point);
        let straight = straight.of_length(straight.length + toll);
        let round =
            || self.path_past(from, RobotSet::default(), &self.alone).filter(|round| round.length < straight.length);
        if toll > 0.0 { round().unwrap_or(straight) } else { straight }
    }

    /// The same round those of `standing` who are in the way; as if they were not there where no way leads
    /// round them.
    ///
    /// `tight` are those of them who cannot make room. The others are walked round only where that is no more
    /// than `price` (m) longer for each of them that would have to.
    pub fn path_round(
        &self,
        from: Position,
        standing: RobotSet,
        tight: RobotSet,
        price: f64,
        rests: &mut [Rest; 2],
    ) -> Path {
        let [rest, rest_tight] = rests;
        let alone = self.path(from);
        if standing.is_empty() || self.is_clear(from, &alone, standing) {
            return alone;
        }
        let round = self.shortest(from, alone, standing, rest);
        if tight == standing {
            return round;
        }
        let through = self.shortest(from, alone, tight, rest_tight);
        let moved = self.met(from, &through).among(&standing).count();
        if round.length <= through.length + price * f64::from(moved) { round } else { through }
    }

    /// The set-points that a path leads over.
    fn met(&self, from: Position, path: &Path) -> RobotSet {
        let starts = std::iter::once(&from).chain(path.points());
        let mut met = RobotSet::default();
        for (from, to) in starts.zip(path.points()) {
            let between = between(&self.corners.places, *from, *to);
            met = met.with(between);
        }
        met
    }

    fn shortest(&self, from: Position, alone: Path, standing: RobotSet, rest: &mut Rest) -> Path {
        let Corners { ground, places, .. } = &*self.corners;
        let is_clear =
            |from: Position, to: Position| standing.is_empty() || !between(places, from, to).meets(&standing);
        if standing.is_empty() || self.is_clear(from, &alone, standing) {
            return alone;
        }
        let mut best: Option<Path> = None;
        if !self.inwards.meets(&standing) && ground.is_free(from, self.entry) && is_clear(from, self.entry) {
            let mut through = Path::straight(from, self.entry);
            through.push(self.set_point);
            through.length += (self.set_point - self.entry).norm();
            through.length += ground.toll(from, self.entry) + ground.toll(self.entry, self.set_point);
            best = Some(through);
        }
        if rest.standing != standing {
            self.walk_back(standing, rest);
        }
        let round = self.path_past(from, standing, rest);
        best = match (best, round) {
            (Some(through), Some(round)) if round.length < through.length => Some(round),
            (through, round) => through.or(round),
        };
        best.unwrap_or(alone.of_length(f64::INFINITY))
    }

    /// Whether nobody of `standing` is in the way of `path`, which keeps clear of the obstacles.
    fn is_clear(&self, from: Position, path: &Path, standing: RobotSet) -> bool {
        let starts = std::iter::once(&from).chain(path.points());
        starts.zip(path.points()).all(|(from, to)| !between(&self.corners.places, *from, *to).meets(&standing))
    }

    fn path_past(&self, from: Position, standing: RobotSet, rest: &Rest) -> Option<Path> {
        let Corners { ground, places, at, .. } = &*self.corners;
        // A roadmap knows at which of its corners a taut way may bend: most need no closer look.
        let map = ground.roadmap().filter(|map| map.is_outside(from));
        let may_bend = |corner| map.is_none_or(|map| corner >= map.corners().len() || map.may_bend(from, corner));
        let (mut first, mut shortest) = (None, f64::INFINITY);
        for (corner, (place, left)) in at.iter().zip(&rest.left).enumerate() {
            let near = (place - from).norm();
            let way = near + left;
            let free = || {
                may_bend(corner)
                    && ground.is_free(from, *place)
                    && (standing.is_empty() || !between(places, from, *place).meets(&standing))
            };
            if near > REACHED && way < shortest {
                let way = way + ground.toll(from, *place);
                if way < shortest && free() {
                    (first, shortest) = (Some(corner), way);
                }
            }
        }
        let mut corner = first?;
        let mut path = Path::straight(from, at[corner]).of_length(shortest);
        loop {
            match rest.next[corner] {
                Next::Corner(next) => {
                    path.push(at[next]);
                    corner = next;
                }
                Next::Entry => {
                    path.push(self.entry);
                    path.push(self.set_point);
                    return Some(path);
                }
                Next::End => {
                    path.push(self.set_point);
                    return Some(path);
                }
            }
        }
    }
}

/// [`between`], without the place of `robot` itself.
fn between_but(places: &[Closed], robot: usize, from: Position, to: Position) -> RobotSet {
    between(places, from, to).without(robot)
}

/// The place `reach` (two separations, m) before the set-point of `robot` from where it gets in between all others
/// with the most room.
fn entry(ground: &Ground, places: &[Closed], robot: usize, set_point: Position, reach: f64) -> Position {
    const DIRECTIONS: usize = 128;
    let others = || {
        let places = places.iter().enumerate().filter(|(other, _)| *other != robot).map(|(_, place)| place);
        ground.discs().iter().chain(places).filter(|disc| (disc.centre - set_point).norm() < 3.0 * disc.radius)
    };
    let room = |to: Position| {
        let way = to - set_point;
        let left = |disc: &Closed| {
            let along = ((disc.centre - set_point).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
            (set_point + way * along - disc.centre).norm() - disc.radius
        };
        let ahead = |disc: &Closed| (set_point + way * 0.5 - disc.centre).norm() - disc.radius;
        let narrowest = others().map(left).fold(ground.room(set_point, to, 3.0 * reach), f64::min);
        // Where it is as narrow at the set-point itself whatever the direction, what opens most.
        narrowest.min(1.0) + 1e-3 * others().map(ahead).fold(f64::INFINITY, f64::min).min(1.0)
    };
    let at = |direction: usize| {
        let (sin, cos) = (TAU * direction as f64 / DIRECTIONS as f64).sin_cos();
        set_point + Position::new(cos, sin) * reach
    };
    let best = (0..DIRECTIONS)
        .map(at)
        .map(|at| (room(at), at))
        .fold((f64::NEG_INFINITY, set_point), |best, next| if next.0 > best.0 { next } else { best });
    best.1
}

#[cfg(test)]
mod tests {
    use super::super::corners::CUT;
    use super::*;
    use crate::geometry::Disc;
    use crate::obstacles::Obstacles;
    use proptest::prelude::*;

    fn team(ends: &[Position], separations: &[f64], places: &[Disc], discs: &[Disc]) -> Vec<Route> {
        let corners = Corners::of_team(separations, places, &Obstacles::new(discs, &[], 1.5));
        Route::of_team(ends, separations, &corners)
    }

    fn place((x, y): (f64, f64)) -> Disc {
        Disc { centre: Position::new(x, y), extra: 0.0 }
    }

    fn route(set_point: (f64, f64), obstacles: &[(f64, f64)]) -> Route {
        let discs: Vec<Disc> =
            obstacles.iter().map(|(x, y)| Disc { centre: Position::new(*x, *y), extra: 0.0 }).collect();
        team(&[Position::new(set_point.0, set_point.1)], &[1.5], &[place(set_point)], &discs).remove(0)
    }

    /// Walks along the aim in small steps: (arrived, length of the way, least distance to an obstacle).
    fn walk(route: &Route, from: (f64, f64)) -> (bool, f64, f64) {
        const STEP: f64 = 0.02;
        let (mut here, mut length, mut least) = (Position::new(from.0, from.1), 0.0, f64::INFINITY);
        for _ in 0..10_000 {
            least = route.corners.ground.discs().iter().map(|disc| (here - disc.centre).norm()).fold(least, f64::min);
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
    fn who_stands_is_walked_round_where_that_is_cheaper_than_pushing() {
        let ends = [Position::new(10.0, 0.0), Position::new(5.0, 0.2)];
        let places = ends.map(|centre| Disc { centre, extra: 0.0 });
        let route = team(&ends, &[1.5; 2], &places, &[]).remove(0);
        let mut rests = [Rest::of(&route), Rest::of(&route)];
        let mut stands = RobotSet::default();
        let mut way = |stands, tight, price| route.path_round(Position::zeros(), stands, tight, price, &mut rests);
        assert_eq!(way(stands, RobotSet::default(), 3.0).points(), &ends[..1]);
        stands.add(1);
        let round = way(stands, RobotSet::default(), 3.0);
        assert!(round.points().len() > 1 && round.length < 10.8 && round.points()[0].y < 0.0);
        assert_eq!(way(stands, RobotSet::default(), 0.0).points(), &ends[..1], "it makes room");
        assert!(way(stands, stands, 0.0).points().len() > 1, "it cannot make room");
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
        let routes = team(&[goal; 3], &[1.5, 1.5, 2.0], &[place((10.0, 0.0)); 3], &discs);
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

//! What ways lead round: discs, the corners of polygons round them, and which corners see each other.

use super::robot_set::RobotSet;
use crate::Position;
use crate::geometry::Disc;
use std::f64::consts::{PI, TAU};

/// Corners of the polygon that is walked round an obstacle, fewest and most: 10 % and 2 % longer than its
/// circle.
const CORNERS: (usize, usize) = (6, 12);
/// Corners in all, where there are many obstacles: the work grows with their square times the obstacles.
const TOGETHER: usize = 600;
/// By how much a way may cut into a disc, as a share of its radius: robots slide along it.
pub(super) const CUT: f64 = 1e-3;
/// A disc that the centre of a robot must not enter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closed {
    /// Its centre, m.
    pub(super) centre: Position,
    /// Its radius, m.
    pub(super) radius: f64,
}

/// The corners round a set of obstacles and of set-points that robots of one size can reach, and who sees whom.
#[derive(Debug)]
pub(super) struct Corners {
    pub(super) closed: Vec<Closed>,
    /// The set-points by robot: closed while somebody stands there.
    pub(super) places: Vec<Closed>,
    pub(super) at: Vec<Position>,
    /// How many of them, the first ones, are round obstacles.
    pub(super) fixed: usize,
    /// By corner: the other corners in a straight line from it, with the set-points in between.
    pub(super) seen: Vec<Vec<(usize, RobotSet)>>,
}

impl Corners {
    /// The corners round `obstacles` and `places`, the set-points with their robots' radii beyond
    /// min_separation / 2; `separation` is what is owed to a disc of radius min_separation / 2, m.
    pub(super) fn new(obstacles: &[Disc], places: &[Disc], separation: f64) -> Self {
        let close = |disc: &Disc| Closed { centre: disc.centre, radius: separation + disc.extra };
        let closed: Vec<Closed> = obstacles.iter().map(close).collect();
        let places: Vec<Closed> = places.iter().map(close).collect();
        let corners = corners_of(closed.len() + places.len());
        let out = 1.0 / shrink(corners);
        let round = |disc: &Closed| {
            let (centre, radius) = (disc.centre, disc.radius * out);
            (0..corners).map(move |corner| {
                let (sin, cos) = (TAU * corner as f64 / corners as f64).sin_cos();
                centre + Position::new(cos, sin) * radius
            })
        };
        let open = |corner: &Position| is_open(&closed, *corner);
        let mut at: Vec<Position> = closed.iter().flat_map(round).filter(open).collect();
        let fixed = at.len();
        at.extend(places.iter().flat_map(round).filter(open));
        // Gates between two discs that leave hardly more than a robot needs: no corner fits in between.
        for (index, a) in places.iter().enumerate() {
            for b in places[..index].iter().chain(&closed) {
                let wide = (a.centre - b.centre).norm() / (a.radius + b.radius);
                if (1.0..1.2).contains(&wide) {
                    let share = a.radius / (a.radius + b.radius);
                    at.extend(Some(a.centre + (b.centre - a.centre) * share).filter(open));
                }
            }
        }
        let mut seen: Vec<Vec<(usize, RobotSet)>> = vec![Vec::new(); at.len()];
        for a in 0..at.len() {
            for b in 0..a {
                if is_free(&closed, at[a], at[b]) {
                    let between = between(&places, at[a], at[b]);
                    seen[a].push((b, between));
                    seen[b].push((a, between));
                }
            }
        }
        Self { closed, places, at, fixed, seen }
    }
}

/// Corners of the polygon round each of `discs` discs.
fn corners_of(discs: usize) -> usize {
    (TOGETHER / discs.max(1)).clamp(CORNERS.0, CORNERS.1)
}

/// The inner radius of a polygon with so many corners, as a share of its outer one.
fn shrink(corners: usize) -> f64 {
    (PI / corners as f64).cos()
}

/// By how much the discs of a layout with so many obstacles have to shrink so that the polygons round them lie within
/// them: no way round the discs is shorter than the shortest one round such polygons.
pub(super) fn inscribed(obstacles: usize) -> f64 {
    shrink(corners_of(obstacles))
}

/// The set-points that a straight way leads over.
pub(super) fn between(places: &[Closed], from: Position, to: Position) -> RobotSet {
    let mut between = RobotSet::default();
    let way = to - from;
    let length_2 = way.norm_squared();
    for (robot, place) in places.iter().enumerate() {
        let along = ((place.centre - from).dot(&way) / length_2).clamp(0.0, 1.0);
        if (from + way * along - place.centre).norm() < place.radius * (1.0 - CUT) {
            between.add(robot);
        }
    }
    between
}

/// Whether a robot can stand there.
fn is_open(closed: &[Closed], point: Position) -> bool {
    closed.iter().all(|disc| (point - disc.centre).norm() >= disc.radius * (1.0 - CUT))
}

/// Whether the straight way keeps out of every disc. One that starts inside may lead out, not deeper.
pub(super) fn is_free(closed: &[Closed], from: Position, to: Position) -> bool {
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

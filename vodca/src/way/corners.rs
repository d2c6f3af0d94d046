//! What ways lead round: the corners of polygons round discs and pieces, and which corners see each other.

use super::ground::{Ground, is_gate};
use super::robot_set::{MOST_STANDING, RobotSet};
use crate::Position;
use crate::geometry::Disc;
use crate::obstacles::Obstacles;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

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
    pub(super) ground: Ground,
    /// The set-points by robot: closed while somebody stands there.
    pub(super) places: Vec<Closed>,
    pub(super) at: Vec<Position>,
    /// How many of them, the first ones, are round obstacles.
    pub(super) fixed: usize,
    /// By corner: the other corners in a straight line from it.
    pub(super) seen: Vec<Vec<Leg>>,
}

/// A straight way from one corner to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub(super) to: usize,
    /// The set-points in between.
    pub(super) between: RobotSet,
    /// What it costs more than it is long, m.
    pub(super) toll: f64,
}

impl Corners {
    /// Those of every robot, by number, once for each size. `separations` (what each robot owes a disc of radius
    /// min_separation / 2, m) are by robot; `places` are the set-points, where robots come to stand, with their robots'
    /// radii beyond min_separation / 2.
    pub(super) fn of_team(separations: &[f64], places: &[Disc], obstacles: &Obstacles) -> Vec<Arc<Self>> {
        let places = if places.len() <= MOST_STANDING { places } else { &[] };
        let mut sizes: Vec<(f64, Arc<Self>)> = Vec::new();
        let of = |separation: &f64| {
            let known = sizes.iter().find(|(size, _)| size == separation).map(|(_, corners)| corners.clone());
            known.unwrap_or_else(|| {
                let corners = Arc::new(Self::new(obstacles, places, *separation));
                sizes.push((*separation, corners.clone()));
                corners
            })
        };
        separations.iter().map(of).collect()
    }

    /// The corners round `obstacles` and `places`; `separation` is what is owed to a disc of radius
    /// min_separation / 2, m.
    fn new(obstacles: &Obstacles, places: &[Disc], separation: f64) -> Self {
        let close = |disc: &Disc| Closed { centre: disc.centre, radius: separation + disc.extra };
        let places: Vec<Closed> = places.iter().map(close).collect();
        let ground = Ground::new(obstacles, &places, separation);
        let (mut at, fixed) = match ground.roadmap() {
            Some(map) => (map.corners().iter().map(|corner| corner.at).collect(), map.fixed()),
            None => round_discs(&ground, &places),
        };
        // Gates between two that leave hardly more than a robot needs: no corner fits in between.
        let first_gate = at.len();
        for (index, a) in places.iter().enumerate() {
            for b in places[..index].iter().chain(ground.discs()) {
                if is_gate((a.centre - b.centre).norm() / (a.radius + b.radius)) {
                    let share = a.radius / (a.radius + b.radius);
                    at.extend(Some(a.centre + (b.centre - a.centre) * share).filter(|gate| ground.is_open(*gate)));
                }
            }
            at.extend(ground.gates(a).filter(|gate| ground.is_open(*gate)));
        }
        let mut seen: Vec<Vec<Leg>> = vec![Vec::new(); at.len()];
        let leg = |from: usize, to: usize| Leg {
            to,
            between: between(&places, at[from], at[to]),
            toll: ground.toll(at[from], at[to]),
        };
        // A roadmap knows which of its corners a taut way joins.
        let known = ground.roadmap().map_or(0, |_| first_gate);
        if let Some(map) = ground.roadmap() {
            for (a, seen) in seen.iter_mut().enumerate().take(known) {
                let others = map.seen_from(a).iter().map(|b| *b as usize);
                seen.extend(others.map(|b| leg(a, b)));
            }
        }
        for a in known..at.len() {
            for b in 0..a {
                if ground.is_free(at[a], at[b]) {
                    let there = leg(a, b);
                    seen[a].push(there);
                    seen[b].push(Leg { to: a, ..there });
                }
            }
        }
        Self { ground, places, at, fixed, seen }
    }
}

/// The corners round discs and `places`, and how many of them are round the discs.
fn round_discs(ground: &Ground, places: &[Closed]) -> (Vec<Position>, usize) {
    let corners = corners_of(ground.discs().len() + places.len());
    let out = 1.0 / (PI / corners as f64).cos();
    let round = |disc: &Closed| {
        let (centre, radius) = (disc.centre, disc.radius * out);
        (0..corners).map(move |corner| {
            let (sin, cos) = (TAU * corner as f64 / corners as f64).sin_cos();
            centre + Position::new(cos, sin) * radius
        })
    };
    let open = |corner: &Position| ground.is_open(*corner);
    let mut at: Vec<Position> = ground.discs().iter().flat_map(round).filter(open).collect();
    let fixed = at.len();
    at.extend(places.iter().flat_map(round).filter(open));
    (at, fixed)
}

/// Corners of the polygon round each of `discs` discs.
fn corners_of(discs: usize) -> usize {
    (TOGETHER / discs.max(1)).clamp(CORNERS.0, CORNERS.1)
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

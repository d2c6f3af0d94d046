//! The corners that robots of one clearance can bend at, and who sees whom.

use super::{Corner, SLIDING, corners, least_in_search, least_on_the_way};
use crate::Position;
use crate::shape::{Obstacles, Piece};
use std::sync::Arc;

/// Less clearance than this has no inside to tell from an outside, m.
const LEAST_CLEARANCE: f64 = 1e-6;

/// Everything about ways that depends on the map and the clearance alone. Shared by a team.
#[derive(Clone, Debug)]
pub struct Roadmap {
    obstacles: Arc<Obstacles>,
    clearance: f64,
    corners: Vec<Corner>,
    /// How many of them, the first ones, are round what stands.
    fixed: usize,
    /// By corner: where its own part of `seen` begins; one more at the end.
    first: Vec<u32>,
    /// The corners that a taut way may go on to.
    seen: Vec<u32>,
}

impl Roadmap {
    /// Looks for all straight lines between the corners for robots whose centres keep `clearance` (m; at least
    /// a micrometre is taken) from everything that stands.
    pub fn new(obstacles: Arc<Obstacles>, clearance: f64) -> Self {
        Self::with_places(obstacles, clearance, &[])
    }

    /// The same with corners round `places` as well: discs (centre and radius, m) that a robot's centre keeps out of
    /// only now and then, so that they are in nobody's way here.
    pub fn with_places(obstacles: Arc<Obstacles>, clearance: f64, places: &[(Position, f64)]) -> Self {
        let clearance = clearance.max(LEAST_CLEARANCE);
        let (corners, seen) = (Vec::new(), Vec::new());
        let mut map = Self { obstacles, clearance, corners, fixed: 0, first: vec![0], seen };
        let least = least_in_search(clearance);
        let open = |corner: &Corner| map.is_open(corner.at, least);
        let mut corners = corners::round_all(&map.obstacles, clearance);
        corners.retain(open);
        let fixed = corners.len();
        corners.extend(corners::round_discs(places).filter(open));
        (map.corners, map.fixed) = (corners, fixed);
        let mut pairs = map.tangents(least);
        pairs.sort_unstable();
        map.first.extend((0..map.corners.len()).map(|i| pairs.partition_point(|pair| pair.0 as usize <= i) as u32));
        map.seen = pairs.into_iter().map(|(_, to)| to).collect();
        map
    }

    /// All pairs of corners, in both directions, between which a taut way may run.
    fn tangents(&self, least: f64) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        let arcs = corners::arcs(&self.corners);
        let (mut here, mut there) = (Vec::new(), Vec::new());
        // What stood in the last way stands in most that run beside it.
        let mut last: Option<&Piece> = None;
        for (number, arc) in arcs.iter().enumerate() {
            for other in &arcs[number..] {
                let may_touch = arc.may_touch(other);
                let choose = |list: &mut Vec<usize>, arc: &corners::Arc| {
                    list.clear();
                    list.extend(arc.corners.clone().filter(|i| may_touch(&self.corners[*i])));
                };
                choose(&mut here, arc);
                choose(&mut there, other);
                for &i in &here {
                    for &j in there.iter().filter(|j| i < **j) {
                        let (from, to) = (&self.corners[i], &self.corners[j]);
                        let way = to.at - from.at;
                        let rounding = 1e-9 * (way.x.abs() + way.y.abs());
                        if from.is_tangent(way, rounding)
                            && to.is_tangent(way, rounding)
                            && !last.is_some_and(|piece| blocks(piece, from.at, to.at, least))
                        {
                            match self.blocker(from.at, to.at, least) {
                                None => pairs.extend([(i as u32, j as u32), (j as u32, i as u32)]),
                                found => last = found,
                            }
                        }
                    }
                }
            }
        }
        pairs
    }

    /// What stands.
    pub fn obstacles(&self) -> &Arc<Obstacles> {
        &self.obstacles
    }

    /// What a robot's centre keeps from everything that stands, m.
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Where ways may bend: round what stands, then round places.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// How many corners, the first ones, are round what stands.
    pub fn fixed(&self) -> usize {
        self.fixed
    }

    /// Whether every piece is at least `least` (m) from `place`.
    pub fn is_open(&self, place: Position, least: f64) -> bool {
        self.obstacles.pieces_within(place, least).all(|piece| piece.distance(place) >= least)
    }

    /// Whether `place` is where ways lead, or nearly so.
    pub fn is_outside(&self, place: Position) -> bool {
        self.is_open(place, self.clearance * (1.0 - SLIDING))
    }

    /// Whether a way straight from `place`, which [is outside](Self::is_outside), may bend at `corner`: else it runs
    /// into what the corner is round.
    pub fn may_bend(&self, place: Position, corner: usize) -> bool {
        let corner = &self.corners[corner];
        corner.is_tangent(corner.at - place, 2.0 * SLIDING * (corner.at - corner.pivot).norm())
    }

    /// The corners to which a taut way may go on from corner `from`.
    pub fn seen_from(&self, from: usize) -> &[u32] {
        &self.seen[self.first[from] as usize..self.first[from + 1] as usize]
    }

    /// Whether a robot may go straight from one place to another. From a place that is too near to a piece the
    /// way may lead out, not nearer to it. Nothing is allocated.
    pub fn is_free(&self, from: Position, to: Position) -> bool {
        self.keeps(from, to, least_on_the_way(self.clearance))
    }

    /// [`Roadmap::is_free`] with `least` (m) as what is owed.
    pub(super) fn keeps(&self, from: Position, to: Position, least: f64) -> bool {
        self.blocker(from, to, least).is_none()
    }

    /// A piece that a straight way comes nearer to than `least`, m.
    fn blocker(&self, from: Position, to: Position, least: f64) -> Option<&Piece> {
        self.obstacles.pieces_along(from, to, least).find(|piece| blocks(piece, from, to, least))
    }
}

/// Whether a straight way comes nearer to a piece than `least` (m), and not only because it begins there.
fn blocks(piece: &Piece, from: Position, to: Position, least: f64) -> bool {
    if piece.separation(from, to) >= least {
        return false;
    }
    // The distance to a convex piece is convex along the way: if it does not shrink at first, it never does.
    let nearest = piece.nearest(from);
    nearest.distance >= least || nearest.normal.dot(&(to - from)) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Obstacle, Shape};

    fn roadmap(discs: &[(f64, f64)]) -> Roadmap {
        let disc = |(x, y): &(f64, f64)| Shape::Disc { centre: Position::new(*x, *y), radius: 0.75 };
        let list = discs.iter().map(|at| Obstacle::new("disc", disc(at)).unwrap()).collect();
        Roadmap::new(Arc::new(Obstacles::new(list)), 0.75)
    }

    #[test]
    fn corners_that_another_obstacle_covers_are_left_out() {
        let pair = roadmap(&[(0.0, 0.0), (1.0, 0.0)]);
        assert!(pair.corners().len() < 32 && pair.corners().len() > 16);
        for corner in pair.corners() {
            assert!(pair.obstacles().nearest(corner.at, 9.0).unwrap().1.distance >= 0.749);
        }
    }

    #[test]
    fn corners_of_a_disc_see_their_neighbours_and_nobody_behind() {
        let one = roadmap(&[(0.0, 0.0)]);
        for corner in 0..16 {
            assert_eq!(one.seen_from(corner).len(), 2);
        }
    }

    #[test]
    fn who_is_too_near_may_get_away_but_not_nearer() {
        let one = roadmap(&[(0.0, 0.0)]);
        let inside = Position::new(1.2, 0.0);
        assert!(one.is_free(inside, Position::new(5.0, 0.0)));
        assert!(one.is_free(inside, Position::new(1.3, 3.0)));
        assert!(!one.is_free(inside, Position::new(1.1, 3.0)));
        assert!(!one.is_free(inside, Position::new(-5.0, 0.0)));
    }
}

//! Everything that stands: discs, and the convex pieces of polygons, walls and maps.
//!
//! A robot sees every piece as a disc: the one of radius 0 at the piece's nearest point. The half plane that touches
//! the circle round that point is the half plane of the piece (`world::shape::Piece` has the proof), so that rows,
//! cells and ORCA treat both alike.

use crate::Position;
use crate::geometry::Disc;
use std::sync::Arc;
use world::shape::{Nearest, Obstacle, Piece, Shape};

/// Nearer to a piece than this its nearest point says nothing about the direction out of it, m.
const TOUCHING: f64 = 1e-6;

/// What stands in a layout. Immutable and shared.
#[derive(Clone, Debug)]
pub struct Obstacles {
    discs: Vec<Disc>,
    /// All that are no discs.
    shapes: Arc<world::shape::Obstacles>,
    /// Discs and shapes, for ways.
    all: Arc<world::shape::Obstacles>,
    /// Half of the usual separation, m: what a disc of radius 0 lacks.
    half: f64,
}

/// A disc or a convex piece.
#[derive(Clone, Copy, Debug)]
pub enum Solid<'a> {
    /// A disc as the paper has it.
    Disc(&'a Disc),
    /// A convex piece of anything else, and half of the usual separation, m.
    Piece(&'a Piece, f64),
}

impl Solid<'_> {
    /// The disc that keeps a robot at `place` away as this does: itself, or one of radius 0 at the nearest point.
    pub fn seen_from(&self, place: Position) -> Disc {
        match self {
            Self::Disc(disc) => **disc,
            Self::Piece(piece, half) => seen_from(piece, *half, place),
        }
    }
}

/// The disc that `piece` is for a robot at `place`, where discs of radius `half` (m) have no extra radius.
pub fn seen_from(piece: &Piece, half: f64, place: Position) -> Disc {
    let Nearest { point, normal, distance } = piece.nearest(place);
    if distance > TOUCHING {
        return Disc { centre: point, extra: -half };
    }
    // From inside the nearest point lies the wrong way: a disc of a metre and as much as it is deep lies the right one.
    Disc { centre: place - normal, extra: 1.0 - distance - half }
}

impl Obstacles {
    /// `discs`, then `shapes`; discs without an extra radius have half of `min_separation` (m) as radius.
    pub fn new(discs: &[Disc], shapes: &[Obstacle], min_separation: f64) -> Self {
        let half = min_separation / 2.0;
        let round = |(number, disc): (usize, &Disc)| {
            let shape = Shape::Disc { centre: disc.centre, radius: half + disc.extra };
            Obstacle::new(format!("disc {number}"), shape).ok() // One without a radius is in nobody's way.
        };
        let shaped = Arc::new(world::shape::Obstacles::new(shapes.to_vec()));
        let all = if discs.is_empty() {
            shaped.clone()
        } else {
            let discs = discs.iter().enumerate().filter_map(round);
            Arc::new(world::shape::Obstacles::new(discs.chain(shapes.iter().cloned()).collect()))
        };
        Self { discs: discs.to_vec(), shapes: shaped, all, half }
    }

    /// The discs.
    pub fn discs(&self) -> &[Disc] {
        &self.discs
    }

    /// What is no disc.
    pub fn shapes(&self) -> &Arc<world::shape::Obstacles> {
        &self.shapes
    }

    /// Discs and shapes as shapes.
    pub fn all(&self) -> &Arc<world::shape::Obstacles> {
        &self.all
    }

    /// What a robot that owes `separation` (m) to a disc without extra radius owes to a surface, m.
    pub fn clearance(&self, separation: f64) -> f64 {
        separation - self.half
    }

    /// Whether there are only discs.
    pub fn are_discs(&self) -> bool {
        self.shapes.list().is_empty()
    }

    /// How many obstacles there are: discs, then shapes, in this order of numbers.
    pub fn count(&self) -> usize {
        self.discs.len() + self.shapes.list().len()
    }

    /// How many discs and pieces there are: at most so many rows they make.
    pub fn solids(&self) -> usize {
        self.discs.len() + self.shapes.pieces().len()
    }

    /// All discs, and every piece within `reach` (m) of `place`; nothing is allocated.
    pub fn near(&self, place: Position, reach: f64) -> impl Iterator<Item = Solid<'_>> + Clone {
        let half = self.half;
        let pieces = self.shapes.pieces_within(place, reach).map(move |piece| Solid::Piece(piece, half));
        self.discs.iter().map(Solid::Disc).chain(pieces)
    }

    /// The least separation of a robot without extra radius that moves straight from one place to another from the
    /// obstacle of every piece that comes within `reach` (m), with that obstacle's number; between samples too.
    pub fn separations(&self, from: Position, to: Position, reach: f64) -> impl Iterator<Item = (usize, f64)> {
        let surface = (reach - self.half).clamp(0.0, FAR);
        let measured =
            move |piece: &Piece| (self.discs.len() + piece.obstacle(), piece.separation(from, to) + self.half);
        self.shapes.pieces_along(from, to, surface).map(measured)
    }
}

/// Farther than anything is from anything, m.
const FAR: f64 = 1e7;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn square() -> Obstacles {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| Position::new(x, y));
        let polygon = Obstacle::new("square", Shape::Polygon(corners.to_vec())).unwrap();
        Obstacles::new(&[Disc { centre: Position::new(9.0, 0.0), extra: 0.25 }], &[polygon], 1.5)
    }

    #[test]
    fn a_piece_is_seen_as_a_point_from_outside_and_pushes_out_from_inside() {
        let all = square();
        let solids: Vec<Solid<'_>> = all.near(Position::new(3.0, 1.0), 2.0).collect();
        assert_eq!(solids.len(), 2, "every disc, and pieces in reach");
        let seen = solids[1].seen_from(Position::new(3.0, 1.0));
        assert_eq!((seen.centre, seen.extra), (Position::new(2.0, 1.0), -0.75));
        let inside = Position::new(1.9, 1.0);
        let seen = solids[1].seen_from(inside);
        let (out, distance) = (inside - seen.centre, (inside - seen.centre).norm());
        assert!((out - Position::new(1.0, 0.0)).norm() < 1e-12);
        // As deep below the separation as the robot's centre is below half of it from the surface.
        assert!((distance - (1.5 + seen.extra) - (-0.1 - 0.75)).abs() < 1e-12);
    }

    #[test]
    fn separations_count_discs_first_and_are_taken_to_the_surface_plus_half() {
        let all = square();
        let found: Vec<_> = all.separations(Position::new(3.0, -1.0), Position::new(3.0, 3.0), 5.0).collect();
        assert_eq!(found, [(1, 1.75)]);
    }

    proptest! {
        /// What cells rest on: who obeys the half plane of the disc that it sees keeps the clearance from the piece.
        #[test]
        fn a_move_within_the_half_plane_of_the_seen_disc_keeps_the_clearance(
            corners in prop::collection::vec(prop::array::uniform2(-3.0f64..3.0), 3..9),
            place in prop::array::uniform2(-6.0f64..6.0),
            step in prop::array::uniform2(-0.3f64..0.3),
        ) {
            let hull = convex_hull(corners.into_iter().map(Position::from).collect());
            prop_assume!(hull.len() >= 3);
            let Ok(polygon) = Obstacle::new("hull", Shape::Polygon(hull)) else { return Ok(()) };
            let all = Obstacles::new(&[], &[polygon], 1.5);
            let (place, step) = (Position::from(place), Position::from(step));
            let clearance = 0.75;
            let distance = all.all().nearest(place, 99.0).unwrap().1.distance;
            prop_assume!(distance >= clearance);
            let kept = all.near(place, 99.0).all(|solid| {
                let disc = solid.seen_from(place);
                let (apart, owed) = (place - disc.centre, 1.5 + disc.extra);
                (apart / apart.norm()).dot(&step) >= owed - apart.norm()
            });
            if kept {
                let least = all.all().separation(place, place + step, 99.0);
                prop_assert!(least >= clearance - 1e-9, "{least}");
            }
        }
    }

    /// Counter-clockwise (Andrew 1979).
    fn convex_hull(mut points: Vec<Position>) -> Vec<Position> {
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let half = |points: &mut dyn Iterator<Item = &Position>| {
            let mut chain: Vec<Position> = Vec::new();
            for &point in points {
                while let [.., a, b] = chain[..] {
                    if (b - a).perp(&(point - a)) > 1e-6 {
                        break;
                    }
                    chain.pop();
                }
                chain.push(point);
            }
            chain.pop();
            chain
        };
        let mut hull = half(&mut points.iter());
        hull.extend(half(&mut points.iter().rev()));
        hull
    }
}

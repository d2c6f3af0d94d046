//! Everything that stands, with an index over its pieces.

use super::tree::{self, Tree};
use super::{Bounds, Nearest, Obstacle, Piece};
use crate::Position;

/// Everything that stands in a layout. Immutable: shared by robots, recorder and checks.
#[derive(Clone, Debug)]
pub struct Obstacles {
    list: Vec<Obstacle>,
    pieces: Vec<Piece>,
    tree: Tree,
}

impl Obstacles {
    /// Indexes the pieces of `list`.
    pub fn new(list: Vec<Obstacle>) -> Self {
        let piece = |(number, obstacle): (usize, &Obstacle)| {
            let radius = obstacle.radius;
            obstacle.cores.iter().map(move |core| Piece::new(core.clone(), radius, number)).collect::<Vec<_>>()
        };
        let mut pieces: Vec<Piece> = list.iter().enumerate().flat_map(piece).collect();
        let tree = Tree::new(&mut pieces);
        Self { list, pieces, tree }
    }

    /// The obstacles, in the order in which they were given.
    pub fn list(&self) -> &[Obstacle] {
        &self.list
    }

    /// All pieces, in the order of the index.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The name of the obstacle that `piece` belongs to.
    pub fn name_of(&self, piece: &Piece) -> &str {
        &self.list[piece.obstacle()].name
    }

    /// The smallest upright rectangle round all of them.
    pub fn bounds(&self) -> Bounds {
        self.pieces.iter().fold(Bounds::NOTHING, |all, piece| all.joined(&piece.bounds()))
    }

    /// The pieces whose rectangles come within `reach` (m) of `place`: every piece that is as near, and perhaps
    /// a few more. Always in the same order; nothing is allocated.
    pub fn pieces_within(&self, place: Position, reach: f64) -> impl Iterator<Item = &Piece> + Clone {
        self.tree.find(&self.pieces, tree::near(place, reach))
    }

    /// The pieces whose rectangles come within `reach` (m) of the straight line: every piece that is as near,
    /// and perhaps a few more. Always in the same order; nothing is allocated.
    pub fn pieces_along(&self, from: Position, to: Position, reach: f64) -> impl Iterator<Item = &Piece> + Clone {
        self.tree.find(&self.pieces, tree::along(from, to, reach))
    }

    /// The piece nearest to `place` among those within `reach` (m), and where it is nearest.
    pub fn nearest(&self, place: Position, reach: f64) -> Option<(&Piece, Nearest)> {
        let mut best: Option<(&Piece, Nearest)> = None;
        for piece in self.pieces_within(place, reach) {
            if best.is_some_and(|(_, least)| piece.bounds().distance(place) > least.distance.max(0.0)) {
                continue;
            }
            let found = piece.nearest(place);
            if found.distance <= reach && best.is_none_or(|(_, least)| found.distance < least.distance) {
                best = Some((piece, found));
            }
        }
        best
    }

    /// The least distance of a straight motion to everything that comes within `reach` (m) of it; `reach` where
    /// nothing does. See [`Piece::separation`].
    pub fn separation(&self, from: Position, to: Position, reach: f64) -> f64 {
        self.pieces_along(from, to, reach).map(|piece| piece.separation(from, to)).fold(reach, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Shape;
    use proptest::prelude::*;

    fn obstacles() -> impl Strategy<Value = Obstacles> {
        let disc = (prop::array::uniform2(-20.0f64..20.0), 0.1f64..3.0)
            .prop_map(|(c, radius)| Shape::Disc { centre: c.into(), radius });
        let wall = (prop::array::uniform4(-20.0f64..20.0), 0.1f64..1.0).prop_map(|(p, thickness)| Shape::Wall {
            points: vec![[p[0], p[1]].into(), [p[2], p[3]].into()],
            thickness,
        });
        prop::collection::vec(prop_oneof![disc, wall], 0..60).prop_map(|shapes| {
            Obstacles::new(shapes.into_iter().map(|shape| Obstacle::new("it", shape).unwrap()).collect())
        })
    }

    #[test]
    fn a_wall_is_one_piece_for_each_leg_and_its_border_runs_there_and_back() {
        let points = vec![Position::new(0.0, 0.0), Position::new(4.0, 0.0), Position::new(4.0, 3.0)];
        let wall = Obstacle::new("wall", Shape::Wall { points: points.clone(), thickness: 0.2 }).unwrap();
        assert_eq!(wall.rings(), [vec![points[0], points[1], points[2], points[1]]]);
        let all = Obstacles::new(vec![wall]);
        assert_eq!(all.pieces().len(), 2);
        assert!((all.nearest(Position::new(5.0, 1.0), 9.0).unwrap().1.distance - 0.9).abs() < 1e-12);
        assert!((all.nearest(Position::new(4.0, 4.0), 9.0).unwrap().1.distance - 0.9).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_index_finds_what_a_look_at_all_pieces_finds(
            all in obstacles(), p in prop::array::uniform4(-25.0f64..25.0), reach in 0.0f64..10.0,
        ) {
            let (from, to) = (Position::new(p[0], p[1]), Position::new(p[2], p[3]));
            let near = all.pieces().iter().filter(|piece| piece.bounds().distance(from) <= reach).count();
            prop_assert_eq!(all.pieces_within(from, reach).count(), near);
            let least = all.pieces().iter().map(|piece| piece.distance(from)).fold(f64::INFINITY, f64::min);
            let found = all.nearest(from, reach).map(|(_, nearest)| nearest.distance);
            prop_assert_eq!(found, (least <= reach).then_some(least));
            let separation = all.pieces().iter().map(|piece| piece.separation(from, to)).fold(reach, f64::min);
            prop_assert_eq!(all.separation(from, to, reach), separation);
        }
    }
}

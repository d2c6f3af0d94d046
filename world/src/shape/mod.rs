//! Shapes as they are written and the convex pieces they are measured by.
//!
//! - A **disc**: centre and radius.
//! - A **polygon**: its corners in order, convex or not, in either direction.
//! - A **wall**: everything within half its thickness of a chain of points. Its ends and its bends are round, so
//!   it reaches half its thickness beyond its first and its last point.
//! - A **region**: an outline with holes, as a map gives ([`crate::map`]).

mod bounds;
mod cut;
mod obstacles;
mod piece;
mod tree;

pub use bounds::Bounds;
pub use cut::CutError;
pub use obstacles::Obstacles;
pub use piece::{Nearest, Piece};

pub(crate) use cut::{into_convex, turn};
pub(crate) use piece::right_of;

use crate::Position;
use crate::check::{self, ShapeProblem};

/// A shape as it is written, m.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Everything within `radius` of `centre`.
    Disc {
        /// m.
        centre: Position,
        /// m, above 0.
        radius: f64,
    },
    /// The inside of an outline; the last corner is joined to the first.
    Polygon(
        /// At least three corners, in order.
        Vec<Position>,
    ),
    /// Everything within half of `thickness` of a chain of points.
    Wall {
        /// At least two points, in order.
        points: Vec<Position>,
        /// m, above 0.
        thickness: f64,
    },
    /// What lies inside an odd number of outlines. Each has the solid on its left, may touch others in corners
    /// and crosses none.
    Region(
        /// Outlines and the rims of holes.
        Vec<Vec<Position>>,
    ),
}

/// One thing that stands, cut into convex pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    name: String,
    shape: Shape,
    /// Closed chains with the solid on their left; together with `radius` the border.
    rings: Vec<Vec<Position>>,
    radius: f64,
    /// Cores of the pieces.
    cores: Vec<Vec<Position>>,
}

impl Obstacle {
    /// Checks a shape and cuts it into convex pieces.
    ///
    /// # Errors
    /// What is wrong with the shape and where ([`ShapeProblem`]).
    pub fn new(name: impl Into<String>, shape: Shape) -> Result<Self, ShapeProblem> {
        let (rings, radius) = match &shape {
            Shape::Disc { centre, radius } => {
                check::disc(*centre, *radius)?;
                (vec![vec![*centre]], *radius)
            }
            Shape::Polygon(corners) => (vec![check::polygon(corners)?], 0.0),
            Shape::Wall { points, thickness } => {
                let mut ring = check::wall(points, *thickness)?;
                // There and back again: a solid without width on the left of both.
                ring.extend(ring[1..ring.len() - 1].iter().rev().copied().collect::<Vec<_>>());
                (vec![ring], thickness / 2.0)
            }
            Shape::Region(rings) => {
                check::region(rings)?;
                (rings.clone(), 0.0)
            }
        };
        let cores = match &shape {
            Shape::Disc { .. } => rings.clone(),
            Shape::Wall { .. } => {
                let legs = rings[0].len() / 2;
                (0..legs.max(1)).map(|leg| vec![rings[0][leg], rings[0][leg + 1]]).collect()
            }
            Shape::Polygon(_) | Shape::Region(_) => into_convex(&rings)?,
        };
        Ok(Self { name: name.into(), shape, rings, radius, cores })
    }

    /// What errors and pictures call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// As it was written.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Its border without [`Obstacle::radius`]: closed chains with the solid on their left. A wall's runs there
    /// and back, a disc's is its centre.
    pub fn rings(&self) -> &[Vec<Position>] {
        &self.rings
    }

    /// The cores of its convex pieces: each is all that is within [`Obstacle::radius`] of one.
    pub fn cores(&self) -> &[Vec<Position>] {
        &self.cores
    }

    /// How far it reaches beyond its rings, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

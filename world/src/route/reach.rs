//! Why a set-point cannot be reached.

use super::{ARC, Roadmap, Route};
use crate::Position;
use crate::check::{self, PlaceProblem};
use crate::shape::{Obstacles, Piece};
use std::fmt;
use std::sync::Arc;

/// An opening between two pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// How wide, m.
    pub width: f64,
    /// Its middle, m.
    pub middle: Position,
    /// The obstacles on its two sides; one name twice where it is an opening in one obstacle.
    pub between: (String, String),
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (a, b) = &self.between;
        write!(f, "{:.3} m wide, between {a} and {b} at [{:.2}, {:.2}] m", self.width, self.middle.x, self.middle.y)
    }
}

/// Why no way leads to a set-point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unreachable {
    /// The start or the set-point itself is not free.
    #[error(transparent)]
    Place(#[from] PlaceProblem),
    /// Both are free, and what stands between them closes every way.
    #[error(
        "no way leads from the start [{}, {}] to the set-point [{}, {}] m with {clearance} m on either side; {}",
        .start[0], .start[1], .set_point[0], .set_point[1], narrow(.gap.as_ref(), *.clearance)
    )]
    Closed {
        /// m.
        start: [f64; 2],
        /// m.
        set_point: [f64; 2],
        /// What the robot's centre keeps from everything that stands, m.
        clearance: f64,
        /// The opening that would have to be wider; none where it is shut in completely.
        gap: Option<Gap>,
    },
}

fn narrow(gap: Option<&Gap>, clearance: f64) -> String {
    match gap {
        Some(gap) => format!(
            "the widest way is through an opening {gap}: it needs {:.3} m; widen it or use a smaller radius",
            2.0 * clearance
        ),
        None => "one of them is shut in on all sides: open a way or move it".into(),
    }
}

impl Route {
    /// The length of the shortest way from `start`, m.
    ///
    /// # Errors
    /// Why there is none: the start is not free, or all ways are closed and through which opening the widest
    /// leads. That takes a roadmap for each of a dozen clearances: for checks before a run.
    pub fn reach(&self, start: Position) -> Result<f64, Unreachable> {
        let clearance = self.map().clearance();
        check::place(self.map().obstacles(), "the robot", "start", start, clearance * (1.0 - super::CUT / 2.0))?;
        self.length(start).ok_or_else(|| Unreachable::Closed {
            start: start.into(),
            set_point: self.set_point().into(),
            clearance,
            gap: narrowest(self.map().obstacles(), clearance, start, self.set_point()),
        })
    }
}

/// The opening that decides whether robots get from one place to the other: the widest that, once a robot is
/// small enough for it, lets it through. Widths between which the roundness of corners decides count as one.
fn narrowest(obstacles: &Arc<Obstacles>, clearance: f64, from: Position, to: Position) -> Option<Gap> {
    let mut gaps: Vec<(f64, &Piece, &Piece)> = Vec::new();
    let pieces = obstacles.pieces();
    for (i, a) in pieces.iter().enumerate() {
        for b in &pieces[i + 1..] {
            if a.bounds().grown(2.0 * clearance).meets(&b.bounds()) {
                let width = a.distance_to(b);
                if width > 0.0 && width < 2.0 * clearance {
                    gaps.push((width, a, b));
                }
            }
        }
    }
    gaps.sort_by(|a, b| b.0.total_cmp(&a.0));
    let passes = |gap: &(f64, &Piece, &Piece)| {
        let map = Arc::new(Roadmap::new(obstacles.clone(), gap.0 / 2.0 * (ARC / 2.0).cos()));
        Route::new(map, to).is_ok_and(|route| route.length(from).is_some())
    };
    let (width, a, b) = gaps[..].get(gaps.partition_point(|gap| !passes(gap)))?;
    let middle = middle_between(a, b);
    Some(Gap { width: *width, middle, between: (obstacles.name_of(a).into(), obstacles.name_of(b).into()) })
}

/// The middle of the shortest line between two pieces, m: alternating projections, which end there for convex
/// sets (von Neumann 1933, Cheney and Goldstein 1959).
fn middle_between(a: &Piece, b: &Piece) -> Position {
    let mut on_a = a.core()[0];
    let mut on_b = b.nearest(on_a).point;
    for _ in 0..200 {
        on_a = a.nearest(on_b).point;
        on_b = b.nearest(on_a).point;
    }
    (on_a + on_b) / 2.0
}

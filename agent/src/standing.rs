//! Robots that stand where they want to be: obstacles until somebody has no other way.
//!
//! Routes ([`crate::route`]) lead round what never moves. Whoever has arrived stands as well: others walk round
//! it, and only where all who stand close a robot's way together do they let it through.

use crate::controller::View;
use crate::layout::Layout;
use crate::route::{self, Closed, is_free};
use shared::Position;
use shared::params::Params;

/// What stands, seen by one robot in one tick.
#[derive(Clone, Debug)]
pub struct Standing {
    /// What the centre of the robot must not enter: robots that stand, then obstacles.
    closed: Vec<Closed>,
    robots: usize,
    /// The robots that stand, by number.
    pub who: route::Standing,
    /// Those of them who cannot make room.
    pub tight: route::Standing,
    /// Chains of overlapping discs: see [`Self::shuts_in`].
    first: Vec<usize>,
    odd: Vec<bool>,
}

impl Standing {
    /// Room for `discs`.
    pub fn with_capacity(discs: usize) -> Self {
        Self {
            closed: Vec::with_capacity(discs),
            robots: 0,
            who: route::Standing::default(),
            tight: route::Standing::default(),
            first: Vec::with_capacity(discs),
            odd: Vec::with_capacity(discs),
        }
    }

    /// Looks at who stands in `view`, as `walker` has to keep away from it.
    pub fn look(&mut self, params: &Params, layout: &Layout, walker: usize, view: &View<'_>) {
        self.closed.clear();
        self.who = route::Standing::default();
        self.tight = route::Standing::default();
        let owed = |extra: f64| params.model.min_separation + layout.robot_extra[walker] + extra;
        for (other, neighbour) in view.neighbours.iter().enumerate().filter(|(other, _)| *other != walker) {
            let Some((_, at)) = neighbour.present else { continue };
            let centre = neighbour.set_point;
            if (at - centre).norm() < 0.5 * params.model.min_separation {
                self.closed.push(Closed { centre, radius: owed(layout.robot_extra[other]) });
                self.who.add(other);
                if layout.is_tight(other, params.model.min_separation) {
                    self.tight.add(other);
                }
            }
        }
        self.robots = self.closed.len();
        let obstacles = layout.obstacles.iter();
        self.closed.extend(obstacles.map(|disc| Closed { centre: disc.centre, radius: owed(disc.extra) }));
    }

    /// Whether a robot that stands is in the straight way.
    fn is_blocked(&self, from: Position, to: Position) -> bool {
        !is_free(&self.closed[..self.robots], from, to)
    }

    /// Whether what stands closes the way between two places: a closed chain of overlapping discs runs round one
    /// of them and not the other. Such a chain crosses the straight line between them an odd number of times.
    pub fn shuts_in(&mut self, from: Position, to: Position) -> bool {
        if !self.is_blocked(from, to) {
            return false;
        }
        let Self { closed, first, odd, .. } = self;
        first.clear();
        first.extend(0..closed.len());
        odd.clear();
        odd.resize(closed.len(), false);
        for a in 0..closed.len() {
            for b in 0..a {
                if !overlap(&closed[a], &closed[b]) {
                    continue;
                }
                let crosses = crosses(from, to, closed[a].centre, closed[b].centre);
                let ((root_a, odd_a), (root_b, odd_b)) = (find(first, odd, a), find(first, odd, b));
                if root_a != root_b {
                    first[root_b] = root_a;
                    odd[root_b] = odd_a ^ odd_b ^ crosses;
                } else if odd_a ^ odd_b != crosses {
                    return true;
                }
            }
        }
        false
    }

}

/// Whether a robot does not fit between two discs.
fn overlap(a: &Closed, b: &Closed) -> bool {
    (a.centre - b.centre).norm() < a.radius + b.radius - 1e-6
}

/// Whether two straight lines cross.
fn crosses(from: Position, to: Position, a: Position, b: Position) -> bool {
    let side = |from: Position, to: Position, at: Position| {
        let (way, off) = (to - from, at - from);
        way.x * off.y - way.y * off.x > 0.0
    };
    side(from, to, a) != side(from, to, b) && side(a, b, from) != side(a, b, to)
}

fn find(first: &[usize], odd: &[bool], mut disc: usize) -> (usize, bool) {
    let mut crossings = false;
    while first[disc] != disc {
        crossings ^= odd[disc];
        disc = first[disc];
    }
    (disc, crossings)
}

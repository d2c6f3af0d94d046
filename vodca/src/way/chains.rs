//! Closed chains of overlapping discs: whether they separate two places.

use super::corners::Closed;
use crate::Position;

/// Chains of discs (union and find), each disc with the parity of the crossings on the way to its chain's first disc.
#[derive(Clone, Debug, Default)]
pub(super) struct Chains {
    first: Vec<usize>,
    odd: Vec<bool>,
}

impl Chains {
    /// Room for `discs`.
    pub(super) fn with_capacity(discs: usize) -> Self {
        Self { first: Vec::with_capacity(discs), odd: Vec::with_capacity(discs) }
    }

    /// Whether `discs` close every way between two places outside of them. They do exactly where a closed chain of
    /// overlapping discs runs round one place and not the other, and such a chain crosses the straight line between
    /// them an odd number of times: the line joining the centres of two overlapping discs lies within both.
    pub(super) fn separate(&mut self, discs: &[Closed], from: Position, to: Position) -> bool {
        self.first.clear();
        self.first.extend(0..discs.len());
        self.odd.clear();
        self.odd.resize(discs.len(), false);
        (0..discs.len()).any(|a| {
            (0..a).any(|b| {
                overlap(&discs[a], &discs[b]) && !self.link(a, b, crosses(from, to, discs[a].centre, discs[b].centre))
            })
        })
    }

    /// Links two discs; false when that closes a chain with an odd number of crossings.
    fn link(&mut self, a: usize, b: usize, crosses: bool) -> bool {
        let ((root_a, odd_a), (root_b, odd_b)) = (self.find(a), self.find(b));
        if root_a == root_b {
            return odd_a ^ odd_b == crosses;
        }
        self.first[root_b] = root_a;
        self.odd[root_b] = odd_a ^ odd_b ^ crosses;
        true
    }

    fn find(&self, mut disc: usize) -> (usize, bool) {
        let mut crossings = false;
        while self.first[disc] != disc {
            crossings ^= self.odd[disc];
            disc = self.first[disc];
        }
        (disc, crossings)
    }
}

/// Whether a robot does not fit between two discs; discs that touch leave it just enough.
fn overlap(a: &Closed, b: &Closed) -> bool {
    const ROUNDING: f64 = 1e-6;
    (a.centre - b.centre).norm() < a.radius + b.radius - ROUNDING
}

/// Whether two straight lines cross.
fn crosses(from: Position, to: Position, a: Position, b: Position) -> bool {
    let side = |from: Position, to: Position, at: Position| {
        let (way, off) = (to - from, at - from);
        way.x * off.y - way.y * off.x > 0.0
    };
    side(from, to, a) != side(from, to, b) && side(a, b, from) != side(a, b, to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ring(discs: usize, radius: f64) -> Vec<Closed> {
        let at = |disc: usize| std::f64::consts::TAU * disc as f64 / discs as f64;
        (0..discs).map(|d| Closed { centre: Position::new(at(d).cos(), at(d).sin()) * radius, radius: 1.5 }).collect()
    }

    #[test]
    fn a_ring_separates_inside_from_outside_and_one_with_a_gap_does_not() {
        let (inside, outside) = (Position::new(0.1, 0.2), Position::new(9.0, 3.0));
        let closed = ring(12, 4.0);
        let mut chains = Chains::default();
        assert!(chains.separate(&closed, inside, outside));
        assert!(!chains.separate(&closed, outside, Position::new(-9.0, 1.0)));
        assert!(!chains.separate(&closed, inside, Position::new(0.5, -0.4)));
        assert!(!chains.separate(&closed[..11], inside, outside), "4.1 m are enough for a robot");
        assert!(!chains.separate(&ring(6, 3.0), inside, outside), "discs that only touch let a robot through");
    }

    proptest! {
        /// A flood over a fine grid can only find ways that exist.
        #[test]
        fn what_a_flood_reaches_is_not_separate(
            discs in prop::collection::vec((0.0f64..12.0, 0.0f64..12.0, 0.5f64..2.0), 0..14),
        ) {
            let discs: Vec<Closed> =
                discs.iter().map(|(x, y, radius)| Closed { centre: Position::new(*x, *y), radius: *radius }).collect();
            const SIDE: usize = 72;
            let at = |cell: usize| Position::new((cell % SIDE) as f64, (cell / SIDE) as f64) * 0.25 - Position::new(3.0, 3.0);
            // Half a cell's diagonal of clearance: straight steps between neighbours stay outside.
            let open = |cell: usize| discs.iter().all(|disc| (at(cell) - disc.centre).norm() > disc.radius + 0.13);
            let (start, middle) = (0, 36 * SIDE + 36);
            prop_assume!(open(middle));
            let (mut seen, mut queue) = (vec![false; SIDE * SIDE], vec![start]);
            while let Some(cell) = queue.pop() {
                if std::mem::replace(&mut seen[cell], true) { continue; }
                let (x, y) = (cell % SIDE, cell / SIDE);
                if x > 0 { queue.push(cell - 1) }
                if x + 1 < SIDE { queue.push(cell + 1) }
                if y > 0 { queue.push(cell - SIDE) }
                if y + 1 < SIDE { queue.push(cell + SIDE) }
                queue.retain(|&cell| open(cell) && !seen[cell]);
            }
            if seen[middle] {
                prop_assert!(!Chains::default().separate(&discs, at(middle), at(start)));
            }
        }
    }
}

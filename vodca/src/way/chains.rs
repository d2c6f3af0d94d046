//! Closed chains of overlapping discs and pieces: whether they separate two places.

use super::corners::Closed;
use super::ground::Ground;
use crate::Position;

/// Two parts of a [`Ground`] between which no robot fits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Overlap {
    /// The number of the one.
    pub(super) a: usize,
    /// The number of the other.
    pub(super) b: usize,
    /// A place that is in both, m; none where the line from middle to middle lies within both.
    pub(super) via: Option<Position>,
}

/// Chains of discs (union and find), each disc with the parity of the crossings on the way to its chain's first disc.
#[derive(Clone, Debug, Default)]
pub(super) struct Chains {
    first: Vec<usize>,
    odd: Vec<bool>,
}

impl Chains {
    /// Room for so many discs and parts.
    pub(super) fn with_capacity(count: usize) -> Self {
        Self { first: Vec::with_capacity(count), odd: Vec::with_capacity(count) }
    }

    /// Whether `discs` and the ground close every way between two places outside of them. They do exactly where a closed
    /// chain of overlapping ones runs round one place and not the other, and such a chain crosses the straight line
    /// between them an odd number of times. All are convex: a line from the middle of one to that of another that
    /// overlaps with it, by way of a place in both, lies within both, and every closed chain within their union can be
    /// drawn together to such lines (the nerve of a cover by convex sets has the union's cycles).
    pub(super) fn separate(&mut self, discs: &[Closed], ground: &Ground, from: Position, to: Position) -> bool {
        let count = discs.len() + ground.parts();
        self.first.clear();
        self.first.extend(0..count);
        self.odd.clear();
        self.odd.resize(count, false);
        let crosses = |a: Position, via: Option<Position>, b: Position| match via {
            Some(via) => crosses(from, to, a, via) ^ crosses(from, to, via, b),
            None => crosses(from, to, a, b),
        };
        let part = |number: usize| discs.len() + number;
        for (a, disc) in discs.iter().enumerate() {
            for (b, other) in discs[..a].iter().enumerate() {
                if overlap(disc, other) && !self.link(a, b, crosses(disc.centre, None, other.centre)) {
                    return true;
                }
            }
        }
        for &Overlap { a, b, via } in ground.overlaps() {
            if !self.link(part(a), part(b), crosses(ground.middle(a), via, ground.middle(b))) {
                return true;
            }
        }
        (0..ground.parts()).any(|number| {
            discs.iter().enumerate().any(|(a, disc)| match ground.meets(number, disc) {
                Some(via) => !self.link(part(number), a, crosses(ground.middle(number), via, disc.centre)),
                None => false,
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
pub(super) fn overlap(a: &Closed, b: &Closed) -> bool {
    const ROUNDING: f64 = 1e-6;
    (a.centre - b.centre).norm() < a.radius + b.radius - ROUNDING
}

/// Whether two straight lines cross.
pub(super) fn crosses(from: Position, to: Position, a: Position, b: Position) -> bool {
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
        let (mut chains, nothing) = (Chains::default(), Ground::of_discs(&[], 1.5));
        assert!(chains.separate(&closed, &nothing, inside, outside));
        assert!(!chains.separate(&closed, &nothing, outside, Position::new(-9.0, 1.0)));
        assert!(!chains.separate(&closed, &nothing, inside, Position::new(0.5, -0.4)));
        assert!(!chains.separate(&closed[..11], &nothing, inside, outside), "4.1 m are enough for a robot");
        assert!(
            !chains.separate(&ring(6, 3.0), &nothing, inside, outside),
            "discs that only touch let a robot through"
        );
    }

    /// Walls of a box from (0, 0) to (12, 12) with a door of `width` (m) in the right one, for robots of clearance 0.75.
    fn room(width: f64) -> Ground {
        use crate::obstacles::Obstacles;
        use world::shape::{Obstacle, Shape};
        let jambs =
            [(12.0, 6.0 + width / 2.0), (12.0, 12.0), (0.0, 12.0), (0.0, 0.0), (12.0, 0.0), (12.0, 6.0 - width / 2.0)];
        let points = jambs.map(|(x, y)| Position::new(x, y)).to_vec();
        let wall = Obstacle::new("wall", Shape::Wall { points, thickness: 1e-3 }).unwrap();
        Ground::new(&Obstacles::new(&[], &[wall], 1.5), &[], 1.5)
    }

    #[test]
    fn a_room_is_shut_by_a_narrow_door_or_by_who_stands_in_a_wide_one() {
        let (inside, outside) = (Position::new(5.0, 4.0), Position::new(30.0, 17.0));
        let mut chains = Chains::default();
        assert!(chains.separate(&[], &room(1.49), inside, outside));
        assert!(!chains.separate(&[], &room(1.52), inside, outside));
        let stands = |y: f64| Closed { centre: Position::new(12.0, y), radius: 1.5 };
        assert!(chains.separate(&[stands(6.0)], &room(4.4), inside, outside));
        assert!(!chains.separate(&[stands(6.0)], &room(4.6), inside, outside));
        assert!(!chains.separate(&[stands(5.0)], &room(4.6), outside, Position::new(30.0, -7.0)));
        assert!(!chains.separate(&[stands(6.0)], &room(4.4), inside, Position::new(3.0, 9.0)));
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
                prop_assert!(!Chains::default().separate(&discs, &Ground::of_discs(&[], 1.5), at(middle), at(start)));
            }
        }
    }
}

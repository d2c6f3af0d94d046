//! Fewer corners for outlines, at the price of a bounded growth.
//!
//! A chord from one point of an outline to a later one takes the place of the points between them if all of
//! those lie on its left, where the solid is, and at most the bound away. What is added lies between the chain
//! and its chord. From a point of it, walk away from the chord at a right angle: within the bound the chain is
//! met, that is, the old solid. So no point of the new outline's inside is farther from an occupied cell than
//! the bound, and, chords being on the outside, nothing that was occupied is lost.
//!
//! A chord replaces no side that makes up most of it, so that straight walls stay as they are. It is taken only
//! if it touches no other part of the region's outlines, old or new, so that they still do not cross. Where what
//! is left of a hole's rim lies within what a chord adds, the whole hole does, and is filled.

use super::outline::{Point, Ring};

/// How many points in a row may spoil a chord before it is no longer looked for: the steps of flat stairs.
const PATIENCE: usize = 12;

/// Sides of up to this many cells may always be replaced, longer ones if they are at most half of the chord.
const SHORT: i64 = 4;

/// The outlines of one region, grown by at most `bound` cells.
pub(super) fn grown(rings: &[Ring], bound: f64) -> Vec<Ring> {
    let mut borders = Borders::new(rings);
    let grow = |(number, ring)| simplified(number, ring, bound, &mut borders);
    rings.iter().enumerate().filter_map(grow).collect()
}

/// One outline with fewer corners; none for a hole that is filled.
fn simplified(number: usize, ring: &Ring, bound: f64, borders: &mut Borders) -> Option<Ring> {
    let count = ring.len();
    // The lowest point, of those the one farthest left, is a corner that sticks out.
    let start = (0..count).min_by_key(|i| (ring[*i].1, ring[*i].0)).unwrap_or(0);
    let point = |i: usize| ring[(start + i) % count];
    let mut kept = vec![point(0)];
    let mut at = 0;
    while at < count {
        let mut candidates = Vec::new();
        let mut spoilt = 0;
        for to in at + 2..=count {
            if spoilt > PATIENCE {
                break;
            }
            let chain = (at..=to).map(point).collect::<Ring>();
            if bridges(&chain, bound) {
                candidates.push(to);
                spoilt = 0;
            } else {
                spoilt += 1;
            }
        }
        // No triangle is left of a ring without at least two other points.
        let enough = |to: usize| to < count || kept.len() >= 3;
        let chord = |to: usize| borders.is_clear(number, (start + at, start + to), point(at), point(to));
        let next = candidates.into_iter().rev().find(|to| enough(*to) && chord(*to));
        if let Some(to) = next {
            let left: Ring = kept.iter().copied().chain((to..count).map(point)).collect();
            if area(&left).signum() != area(ring).signum() {
                return None;
            }
            borders.replace(number, (start + at, start + to), point(at), point(to));
            at = to;
        } else {
            at += 1;
        }
        if at < count {
            kept.push(point(at));
        }
    }
    Some(without_straight(kept))
}

/// Twice the area of an outline, below 0 for the rim of a hole.
fn area(ring: &[Point]) -> i64 {
    (1..ring.len().saturating_sub(1)).map(|i| cross(ring[0], ring[i], ring[i + 1])).sum()
}

/// Whether all points of a chain lie on the left of the chord between its ends, at most `bound` away, and no
/// side makes up most of it.
fn bridges(chain: &[Point], bound: f64) -> bool {
    let (Some(&from), Some(&to)) = (chain.first(), chain.last()) else { return false };
    let squared = |a: Point, b: Point| (b.0 - a.0).pow(2) + (b.1 - a.1).pow(2);
    let most = bound * (squared(from, to) as f64).sqrt();
    let longest = squared(from, to).max(4 * SHORT * SHORT);
    from != to
        && chain.windows(2).all(|side| 4 * squared(side[0], side[1]) <= longest)
        && chain.iter().all(|point| {
            let off = cross(from, to, *point);
            off >= 0 && off as f64 <= most
        })
}

/// Twice the area of a triangle, above 0 where c is left of the line from a to b.
fn cross(a: Point, b: Point, c: Point) -> i64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// A ring without the points on straight sides.
fn without_straight(ring: Ring) -> Ring {
    let count = ring.len();
    let bends = |i: usize| cross(ring[(i + count - 1) % count], ring[i], ring[(i + 1) % count]) != 0;
    (0..count).filter(|i| bends(*i)).map(|i| ring[i]).collect()
}

/// The sides of all rings of a region as they are now.
struct Borders {
    /// By ring: its points.
    rings: Vec<Ring>,
    /// By ring and side: whether no chord has taken its place.
    stands: Vec<Vec<bool>>,
    chords: Vec<(Point, Point)>,
}

impl Borders {
    fn new(rings: &[Ring]) -> Self {
        let stands = rings.iter().map(|ring| vec![true; ring.len()]).collect();
        Self { rings: rings.to_vec(), stands, chords: Vec::new() }
    }

    /// Whether a chord touches nothing but the ends of the chain that it replaces, the points `chain.0` to
    /// `chain.1` of a ring, counted on past its end.
    fn is_clear(&self, number: usize, chain: (usize, usize), from: Point, to: Point) -> bool {
        let clear_of = |a: Point, b: Point| {
            if b == from || a == to {
                // The side before or behind, or one that meets it in a corner: it must not run back over it.
                let far = if b == from { a } else { b };
                return !is_on(far, from, to) && !is_on(if b == from { to } else { from }, a, b);
            }
            !touch(a, b, from, to)
        };
        let count = self.rings[number].len();
        let in_chain = |i: usize| (i + count - chain.0 % count) % count < chain.1 - chain.0;
        let sides = self.rings.iter().zip(&self.stands).enumerate().all(|(ring, (points, stands))| {
            (0..points.len()).all(|i| {
                !stands[i] || (ring == number && in_chain(i)) || clear_of(points[i], points[(i + 1) % points.len()])
            })
        });
        sides && self.chords.iter().all(|(a, b)| clear_of(*a, *b))
    }

    fn replace(&mut self, number: usize, chain: (usize, usize), from: Point, to: Point) {
        let count = self.rings[number].len();
        for i in chain.0..chain.1 {
            self.stands[number][i % count] = false;
        }
        self.chords.push((from, to));
    }
}

/// Whether a point lies on a straight line between two others.
fn is_on(point: Point, a: Point, b: Point) -> bool {
    cross(a, b, point) == 0
        && (a.0.min(b.0)..=a.0.max(b.0)).contains(&point.0)
        && (a.1.min(b.1)..=a.1.max(b.1)).contains(&point.1)
}

/// Whether two straight lines have a point in common.
fn touch(a: Point, b: Point, c: Point, d: Point) -> bool {
    if a.0.max(b.0) < c.0.min(d.0)
        || c.0.max(d.0) < a.0.min(b.0)
        || a.1.max(b.1) < c.1.min(d.1)
        || c.1.max(d.1) < a.1.min(b.1)
    {
        return false;
    }
    let apart = |p: i64, q: i64| p.signum() * q.signum() > 0;
    !apart(cross(a, b, c), cross(a, b, d)) && !apart(cross(c, d, a), cross(c, d, b))
}

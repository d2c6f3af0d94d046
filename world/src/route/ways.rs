//! All ways to one set-point.

use super::{CUT, REACHED, Roadmap, Unreachable, Walk, least_in_search};
use crate::Position;
use crate::check;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// No corner: the set-point is next.
pub(super) const NONE: u32 = u32::MAX;
/// How often a place that is too near to several pieces is moved out of the deepest.
const PUSHES: usize = 16;

/// Where a robot has to go next on its shortest way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The next bend, or the set-point, m: in a straight free line.
    pub point: Position,
    /// The length of the whole way that is left, m.
    pub left: f64,
    /// The corner that `point` is; none for the set-point. Pass it to the next [`Route::aim`].
    pub corner: Option<u32>,
}

/// All ways of robots of one clearance to one set-point.
#[derive(Clone, Debug)]
pub struct Route {
    map: Arc<Roadmap>,
    set_point: Position,
    /// By corner: what is left from there, m; infinite where no way leads on.
    left: Vec<f64>,
    /// By corner: the next one, or [`NONE`].
    next: Vec<u32>,
    /// The corners from which a way leads on, those with the least left first.
    order: Vec<u32>,
}

impl Route {
    /// The shortest ways from every corner to `set_point`, m.
    ///
    /// # Errors
    /// The set-point is inside an obstacle or nearer to one than the clearance.
    pub fn new(map: Arc<Roadmap>, set_point: Position) -> Result<Self, Unreachable> {
        let owed = map.clearance() * (1.0 - CUT / 2.0);
        check::place(map.obstacles(), "the robot", "set-point", set_point, owed)?;
        let least = least_in_search(map.clearance());
        let corners = map.corners();
        let (mut left, mut next) = (vec![f64::INFINITY; corners.len()], vec![NONE; corners.len()]);
        // All lengths are at least 0, so that their bits are in their order.
        let mut open = BinaryHeap::new();
        for (i, corner) in corners.iter().enumerate() {
            if map.keeps(corner.at, set_point, least) {
                left[i] = (set_point - corner.at).norm();
                open.push(Reverse((left[i].to_bits(), i as u32)));
            }
        }
        let mut order = Vec::with_capacity(corners.len());
        while let Some(Reverse((length, corner))) = open.pop() {
            let at = corner as usize;
            if length != left[at].to_bits() {
                continue; // A shorter one was found since.
            }
            order.push(corner);
            for &other in map.seen_from(at) {
                let to = other as usize;
                let length = left[at] + (corners[to].at - corners[at].at).norm();
                if length < left[to] {
                    (left[to], next[to]) = (length, corner);
                    open.push(Reverse((length.to_bits(), other)));
                }
            }
        }
        Ok(Self { map, set_point, left, next, order })
    }

    /// Where all ways end, m.
    pub fn set_point(&self) -> Position {
        self.set_point
    }

    /// The map that the ways run on.
    pub fn map(&self) -> &Arc<Roadmap> {
        &self.map
    }

    /// The corner after `corner`; none where the set-point is next.
    pub(super) fn after(&self, corner: u32) -> Option<u32> {
        Some(self.next[corner as usize]).filter(|next| *next != NONE)
    }

    /// Where a robot at `from` (m) has to go next, and how long its way is. `hint`, the corner of its last aim,
    /// only makes the answer quicker, never another. None where no way leads out. Nothing is allocated.
    ///
    /// Who is too near to something (robots slide along their ways) is led away from it, never nearer; where
    /// even that leads nowhere, because several pieces are too near, first straight out.
    pub fn aim(&self, from: Position, hint: Option<u32>) -> Option<Aim> {
        self.aim_from(from, hint).or_else(|| {
            let out = self.pushed_out(from)?;
            let aim = self.aim_from(out, hint)?;
            Some(Aim { point: out, left: aim.left + (out - from).norm(), corner: None })
        })
    }

    fn aim_from(&self, from: Position, hint: Option<u32>) -> Option<Aim> {
        let straight = (self.set_point - from).norm();
        if self.map.is_free(from, self.set_point) {
            return Some(Aim { point: self.set_point, left: straight, corner: None });
        }
        // Corners that it could only reach through their own shapes need no closer look, unless it is in one.
        let is_outside = self.map.is_outside(from);
        let mut best: Option<(f64, u32)> = None;
        let known = hint.filter(|corner| self.left.get(*corner as usize).is_some_and(|left| left.is_finite()));
        for &corner in known.iter().chain(&self.order) {
            let left = self.left[corner as usize];
            if best.is_some_and(|(least, _)| left > least) {
                break; // So it is for all that follow.
            }
            let at = self.map.corners()[corner as usize].at;
            let near = (at - from).norm();
            let way = (near + left, corner);
            let may_pass = || !is_outside || self.map.may_bend(from, corner as usize);
            if best.is_none_or(|least| way < least)
                && (near <= REACHED || (may_pass() && self.is_taut(from, corner) && self.map.is_free(from, at)))
            {
                best = Some(way);
            }
        }
        let (left, corner) = best?;
        let at = self.map.corners()[corner as usize].at;
        if (at - from).norm() > REACHED {
            return Some(Aim { point: at, left, corner: Some(corner) });
        }
        // It stands on the corner: what comes after it.
        let next = self.after(corner);
        let point = next.map_or(self.set_point, |next| self.map.corners()[next as usize].at);
        Some(Aim { point, left, corner: next })
    }

    /// Whether the way over `corner` bends there towards what it goes round: else there is a shorter one.
    fn is_taut(&self, from: Position, corner: u32) -> bool {
        let Some(next) = self.after(corner) else { return true };
        let corners = self.map.corners();
        let corner = &corners[corner as usize];
        let (into, on) = (corner.at - from, corners[next as usize].at - corner.at);
        let (bend, solid) = (into.perp(&on), into.perp(&(corner.pivot - corner.at)));
        let tolerance = 1e-9 * into.norm() * on.norm();
        bend.abs() <= tolerance || (bend > 0.0) == (solid > 0.0)
    }

    /// The nearest place outside that moving out of the deepest piece, again and again, leads to.
    fn pushed_out(&self, from: Position) -> Option<Position> {
        let clearance = self.map.clearance();
        let mut place = from;
        for _ in 0..PUSHES {
            let Some((_, nearest)) = self.map.obstacles().nearest(place, clearance) else { break };
            place += nearest.normal * (clearance - nearest.distance);
        }
        (place != from && self.map.is_open(place, least_in_search(clearance))).then_some(place)
    }

    /// The bends of the shortest way from `from` (m), the set-point last. Nothing is allocated.
    pub fn walk(&self, from: Position, hint: Option<u32>) -> Walk<'_> {
        Walk::new(self, from, self.aim(from, hint))
    }

    /// The length of the shortest way from `from`, m; none where no way leads out.
    pub fn length(&self, from: Position) -> Option<f64> {
        self.aim(from, None).map(|aim| aim.left)
    }
}

//! Along a way.

use super::{Aim, Route};
use crate::Position;

/// The bends of a way, in order, the set-point last. Empty where no way leads out.
#[derive(Clone, Debug)]
pub struct Walk<'a> {
    route: &'a Route,
    here: Position,
    /// What the iterator gives next.
    next: Option<Aim>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(route: &'a Route, from: Position, next: Option<Aim>) -> Self {
        Self { route, here: from, next }
    }

    /// The places at which a robot is that goes along the way by each of `steps` (m) in turn; it stays on the
    /// set-point once there, and where it is when no way leads out. Nothing is allocated.
    pub fn paced<I: IntoIterator<Item = f64>>(mut self, steps: I) -> impl Iterator<Item = Position> {
        let mut target = self.next();
        let mut here = None;
        steps.into_iter().map(move |mut step| {
            let mut place = here.unwrap_or(self.start());
            while let Some(point) = target {
                let rest = (point - place).norm();
                if rest > step {
                    place += (point - place) * (step / rest);
                    break;
                }
                step -= rest;
                place = point;
                target = self.next();
            }
            here = Some(place);
            place
        })
    }

    /// Where it began, m.
    fn start(&self) -> Position {
        self.here
    }
}

impl Iterator for Walk<'_> {
    type Item = Position;

    fn next(&mut self) -> Option<Position> {
        let aim = self.next?;
        self.next = if let Some(corner) = aim.corner {
            let map = self.route.map();
            let next = self.route.after(corner);
            let point = next.map_or(self.route.set_point(), |next| map.corners()[next as usize].at);
            Some(Aim { point, left: aim.left - (point - aim.point).norm(), corner: next })
        } else if aim.point != self.route.set_point() {
            self.route.aim(aim.point, None) // It was led straight out first.
        } else {
            None
        };
        Some(aim.point)
    }
}

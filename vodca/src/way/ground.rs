//! What never moves, for the centres of robots of one size: discs, or pieces on a roadmap.

use super::chains::{Overlap, crosses, overlap};
use super::corners::{CUT, Closed, is_free};
use crate::Position;
use crate::geometry::Disc;
use crate::obstacles::Obstacles;
use std::sync::Arc;
use world::route::Roadmap;
use world::shape::Piece;

/// What a way through a lane costs, in separations.
const TOLL: f64 = 4.0;
/// Nearer to closing a gap than this counts as leaving just enough, m.
const ROUNDING: f64 = 1e-6;

/// What the centre of a robot of one size must not enter.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    form: Form,
    /// Pairs of its parts between which the robot does not fit.
    overlaps: Vec<Overlap>,
    /// Lines from part to part across lanes in which two such robots cannot pass each other.
    lanes: Vec<(Position, Position)>,
    /// What a way through a lane costs more than it is long, m.
    toll: f64,
}

#[derive(Clone, Debug)]
enum Form {
    /// Discs only.
    Discs(Vec<Closed>),
    /// Convex pieces, discs among them.
    Pieces(Arc<Roadmap>),
}

impl Ground {
    /// Of a robot that owes `separation` (m) to a disc without extra radius. `places` are the set-points, where robots
    /// come to stand: they are in nobody's way here, but ways bend round them.
    pub(super) fn new(obstacles: &Obstacles, places: &[Closed], separation: f64) -> Self {
        if obstacles.are_discs() {
            return Self::of_discs(obstacles.discs(), separation);
        }
        let round: Vec<(Position, f64)> = places.iter().map(|place| (place.centre, place.radius)).collect();
        let clearance = obstacles.clearance(separation);
        let map = Roadmap::with_places(obstacles.all().clone(), clearance, &round);
        let pieces = map.obstacles().pieces();
        let (mut overlaps, mut lanes) = (Vec::new(), Vec::new());
        for (a, b) in pairs(pieces.len()) {
            match Gap::between(&pieces[a], &pieces[b], 4.0 * clearance) {
                Some(gap) if gap.width < 2.0 * clearance - ROUNDING => {
                    overlaps.push(Overlap { a, b, via: Some(gap.middle()) });
                }
                Some(gap)
                    if gap.width < 4.0 * clearance - ROUNDING && map.is_open(gap.middle(), clearance * (1.0 - CUT)) =>
                {
                    lanes.push((gap.on_a, gap.on_b));
                }
                _ => {}
            }
        }
        Self { form: Form::Pieces(Arc::new(map)), overlaps, lanes, toll: TOLL * separation }
    }

    /// The same where only discs stand.
    pub(super) fn of_discs(discs: &[Disc], separation: f64) -> Self {
        let close = |disc: &Disc| Closed { centre: disc.centre, radius: separation + disc.extra };
        let closed: Vec<Closed> = discs.iter().map(close).collect();
        let meet = |(a, b): &(usize, usize)| overlap(&closed[*a], &closed[*b]);
        let overlaps = pairs(closed.len()).filter(meet).map(|(a, b)| Overlap { a, b, via: None }).collect();
        Self { form: Form::Discs(closed), overlaps, lanes: Vec::new(), toll: 0.0 }
    }

    /// The discs, where there are only discs.
    pub(super) fn discs(&self) -> &[Closed] {
        match &self.form {
            Form::Discs(closed) => closed,
            Form::Pieces(_) => &[],
        }
    }

    /// The roadmap, where there is more than discs.
    pub(super) fn roadmap(&self) -> Option<&Roadmap> {
        match &self.form {
            Form::Discs(_) => None,
            Form::Pieces(map) => Some(map),
        }
    }

    /// Whether the straight way keeps out of everything. One that starts inside may lead out, not deeper.
    pub(super) fn is_free(&self, from: Position, to: Position) -> bool {
        match &self.form {
            Form::Discs(closed) => is_free(closed, from, to),
            Form::Pieces(map) => map.is_free(from, to),
        }
    }

    /// Whether a robot can stand there, but for the share of what it owes that ways may cut.
    pub(super) fn is_open(&self, place: Position) -> bool {
        match &self.form {
            Form::Discs(closed) => closed.iter().all(|disc| (place - disc.centre).norm() >= disc.radius * (1.0 - CUT)),
            Form::Pieces(map) => map.is_open(place, map.clearance() * (1.0 - CUT)),
        }
    }

    /// Whether a robot that stands there keeps all that it owes.
    pub(super) fn keeps(&self, place: Position) -> bool {
        match &self.form {
            Form::Discs(closed) => closed.iter().all(|disc| (place - disc.centre).norm() >= disc.radius),
            Form::Pieces(map) => map.is_open(place, map.clearance()),
        }
    }

    /// What the straight way costs more than it is long, m: so much for each lane that it leads through. Two who meet
    /// in a lane hold each other up until one has gone all the way back.
    pub(super) fn toll(&self, from: Position, to: Position) -> f64 {
        let through = |&&(a, b): &&(Position, Position)| crosses(from, to, a, b);
        if self.lanes.is_empty() { 0.0 } else { self.toll * self.lanes.iter().filter(through).count() as f64 }
    }

    /// How much a robot on the straight way has to spare beside the nearest part that comes within `reach` (m) of it, m.
    pub(super) fn room(&self, from: Position, to: Position, reach: f64) -> f64 {
        match &self.form {
            Form::Discs(_) => f64::INFINITY,
            Form::Pieces(map) => map.obstacles().separation(from, to, reach) - map.clearance(),
        }
    }

    /// How many parts there are.
    pub(super) fn parts(&self) -> usize {
        match &self.form {
            Form::Discs(closed) => closed.len(),
            Form::Pieces(map) => map.obstacles().pieces().len(),
        }
    }

    /// A place within part `number`, m.
    pub(super) fn middle(&self, number: usize) -> Position {
        match &self.form {
            Form::Discs(closed) => closed[number].centre,
            Form::Pieces(map) => map.obstacles().pieces()[number].core()[0],
        }
    }

    /// Pairs of parts between which the robot does not fit.
    pub(super) fn overlaps(&self) -> &[Overlap] {
        &self.overlaps
    }

    /// Whether the robot does not fit between part `number` and `disc`, and then by which place that is in both a line
    /// from the middle of the one to that of the other may bend; none: by none.
    pub(super) fn meets(&self, number: usize, disc: &Closed) -> Option<Option<Position>> {
        match &self.form {
            Form::Discs(closed) => overlap(&closed[number], disc).then_some(None),
            Form::Pieces(map) => {
                let piece = &map.obstacles().pieces()[number];
                if piece.bounds().distance(disc.centre) >= disc.radius + map.clearance() {
                    return None;
                }
                let nearest = piece.nearest(disc.centre);
                let closes = nearest.distance < disc.radius + map.clearance() - ROUNDING;
                let way = nearest.point - disc.centre;
                let share = if nearest.distance > disc.radius { disc.radius / nearest.distance } else { 1.0 };
                closes.then(|| Some(if nearest.distance > 0.0 { disc.centre + way * share } else { disc.centre }))
            }
        }
    }

    /// Gates between part after part and `place` that leave hardly more than a robot needs, m.
    pub(super) fn gates<'a>(&'a self, place: &'a Closed) -> impl Iterator<Item = Position> + 'a {
        let near =
            move |map: &'a Roadmap| map.obstacles().pieces_within(place.centre, place.radius + 2.0 * map.clearance());
        self.roadmap().into_iter().flat_map(near).filter_map(move |piece| {
            let nearest = piece.nearest(place.centre);
            let needed = place.radius + self.roadmap()?.clearance();
            let share = place.radius / needed;
            is_gate(nearest.distance / needed).then(|| place.centre + (nearest.point - place.centre) * share)
        })
    }
}

/// Whether no corner fits into a gap that is `wide` times as wide as a robot needs.
pub(super) fn is_gate(wide: f64) -> bool {
    (1.0..1.2).contains(&wide)
}

/// All pairs of numbers below `count`, the larger one first.
fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(|a| (0..a).map(move |b| (a, b)))
}

/// The narrowest line between two pieces.
struct Gap {
    width: f64,
    on_a: Position,
    on_b: Position,
}

impl Gap {
    /// None where it is wider than `most`, m. Projections on the one and the other in turn end where they are nearest to
    /// each other (Cheney and Goldstein 1959), in a common place where they overlap.
    fn between(a: &Piece, b: &Piece, most: f64) -> Option<Self> {
        if !a.bounds().grown(most).meets(&b.bounds()) {
            return None;
        }
        let width = a.distance_to(b);
        let onto = |piece: &Piece, place: Position| {
            let nearest = piece.nearest(place);
            if nearest.distance > 0.0 { nearest.point } else { place }
        };
        let mut on_a = a.core()[0];
        let mut on_b = onto(b, on_a);
        for _ in 0..200 {
            on_a = onto(a, on_b);
            on_b = onto(b, on_a);
        }
        (width < most).then_some(Self { width, on_a, on_b })
    }

    fn middle(&self) -> Position {
        (self.on_a + self.on_b) / 2.0
    }
}

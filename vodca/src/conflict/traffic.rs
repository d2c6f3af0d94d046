//! Traffic ahead: by how much a robot has to keep right so that, if everybody did the same, nobody would meet.
//!
//! It looks at where everybody wishes to go, not at plans: a plan shows a conflict only within the shorter of
//! two horizons, and then a row brakes whom an earlier turn would have led past.

use crate::Position;
use crate::geometry::turned;
use crate::params::Aim;

/// Turns that are tried: 0, and this many up to `aim.most`.
const TURNS: usize = 12;

/// A straight walk: the motion expected of a robot that meets nobody (ARCHITECTURE, rules 3 and 8).
#[derive(Clone, Copy, Debug)]
pub struct StraightMotion {
    /// Present position, m.
    pub from: Position,
    /// Set-point, m.
    pub to: Position,
    /// Largest move per tick and axis, m.
    pub stride: f64,
}

/// A walk with what does not depend on the turn.
#[derive(Clone, Copy, Debug)]
struct Straight {
    from: Position,
    way: Position,
    /// Share of a turn that is left this near to the set-point, 0..=1.
    fade: f64,
    /// Length of the walk, ticks; no whole tick: it stands.
    ticks: f64,
    /// Largest move per tick and axis, m.
    stride: f64,
}

impl Straight {
    fn new(aim: &Aim, StraightMotion { from, to, stride }: StraightMotion) -> Self {
        let way = to - from;
        Self { from, way, fade: aim.fade(way.norm()), ticks: way.amax() / stride, stride }
    }

    /// The move per tick after a right turn by `angle`, m: the largest axis at full speed.
    fn stride(&self, angle: f64) -> Position {
        if self.ticks < 1.0 {
            return Position::zeros();
        }
        let way = turned(self.way, -angle * self.fade);
        way * (self.stride / way.amax())
    }
}

/// The traffic round one robot in one tick.
#[derive(Clone, Debug)]
pub struct Traffic {
    aim: Aim,
    /// The others' walks with the separation owed to them, m.
    others: Vec<(Straight, f64)>,
}

impl Traffic {
    /// Room for `robots`.
    pub fn with_capacity(robots: usize, aim: &Aim) -> Self {
        Self { aim: aim.clone(), others: Vec::with_capacity(robots) }
    }

    /// Forgets the last tick.
    pub fn clear(&mut self) {
        self.others.clear();
    }

    /// One more robot that wishes to walk and is owed `separation`, m.
    pub fn add(&mut self, walk: StraightMotion, separation: f64) {
        self.others.push((Straight::new(&self.aim, walk), separation));
    }

    /// The right turn, rad, that a robot wishing to walk `own` should take: the one with the fewest
    /// meetings plus `aim.price` meetings per radian, if everybody took it. 0 when a straight walk
    /// meets nobody, at least `aim.angle` when it does.
    pub fn turn(&self, own: StraightMotion) -> f64 {
        let own = Straight::new(&self.aim, own);
        let straight = self.meetings(&own, 0.0, usize::MAX);
        if straight == 0 {
            return 0.0;
        }
        let (mut best, mut least) = (0.0, straight as f64);
        for turn in (1..=TURNS).map(|step| self.aim.most * step as f64 / TURNS as f64) {
            let price = self.aim.price * turn;
            if price >= least {
                break;
            }
            let cost = price + self.meetings(&own, turn, (least - price).ceil() as usize) as f64;
            if cost < least {
                (best, least) = (turn, cost);
            }
        }
        best.max(self.aim.angle)
    }

    /// How many others `own` meets within `aim.look_ahead` ticks if everybody turns right by `angle`;
    /// not counted on from `enough`.
    fn meetings(&self, own: &Straight, angle: f64, enough: usize) -> usize {
        let velocity = own.stride(angle);
        let meets = |(other, separation): &&(Straight, f64)| {
            // Whoever stands is met by who walks, whoever walks only until one of both has arrived.
            let walk = if other.ticks < 1.0 { own.ticks } else { own.ticks.min(other.ticks) };
            let until = walk.min(self.aim.look_ahead as f64);
            let apart = own.from - other.from;
            let closing = velocity - other.stride(angle);
            let speed_2 = closing.norm_squared();
            let nearest = if speed_2 > 0.0 { (-apart.dot(&closing) / speed_2).clamp(0.0, until) } else { 0.0 };
            (apart + closing * nearest).norm_squared() < separation * separation
        };
        self.others.iter().filter(meets).take(enough).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Params;
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};

    const STRIDE: f64 = 0.3;

    fn aim() -> Aim {
        Aim { angle: 0.1, most: 0.6, price: 3.0, look_ahead: 49, ..Params::safe().aim }
    }

    fn walk(from: (f64, f64), to: (f64, f64)) -> StraightMotion {
        StraightMotion { from: Position::new(from.0, from.1), to: Position::new(to.0, to.1), stride: STRIDE }
    }

    fn turn(aim: &Aim, own: StraightMotion, others: &[StraightMotion]) -> f64 {
        let mut traffic = Traffic::with_capacity(others.len(), aim);
        others.iter().for_each(|other| traffic.add(*other, 1.5));
        traffic.turn(own)
    }

    #[test]
    fn who_meets_nobody_walks_straight() {
        let own = walk((0.0, 0.0), (20.0, 0.0));
        assert_eq!(turn(&aim(), own, &[]), 0.0);
        assert_eq!(turn(&aim(), own, &[walk((20.0, 1.6), (0.0, 1.6))]), 0.0);
        assert_eq!(turn(&aim(), own, &[walk((40.0, 0.0), (20.0, 0.0))]), 0.0, "beyond 49 ticks");
    }

    #[test]
    fn head_on_the_least_turn_is_enough() {
        // Both turned by 0.1 rad pass each other at 2 m.
        let own = walk((0.0, 0.0), (20.0, 0.0));
        assert_eq!(turn(&aim(), own, &[walk((20.0, 0.0), (0.0, 0.0))]), 0.1);
    }

    #[test]
    fn who_stands_is_met_and_passed() {
        let stands = walk((8.0, -0.2), (8.0, -0.1));
        let angle = turn(&aim(), walk((0.0, 0.0), (20.0, 0.0)), &[stands]);
        assert!(8.0 * angle.sin() - 0.2 * angle.cos() >= 1.5 && angle < 0.3, "{angle}");
        assert_eq!(turn(&aim(), walk((0.0, 0.0), (5.0, 0.0)), &[stands]), 0.0, "arrived before");
    }

    #[test]
    fn a_ring_turns_into_a_roundabout() {
        // Sixteen walks through one point, as fast as each other: a circle on which 1.5 m are kept.
        let at = |k: usize| (10.0 * (TAU * k as f64 / 16.0).cos(), 10.0 * (TAU * k as f64 / 16.0).sin());
        let walks: Vec<StraightMotion> = (0..16).map(|k| walk(at(k), at(k + 8))).collect();
        let free = Aim { price: 0.1, ..aim() };
        let angle = turn(&free, walks[0], &walks[1..]);
        let circle = 1.5 / (2.0 * (PI / 16.0).sin());
        assert!(10.0 * angle.sin() > 0.8 * circle && angle < 0.6, "{angle}");
        let dear = Aim { price: 1000.0, ..aim() };
        assert_eq!(turn(&dear, walks[0], &walks[1..]), dear.angle);
    }

    proptest! {
        #[test]
        fn a_turn_is_in_bounds_and_costs_no_more_than_walking_straight(
            places in prop::collection::vec(((0.0..25.0, 0.0..25.0), (0.0..25.0, 0.0..25.0)), 2..20),
        ) {
            let walks: Vec<StraightMotion> = places.iter().map(|(from, to)| walk(*from, *to)).collect();
            let aim = Aim { angle: 0.0, ..aim() };
            let angle = turn(&aim, walks[0], &walks[1..]);
            prop_assert!((0.0..=aim.most).contains(&angle));
            let mut traffic = Traffic::with_capacity(walks.len(), &aim);
            walks[1..].iter().for_each(|other| traffic.add(*other, 1.5));
            let own = Straight::new(&aim, walks[0]);
            let cost = |angle: f64| traffic.meetings(&own, angle, usize::MAX) as f64 + aim.price * angle;
            for step in 0..=TURNS {
                prop_assert!(cost(angle) <= cost(aim.most * step as f64 / TURNS as f64) + 1e-12);
            }
        }
    }
}

//! Who takes its set-point first where set-points close each other in: the deepest.
//!
//! A set-point is *open* when a robot gets to it from far away although all others are taken. The open ones are
//! the first layer; what is open once they are left free, the second; and so on, as one peels an onion. Filled
//! from the last layer to the first, every set-point is open when its turn comes.

use super::chains::Chains;
use super::corners::{Closed, Corners};
use super::ground::Ground;
use crate::Position;
use crate::geometry::Disc;
use std::sync::Arc;

/// Farther than any layout reaches, m.
const FAR: f64 = 1e7;
/// Step in which a waiting place is searched, m.
const STEP: f64 = 0.1;

/// The turn of each robot.
#[derive(Clone, Debug, Default)]
pub struct Filling {
    /// By robot: the group of its set-point (those that can close each other in) and its layer, 1 for the open ones.
    turn: Vec<(usize, usize)>,
    /// By robot: where it waits, m; its set-point where it waits for nobody.
    pub outside: Vec<Position>,
}

impl Filling {
    /// The turns of robots that come to stand at `places` (set-points, with radii beyond min_separation / 2) among what
    /// stands for each of them, by `corners`.
    pub(super) fn new(places: &[Disc], corners: &[Arc<Corners>], min_separation: f64) -> Self {
        let grounds: Vec<&Ground> = corners.iter().map(|corners| &corners.ground).collect();
        Self::among(places, &grounds, min_separation)
    }

    fn among(places: &[Disc], grounds: &[&Ground], min_separation: f64) -> Self {
        let layers = layers(places, grounds, min_separation);
        let groups = groups(places, min_separation);
        let mut filling = Self { turn: groups.into_iter().zip(layers).collect(), outside: Vec::new() };
        filling.outside = (0..places.len())
            .map(|robot| filling.waiting_place(robot, places, grounds[robot], min_separation))
            .collect();
        filling
    }

    /// Whether `robot` waits until `other` has taken its set-point.
    pub fn waits(&self, robot: usize, other: usize) -> bool {
        let ((group, layer), (other_group, other_layer)) = (self.turn[robot], self.turn[other]);
        group == other_group && layer < other_layer
    }

    /// Straight away from those who come before until a lane as wide as a robot is left all round the group, and
    /// one more for each layer in between; as far as no obstacle is in the way.
    fn waiting_place(&self, robot: usize, places: &[Disc], ground: &Ground, min_separation: f64) -> Position {
        let own = places[robot];
        let owed = |disc: &Disc| min_separation + own.extra + disc.extra;
        let group = || (0..places.len()).filter(|&other| other != robot && self.turn[other].0 == self.turn[robot].0);
        let before = || group().filter(|&other| self.waits(robot, other));
        let away: Position =
            before().map(|other| own.centre - places[other].centre).map(|apart| apart / apart.norm_squared()).sum();
        let Some(step) = away.try_normalize(1e-9).map(|direction| direction * STEP) else { return own.centre };
        let deepest = before().map(|other| self.turn[other].1).max().unwrap_or_default();
        let lanes = (1 + deepest - self.turn[robot].1) as f64;
        let far =
            |at: Position| group().all(|other| (at - places[other].centre).norm() >= lanes * owed(&places[other]));
        let mut at = own.centre;
        while !far(at) && ground.keeps(at + step) {
            at += step;
        }
        at
    }
}

/// The layer of each place, 1 for the open ones. Those that never become open are of the last one.
fn layers(places: &[Disc], grounds: &[&Ground], min_separation: f64) -> Vec<usize> {
    let mut layers = vec![0; places.len()];
    let (mut chains, mut closed) = (Chains::default(), Vec::new());
    for layer in 1.. {
        let left: Vec<usize> = (0..places.len()).filter(|&robot| layers[robot] == 0).collect();
        let open: Vec<usize> = left
            .iter()
            .copied()
            .filter(|&robot| {
                let own = places[robot];
                let others = left.iter().filter(|&&other| other != robot).map(|&other| &places[other]);
                closed.clear();
                let owed = |disc: &Disc| min_separation + own.extra + disc.extra;
                closed.extend(others.map(|disc| Closed { centre: disc.centre, radius: owed(disc) }));
                // In a direction that no grid has.
                let far = own.centre + Position::new(1f64.cos(), 1f64.sin()) * FAR;
                !chains.separate(&closed, grounds[robot], own.centre, far)
            })
            .collect();
        let peeled = if open.is_empty() { &left } else { &open };
        peeled.iter().for_each(|&robot| layers[robot] = layer);
        if peeled.len() == left.len() {
            break;
        }
    }
    layers
}

/// The group of each place: those between which no robot fits belong together.
fn groups(places: &[Disc], min_separation: f64) -> Vec<usize> {
    let mut groups: Vec<usize> = (0..places.len()).collect();
    for a in 0..places.len() {
        for b in 0..a {
            let between = 2.0 * (min_separation + places[a].extra + places[b].extra);
            if (places[a].centre - places[b].centre).norm() < between {
                let (from, to) = (groups[a], groups[b]);
                groups.iter_mut().filter(|group| **group == from).for_each(|group| *group = to);
            }
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn grid(columns: usize, pitch: f64) -> Vec<Disc> {
        let at = |place: usize| Position::new((place % columns) as f64, (place / columns) as f64) * pitch;
        (0..columns * columns).map(|place| Disc { centre: at(place), extra: 0.0 }).collect()
    }

    fn among(places: &[Disc], obstacles: &[Disc]) -> Filling {
        let ground = Ground::of_discs(obstacles, 1.5);
        Filling::among(places, &vec![&ground; places.len()], 1.5)
    }

    #[test]
    fn a_square_of_places_is_filled_from_its_middle() {
        let ground = Ground::of_discs(&[], 1.5);
        let layers = layers(&grid(6, 1.55), &[&ground; 36], 1.5);
        let of = |layer: usize| layers.iter().filter(|own| **own == layer).count();
        assert_eq!((of(1), of(2), of(3)), (20, 12, 4));
        let filling = among(&grid(6, 1.55), &[]);
        assert!(filling.waits(0, 14) && !filling.waits(14, 0) && !filling.waits(0, 5));
        assert_eq!(filling.outside[14], grid(6, 1.55)[14].centre, "the deepest wait for nobody");
    }

    #[test]
    fn who_can_be_passed_waits_for_nobody() {
        let filling = among(&grid(5, 3.0), &[]);
        assert!((0..25).all(|robot| (0..25).all(|other| !filling.waits(robot, other))));
    }

    #[test]
    fn the_far_end_of_a_blind_alley_is_filled_first() {
        let wall = |x: f64, y: f64| Disc { centre: Position::new(x, y), extra: 0.0 };
        let alley: Vec<Disc> = (0..8).flat_map(|x| [wall(1.5 * x as f64, 1.6), wall(1.5 * x as f64, -1.6)]).collect();
        let end = [wall(11.6, 0.8), wall(11.6, -0.8)];
        let places = [wall(3.0, 0.0), wall(5.0, 0.0), wall(7.0, 0.0)];
        let filling = among(&places, &[&alley[..], &end[..]].concat());
        assert!(filling.waits(0, 1) && filling.waits(1, 2) && filling.waits(0, 2));
    }

    proptest! {
        /// What the rule rests on: whoever's turn it is finds a way past all who stand.
        #[test]
        fn filled_in_turn_every_place_is_open(
            places in prop::collection::vec((0.0f64..9.0, 0.0f64..9.0), 1..30),
        ) {
            let mut apart: Vec<Disc> = Vec::new();
            for (x, y) in places {
                let centre = Position::new(x, y);
                if apart.iter().all(|other| (other.centre - centre).norm() >= 1.5) {
                    apart.push(Disc { centre, extra: 0.0 });
                }
            }
            let ground = Ground::of_discs(&[], 1.5);
            let layers = layers(&apart, &vec![&ground; apart.len()], 1.5);
            for robot in 0..apart.len() {
                let stand: Vec<Closed> = (0..apart.len())
                    .filter(|&other| other != robot && layers[other] >= layers[robot])
                    .map(|other| Closed { centre: apart[other].centre, radius: 1.5 })
                    .collect();
                let far = apart[robot].centre + Position::new(1f64.cos(), 1f64.sin()) * FAR;
                prop_assert!(!Chains::default().separate(&stand, &ground, apart[robot].centre, far));
            }
        }
    }
}

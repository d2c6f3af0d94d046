//! Layouts with hardly more room than the robots need: parking lots, rings, permutations, mixed sizes.

use super::{ATTEMPTS, CENTRE, SPACING, ceil_sqrt, grid, offset, scenario, shuffled, stream};
use crate::Position;
use crate::random;
use crate::scenario::Scenario;
use chacha20::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

pub(super) const PARK: &str = "park:N:SEED";
pub(super) const TIGHT_RING: &str = "tight_ring:N:SEED";
pub(super) const PERMUTE: &str = "permute:N:SEED";
pub(super) const MIXED: &str = "mixed:N:SEED";

/// K of these layouts: the last ones wait for all others.
const MAX_TICKS: u64 = 1000;

/// Set-points in a square grid just wider than the separation (1.55 m against 1.5 m), starts at random around it.
pub(super) fn park(robots: usize, seed: u64) -> Result<Scenario, String> {
    const PITCH: f64 = 1.55;
    let mut generator = stream(seed, PARK, robots, 0);
    let columns = ceil_sqrt(robots);
    let lot = PITCH * columns as f64 / 2.0 + 1.5;
    // Enough ground for starts of 2 m: four times what they cover.
    let half = (lot * lot + 4.0 * robots as f64).sqrt() + 1.0;
    let outside = |generator: &mut ChaCha8Rng| {
        let point = offset(half, generator);
        (point.amax() > lot).then_some(point)
    };
    let starts = apart(robots, |_, _| SPACING, &mut generator, outside)?;
    let lots = shuffled(robots, &mut generator);
    let pairs = starts.into_iter().zip(lots).map(|(start, lot)| (start, CENTRE + grid(lot, columns, PITCH)));
    Ok(scenario(format!("park:{robots}:{seed}"), seed, MAX_TICKS, pairs, []))
}

/// Robots on a circle exchange places with the opposite point; each neighbour stands 1.5 to 1.7 m from the next.
pub(super) fn tight_ring(robots: usize, seed: u64) -> Scenario {
    let mut generator = stream(seed, TIGHT_RING, robots, 0);
    let chords: Vec<f64> = (0..robots).map(|_| 1.5 + 1e-6 + 0.2 * random::unit(&mut generator)).collect();
    let angle = |chord: f64, radius: f64| 2.0 * (chord / (2.0 * radius)).min(1.0).asin();
    // The circle on which these chords close: their angles grow as it shrinks.
    let (mut low, mut high) = (0.85, 0.85 + 1.7 * robots as f64);
    for _ in 0..100 {
        let radius = (low + high) / 2.0;
        let round: f64 = chords.iter().map(|chord| angle(*chord, radius)).sum();
        if round > TAU { low = radius } else { high = radius }
    }
    let mut at = TAU * random::unit(&mut generator);
    let pairs: Vec<(Position, Position)> = chords
        .iter()
        .map(|chord| {
            let place = Position::new(at.cos(), at.sin()) * high;
            at += angle(*chord, high);
            (CENTRE + place, CENTRE - place)
        })
        .collect();
    scenario(format!("tight_ring:{robots}:{seed}"), seed, MAX_TICKS, pairs, [])
}

/// Everybody goes to somebody's place in a square grid of 2.2 m: no start is free before its robot has left.
pub(super) fn permute(robots: usize, seed: u64) -> Scenario {
    const PITCH: f64 = 2.2;
    let columns = ceil_sqrt(robots);
    let places = shuffled(robots, &mut stream(seed, PERMUTE, robots, 0));
    let at = |place: usize| CENTRE + grid(place, columns, PITCH);
    let pairs = places.into_iter().enumerate().map(|(start, set_point)| (at(start), at(set_point)));
    scenario(format!("permute:{robots}:{seed}"), seed, MAX_TICKS, pairs, [])
}

/// Robots of 0.4 to 1.2 m radius in a box with as much free ground as one of `box:N` has.
pub(super) fn mixed(robots: usize, seed: u64) -> Result<Scenario, String> {
    let mut generator = stream(seed, MIXED, robots, 0);
    let radii: Vec<f64> = (0..robots).map(|_| 0.4 + 0.8 * random::unit(&mut generator)).collect();
    let ground: f64 = radii.iter().map(|radius| PI * radius * radius).sum();
    let half = (ground / 0.18).sqrt().max(12.0) / 2.0;
    // A quarter of a metre more than they need, as 2 m are half a metre more than 1.5 m.
    let needed = |a: usize, b: usize| radii[a] + radii[b] + 0.5;
    let starts = apart(robots, needed, &mut generator, |generator| Some(offset(half, generator)))?;
    let set_points = apart(robots, needed, &mut generator, |generator| Some(offset(half, generator)))?;
    let mut made = scenario(format!("mixed:{robots}:{seed}"), seed, MAX_TICKS, starts.into_iter().zip(set_points), []);
    for (robot, radius) in made.robots.iter_mut().zip(radii) {
        robot.radius = Some((radius * 1e9).round() / 1e9);
    }
    Ok(made)
}

/// `count` points drawn by `draw` (relative to the centre; `None`: try again), each pair `needed` metres apart.
pub(super) fn apart(
    count: usize,
    needed: impl Fn(usize, usize) -> f64,
    generator: &mut ChaCha8Rng,
    draw: impl Fn(&mut ChaCha8Rng) -> Option<Position>,
) -> Result<Vec<Position>, String> {
    let mut placed: Vec<Position> = Vec::with_capacity(count);
    for index in 0..count {
        let point = (0..ATTEMPTS)
            .filter_map(|_| draw(generator))
            .map(|point| CENTRE + point)
            .find(|point| placed.iter().enumerate().all(|(other, at)| (point - at).norm() >= needed(index, other)));
        placed.push(point.ok_or("there is no room for so many; use fewer robots or another seed")?);
    }
    Ok(placed)
}

//! Layouts with walls: rows of touching discs with openings.

use super::tight::apart;
use super::{CENTRE, SPACING, ceil_sqrt, grid, scenario, shuffled, stream};
use crate::Position;
use crate::random;
use crate::scenario::Scenario;
use chacha20::ChaCha8Rng;

pub(super) const DOOR: &str = "door:N:WIDTH:SEED";
pub(super) const POCKET: &str = "pocket:N:SEED";
pub(super) const CORRIDOR: &str = "corridor:N:SEED";
pub(super) const FOREST: &str = "forest:N:SEED";
pub(super) const ROOMS: &str = "rooms:N:SEED";

/// K of layouts in which robots queue.
pub(super) const MAX_TICKS: u64 = 1500;
/// Radius of a wall's discs, m: half of the usual min_separation, what a disc without a radius has.
const RADIUS: f64 = 0.75;
/// Width of the openings between rooms, m.
const DOORWAY: f64 = 3.4;
/// Least clear width of an opening, m: a robot passes with 0.1 m to spare.
pub(super) const NARROWEST: f64 = 1.6;

/// A uniform draw from the rectangle between two corners, relative to the centre.
fn rectangle(low: (f64, f64), high: (f64, f64)) -> impl Fn(&mut ChaCha8Rng) -> Option<Position> {
    move |generator| {
        let mut draw = |low: f64, high: f64| low + (high - low) * random::unit(generator);
        Some(Position::new(draw(low.0, high.0), draw(low.1, high.1)))
    }
}

/// Discs that touch each other from `from` on towards `to`, the last one reaching at least as far.
fn wall(from: Position, to: Position) -> impl Iterator<Item = Position> {
    let way = to - from;
    let discs = (way.norm() / (2.0 * RADIUS)).ceil() as usize;
    (0..=discs).map(move |disc| CENTRE + from + way.normalize() * (2.0 * RADIUS * disc as f64))
}

/// A wall with one opening of `width` (m) clear; half of the robots on each side want to the other.
pub(super) fn door(robots: usize, width: f64, seed: u64) -> Result<Scenario, String> {
    let mut generator = stream(seed, DOOR, robots, (width * 1e6).round() as usize);
    // Ground for places 2 m apart at random: three times what a square grid of them takes.
    let half = (6.0 * robots as f64).sqrt().max(6.0) / 2.0;
    let side = |x: f64| rectangle((x - half, -half), (x + half, half));
    let (left, right) = (robots.div_ceil(2), robots / 2);
    let mut places = |count, x| apart(count, |_, _| SPACING, &mut generator, side(x));
    let away = 4.0 + half;
    let (mut starts, mut set_points) = (places(left, -away)?, places(left, away)?);
    starts.extend(places(right, away)?);
    set_points.extend(places(right, -away)?);
    let jamb = width / 2.0 + RADIUS;
    let end = half + jamb + 6.0;
    let obstacles = wall(Position::new(0.0, jamb), Position::new(0.0, end))
        .chain(wall(Position::new(0.0, -jamb), Position::new(0.0, -end)));
    let name = format!("door:{robots}:{width}:{seed}");
    Ok(scenario(name, seed, MAX_TICKS, starts.into_iter().zip(set_points), obstacles))
}

/// Everybody starts inside a U and wants behind its closed side.
pub(super) fn pocket(robots: usize, seed: u64) -> Result<Scenario, String> {
    let mut generator = stream(seed, POCKET, robots, 0);
    let columns = ceil_sqrt(robots);
    let half = (columns as f64 * SPACING / 2.0).max(2.0);
    let inside = rectangle((-half, -half), (half, half));
    // The densest random packing of discs covers 0.54 of the ground: a grid with small draws is sure to fit.
    let starts = (0..robots).map(|robot| {
        let slack = rectangle((-0.2, -0.2), (0.2, 0.2))(&mut generator).unwrap_or_default();
        CENTRE + grid(robot, columns, SPACING + 0.2) + slack
    });
    let starts: Vec<Position> = starts.collect();
    let behind = apart(
        robots,
        |_, _| SPACING,
        &mut generator,
        |generator| inside(generator).map(|point| point * 1.6 + Position::new(2.6 * half + 6.0, 0.0)),
    )?;
    let order = shuffled(robots, &mut generator);
    let pairs: Vec<(Position, Position)> = starts.into_iter().zip(order.into_iter().map(|i| behind[i])).collect();
    let (back, arm) = (half + 1.5 + RADIUS, half + 1.5 + RADIUS);
    let corner = |sign: f64| Position::new(back, sign * arm);
    let obstacles = wall(corner(1.0), Position::new(-half, arm))
        .chain(wall(corner(-1.0), Position::new(-half, -arm)))
        .chain(wall(corner(-1.0) + Position::new(0.0, 2.0 * RADIUS), corner(1.0) - Position::new(0.0, 2.0 * RADIUS)));
    Ok(scenario(format!("pocket:{robots}:{seed}"), seed, MAX_TICKS, pairs, obstacles))
}

/// Two walls 4.2 m apart and 20 m long; half of the robots at each end want to the other.
pub(super) fn corridor(robots: usize, seed: u64) -> Result<Scenario, String> {
    const WIDTH: f64 = 4.2;
    const HALF_LENGTH: f64 = 10.0;
    let mut generator = stream(seed, CORRIDOR, robots, 0);
    let half = (6.0 * robots as f64).sqrt().max(6.0) / 2.0;
    let side = |x: f64| rectangle((x - half, -half), (x + half, half));
    let mut places = |count, x| apart(count, |_, _| SPACING, &mut generator, side(x));
    let (left, right, away) = (robots.div_ceil(2), robots / 2, HALF_LENGTH + 3.0 + half);
    let (mut starts, mut set_points) = (places(left, -away)?, places(left, away)?);
    starts.extend(places(right, away)?);
    set_points.extend(places(right, -away)?);
    let y = WIDTH / 2.0 + RADIUS;
    let obstacles =
        [y, -y].into_iter().flat_map(|y| wall(Position::new(-HALF_LENGTH, y), Position::new(HALF_LENGTH, y)));
    let name = format!("corridor:{robots}:{seed}");
    Ok(scenario(name, seed, MAX_TICKS, starts.into_iter().zip(set_points), obstacles))
}

/// A box full of trees: as many as robots, at least 12, 3.3 m from each other (a robot passes between any two).
pub(super) fn forest(robots: usize, seed: u64) -> Result<Scenario, String> {
    const BETWEEN: f64 = 3.3;
    let mut generator = stream(seed, FOREST, robots, 0);
    let trees = robots.max(12);
    let half = (robots as f64 * 8.0 + trees as f64 * 18.0).sqrt() / 2.0;
    let box_ = rectangle((-half, -half), (half, half));
    let trees = apart(trees, |_, _| BETWEEN, &mut generator, &box_)?;
    let clear = |generator: &mut ChaCha8Rng| {
        box_(generator).filter(|point| trees.iter().all(|tree| (CENTRE + point - tree).norm() >= SPACING))
    };
    let starts = apart(robots, |_, _| SPACING, &mut generator, clear)?;
    let set_points = apart(robots, |_, _| SPACING, &mut generator, clear)?;
    let pairs = starts.into_iter().zip(set_points);
    Ok(scenario(format!("forest:{robots}:{seed}"), seed, 1000, pairs, trees))
}

/// Four rooms round a crossing of two walls, a door between each and the next; everybody wants into another room.
pub(super) fn rooms(robots: usize, seed: u64) -> Result<Scenario, String> {
    let mut generator = stream(seed, ROOMS, robots, 0);
    let room = (4.0 * robots as f64).sqrt().max(10.0);
    let reach = room + 2.5;
    // By robot, so that every room holds about as many at the start and at the end.
    let into = |room_of: usize| {
        let corner = |sign: f64| if sign > 0.0 { (2.5, reach) } else { (-reach, -2.5) };
        let (x, y) =
            (corner(if room_of & 1 == 0 { 1.0 } else { -1.0 }), corner(if room_of & 2 == 0 { 1.0 } else { -1.0 }));
        rectangle((x.0, y.0), (x.1, y.1))
    };
    let mut starts: Vec<Vec<Position>> = Vec::new();
    let mut set_points: Vec<Vec<Position>> = Vec::new();
    let first: Vec<usize> = (0..robots).map(|robot| robot % 4).collect();
    let last: Vec<usize> =
        first.iter().map(|from| (from + 1 + random::below(&mut generator, 3) as usize) % 4).collect();
    for of in 0..4 {
        let count = |rooms: &[usize]| rooms.iter().filter(|room| **room == of).count();
        starts.push(apart(count(&first), |_, _| SPACING, &mut generator, into(of))?);
        set_points.push(apart(count(&last), |_, _| SPACING, &mut generator, into(of))?);
    }
    let take = |from: &mut Vec<Vec<Position>>, room: usize| from[room].pop().unwrap_or(CENTRE);
    let pairs: Vec<(Position, Position)> =
        first.iter().zip(&last).map(|(from, to)| (take(&mut starts, *from), take(&mut set_points, *to))).collect();
    let arms = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, y)| Position::new(x, y));
    let (near, far) = (room / 2.0 - DOORWAY / 2.0, room / 2.0 + DOORWAY / 2.0 + 2.0 * RADIUS);
    let obstacles = std::iter::once(CENTRE).chain(arms.into_iter().flat_map(|arm| {
        // From the outer jamb outwards, from the inner one to the crossing.
        let inner = wall(arm * near, arm * 2.0 * RADIUS).filter(|disc| (disc - CENTRE).norm() > RADIUS);
        wall(arm * far, arm * (reach + 6.0)).chain(inner)
    }));
    Ok(scenario(format!("rooms:{robots}:{seed}"), seed, MAX_TICKS, pairs, obstacles))
}

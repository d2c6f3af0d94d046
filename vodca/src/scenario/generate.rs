//! Scenarios of any size by name: rings, random boxes, exchanges of sides, gathering groups, tight places
//! ([`tight`]), walls ([`walls`]) and a hall ([`warehouse`]).
//!
//! Coordinates are rounded to 1e-9 m, so that a generated layout and its copy in a file are the same
//! on every machine.

mod tight;
mod walls;
mod warehouse;

use super::file::{obstacle_name, robot_name};
use super::{DEFAULT_MAX_TICKS, MAX_ROBOTS, Obstacle, Robot, Scenario, ScenarioError};
use crate::Position;
use crate::random::{self, Use};
use chacha20::ChaCha8Rng;
use std::f64::consts::PI;
use tight::{MIXED, PARK, PERMUTE, TIGHT_RING};
use walls::{CORRIDOR, DOOR, FOREST, POCKET, ROOMS};
use warehouse::WAREHOUSE;

/// The forms of all generators, for messages.
pub(super) const FORMS: &[&str] = &[
    RING, BOX, EXCHANGE, SEGREGATE, PARK, TIGHT_RING, PERMUTE, MIXED, DOOR, POCKET, CORRIDOR, FOREST, ROOMS, WAREHOUSE,
];
const RING: &str = "ring:N";
const BOX: &str = "box:N:OBSTACLES:SEED";
const EXCHANGE: &str = "exchange:N:SEED";
const SEGREGATE: &str = "segregate:GROUPSxSIZE:SEED";

/// Centre of all generated layouts, m.
const CENTRE: Position = Position::new(12.5, 12.5);
/// Centre distance kept between starts, set-points and obstacles that are drawn, m.
const SPACING: f64 = 2.0;
/// Distance of obstacles, m: a disc of 1.5 m passes between them with room to spare.
const PASSAGE: f64 = 3.6;
/// Draws per point before a box counts as too full.
const ATTEMPTS: usize = 10_000;

/// Makes the scenario of a generator `spec`, or `None` when `spec` names no generator. A missing N is
/// taken from `robots`; missing obstacles and seed are 0.
pub(super) fn from_spec(spec: &str, robots: Option<usize>) -> Option<Result<Scenario, ScenarioError>> {
    let mut parts = spec.split(':');
    let kind = parts.next()?;
    let form = FORMS.iter().copied().find(|form| form.split(':').next() == Some(kind))?;
    let arguments: Vec<&str> = parts.collect();
    let made =
        make(form, &arguments, robots).map_err(|reason| ScenarioError::Generator { spec: spec.into(), reason, form });
    Some(made.and_then(|scenario| scenario.validate().map(|()| scenario)))
}

fn make(form: &str, arguments: &[&str], robots: Option<usize>) -> Result<Scenario, String> {
    let most = form.split(':').count() - 1;
    if arguments.len() > most {
        return Err(format!("{} arguments are too many", arguments.len()));
    }
    let number = |index: usize, what: &str, high: u64| match arguments.get(index) {
        None => Ok(0),
        Some(text) => match text.parse::<u64>() {
            Ok(value) if value <= high => Ok(value),
            _ => Err(format!("{what} `{text}` is not a whole number in 0..={high}")),
        },
    };
    let seed = |index| number(index, "seed", i64::MAX as u64);
    let count = || match (arguments.first(), robots) {
        (Some(text), _) => match text.parse() {
            Ok(n) if (1..=MAX_ROBOTS).contains(&n) => Ok(n),
            _ => Err(format!("the number of robots `{text}` is not in 1..={MAX_ROBOTS}")),
        },
        (None, Some(n)) if (1..=MAX_ROBOTS).contains(&n) => Ok(n),
        (None, Some(n)) => Err(format!("the number of robots {n} is not in 1..={MAX_ROBOTS}")),
        (None, None) => Err("the number of robots is missing".into()),
    };
    match form {
        RING => Ok(ring(count()?)),
        BOX => random_box(count()?, number(1, "number of obstacles", MAX_ROBOTS as u64)? as usize, seed(2)?),
        EXCHANGE => Ok(exchange(count()?, seed(1)?)),
        PARK => tight::park(count()?, seed(1)?),
        TIGHT_RING => Ok(tight::tight_ring(count()?, seed(1)?)),
        PERMUTE => Ok(tight::permute(count()?, seed(1)?)),
        MIXED => tight::mixed(count()?, seed(1)?),
        DOOR => walls::door(count()?, width(arguments.get(1).copied())?, seed(2)?),
        POCKET => walls::pocket(count()?, seed(1)?),
        CORRIDOR => walls::corridor(count()?, seed(1)?),
        FOREST => walls::forest(count()?, seed(1)?),
        ROOMS => walls::rooms(count()?, seed(1)?),
        WAREHOUSE => warehouse::warehouse(count()?, seed(1)?),
        _ => {
            let text = arguments.first().ok_or("the groups are missing")?;
            let sizes = text.split_once('x').and_then(|(g, s)| Some((g.parse().ok()?, s.parse().ok()?)));
            match sizes {
                Some((groups, size)) if (1..=MAX_ROBOTS).contains(&usize::saturating_mul(groups, size)) => {
                    Ok(segregate(groups, size, seed(1)?))
                }
                _ => Err(format!("`{text}` is not GROUPSxSIZE with 1..={MAX_ROBOTS} robots in all")),
            }
        }
    }
}

/// The clear width of a door, m; 3.4 where none is given: two robots pass each other.
fn width(text: Option<&str>) -> Result<f64, String> {
    let Some(text) = text else { return Ok(3.4) };
    match text.parse::<f64>() {
        Ok(width) if (walls::NARROWEST..=100.0).contains(&width) => Ok(width),
        _ => Err(format!("the width `{text}` is not a number of metres in {}..=100", walls::NARROWEST)),
    }
}

/// `robots` robots on a circle, each to the opposite point: 10 m radius up to 32 robots, beyond that
/// 2 m of circumference for each. Up to rounding these are the layouts antipodal4..100.
fn ring(robots: usize) -> Scenario {
    let radius = if robots <= 32 { 10.0 } else { robots as f64 * SPACING / (2.0 * PI) };
    let on_circle = |i: usize| {
        let angle = 2.0 * PI * i as f64 / robots as f64;
        Position::new(angle.cos(), angle.sin()) * radius
    };
    let pairs = (0..robots).map(|i| (CENTRE + on_circle(i), CENTRE - on_circle(i)));
    let max_ticks = if robots <= 32 { DEFAULT_MAX_TICKS } else { 1000.max(10 * robots as u64) };
    scenario(format!("ring:{robots}"), 0, max_ticks, pairs, [])
}

/// Starts, set-points and obstacles uniform in a square of 22 m (larger beyond 48 discs, at the same
/// density), at least 2 m apart where they could touch; obstacles leave room to pass between them.
fn random_box(robots: usize, obstacles: usize, seed: u64) -> Result<Scenario, String> {
    let discs = robots + obstacles;
    let side = 22.0 * (discs as f64 / 48.0).sqrt().max(1.0);
    let mut generator = stream(seed, BOX, robots, obstacles);
    let mut place = |count: usize, apart: f64, taken: &[Position]| -> Result<Vec<Position>, String> {
        let mut placed = taken.to_vec();
        for _ in 0..count {
            let mut draw = || side * (random::unit(&mut generator) - 0.5);
            let point = (0..ATTEMPTS)
                .map(|_| CENTRE + Position::new(draw(), draw()))
                .find(|point| {
                    let far = |(index, other): (usize, &Position)| {
                        (point - other).norm() >= if index < taken.len() { SPACING } else { apart }
                    };
                    placed.iter().enumerate().all(far)
                })
                .ok_or("the box is too full; use fewer robots or obstacles, or another seed")?;
            placed.push(point);
        }
        Ok(placed.split_off(taken.len()))
    };
    let obstacle = place(obstacles, PASSAGE, &[])?;
    let start = place(robots, SPACING, &obstacle)?;
    let set_point = place(robots, SPACING, &obstacle)?;
    let max_ticks = if discs <= 51 { DEFAULT_MAX_TICKS } else { 1000 };
    let name = format!("box:{robots}:{obstacles}:{seed}");
    Ok(scenario(name, seed, max_ticks, start.into_iter().zip(set_point), obstacle))
}

/// Two sides swap, as in the layouts ex14_*: lanes 3 m apart (at most 8, then further columns behind),
/// a random lane on the other side, one obstacle in the middle for every second lane.
fn exchange(robots: usize, seed: u64) -> Scenario {
    const LANES: usize = 8;
    let mut generator = stream(seed, EXCHANGE, robots, 0);
    let mut pairs = Vec::with_capacity(robots);
    for (side, count) in [(-1.0, robots.div_ceil(2)), (1.0, robots / 2)] {
        for column in 0..count.div_ceil(LANES) {
            let lanes = (count - column * LANES).min(LANES);
            let x = side * (10.0 + 3.0 * column as f64);
            let y = |lane: usize| 3.0 * (lane as f64 - (lanes - 1) as f64 / 2.0);
            let targets = shuffled(lanes, &mut generator);
            for (lane, target) in targets.into_iter().enumerate() {
                let start = Position::new(x, y(lane)) + offset(0.4, &mut generator);
                let set_point = Position::new(-x, y(target)) + offset(0.4, &mut generator);
                pairs.push((CENTRE + start, CENTRE + set_point));
            }
        }
    }
    let obstacles = robots.div_ceil(2).min(LANES) / 2;
    let obstacle: Vec<Position> = (0..obstacles)
        .map(|l| {
            let y = 6.0 * (l as f64 - (obstacles as f64 - 1.0) / 2.0);
            CENTRE + Position::new(0.0, y) + offset(1.0, &mut generator)
        })
        .collect();
    let max_ticks = if robots <= 2 * LANES { DEFAULT_MAX_TICKS } else { 1000 };
    scenario(format!("exchange:{robots}:{seed}"), seed, max_ticks, pairs, obstacle)
}

/// Groups gather, as in the layouts segregate*: all start mixed on a grid of 2.5 m, each group's
/// set-points are a grid of 2 m, the groups' centres lie on a circle.
fn segregate(groups: usize, size: usize, seed: u64) -> Scenario {
    let robots = groups * size;
    let mut generator = stream(seed, SEGREGATE, groups, size);
    let columns = ceil_sqrt(robots);
    let places = shuffled(robots, &mut generator);
    let group_columns = ceil_sqrt(size);
    let extent = (group_columns - 1) as f64 * SPACING;
    // Neighbouring groups keep 2 m between their corners' circumcircles.
    let reach = extent * 2f64.sqrt() + SPACING;
    let radius = if groups == 1 { 8.5 } else { f64::max(8.5, reach / (2.0 * (PI / groups as f64).sin())) };
    let pairs: Vec<(Position, Position)> = (0..robots)
        .map(|robot| {
            let start = grid(places[robot], columns, 2.5) + offset(0.2, &mut generator);
            let angle = PI / 2.0 + 2.0 * PI * (robot / size) as f64 / groups as f64;
            let centre = Position::new(angle.cos(), angle.sin()) * radius;
            (CENTRE + start, CENTRE + centre + grid(robot % size, group_columns, SPACING))
        })
        .collect();
    let max_ticks = if robots <= 16 { DEFAULT_MAX_TICKS } else { 1000 };
    scenario(format!("segregate:{groups}x{size}:{seed}"), seed, max_ticks, pairs, [])
}

/// Point `index` of a square grid around the origin with `columns` columns.
fn grid(index: usize, columns: usize, spacing: f64) -> Position {
    let middle = (columns - 1) as f64 / 2.0;
    Position::new((index % columns) as f64 - middle, (index / columns) as f64 - middle) * spacing
}

fn ceil_sqrt(n: usize) -> usize {
    (n as f64).sqrt().ceil() as usize
}

/// A uniform draw from a square of half width `half`.
fn offset(half: f64, generator: &mut ChaCha8Rng) -> Position {
    let mut draw = || half * (2.0 * random::unit(generator) - 1.0);
    Position::new(draw(), draw())
}

/// The numbers below `n` in random order (Fisher and Yates).
fn shuffled(n: usize, generator: &mut ChaCha8Rng) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        order.swap(i, random::below(generator, i as u64 + 1) as usize);
    }
    order
}

/// Each form and size draws from its own stream.
fn stream(seed: u64, form: &str, a: usize, b: usize) -> ChaCha8Rng {
    let kind = FORMS.iter().position(|known| *known == form).unwrap_or_default() as u64;
    random::stream(seed, Use::Scenario, kind << 32 | a as u64, b as u64)
}

fn scenario(
    name: String,
    seed: u64,
    max_ticks: u64,
    pairs: impl IntoIterator<Item = (Position, Position)>,
    obstacles: impl IntoIterator<Item = Position>,
) -> Scenario {
    let rounded = |point: Position| point.map(|x| (x * 1e9).round() / 1e9);
    Scenario {
        name,
        robots: pairs
            .into_iter()
            .enumerate()
            .map(|(i, (start, set_point))| Robot {
                name: robot_name(i),
                start: rounded(start),
                set_point: rounded(set_point),
                radius: None,
                max_speed: None,
            })
            .collect(),
        obstacles: obstacles
            .into_iter()
            .enumerate()
            .map(|(i, position)| Obstacle { name: obstacle_name(i), position: rounded(position), radius: None })
            .collect(),
        shapes: Vec::new(),
        max_ticks,
        seed,
        allow_close_start: false,
        params: toml::Table::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(spec: &str) -> Scenario {
        let scenario = Scenario::resolve(Some(spec), None).unwrap_or_else(|error| panic!("{error}"));
        scenario.validate_distances(1.5).unwrap_or_else(|error| panic!("{error}"));
        scenario
    }

    #[test]
    fn rings_are_the_published_ones() {
        for n in [4, 8, 16, 32, 64, 100] {
            let (ours, published) = (made(&format!("ring:{n}")), made(&format!("antipodal{n}")));
            assert_eq!(ours.max_ticks, published.max_ticks);
            for (a, b) in ours.robots.iter().zip(&published.robots) {
                assert!((a.start - b.start).amax() < 2e-9 && (a.set_point - b.set_point).amax() < 2e-9, "ring:{n}");
            }
        }
    }

    #[test]
    fn every_generator_gives_valid_layouts_of_any_size() {
        for n in [1, 2, 3, 5, 14, 33, 50, 100, 200] {
            for spec in
                [format!("ring:{n}"), format!("box:{n}:3:1"), format!("exchange:{n}:1"), format!("segregate:1x{n}:1")]
            {
                assert_eq!(made(&spec).robots.len(), n, "{spec}");
            }
        }
        for spec in
            ["segregate:3x4:0", "segregate:4x4:1", "segregate:10x20:2", "segregate:20x10:2", "segregate:200x1:0"]
        {
            made(spec);
        }
        for seed in 0..200 {
            made(&format!("exchange:14:{seed}"));
            made(&format!("segregate:3x5:{seed}"));
            made(&format!("box:48:0:{seed}"));
        }
    }

    #[test]
    fn every_family_of_tight_places_and_walls_is_valid_for_every_seed() {
        for seed in 0..50 {
            for form in ["park:16", "park:36", "tight_ring:24", "tight_ring:40", "permute:36", "mixed:16", "pocket:6"] {
                made(&format!("{form}:{seed}"));
            }
            for form in ["door:6:3.4", "door:16:5", "corridor:10", "forest:15", "rooms:20", "warehouse:40"] {
                made(&format!("{form}:{seed}"));
            }
        }
        let ring = made("tight_ring:32:7");
        let apart = |i: usize| (ring.robots[i].start - ring.robots[(i + 1) % 32].start).norm();
        assert!((0..32).all(|i| (1.5..1.7 + 1e-6).contains(&apart(i))));
        assert!(Scenario::resolve(Some("door:6:1.5:0"), None).unwrap_err().to_string().contains("the width `1.5`"));
    }

    #[test]
    fn the_seed_decides_and_the_name_reproduces() {
        for (a, b) in
            [("box:16:3:1", "box:16:3:2"), ("exchange:14:1", "exchange:14:2"), ("segregate:3x4:1", "segregate:3x4:2")]
        {
            assert_eq!(made(a), made(a));
            assert_ne!(made(a).robots, made(b).robots);
            assert_eq!(made(a).name, a);
        }
        assert_eq!(made("box:16").name, "box:16:0:0");
    }

    #[test]
    fn boxes_and_groups_look_like_the_published_ones() {
        let inside = |p: Position| (p - CENTRE).amax() <= 11.0;
        let boxed = made("box:48:0:5");
        assert!(boxed.robots.iter().all(|robot| inside(robot.start) && inside(robot.set_point)));
        assert_eq!(made("exchange:14:3").obstacles.len(), 3);
        let (ours, published) = (made("segregate:3x4:0"), made("segregate3x4_s0"));
        for (a, b) in ours.robots.iter().zip(&published.robots) {
            assert!((a.set_point - b.set_point).amax() < 1e-8, "{:?} {:?}", a.set_point, b.set_point);
        }
    }

    #[test]
    fn a_number_of_robots_completes_a_bare_name() {
        assert_eq!(Scenario::resolve(Some("ring"), Some(7)).unwrap().name, "ring:7");
        assert_eq!(Scenario::resolve(Some("exchange"), Some(6)).unwrap().name, "exchange:6:0");
    }

    #[test]
    fn arguments_that_cannot_be_used_are_answered_with_the_form() {
        let cases = [
            ("ring:0", "the number of robots `0` is not in 1..=200; the form is ring:N"),
            ("ring:201", "not in 1..=200"),
            ("ring", "the number of robots is missing"),
            ("ring:4:4", "2 arguments are too many"),
            ("box:8:x:1", "number of obstacles `x` is not a whole number"),
            ("box:8:1:-1", "seed `-1` is not a whole number"),
            ("box:10:200:0", ""),
            ("segregate:3", "`3` is not GROUPSxSIZE"),
            ("segregate:0x4:1", "with 1..=200 robots in all"),
            ("segregate:99999999999x99999999999", "with 1..=200"),
        ];
        for (spec, part) in cases {
            match Scenario::resolve(Some(spec), None) {
                Ok(_) => assert_eq!(part, "", "{spec} was accepted"),
                Err(error) => assert!(error.to_string().contains(part), "{error}"),
            }
        }
    }
}

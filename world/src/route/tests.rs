//! Ways against brute force: an independent visibility graph and a fine grid.

use super::*;
use crate::Position;
use crate::shape::{Obstacle, Obstacles, Shape};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;

fn at(x: f64, y: f64) -> Position {
    Position::new(x, y)
}

fn disc(x: f64, y: f64) -> Shape {
    Shape::Disc { centre: at(x, y), radius: 0.75 }
}

fn wall(points: &[(f64, f64)]) -> Shape {
    Shape::Wall { points: points.iter().map(|(x, y)| at(*x, *y)).collect(), thickness: 0.2 }
}

fn obstacles(shapes: Vec<Shape>) -> Arc<Obstacles> {
    let named = |(i, shape)| Obstacle::new(format!("obstacle-{i}"), shape).unwrap();
    Arc::new(Obstacles::new(shapes.into_iter().enumerate().map(named).collect()))
}

fn route(shapes: Vec<Shape>, clearance: f64, set_point: Position) -> Route {
    Route::new(Arc::new(Roadmap::new(obstacles(shapes), clearance)), set_point).unwrap()
}

/// Follows the aim in small steps: length of the way and least distance to an obstacle; none when it does not
/// arrive.
fn follow(route: &Route, from: Position, step: f64) -> Option<(f64, f64)> {
    let (mut here, mut length, mut hint) = (from, 0.0, None);
    let mut least = f64::INFINITY;
    for _ in 0..100_000 {
        least = least.min(route.map().obstacles().nearest(here, 99.0).map_or(99.0, |(_, n)| n.distance));
        let rest = (route.set_point() - here).norm();
        if rest <= step {
            return Some((length + rest, least));
        }
        let aim = route.aim(here, hint)?;
        assert_eq!(route.aim(here, None), Some(aim), "the hint changes nothing");
        hint = aim.corner;
        let away = aim.point - here;
        here = if away.norm() <= step { aim.point } else { here + away * (step / away.norm()) };
        length += away.norm().min(step);
    }
    None
}

#[test]
fn a_free_way_is_straight() {
    let route = route(vec![disc(5.0, 1.6)], 0.75, at(10.0, 0.0));
    assert_eq!(route.aim(at(0.0, 0.0), None), Some(Aim { point: at(10.0, 0.0), left: 10.0, corner: None }));
}

#[test]
fn round_one_obstacle_the_way_is_two_tangents_and_an_arc() {
    let route = route(vec![disc(5.0, 0.1)], 0.75, at(10.0, 0.0));
    let tangent = (5.0f64 * 5.0 + 0.1 * 0.1 - 1.5 * 1.5).sqrt();
    let turn = 2.0 * (1.5f64 / 5.001).asin() - 2.0 * (0.1f64 / 5.0).atan();
    let shortest = 2.0 * tangent + 1.5 * turn;
    let length = route.length(at(0.0, 0.0)).unwrap();
    assert!(length >= shortest - 1e-9 && length < 1.01 * shortest, "{length} against {shortest}");
}

#[test]
fn a_gap_that_is_too_narrow_is_walked_round_and_a_wide_one_through() {
    // 0.9 m and 1.6 m between the discs; 1.5 m are needed.
    for (gap, through) in [(0.9, false), (1.6, true)] {
        let (up, down) = (disc(5.0, 0.75 + gap / 2.0), disc(5.0, -0.75 - gap / 2.0));
        let (length, least) = follow(&route(vec![up, down], 0.75, at(10.0, 0.0)), at(0.0, 0.0), 0.02).unwrap();
        assert_eq!(length < 10.01, through, "{length}");
        assert!(least >= 0.75 * (1.0 - CUT) - 1e-6, "{least}");
    }
}

#[test]
fn who_stands_in_a_u_is_led_out_of_it() {
    let u = wall(&[(0.0, 2.0), (4.0, 2.0), (4.0, -2.0), (0.0, -2.0)]);
    let route = route(vec![u], 0.5, at(8.0, 0.0));
    let mut walk = route.walk(at(3.0, 0.0), None);
    let first = walk.next().unwrap();
    assert!(first.x < 0.0 && first.y.abs() > 1.4, "{first}");
    assert_eq!(walk.last(), Some(at(8.0, 0.0)));
    let (length, least) = follow(&route, at(3.0, 0.0), 0.02).unwrap();
    let whole = route.length(at(3.0, 0.0)).unwrap();
    assert!(least >= 0.499 && length <= whole + 1e-6 && length > 0.99 * whole, "{least} {length} {whole}");
}

#[test]
fn who_is_shut_in_learns_through_which_gap_it_would_have_to_go() {
    let ring = |k: f64| disc(2.2 * (TAU * k / 8.0).cos(), 2.2 * (TAU * k / 8.0).sin());
    let mut discs: Vec<Shape> = (0..8).map(|k| ring(f64::from(k))).collect();
    discs[2] = disc(0.0, 3.1);
    let route = route(discs.clone(), 0.75, at(10.0, 0.0));
    assert_eq!(route.aim(at(0.0, 0.0), None), None);
    let message = route.reach(at(0.0, 0.0)).unwrap_err().to_string();
    for part in ["no way", "1.500 m", "obstacle-2", "m wide"] {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    let Err(Unreachable::Closed { gap: Some(gap), .. }) = route.reach(at(0.0, 0.0)) else { panic!("no gap") };
    let side = at(2.2 * (TAU / 8.0).cos(), 2.2 * (TAU / 8.0).sin());
    assert!((gap.width - ((at(0.0, 3.1) - side).norm() - 1.5)).abs() < 1e-9, "{gap}");
    assert!((gap.middle - (at(0.0, 3.1) + side) / 2.0).norm() < 1e-6 || gap.middle.x < 0.0, "{gap}");
}

#[test]
fn who_is_walled_in_completely_is_told_so() {
    let room = wall(&[(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0), (-2.0, -2.0)]);
    let message = route(vec![room], 0.5, at(10.0, 0.0)).reach(at(0.0, 0.0)).unwrap_err().to_string();
    assert!(message.contains("shut in on all sides"), "{message}");
}

#[test]
fn set_points_and_starts_that_are_not_free_are_refused() {
    let map = Arc::new(Roadmap::new(obstacles(vec![disc(0.0, 0.0)]), 0.75));
    let message = |place: Position| Route::new(map.clone(), place).unwrap_err().to_string();
    assert!(message(at(0.2, 0.0)).contains("inside obstacle-0"));
    assert!(message(at(1.4, 0.0)).contains("0.6500 m from obstacle-0"));
    let route = Route::new(map, at(1.5, 0.0)).unwrap();
    assert!(route.reach(at(-1.4, 0.0)).unwrap_err().to_string().contains("start of the robot"));
    assert!(route.reach(at(-1.5, 0.0)).is_ok());
}

#[test]
fn who_is_pressed_into_an_inner_corner_is_led_out() {
    let l = wall(&[(0.0, 5.0), (0.0, 0.0), (5.0, 0.0)]);
    let route = route(vec![l], 0.75, at(-5.0, -5.0));
    for start in [at(0.5, 0.5), at(0.84, 0.3), at(0.2, 0.84), at(0.849, 0.849)] {
        assert!(follow(&route, start, 0.02).is_some(), "{start}");
    }
}

#[test]
fn a_paced_walk_keeps_its_steps_and_stays_on_the_set_point() {
    let route = route(vec![disc(5.0, 0.1)], 0.75, at(10.0, 0.0));
    let length = route.length(at(0.0, 0.0)).unwrap();
    let places: Vec<Position> = route.walk(at(0.0, 0.0), None).paced(std::iter::repeat_n(0.25, 60)).collect();
    assert_eq!(places.len(), 60);
    assert_eq!(places[59], at(10.0, 0.0));
    let on_the_way = (length / 0.25) as usize;
    let mut here = at(0.0, 0.0);
    for place in &places[..on_the_way] {
        let step = (place - here).norm();
        assert!(step <= 0.25 + 1e-12 && step > 0.24, "{step}");
        here = *place;
    }
}

/// Discs, walls and triangles in a box of 12 m, away from two opposite corners outside.
fn shapes(most: usize) -> impl Strategy<Value = Vec<Shape>> {
    let point = || (0.0f64..12.0, 0.0f64..12.0);
    let disc = (point(), 0.2f64..1.5).prop_map(|((x, y), radius)| Shape::Disc { centre: at(x, y), radius });
    let wall = (prop::collection::vec(point(), 2..4), 0.1f64..0.5).prop_map(|(points, thickness)| Shape::Wall {
        points: points.into_iter().map(|(x, y)| at(x, y)).collect(),
        thickness,
    });
    let triangle = (point(), point(), point())
        .prop_map(|(a, b, c)| Shape::Polygon(vec![at(a.0, a.1), at(b.0, b.1), at(c.0, c.1)]));
    let valid = |shape: &Shape| Obstacle::new("it", shape.clone()).is_ok();
    prop::collection::vec(prop_oneof![disc, wall, triangle].prop_filter("a shape", valid), 0..most)
}

/// The shortest way by trying all: every pair of corners of polygons with `sides` sides round every vertex of
/// every piece, tangent or not, Bellman and Ford.
fn brute_force(all: &Obstacles, clearance: f64, from: Position, to: Position, sides: usize) -> f64 {
    let open = |p: Position| all.pieces().iter().all(|piece| piece.distance(p) >= clearance * (1.0 - 1e-9));
    let free =
        |a: Position, b: Position| all.pieces().iter().all(|piece| piece.separation(a, b) >= clearance * (1.0 - 1e-9));
    let mut nodes = vec![to, from];
    for piece in all.pieces() {
        let out = (clearance + piece.radius()) / (TAU / 2.0 / sides as f64).cos();
        for vertex in piece.core() {
            nodes.extend((0..sides).map(|k| {
                let (sin, cos) = (TAU * k as f64 / sides as f64).sin_cos();
                vertex + at(cos, sin) * out
            }));
        }
    }
    nodes.retain(|node| open(*node));
    let mut left = vec![f64::INFINITY; nodes.len()];
    left[0] = 0.0;
    let mut done = vec![false; nodes.len()];
    while let Some(i) = (0..nodes.len()).filter(|i| !done[*i]).min_by(|a, b| left[*a].total_cmp(&left[*b])) {
        done[i] = true;
        if left[i].is_infinite() {
            break;
        }
        for j in 0..nodes.len() {
            if !done[j] && left[i] + (nodes[i] - nodes[j]).norm() < left[j] && free(nodes[i], nodes[j]) {
                left[j] = left[i] + (nodes[i] - nodes[j]).norm();
            }
        }
    }
    left[1]
}

/// The shortest way over a grid with steps to 16 neighbours; at least the true one, as all its steps are free.
fn over_grid(all: &Obstacles, clearance: f64, from: Position, to: Position, cell: f64) -> f64 {
    let low = from.inf(&to).add_scalar(-3.0);
    let size = ((from.sup(&to).add_scalar(3.0) - low) / cell).map(|x| x.ceil() as usize + 1);
    let place = |i: usize| low + at((i % size.x) as f64, (i / size.x) as f64) * cell;
    let count = size.x * size.y;
    let free = |a: Position, b: Position| all.separation(a, b, clearance + 1.0) >= clearance;
    let mut left = vec![f64::INFINITY; count];
    let mut open = std::collections::BinaryHeap::new();
    let ends = |p: Position| (0..count).filter(move |i| (place(*i) - p).norm() <= 1.5 * cell);
    for i in ends(to).filter(|i| free(place(*i), to)) {
        left[i] = (place(i) - to).norm();
        open.push(std::cmp::Reverse((left[i].to_bits(), i)));
    }
    while let Some(std::cmp::Reverse((bits, i))) = open.pop() {
        if bits != left[i].to_bits() {
            continue;
        }
        for (dx, dy) in (-2i64..=2).flat_map(|dx| (-2i64..=2).map(move |dy| (dx, dy))) {
            let (x, y) = ((i % size.x) as i64 + dx, (i / size.x) as i64 + dy);
            if (0..size.x as i64).contains(&x) && (0..size.y as i64).contains(&y) {
                let j = x as usize + y as usize * size.x;
                let length = left[i] + (place(i) - place(j)).norm();
                if length < left[j] && free(place(i), place(j)) {
                    left[j] = length;
                    open.push(std::cmp::Reverse((length.to_bits(), j)));
                }
            }
        }
    }
    ends(from)
        .filter(|i| free(place(*i), from))
        .map(|i| left[i] + (place(i) - from).norm())
        .fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn every_way_is_free_and_ends_at_the_set_point(shapes in shapes(9), clearance in 0.2f64..1.0) {
        let route = route(shapes, clearance, at(15.5, 15.5));
        // Both lie outside the box, so that a way always exists.
        let start = at(-3.5, -3.5);
        let length = route.length(start);
        prop_assert!(length.is_some());
        let mut here = start;
        let mut sum = 0.0;
        for bend in route.walk(start, None) {
            let least = route.map().obstacles().separation(here, bend, 9.0);
            prop_assert!(least >= clearance * (1.0 - CUT) - 1e-6, "{least} on the way to {bend}");
            sum += (bend - here).norm();
            here = bend;
        }
        prop_assert_eq!(here, at(15.5, 15.5));
        prop_assert!((sum - length.unwrap()).abs() < 1e-9);
        let (followed, least) = follow(&route, start, 0.05).unwrap();
        prop_assert!(least >= clearance * (1.0 - CUT) - 1e-6);
        prop_assert!(followed <= sum + 1e-6, "{followed} against {sum}");
    }

    #[test]
    fn who_is_anywhere_even_too_near_finds_a_way_or_is_shut_in(
        shapes in shapes(6), clearance in 0.2f64..0.8, x in 0.0f64..12.0, y in 0.0f64..12.0,
    ) {
        let route = route(shapes, clearance, at(15.5, 15.5));
        let from = at(x, y);
        if let Some(aim) = route.aim(from, None) {
            prop_assert!(aim.left >= (route.set_point() - from).norm() - 1e-9);
            // Nobody slides as far as this into what it owes.
            if route.map().obstacles().nearest(from, 0.5 * clearance).is_none() {
                prop_assert!(follow(&route, from, 0.05).is_some());
            }
        }
    }

    #[test]
    fn no_way_is_longer_than_brute_force_finds_at_the_stated_excess(shapes in shapes(4), clearance in 0.2f64..1.0) {
        let (from, to) = (at(-3.5, -3.5), at(15.5, 15.5));
        let all = obstacles(shapes);
        let found = Route::new(Arc::new(Roadmap::new(all.clone(), clearance)), to).unwrap().length(from).unwrap();
        let excess = 1.0 / (ARC / 2.0).cos();
        // Wider by the excess of the largest arc: (clearance + radius) * excess - radius for discs of 1.5 m.
        let wider = (clearance + 1.5) * excess - 1.5;
        prop_assert!(found <= brute_force(&all, wider, from, to, 24) * excess + 1e-9);
        prop_assert!(found >= brute_force(&all, clearance * (1.0 - CUT), from, to, 48) / 1.0022 - 1e-9);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn no_way_is_longer_than_a_fine_grid_finds(shapes in shapes(8), clearance in 0.3f64..0.8) {
        let (from, to) = (at(-3.5, -3.5), at(15.5, 15.5));
        let all = obstacles(shapes);
        let found = Route::new(Arc::new(Roadmap::new(all.clone(), clearance)), to).unwrap().length(from).unwrap();
        let excess = 1.0 / (ARC / 2.0).cos();
        let wider = (clearance + 1.5) * excess - 1.5;
        prop_assert!(found <= over_grid(&all, wider, from, to, 0.2) * excess + 1e-9);
    }
}

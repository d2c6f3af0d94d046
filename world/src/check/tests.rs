//! What is refused, and with which words.

use super::*;
use crate::shape::{Obstacle, Shape};

fn points(list: &[(f64, f64)]) -> Vec<Position> {
    list.iter().map(|(x, y)| Position::new(*x, *y)).collect()
}

fn message(list: &[(f64, f64)]) -> String {
    polygon(&points(list)).unwrap_err().to_string()
}

fn assert_names(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[test]
fn polygons_may_run_either_way_and_be_closed_or_not() {
    let open = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)];
    let ring = polygon(&points(&open)).unwrap();
    assert_eq!(ring, points(&open));
    assert_eq!(polygon(&points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)])).unwrap(), ring);
    assert_eq!(polygon(&points(&[(1.0, 1.0), (1.0, 0.0), (1.0, 0.0), (0.0, 0.0)])).unwrap(), ring);
}

#[test]
fn polygons_that_are_none_are_refused() {
    assert_names(&message(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)]), &["at least 3", "found 2", "wall"]);
    assert_names(&message(&[(0.0, 0.0), (1.0, 1.0), (3.0, 3.0), (2.0, 2.0)]), &["no area", "wall"]);
    assert_names(&message(&[(0.0, 0.0), (f64::NAN, 1.0), (3.0, 3.0)]), &["point 2", "NaN", "finite"]);
    assert_names(&message(&[(0.0, 0.0), (1.0, 1.0), (3.0, 3e6)]), &["point 3", "3000000"]);
    assert_names(&message(&[(0.0, 0.0), (1e-6, 0.0), (0.0, 1e-6)]), &["no area"]);
}

#[test]
fn the_two_sides_that_cross_are_named() {
    let bow = message(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
    assert_names(&bow, &["from point 1 to point 2", "from point 3 to point 4", "[1.000, 1.000]"]);
    let closing = message(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, -1.0), (2.0, 3.0)]);
    assert_names(&closing, &["from point 1 to point 2", "from point 3 to point 4"]);
}

#[test]
fn sides_that_touch_or_run_back_are_refused() {
    let touching = message(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 0.0), (0.0, 4.0)]);
    assert_names(&touching, &["from point 1 to point 2", "touches", "[2.000, 0.000]"]);
    let spike = message(&[(0.0, 0.0), (4.0, 0.0), (2.0, 0.0), (2.0, 3.0)]);
    assert_names(&spike, &["from point 1 to point 2", "from point 2 to point 3"]);
}

#[test]
fn walls_and_discs_need_a_size() {
    let two = points(&[(0.0, 0.0), (1.0, 0.0)]);
    assert_names(&wall(&two[..1], 0.1).unwrap_err().to_string(), &["at least 2", "found 1", "radius"]);
    for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_names(&wall(&two, size).unwrap_err().to_string(), &["thickness", "above 0"]);
        assert_names(&disc(two[0], size).unwrap_err().to_string(), &["radius", "above 0"]);
    }
}

#[test]
fn robots_inside_or_too_near_are_named() {
    let square = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
    let all = Obstacles::new(vec![Obstacle::new("shelf", Shape::Polygon(square)).unwrap()]);
    let at = |x: f64| place(&all, "left", "start", Position::new(x, 2.0), 0.75).map_err(|e| e.to_string());
    assert_names(&at(3.0).unwrap_err(), &["start of left", "[3, 2]", "inside shelf", "1.0000 m deep"]);
    assert_names(&at(4.5).unwrap_err(), &["0.5000 m from shelf", "0.7500 m"]);
    assert_eq!(at(4.75), Ok(()));
}

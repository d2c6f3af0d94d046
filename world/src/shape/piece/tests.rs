//! Distances, motions and the half plane of the nearest point.

use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;

fn at(x: f64, y: f64) -> Position {
    Position::new(x, y)
}

fn square() -> Piece {
    Piece::new(vec![at(0.0, 0.0), at(2.0, 0.0), at(2.0, 2.0), at(0.0, 2.0)], 0.0, 0)
}

/// Discs, legs of walls and convex polygons (corners on an ellipse).
fn piece() -> impl Strategy<Value = Piece> {
    let centre = prop::array::uniform2(-3.0f64..3.0);
    let angles = prop::collection::btree_set(0u32..64, 1..8);
    (centre, angles, prop::array::uniform2(0.3f64..3.0), 0.0f64..1.0).prop_map(|(c, angles, axes, radius)| {
        let corner = |k: &u32| {
            let (sin, cos) = (TAU * f64::from(*k) / 64.0).sin_cos();
            at(c[0] + axes[0] * cos, c[1] + axes[1] * sin)
        };
        Piece::new(angles.iter().map(corner).collect(), radius, 0)
    })
}

fn place() -> impl Strategy<Value = Position> {
    prop::array::uniform2(-8.0f64..8.0).prop_map(|p| at(p[0], p[1]))
}

/// Points of the piece: combinations of its corners, moved by at most the radius.
fn points_of(piece: &Piece) -> Vec<Position> {
    let core = piece.core();
    let mut points = Vec::new();
    for (i, a) in core.iter().enumerate() {
        for b in &core[i..] {
            for step in 0..=8 {
                let on = a + (b - a) * (f64::from(step) / 8.0);
                points.extend((0..16).map(|k| {
                    let (sin, cos) = (TAU * f64::from(k) / 16.0).sin_cos();
                    on + at(cos, sin) * piece.radius()
                }));
            }
        }
    }
    points
}

#[test]
fn a_place_beside_over_a_corner_and_inside() {
    let beside = square().nearest(at(3.0, 1.0));
    assert_eq!((beside.point, beside.normal, beside.distance), (at(2.0, 1.0), at(1.0, 0.0), 1.0));
    assert_eq!(square().nearest(at(5.0, 6.0)).distance, 5.0);
    let inside = square().nearest(at(1.0, 0.25));
    assert_eq!((inside.point, inside.normal, inside.distance), (at(1.0, 0.0), at(0.0, -1.0), -0.25));
    assert!(square().contains(at(2.0, 2.0)) && !square().contains(at(2.001, 2.0)));
}

#[test]
fn a_disc_and_a_leg_of_a_wall_reach_beyond_their_cores() {
    let disc = Piece::new(vec![at(1.0, 0.0)], 0.5, 0);
    assert_eq!(disc.nearest(at(3.0, 0.0)).distance, 1.5);
    assert_eq!(disc.nearest(at(1.0, 0.0)).normal, at(1.0, 0.0));
    let leg = Piece::new(vec![at(0.0, 0.0), at(4.0, 0.0)], 0.1, 0);
    assert!((leg.distance(at(4.6, 0.8)) - 0.9).abs() < 1e-12, "the end is round");
    let on_it = leg.nearest(at(1.0, 0.0));
    assert_eq!((on_it.normal, on_it.distance), (at(0.0, 1.0), -0.1));
}

#[test]
fn motion_through_a_piece_is_seen_between_the_samples() {
    assert_eq!(square().separation(at(-1.0, 1.0), at(3.0, 1.0)), 0.0);
    assert_eq!(square().separation(at(-1.0, 3.0), at(3.0, 3.0)), 1.0);
    let leg = Piece::new(vec![at(0.0, 0.0), at(4.0, 0.0)], 0.1, 0);
    assert_eq!(leg.separation(at(2.0, -1.0), at(2.0, 1.0)), -0.1);
}

#[test]
fn pieces_know_how_far_they_are_from_each_other() {
    let other = Piece::new(vec![at(5.0, 1.0)], 0.5, 1);
    assert!((square().distance_to(&other) - 2.5).abs() < 1e-12);
    assert!((other.distance_to(&square()) - 2.5).abs() < 1e-12);
    let within = Piece::new(vec![at(1.0, 1.0)], 0.5, 1);
    assert!(square().distance_to(&within) <= 0.0 && within.distance_to(&square()) <= 0.0);
}

proptest! {
    #[test]
    fn the_half_plane_keeps_the_separation_at_the_end_and_on_the_way(
        piece in piece(), p in place(), r in 0.0f64..2.0, slack in 0.0f64..1.0, aside in -2.0f64..2.0,
    ) {
        let Nearest { normal, distance, .. } = piece.nearest(p);
        prop_assume!(distance > 1e-6);
        let m = normal * (r - distance + slack) + right_of(normal) * aside;
        prop_assert!(piece.distance(p + m) >= r - 1e-9, "{} < {r}", piece.distance(p + m));
        prop_assert!(piece.separation(p, p + m) >= distance.min(r) - 1e-9);
    }

    #[test]
    fn the_piece_lies_behind_its_half_plane(piece in piece(), p in place()) {
        let Nearest { point, normal, distance } = piece.nearest(p);
        prop_assert!((normal.norm() - 1.0).abs() < 1e-12);
        prop_assert!((p - point - normal * distance).norm() < 1e-9);
        if distance > 1e-6 {
            for x in points_of(&piece) {
                prop_assert!(normal.dot(&(x - point)) <= 1e-9);
                prop_assert!((p - x).norm() >= distance - 1e-9);
            }
        }
    }

    #[test]
    fn the_separation_is_the_minimum_over_dense_sampling(piece in piece(), a in place(), b in place()) {
        let exact = piece.separation(a, b);
        let sampled = (0..=2000)
            .map(|s| piece.distance(a + (b - a) * (f64::from(s) / 2000.0)).max(-piece.radius()))
            .fold(f64::INFINITY, f64::min);
        prop_assert!(exact <= sampled + 1e-9 && sampled - exact < 0.012, "{exact} {sampled}");
        prop_assert!((exact - piece.separation(b, a)).abs() < 1e-12);
    }

    #[test]
    fn the_bounds_never_promise_more_than_the_distance(piece in piece(), p in place()) {
        prop_assert!(piece.bounds().distance(p) <= piece.distance(p).max(0.0) + 1e-12);
    }
}

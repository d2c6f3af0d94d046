//! Maps from pixels to pieces.

use super::*;
use crate::shape::Obstacles;
use proptest::prelude::*;

const META: &str = "image: a.pgm\nresolution: 1.0\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n\
                    free_thresh: 0.25\n";

fn meta() -> Meta {
    Meta::from_yaml(META, Path::new("a.yaml")).unwrap()
}

/// An image drawn with `#` occupied, `?` unknown, everything else free.
fn drawn(rows: &[&str]) -> Grey {
    let grey = |c: char| {
        Some(if c == '#' {
            0
        } else if c == '?' {
            150
        } else {
            254
        })
    };
    let pixels = rows.iter().flat_map(|row| row.chars().map(grey)).collect();
    Grey { width: rows[0].len(), height: rows.len(), pixels }
}

fn free(simplify: f64) -> MapSettings {
    MapSettings { unknown: Unknown::Free, simplify: Some(simplify) }
}

fn area(obstacles: &[Obstacle]) -> f64 {
    let ring = |ring: &Vec<Position>| -> f64 {
        (0..ring.len()).map(|i| ring[i].perp(&ring[(i + 1) % ring.len()])).sum::<f64>() / 2.0
    };
    obstacles.iter().flat_map(|obstacle| obstacle.rings()).map(ring).sum()
}

#[test]
fn outlines_run_on_cell_borders_and_holes_stay_open() {
    let image = drawn(&[".....", ".###.", ".#.#.", ".###.", "....#"]);
    let found = obstacles("map", &image, &meta(), free(0.0)).unwrap();
    assert_eq!(found.iter().map(Obstacle::name).collect::<Vec<_>>(), ["map-1", "map-2"]);
    assert_eq!(found[0].rings().len(), 1);
    assert_eq!((found[1].rings().len(), found[1].rings()[0].len()), (2, 4));
    assert_eq!(area(&found), 9.0);
    let all = Obstacles::new(found);
    assert_eq!(all.nearest(Position::new(2.5, 2.5), 9.0).unwrap().1.distance, 0.5);
    assert!(all.nearest(Position::new(4.5, 0.5), 9.0).unwrap().1.distance < 0.0, "the last row is the lowest");
}

#[test]
fn unknown_cells_are_walls_unless_said_otherwise_and_so_is_the_edge_of_the_map() {
    let image = drawn(&["....", ".?..", "...."]);
    let open = Obstacles::new(obstacles("map", &image, &meta(), free(0.0)).unwrap());
    assert!(open.pieces().is_empty());
    let shut = Obstacles::new(obstacles("map", &image, &meta(), MapSettings::default()).unwrap());
    assert!(shut.nearest(Position::new(1.5, 1.5), 9.0).unwrap().1.distance < 0.0);
    assert_eq!(shut.nearest(Position::new(0.25, 0.5), 9.0).unwrap().1.distance, 0.25);
    assert_eq!(shut.bounds().low, Position::new(-1.0, -1.0));
}

#[test]
fn cells_that_meet_in_a_corner_are_regions_of_their_own() {
    let image = drawn(&["#.", ".#"]);
    let found = obstacles("map", &image, &meta(), free(0.0)).unwrap();
    assert_eq!(found.len(), 2);
    let loop_with_pinch = drawn(&["###", "#.#", "##.", "..."]);
    let found = obstacles("map", &loop_with_pinch, &meta(), free(0.0)).unwrap();
    assert_eq!((found.len(), area(&found)), (1, 7.0));
}

#[test]
fn stairs_become_a_slope_that_covers_them() {
    let image =
        drawn(&["#.......", "##......", "###.....", "####....", "#####...", "######..", "#######.", "########"]);
    let found = obstacles("map", &image, &meta(), free(1.0)).unwrap();
    assert!(found[0].rings()[0].len() <= 5, "{:?}", found[0].rings());
    assert!(area(&found) >= 36.0 && area(&found) <= 40.0);
}

#[test]
fn the_origin_moves_and_turns_the_map() {
    let mut turned = meta();
    turned.origin = Position::new(10.0, 20.0);
    turned.yaw = std::f64::consts::FRAC_PI_2;
    let found = Obstacles::new(obstacles("map", &drawn(&["..#"]), &turned, free(0.0)).unwrap());
    assert!((found.bounds().low - Position::new(9.0, 22.0)).norm() < 1e-12);
    assert!((found.bounds().high - Position::new(10.0, 23.0)).norm() < 1e-12);
}

#[test]
fn a_map_whose_files_are_missing_names_them() {
    let message = load(Path::new("no/such.yaml"), MapSettings::default()).unwrap_err().to_string();
    assert!(message.contains("no/such.yaml") && message.contains("relative to the scenario"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn growth_covers_every_occupied_cell_and_stays_within_its_bound(
        cells in prop::collection::vec(prop::bool::weighted(0.6), 144), bound in 0.0f64..2.5,
    ) {
        let pixels = cells.iter().map(|occupied| Some(if *occupied { 0 } else { 254 })).collect();
        let image = Grey { width: 12, height: 12, pixels };
        let exact = obstacles("map", &image, &meta(), free(0.0)).unwrap();
        prop_assert_eq!(area(&exact), cells.iter().filter(|occupied| **occupied).count() as f64);
        let grown = obstacles("map", &image, &meta(), free(bound)).unwrap();
        let corners = |list: &[Obstacle]| list.iter().flat_map(|o| o.rings()).map(Vec::len).sum::<usize>();
        prop_assert!(corners(&grown) <= corners(&exact));
        let (exact, grown) = (Obstacles::new(exact), Obstacles::new(grown));
        let distance = |all: &Obstacles, p| all.nearest(p, 3.0).map_or(3.0, |(_, nearest)| nearest.distance);
        for i in 0..=36 {
            for j in 0..=36 {
                let p = Position::new(f64::from(i), f64::from(j)) / 3.0;
                if distance(&exact, p) <= 0.0 {
                    prop_assert!(distance(&grown, p) <= 1e-9, "{p} is occupied");
                }
                if distance(&grown, p) < 0.0 {
                    prop_assert!(distance(&exact, p) <= bound + 1e-9, "{p} is {} away", distance(&exact, p));
                }
            }
        }
    }
}

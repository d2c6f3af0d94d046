//! The shipped warehouse is what its generator draws, and robots get about in it.

#[path = "../examples/make_warehouse.rs"]
mod make_warehouse;

use std::path::PathBuf;
use std::sync::Arc;
use world::file::Places;
use world::map::{MapSettings, load};
use world::route::{Roadmap, Route};
use world::shape::Obstacles;

fn maps() -> PathBuf {
    concat!(env!("CARGO_MANIFEST_DIR"), "/maps").into()
}

fn warehouse() -> (Arc<Obstacles>, Places) {
    let obstacles = load(&maps().join("warehouse.yaml"), MapSettings::default()).expect("the map is read");
    let places = std::fs::read_to_string(maps().join("warehouse.places.toml")).expect("places are there");
    (Arc::new(Obstacles::new(obstacles)), toml::from_str(&places).expect("places are read"))
}

#[test]
fn the_shipped_files_are_those_that_the_generator_writes() {
    for (name, bytes) in make_warehouse::files() {
        assert!(std::fs::read(maps().join(name)).unwrap() == bytes, "{name}: run the example make_warehouse");
    }
}

#[test]
fn the_hall_is_walls_and_eighteen_shelves() {
    let (all, _) = warehouse();
    assert_eq!(all.list().len(), 1 + 18);
    let corners: usize = all.list().iter().flat_map(|obstacle| obstacle.rings()).map(Vec::len).sum();
    // Shelves, the outer rim, and four for each cut-off corner: its slope, and a stair at both ends, as straight
    // walls stay as they are.
    assert_eq!(corners, 18 * 4 + 4 + 4 * 4);
    let middle = |x: f64, y: f64| all.nearest([x, y].into(), 9.0).unwrap().1.distance;
    // Aisles of 2.0 and 3.6 m between the first rows, in their middles.
    assert!((middle(8.0, 4.7 + 1.2 + 1.0) - 1.0).abs() < 1e-9);
    assert!((middle(8.0, 4.7 + 1.2 + 2.0 + 1.2 + 1.8) - 1.8).abs() < 1e-9);
}

#[test]
fn robots_fit_into_all_places_at_once_and_reach_each_from_each() {
    let (all, places) = warehouse();
    assert!(places.place.len() >= 60);
    let at: Vec<_> = places.place.iter().map(|place| place.position.0).collect();
    for (i, a) in at.iter().enumerate() {
        assert!(at[..i].iter().all(|b| (a - b).norm() >= 2.0), "{}", places.place[i].name);
    }
    let map = Arc::new(Roadmap::new(all, 0.75));
    for to in &at {
        let route = Route::new(map.clone(), *to).unwrap();
        for from in at.iter().step_by(7) {
            assert!(route.reach(*from).unwrap() >= (to - from).norm() - 1e-9);
        }
    }
}

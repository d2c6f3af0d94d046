//! Draws the shipped warehouse: `cargo run --example make_warehouse [FOLDER]` writes `warehouse.pgm`,
//! `warehouse.yaml` and `warehouse.places.toml`. Whole cells only, so that every machine draws the same.
//!
//! A hall of 40 x 30 m with cut-off corners; six rows of shelves in three blocks each. Along the walls runs a
//! road of 4.4 m; between the rows aisles of 3.6 m (two robots of 1.5 m pass each other) and of 2.0 m (one)
//! alternate; across run an aisle of 3.6 m and one of 2.2 m. Every passage lies on a loop.

use std::fmt::Write;

/// Cells of a decimetre.
const WIDTH: i64 = 400;
const HEIGHT: i64 = 300;
const WALL: i64 = 3;
const ROAD: i64 = 44;
/// Legs of the cut-off corners, from the outer edge.
const CUT_OFF: i64 = 25;
/// From left to right: block, aisle, block, aisle, block.
const ACROSS: [i64; 5] = [82, 36, 82, 22, 84];
const SHELF: i64 = 12;
/// Between the rows, from below.
const AISLES: [i64; 5] = [20, 36, 20, 36, 20];
/// From a wall or a shelf to the middle of a place.
const BESIDE: i64 = 10;
/// Between stations.
const APART: i64 = 22;

const DESCRIPTION: &str = "image: warehouse.pgm\nmode: trinary\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n\
                           occupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// Left and right edges of the blocks.
fn blocks() -> Vec<(i64, i64)> {
    let left = |block: usize| WALL + ROAD + ACROSS[..2 * block].iter().sum::<i64>();
    (0..3).map(|block| (left(block), left(block) + ACROSS[2 * block])).collect()
}

/// Lower and upper edges of the rows of shelves.
fn rows() -> Vec<(i64, i64)> {
    let low = |row: usize| WALL + ROAD + row as i64 * SHELF + AISLES[..row].iter().sum::<i64>();
    (0..=AISLES.len()).map(|row| (low(row), low(row) + SHELF)).collect()
}

fn is_occupied(x: i64, y: i64) -> bool {
    let inside = |(low, high): &(i64, i64), at: i64| (*low..*high).contains(&at);
    let (from_side, from_end) = (x.min(WIDTH - 1 - x), y.min(HEIGHT - 1 - y));
    from_side < WALL
        || from_end < WALL
        || from_side + from_end < CUT_OFF
        || (blocks().iter().any(|block| inside(block, x)) && rows().iter().any(|row| inside(row, y)))
}

/// Names and places, in cells.
fn places() -> Vec<(String, i64, i64)> {
    let mut places = Vec::new();
    let beside = WALL + BESIDE;
    let along = |length: i64, count: i64| (0..count).map(move |k| length / 2 - (count - 1) * APART / 2 + k * APART);
    for (k, x) in along(WIDTH, 15).enumerate() {
        places.push((format!("south-{k}"), x, beside));
        places.push((format!("north-{k}"), x, HEIGHT - beside));
    }
    for (k, y) in along(HEIGHT, 10).enumerate() {
        places.push((format!("west-{k}"), beside, y));
        places.push((format!("east-{k}"), WIDTH - beside, y));
    }
    let mut pick = 0;
    for (row, _) in AISLES.iter().enumerate().filter(|(_, aisle)| **aisle == 36) {
        for (left, right) in blocks() {
            for x in [left + 20, right - 20] {
                places.push((format!("pick-{pick}"), x, rows()[row].1 + BESIDE));
                pick += 1;
            }
        }
    }
    places
}

/// The three files: name and bytes.
pub(crate) fn files() -> Vec<(&'static str, Vec<u8>)> {
    let mut image = format!("P5\n{WIDTH} {HEIGHT}\n255\n").into_bytes();
    for row in 0..HEIGHT {
        image.extend((0..WIDTH).map(|x| if is_occupied(x, HEIGHT - 1 - row) { 0u8 } else { 254 }));
    }
    let mut list = String::from("# Where robots may start and end. Drawn by examples/make_warehouse.rs.\n");
    for (name, x, y) in places() {
        let metres = |cells: i64| format!("{}.{}", cells / 10, cells % 10);
        // Writing to a string cannot fail.
        let _ = write!(list, "\n[[place]]\nname = \"{name}\"\nposition = [{}, {}]\n", metres(x), metres(y));
    }
    vec![("warehouse.pgm", image), ("warehouse.yaml", DESCRIPTION.into()), ("warehouse.places.toml", list.into_bytes())]
}

#[allow(dead_code)] // the test that compares the shipped files includes this one.
fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/maps").into());
    for (name, bytes) in files() {
        std::fs::write(std::path::Path::new(&folder).join(name), bytes)?;
    }
    Ok(())
}

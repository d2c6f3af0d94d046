//! Times roadmaps, routes and aims: `cargo run --release --example measure`. Means over a fifth of a second; on Linux the
//! time that the thread was running, so that other work on the machine does not count.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;
use world::Position;
use world::file::Places;
use world::map::{Grey, MapSettings, Meta, load, obstacles};
use world::route::{Roadmap, Route};
use world::shape::{Obstacle, Obstacles, Shape};

/// Numbers in 0..1 that are the same on every machine (the multiplier of Steele and Vigna 2021).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(1);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// `count` turned rectangles in a square of `side` metres.
fn boxes(count: usize, side: f64) -> Obstacles {
    let mut draw = Draw(7);
    let list = (0..count).map(|i| {
        let centre = Position::new(draw.next(), draw.next()) * side;
        let (sin, cos) = (draw.next() * 3.0).sin_cos();
        let half = Position::new(0.3 + draw.next(), 0.3 + 2.0 * draw.next());
        let corner =
            |x: f64, y: f64| centre + Position::new(cos, sin) * (half.x * x) + Position::new(-sin, cos) * (half.y * y);
        let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        Obstacle::new(format!("box-{i}"), Shape::Polygon(corners)).expect("a rectangle is a polygon")
    });
    Obstacles::new(list.collect())
}

fn discs(count: usize, side: f64) -> Obstacles {
    let mut draw = Draw(11);
    let list = (0..count).map(|i| {
        let centre = Position::new(draw.next(), draw.next()) * side;
        Obstacle::new(format!("disc-{i}"), Shape::Disc { centre, radius: 0.75 }).expect("a disc is a disc")
    });
    Obstacles::new(list.collect())
}

/// For how long this thread has been running, s; elsewhere than on Linux how late it is.
fn running() -> f64 {
    static BEGIN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = text.and_then(|text| text.split(' ').next().and_then(|first| first.parse::<f64>().ok()));
    nanoseconds.map_or_else(|| BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64(), |ns| ns / 1e9)
}

/// Mean of as many repetitions as take a fifth of a second, in units of `1 / per_second` seconds.
fn timed(per_second: f64, mut what: impl FnMut()) -> f64 {
    let (begin, mut count) = (running(), 0.0);
    loop {
        what();
        count += 1.0;
        let time = running() - begin;
        if time >= 0.2 {
            return time / count * per_second;
        }
    }
}

fn report(name: &str, all: Obstacles, clearance: f64, set_point: Position, starts: &[Position]) {
    let all = Arc::new(all);
    let vertices: usize = all.list().iter().flat_map(|obstacle| obstacle.rings()).map(Vec::len).sum();
    let both = timed(1e3, || {
        let map = Arc::new(Roadmap::new(all.clone(), clearance));
        std::hint::black_box(Route::new(map, set_point).expect("the set-point is free"));
    });
    let map = Arc::new(Roadmap::new(all.clone(), clearance));
    let one = timed(1e3, || {
        std::hint::black_box(Route::new(map.clone(), set_point).expect("the set-point is free"));
    });
    let route = Route::new(map.clone(), set_point).expect("the set-point is free");
    let each = 1e6 / starts.len() as f64;
    let aim = timed(each, || {
        for start in starts {
            std::hint::black_box(route.aim(*start, None));
        }
    });
    let hints: Vec<_> = starts.iter().map(|start| route.aim(*start, None).and_then(|aim| aim.corner)).collect();
    let hinted = timed(each, || {
        for (start, hint) in starts.iter().zip(&hints) {
            std::hint::black_box(route.aim(*start, *hint));
        }
    });
    let edges: usize = (0..map.corners().len()).map(|corner| map.seen_from(corner).len()).sum();
    println!(
        "{name}: {vertices} vertices, {} pieces, {} corners, {edges} lines; roadmap + route {both:.1} ms, \
         further route {one:.2} ms; aim {aim:.2} us, with the last corner {hinted:.2} us",
        all.pieces().len(),
        map.corners().len(),
    );
}

/// Free places of a square.
fn starts(all: &Obstacles, side: f64, clearance: f64) -> Vec<Position> {
    let mut draw = Draw(3);
    let places = std::iter::repeat_with(|| Position::new(draw.next(), draw.next()) * side);
    places.filter(|place| all.nearest(*place, clearance).is_none()).take(2000).collect()
}

/// A map as a robot makes it: a turned building of rooms with rough walls, 1,000 x 1,000 cells of 0.05 m.
fn rough_map() -> (Grey, Meta) {
    let mut draw = Draw(5);
    let (sin, cos) = 0.1f64.sin_cos();
    let pixel = |i: usize, rough: f64| {
        let (x, y) = ((i % 1000) as f64 - 500.0, (i / 1000) as f64 - 500.0);
        let (u, v) = (cos * x + sin * y, cos * y - sin * x);
        let off = |w: f64| (w + 400.0).rem_euclid(160.0).min(160.0 - (w + 400.0).rem_euclid(160.0));
        let door = |w: f64| off(w + 80.0) < 22.0;
        let wall = (off(u) < 4.0 + rough && !door(v)) || (off(v) < 4.0 + rough && !door(u));
        let outside = u.abs().max(v.abs());
        if outside > 405.0 {
            205
        } else if wall || outside > 398.0 {
            0
        } else {
            254
        }
    };
    let pixels = (0..1_000_000).map(|i| Some(pixel(i, 1.5 * draw.next()))).collect();
    let text =
        "image: a.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    let meta = Meta::from_yaml(text, Path::new("rough")).expect("the description is good");
    (Grey { width: 1000, height: 1000, pixels }, meta)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (name, all, side) in [
        ("250 boxes in 100 m", boxes(250, 100.0), 100.0),
        ("60 boxes in 50 m", boxes(60, 50.0), 50.0),
        ("25 discs in 40 m", discs(25, 40.0), 40.0),
        ("1000 discs in 200 m", discs(1000, 200.0), 200.0),
    ] {
        let from = starts(&all, side, 0.76);
        report(name, all, 0.75, Position::new(side + 3.0, side + 3.0), &from);
    }
    let (image, meta) = rough_map();
    let set_point = meta.to_world(Position::new(520.0, 570.0));
    for simplify in [0.0, 0.05, 0.1] {
        let settings = MapSettings { simplify: Some(simplify), ..MapSettings::default() };
        let begin = running();
        let all = Obstacles::new(obstacles("rough", &image, &meta, settings)?);
        println!("rough map, growth up to {simplify} m: traced and cut in {:.0} ms", (running() - begin) * 1e3);
        if simplify > 0.0 {
            let from: Vec<Position> = starts(&all, 50.0, 0.41);
            report("rough map", all, 0.4, set_point, &from);
        }
    }
    let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("maps");
    let begin = running();
    let all = Obstacles::new(load(&maps.join("warehouse.yaml"), MapSettings::default())?);
    println!("warehouse: read and cut in {:.1} ms", (running() - begin) * 1e3);
    let places: Places = toml::from_str(&std::fs::read_to_string(maps.join("warehouse.places.toml"))?)?;
    let from: Vec<Position> = starts(&all, 30.0, 0.76);
    report("warehouse", all, 0.75, places.place[0].position.0, &from);
    Ok(())
}

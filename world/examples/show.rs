//! Draws a scenario: `cargo run --example show SCENARIO.toml PICTURE.svg [CLEARANCE]`. Stands in for
//! `scenario show FILE` until the loader knows shapes.

use serde::Deserialize;
use std::path::Path;
use std::sync::Arc;
use world::draw::{RobotMark, svg};
use world::file::{MapEntry, ObstacleEntry, Point, obstacles};
use world::route::{Roadmap, Route};

#[derive(Deserialize)]
struct File {
    map: Option<MapEntry>,
    #[serde(default)]
    obstacle: Vec<ObstacleEntry>,
    #[serde(default)]
    robot: Vec<Robot>,
}

#[derive(Deserialize)]
struct Robot {
    start: Point,
    set_point: Point,
    radius: Option<f64>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let (Some(scenario), Some(picture)) = (args.next(), args.next()) else {
        return Err("usage: show SCENARIO.toml PICTURE.svg [CLEARANCE]".into());
    };
    let clearance: f64 = args.next().map_or(Ok(0.75), |text| text.parse())?;
    let file: File = toml::from_str(&std::fs::read_to_string(&scenario)?)?;
    let folder = Path::new(&scenario).parent().unwrap_or(Path::new(""));
    let all = Arc::new(obstacles(&file.obstacle, file.map.as_ref(), folder, 0.75)?);
    let map = Arc::new(Roadmap::new(all.clone(), clearance));
    let mut marks = Vec::new();
    for (number, robot) in file.robot.iter().enumerate() {
        let (start, set_point) = (robot.start.0, robot.set_point.0);
        let route = Route::new(map.clone(), set_point).and_then(|route| route.reach(start).map(|_| route));
        let way = match route {
            Ok(route) => route.walk(start, None).collect(),
            Err(reason) => {
                println!("robot-{number}: {reason}");
                Vec::new()
            }
        };
        let radius = robot.radius.unwrap_or(0.75);
        marks.push(RobotMark { name: format!("robot-{number}"), start, set_point, radius, way });
    }
    std::fs::write(picture, svg(&scenario, &all, &marks))?;
    Ok(())
}

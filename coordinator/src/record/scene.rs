//! The team as a picture: Foxglove's published messages `SceneUpdate` and `PosesInFrame`.
//!
//! Numbers in the calls are the field numbers of the published schemas (`schemas/*.bin`, which go into
//! the log as well). Frame `world`, metres, z up; discs are 0.2 m high so that they can be seen from the side.

use super::protobuf::{Message, Value, fields};
use vodca::Position;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;

/// Descriptors of `foxglove.SceneUpdate` and everything it uses (Foxglove SDK, MIT licence).
pub(super) const SCENE_UPDATE: &[u8] = include_bytes!("schemas/SceneUpdate.bin");
/// Descriptors of `foxglove.PosesInFrame` and everything it uses (Foxglove SDK, MIT licence).
pub(super) const POSES_IN_FRAME: &[u8] = include_bytes!("schemas/PosesInFrame.bin");

const FRAME: &str = "world";
const DISC_HEIGHT: f64 = 0.2; // m
const GREY: [f64; 4] = [0.45, 0.45, 0.45, 1.0];

/// `SceneUpdate` with what does not move: obstacles, and a ring at every set-point.
pub(super) fn layout(scenario: &Scenario, params: &Params) -> Message {
    let half = params.model.min_separation / 2.0;
    let obstacles = scenario.obstacles.iter().enumerate().map(|(l, obstacle)| {
        let disc = disc(obstacle.position, obstacle.radius.unwrap_or(half), GREY);
        entity(&format!("obstacle {l}"), 0).message(10, &disc).message(13, &label(obstacle.position, &obstacle.name))
    });
    let count = scenario.robots.len();
    let set_points = scenario.robots.iter().enumerate().map(|(i, robot)| {
        let rim = circle(robot.set_point, robot.radius.unwrap_or(half));
        entity(&format!("set-point {i}"), 0).message(11, &line(LineKind::Loop, &rim, colour(i, count, 0.6)))
    });
    Message::default().messages(2, obstacles.chain(set_points))
}

/// `SceneUpdate` of one tick: every robot as a disc with its number, and its predicted path.
pub(super) fn team(scenario: &Scenario, params: &Params, nanoseconds: u64, steps: &[Step]) -> Message {
    let half = params.model.min_separation / 2.0;
    let entities = steps.iter().zip(&scenario.robots).enumerate().map(|(i, (step, robot))| {
        let colour = colour(i, steps.len(), 1.0);
        entity(&format!("robot {i}"), nanoseconds)
            .message(10, &disc(step.position, robot.radius.unwrap_or(half), colour))
            .message(11, &line(LineKind::Strip, step.plan.states(), colour))
            .message(13, &label(step.position, &i.to_string()))
    });
    Message::default().messages(2, entities)
}

/// `PosesInFrame` of one tick: all positions, in the order of the robots, heading along the input.
pub(super) fn poses(nanoseconds: u64, steps: &[Step]) -> Message {
    let poses = steps.iter().map(|step| {
        let half_angle = step.input.y.atan2(step.input.x) / 2.0;
        let heading = Message::default().double(3, half_angle.sin()).double(4, half_angle.cos());
        Message::default().message(1, &triple(step.position, 0.0)).message(2, &heading)
    });
    Message::default().message(1, &timestamp(nanoseconds)).text(2, FRAME).messages(3, poses)
}

/// The predicted paths in a `SceneUpdate` that [`team`] wrote, by robot.
pub(super) fn plans(scene: &[u8]) -> Vec<Vec<Position>> {
    let nested = |bytes, wanted| {
        fields(bytes).filter_map(move |(number, value)| match value {
            Value::Bytes(bytes) if number == wanted => Some(bytes),
            _ => None,
        })
    };
    let coordinate = |point, wanted| {
        let found = fields(point).find_map(|(number, value)| match value {
            Value::Double(value) if number == wanted => Some(value),
            _ => None,
        });
        found.unwrap_or(0.0) // a default is left out
    };
    let point = |bytes| Position::new(coordinate(bytes, 1), coordinate(bytes, 2));
    let plan = |entity| nested(entity, 11).flat_map(|line| nested(line, 5)).map(point).collect();
    nested(scene, 2).map(plan).collect()
}

fn entity(id: &str, nanoseconds: u64) -> Message {
    Message::default().message(1, &timestamp(nanoseconds)).text(2, FRAME).text(3, id)
}

fn disc(centre: Position, radius: f64, colour: [f64; 4]) -> Message {
    let size = Message::default().double(1, 2.0 * radius).double(2, 2.0 * radius).double(3, DISC_HEIGHT);
    Message::default()
        .message(1, &pose(centre, DISC_HEIGHT / 2.0))
        .message(2, &size)
        .double(3, 1.0)
        .double(4, 1.0)
        .message(5, &rgba(colour))
}

fn label(at: Position, text: &str) -> Message {
    Message::default()
        .message(1, &pose(at, 2.0 * DISC_HEIGHT))
        .integer(2, 1) // billboard: faces the camera
        .double(3, 0.5) // font size, m
        .message(5, &rgba([1.0, 1.0, 1.0, 1.0]))
        .text(6, text)
}

#[derive(Clone, Copy)]
enum LineKind {
    Strip = 0,
    Loop = 1,
}

fn line(kind: LineKind, points: &[Position], colour: [f64; 4]) -> Message {
    Message::default()
        .integer(1, kind as u64)
        .message(2, &pose(Position::zeros(), 0.0))
        .double(3, 0.05) // thickness, m
        .messages(5, points.iter().map(|&point| triple(point, 0.0)))
        .message(6, &rgba(colour))
}

fn circle(centre: Position, radius: f64) -> [Position; 24] {
    std::array::from_fn(|n| {
        let angle = n as f64 / 24.0 * std::f64::consts::TAU;
        centre + Position::new(angle.cos(), angle.sin()) * radius
    })
}

fn pose(at: Position, z: f64) -> Message {
    let upright = Message::default().double(4, 1.0);
    Message::default().message(1, &triple(at, z)).message(2, &upright)
}

fn triple(at: Position, z: f64) -> Message {
    Message::default().double(1, at.x).double(2, at.y).double(3, z)
}

fn rgba(colour: [f64; 4]) -> Message {
    colour.iter().enumerate().fold(Message::default(), |message, (n, &part)| message.double(n as u64 + 1, part))
}

fn timestamp(nanoseconds: u64) -> Message {
    Message::default().integer(1, nanoseconds / 1_000_000_000).integer(2, nanoseconds % 1_000_000_000)
}

/// Evenly spaced hues, so that neighbours in number differ.
fn colour(robot: usize, count: usize, alpha: f64) -> [f64; 4] {
    let hue = robot as f64 / count.max(1) as f64 * 6.0;
    let channel = |shift: f64| {
        let away = ((hue + shift) % 6.0 - 3.0).abs() - 1.0;
        0.25 + 0.7 * away.clamp(0.0, 1.0)
    };
    [channel(0.0), channel(4.0), channel(2.0), alpha]
}

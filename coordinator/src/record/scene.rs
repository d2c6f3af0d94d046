//! The team as a picture: Foxglove's `SceneUpdate` and `PosesInFrame`.
//!
//! Frame `world`, metres, z up; discs are 0.2 m high so that they can be seen from the side.

use super::foxglove::{
    Color, CylinderPrimitive, LinePrimitive, LineType, Message, Pose, PosesInFrame, Quaternion, SceneEntity,
    SceneUpdate, TextPrimitive, Timestamp, TriangleListPrimitive, Vector3, nonzero,
};
use vodca::Position;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;

const FRAME: &str = "world";
const DISC_HEIGHT: f64 = 0.2; // m
const GREY: Color = Color { r: 0.45, g: 0.45, b: 0.45, a: 1.0 };
const WHITE: Color = Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 };

/// `SceneUpdate` with what does not move: obstacles, and a ring at every set-point.
pub(super) fn layout(scenario: &Scenario, params: &Params) -> Vec<u8> {
    let half = params.model.min_separation / 2.0;
    let obstacles = scenario.obstacles.iter().enumerate().map(|(l, obstacle)| SceneEntity {
        cylinders: vec![disc(obstacle.position, obstacle.radius.unwrap_or(half), GREY)],
        texts: vec![label(obstacle.position, &obstacle.name)],
        ..entity(&format!("obstacle {l}"), 0)
    });
    let count = scenario.robots.len();
    let set_points = scenario.robots.iter().enumerate().map(|(i, robot)| {
        let rim = circle(robot.set_point, robot.radius.unwrap_or(half));
        let ring = line(LineType::Loop, &rim, colour(i, count, 0.6));
        SceneEntity { lines: vec![ring], ..entity(&format!("set-point {i}"), 0) }
    });
    SceneUpdate { entities: obstacles.chain(shapes(scenario)).chain(set_points).collect() }.encode_to_vec()
}

/// Polygons, walls and regions, numbered after the discs: their pieces as triangles, walls as lines as well.
fn shapes(scenario: &Scenario) -> impl Iterator<Item = SceneEntity> {
    let numbered = scenario.shapes.iter().enumerate();
    numbered.map(|(l, shape)| {
        let fan = |core: &Vec<Position>| {
            let last = core.len().saturating_sub(1);
            let corners = core.clone();
            (1..last).flat_map(move |k| [corners[0], corners[k], corners[k + 1]])
        };
        let points: Vec<Vector3> = shape.cores().iter().flat_map(fan).map(|at| point(at, DISC_HEIGHT)).collect();
        let triangles = TriangleListPrimitive { pose: Some(pose(Position::zeros(), 0.0)), points, color: Some(GREY) };
        let borders = shape.rings().iter().map(|ring| LinePrimitive {
            thickness: (2.0 * shape.radius()).max(0.05),
            ..line(LineType::Loop, ring, GREY)
        });
        let label = shape.rings().first().and_then(|ring| ring.first()).map(|at| label(*at, shape.name()));
        SceneEntity {
            lines: borders.collect(),
            triangles: Some(triangles).filter(|list| !list.points.is_empty()).into_iter().collect(),
            texts: label.into_iter().collect(),
            ..entity(&format!("obstacle {}", scenario.obstacles.len() + l), 0)
        }
    })
}

/// `SceneUpdate` of one tick: every robot as a disc with its number, and its predicted path.
pub(super) fn team(scenario: &Scenario, params: &Params, nanoseconds: u64, steps: &[Step]) -> Vec<u8> {
    let half = params.model.min_separation / 2.0;
    let entities = steps.iter().zip(&scenario.robots).enumerate().map(|(i, (step, robot))| {
        let colour = colour(i, steps.len(), 1.0);
        SceneEntity {
            cylinders: vec![disc(step.position, robot.radius.unwrap_or(half), colour)],
            lines: vec![line(LineType::Strip, step.plan.states(), colour)],
            texts: vec![label(step.position, &i.to_string())],
            ..entity(&format!("robot {i}"), nanoseconds)
        }
    });
    SceneUpdate { entities: entities.collect() }.encode_to_vec()
}

/// `PosesInFrame` of one tick: all positions, in the order of the robots, heading along the input.
pub(super) fn poses(nanoseconds: u64, steps: &[Step]) -> Vec<u8> {
    let pose = |step: &Step| {
        let half_angle = step.input.y.atan2(step.input.x) / 2.0;
        let orientation = Quaternion { z: nonzero(half_angle.sin()), w: nonzero(half_angle.cos()) };
        Pose { position: Some(point(step.position, 0.0)), orientation: Some(orientation) }
    };
    let (timestamp, poses) = (Some(timestamp(nanoseconds)), steps.iter().map(pose).collect());
    PosesInFrame { timestamp, frame_id: FRAME.into(), poses }.encode_to_vec()
}

/// The predicted paths in a `SceneUpdate` that [`team`] wrote, by robot; none in what is no such message.
pub(super) fn plans(scene: &[u8]) -> Vec<Vec<Position>> {
    let position = |point: Vector3| Position::new(point.x.unwrap_or(0.0), point.y.unwrap_or(0.0));
    let plan = |entity: SceneEntity| entity.lines.into_iter().flat_map(|line| line.points).map(position).collect();
    SceneUpdate::decode(scene).unwrap_or_default().entities.into_iter().map(plan).collect()
}

fn entity(id: &str, nanoseconds: u64) -> SceneEntity {
    let (frame_id, id) = (FRAME.into(), id.into());
    SceneEntity { timestamp: Some(timestamp(nanoseconds)), frame_id, id, ..SceneEntity::default() }
}

fn disc(centre: Position, radius: f64, colour: Color) -> CylinderPrimitive {
    CylinderPrimitive {
        pose: Some(pose(centre, DISC_HEIGHT / 2.0)),
        size: Some(point(Position::new(2.0 * radius, 2.0 * radius), DISC_HEIGHT)),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Some(colour),
    }
}

fn label(at: Position, text: &str) -> TextPrimitive {
    TextPrimitive {
        pose: Some(pose(at, 2.0 * DISC_HEIGHT)),
        billboard: true,
        font_size: 0.5,
        color: Some(WHITE),
        text: text.into(),
    }
}

fn line(kind: LineType, points: &[Position], colour: Color) -> LinePrimitive {
    LinePrimitive {
        r#type: kind.into(),
        pose: Some(pose(Position::zeros(), 0.0)),
        thickness: 0.05,
        points: points.iter().map(|&at| point(at, 0.0)).collect(),
        color: Some(colour),
    }
}

fn circle(centre: Position, radius: f64) -> [Position; 24] {
    std::array::from_fn(|n| {
        let angle = n as f64 / 24.0 * std::f64::consts::TAU;
        centre + Position::new(angle.cos(), angle.sin()) * radius
    })
}

fn pose(at: Position, z: f64) -> Pose {
    let upright = Quaternion { z: None, w: Some(1.0) };
    Pose { position: Some(point(at, z)), orientation: Some(upright) }
}

fn point(at: Position, z: f64) -> Vector3 {
    Vector3 { x: nonzero(at.x), y: nonzero(at.y), z: nonzero(z) }
}

fn timestamp(nanoseconds: u64) -> Timestamp {
    Timestamp { seconds: (nanoseconds / 1_000_000_000) as i64, nanos: (nanoseconds % 1_000_000_000) as i32 }
}

/// Evenly spaced hues, so that neighbours in number differ.
fn colour(robot: usize, count: usize, alpha: f64) -> Color {
    let hue = robot as f64 / count.max(1) as f64 * 6.0;
    let channel = |shift: f64| {
        let away = ((hue + shift) % 6.0 - 3.0).abs() - 1.0;
        0.25 + 0.7 * away.clamp(0.0, 1.0)
    };
    Color { r: channel(0.0), g: channel(4.0), b: channel(2.0), a: alpha }
}

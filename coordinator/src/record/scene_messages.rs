//! The messages of a run's film: what its log holds and what viewers are sent while it goes on.
//!
//! | topic | schema | when |
//! |---|---|---|
//! | `/layout` | `foxglove.SceneUpdate` | once: obstacles and set-points |
//! | `/scene` | `foxglove.SceneUpdate` | every tick: discs with their number, predicted paths |
//! | `/poses` | `foxglove.PosesInFrame` | every tick: positions (Rerun shows these, it has no SceneUpdate) |
//! | `/team` | `vodca.Team`, JSON | every tick: the values of `trajectory.csv` and more, for plots |
//!
//! Why not the `foxglove` crate: it would add some ninety crates and a minute of build time for three
//! message types. The published descriptors lie beside this file and go into every log, the messages
//! are in `foxglove.rs`, what is drawn with them in `scene.rs`; Foxglove's own Python decoder reads them back.

use super::{foxglove, scene};
use serde_json::json;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;

/// A stream of messages of one kind.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    /// What viewers call it.
    pub(crate) topic: &'static str,
    /// Name of the schema.
    pub(crate) schema: &'static str,
    /// Language of the schema.
    pub(crate) schema_encoding: &'static str,
    /// The schema.
    pub(crate) description: Vec<u8>,
    /// How messages are encoded.
    pub(crate) encoding: &'static str,
}

/// RuntimeDir of `/layout` in [`channels`].
pub(crate) const LAYOUT: usize = 0;
const SCENE: usize = 1;
const POSES: usize = 2;
const TEAM: usize = 3;

/// All channels.
pub(crate) fn channels() -> [Channel; 4] {
    let picture = |topic, schema, descriptor: &[u8]| Channel {
        topic,
        schema,
        schema_encoding: "protobuf",
        description: descriptor.to_vec(),
        encoding: "protobuf",
    };
    [
        picture("/layout", "foxglove.SceneUpdate", foxglove::SCENE_UPDATE),
        picture("/scene", "foxglove.SceneUpdate", foxglove::SCENE_UPDATE),
        picture("/poses", "foxglove.PosesInFrame", foxglove::POSES_IN_FRAME),
        Channel {
            topic: "/team",
            schema: "vodca.Team",
            schema_encoding: "jsonschema",
            description: team_schema().into_bytes(),
            encoding: "json",
        },
    ]
}

/// The only message of `/layout`.
pub(crate) fn layout(scenario: &Scenario, params: &Params) -> Vec<u8> {
    scene::layout(scenario, params)
}

/// The messages of one tick: the place of the channel, and the message.
pub(crate) fn tick(scenario: &Scenario, params: &Params, tick: u64, steps: &[Step]) -> [(usize, Vec<u8>); 3] {
    let time = nanoseconds(params.model.sample_time, tick);
    [
        (SCENE, scene::team(scenario, params, time, steps)),
        (POSES, scene::poses(time, steps)),
        (TEAM, team_values(scenario, tick, steps).to_string().into_bytes()),
    ]
}

/// When tick `tick` begins, ns from the start of the run.
pub(crate) fn nanoseconds(sample_time: f64, tick: u64) -> u64 {
    (tick as f64 * sample_time * 1e9).round() as u64
}

/// The message on `/team`.
fn team_values(scenario: &Scenario, tick: u64, steps: &[Step]) -> serde_json::Value {
    let robots: Vec<_> = steps
        .iter()
        .zip(&scenario.robots)
        .map(|(step, robot)| {
            json!({
                "x": step.position.x, "y": step.position.y, "ux": step.input.x, "uy": step.input.y,
                "distance": (robot.set_point - step.position).norm(),
                "horizon": step.horizon, "rows": step.rows,
                "level": step.level.word(), "status": step.status.word(), "filtered": step.filtered,
            })
        })
        .collect();
    json!({ "tick": tick, "robots": robots })
}

/// JSON schema of [`team_values`].
fn team_schema() -> String {
    let number = |what| json!({ "type": "number", "description": what });
    let integer = |what| json!({ "type": "integer", "description": what });
    let word = |what| json!({ "type": "string", "description": what });
    json!({
        "title": "vodca.Team",
        "type": "object",
        "properties": {
            "tick": integer("k"),
            "robots": { "type": "array", "items": { "type": "object", "properties": {
                "x": number("position at the start of the tick, m"),
                "y": number("position at the start of the tick, m"),
                "ux": number("input applied during the tick, m/s"),
                "uy": number("input applied during the tick, m/s"),
                "distance": number("to the set-point at the start of the tick, m"),
                "horizon": integer("prediction steps, 1..=49"),
                "rows": integer("collision rows of the QP"),
                "level": word("rung of the solver ladder that gave the plan"),
                "status": word("how the plan came about"),
                "filtered": { "type": "boolean", "description": "whether the safety filter changed the input" },
            }}},
        },
    })
    .to_string()
}

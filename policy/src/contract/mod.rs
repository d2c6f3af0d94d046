//! The contract of a policy: what goes into its model, what comes out and what that means.
//!
//! It stands as JSON beside the model (`manifest.json`, or `NAME.json` beside `NAME.onnx`) and, less
//! the four fields that name the file itself, in the model's metadata_props under [`METADATA_KEY`].

mod error;
mod infer;
mod load;

pub use error::ContractError;
pub use infer::infer;
pub use load::{Found, find, from_json, places};

use super::onnx::Dim;
use serde::{Deserialize, Serialize};
use vodca::Position;
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::scenario::Scenario;

/// The format that is read and written.
pub const SCHEMA: &str = "vodca/policy/1";

/// Where the contract stands in metadata_props.
pub const METADATA_KEY: &str = "vodca.contract";

/// The contract of a policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contract {
    /// [`SCHEMA`].
    pub schema: String,
    /// What people call it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// N: a model fits one number of robots.
    pub robots: usize,
    /// How positions become the model's input.
    pub observation: Observation,
    /// The model's only input, `[batch, 2N]`.
    pub input: Tensor,
    /// Its outputs, `[batch, N]` each.
    pub outputs: Outputs,
    /// How a mean becomes an action in [-1, 1].
    pub action_map: ActionMap,
    /// Bounds of the horizons it may choose.
    #[serde(default)]
    pub horizon: HorizonBounds,
    /// Version of ONNX's operator set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opset: Option<i64>,
    /// Program that wrote the model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub producer: Option<String>,
    /// The training run, in its own words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trained_from: Option<String>,
    /// Folder name of this version, `v000017`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// SHA-256 of the model file, hexadecimal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// Size of the model file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// When it was published, seconds since 1970.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub created: Option<u64>,
}

/// How positions become the model's input: (position - offset) * scale, per axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Observation {
    /// What is observed.
    pub kind: ObservationKind,
    /// In which order.
    pub layout: Layout,
    /// Subtracted first, [x, y], m.
    #[serde(default)]
    pub offset: [f64; 2],
    /// Multiplied then, [x, y], 1/m.
    #[serde(default = "one")]
    pub scale: [f64; 2],
}

fn one() -> [f64; 2] {
    [1.0, 1.0]
}

/// What is observed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ObservationKind {
    /// The measured positions of all robots, s of the paper.
    Positions,
}

/// In which order the numbers stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// x0, y0, x1, y1, ...
    XyInterleaved,
}

/// Name and shape of an input or output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tensor {
    /// Its name in the model.
    pub name: String,
    /// Its shape; a text stands for any size.
    pub shape: Vec<Dim>,
}

/// The outputs of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outputs {
    /// Mean of the raw action (or the action itself, see [`ActionMap`]).
    pub mean: Tensor,
    /// Logarithm of its standard deviation; without it a policy cannot be sampled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub log_std: Option<Tensor>,
}

/// How a mean becomes an action in [-1, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ActionMap {
    /// a = tanh(mean), or tanh(mean + exp(log_std) eps) when sampled.
    Tanh,
    /// The model squashes by itself: a = mean.
    Identity,
}

/// Bounds of the horizons a policy may choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HorizonBounds {
    /// Shortest, at least 1.
    pub min: u64,
    /// Longest, at most 49.
    pub max: u64,
}

impl Default for HorizonBounds {
    fn default() -> Self {
        Self { min: 1, max: MAX_HORIZON as u64 }
    }
}

impl Contract {
    /// The contract of our own actors: `state` [batch, 2N] in, `mean` (and `log_std`) [batch, N] out.
    pub fn standard(robots: usize, samples: bool) -> Self {
        let tensor = |name: &str, width: usize| Tensor {
            name: name.into(),
            shape: vec![Dim::Free("batch".into()), Dim::Fixed(width as i64)],
        };
        Self {
            schema: SCHEMA.into(),
            name: None,
            robots,
            observation: Observation::default(),
            input: tensor("state", 2 * robots),
            outputs: Outputs { mean: tensor("mean", robots), log_std: samples.then(|| tensor("log_std", robots)) },
            action_map: ActionMap::Tanh,
            horizon: HorizonBounds::default(),
            opset: None,
            producer: None,
            trained_from: None,
            version: None,
            sha256: None,
            bytes: None,
            created: None,
        }
    }

    /// The same without the fields that name the file itself: the form inside the model.
    pub fn meaning(&self) -> Self {
        Self { version: None, sha256: None, bytes: None, created: None, ..self.clone() }
    }

    /// Pretty JSON with a final line break.
    pub fn to_json(&self) -> String {
        // Only strings, numbers and lists: cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Writes the model's input for `positions` (m) into `input`, 2N numbers.
    pub fn normalise(&self, positions: &[Position], input: &mut [f32]) {
        for (pair, position) in input.chunks_exact_mut(2).zip(positions) {
            pair[0] = self.observation.scaled(0, position.x);
            pair[1] = self.observation.scaled(1, position.y);
        }
    }

    /// a for a (sampled) mean; computed in f64.
    pub fn action(&self, mean: f64) -> f64 {
        match self.action_map {
            ActionMap::Tanh => mean.tanh(),
            ActionMap::Identity => mean,
        }
    }

    /// N_i^k for an action: ceil(1 + (a + 1) 24) within the bounds; `None` when it is not finite.
    pub fn horizon(&self, action: f64) -> Option<Horizon> {
        let free = Horizon::from_action(action)?;
        let HorizonBounds { min, max } = self.horizon;
        Some(Horizon::saturating((free.steps() as i64).clamp(min as i64, max as i64)))
    }
}

/// Shorter sides of a box of positions than this are not stretched to [-1, 1], m.
const SHORTEST_SIDE: f64 = 1.0;

impl Observation {
    /// Scales the box between two corners (m, per axis) to [-1, 1] on each axis.
    pub fn over(low: [f64; 2], high: [f64; 2]) -> Self {
        Self {
            offset: [0, 1].map(|axis| 0.5 * (low[axis] + high[axis])),
            scale: [0, 1].map(|axis| 2.0 / (high[axis] - low[axis]).max(SHORTEST_SIDE)),
            ..Self::default()
        }
    }

    /// Scales the box around all starts, set-points and obstacles of `layouts` to [-1, 1] on each axis.
    pub fn over_layouts(layouts: &[Scenario]) -> Self {
        let points = layouts.iter().flat_map(|layout| {
            let robots = layout.robots.iter().flat_map(|robot| [robot.start, robot.set_point]);
            let rings = layout.shapes.iter().flat_map(|shape| shape.rings().iter().flatten().copied());
            robots.chain(layout.obstacles.iter().map(|obstacle| obstacle.position)).chain(rings)
        });
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for (axis, at) in [point.x, point.y].into_iter().enumerate() {
                (low[axis], high[axis]) = (low[axis].min(at), high[axis].max(at));
            }
        }
        Self::over(low, high)
    }

    /// A coordinate on `axis` (0: x, 1: y), m, as the model takes it.
    pub fn scaled(&self, axis: usize, metres: f64) -> f32 {
        ((metres - self.offset[axis]) * self.scale[axis]) as f32
    }
}

impl Default for Observation {
    fn default() -> Self {
        Self { kind: ObservationKind::Positions, layout: Layout::XyInterleaved, offset: [0.0, 0.0], scale: one() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_interleaved_moved_and_scaled() {
        let mut contract = Contract::standard(2, true);
        contract.observation.offset = [1.0, 2.0];
        contract.observation.scale = [0.5, 0.1];
        let mut input = [0.0; 4];
        contract.normalise(&[Position::new(3.0, 12.0), Position::new(1.0, 2.0)], &mut input);
        assert_eq!(input, [1.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn horizons_stay_within_the_bounds_of_the_contract() {
        let mut contract = Contract::standard(1, false);
        let steps = |contract: &Contract, mean| contract.horizon(contract.action(mean)).map(Horizon::steps);
        assert_eq!(steps(&contract, 0.0), Some(25));
        assert_eq!(steps(&contract, 20.0), Some(49));
        assert_eq!(steps(&contract, -20.0), Some(1));
        assert_eq!(steps(&contract, f64::NAN), None);
        contract.horizon = HorizonBounds { min: 5, max: 30 };
        assert_eq!(steps(&contract, 20.0), Some(30));
        assert_eq!(steps(&contract, -20.0), Some(5));
        contract.action_map = ActionMap::Identity;
        assert_eq!(steps(&contract, 0.0), Some(25));
        assert_eq!(steps(&contract, -0.5), Some(13));
    }
}

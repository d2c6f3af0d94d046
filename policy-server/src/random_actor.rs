//! `policy new --random`: a valid actor that was never trained, to try things with.

use policy::contract::{Contract, METADATA_KEY};
use policy::onnx::{Activation, ActorGraph, Dense};
use std::collections::BTreeMap;
use vodca::random::{self, Use};

/// Neurons of each of the two hidden layers, as the learner's.
const HIDDEN: usize = 256;
/// Distance at which a normalised coordinate is 1, m.
const UNIT: f64 = 50.0;
const LOG_STD_BOUNDS: (f32, f32) = (-20.0, 2.0);

/// The model and its contract: two hidden layers, weights drawn uniformly as PyTorch does by default
/// (bound 1/sqrt(inputs)), the last layer larger so that horizons differ.
pub fn random_actor(robots: usize, seed: u64) -> (Vec<u8>, Contract) {
    let mut contract = Contract::standard(robots, true);
    contract.name = Some(format!("random-{robots}-{seed}"));
    contract.trained_from = Some(format!("never trained, weights from seed {seed}"));
    contract.observation.scale = [1.0 / UNIT, 1.0 / UNIT];
    let layer = |number: u64, inputs: usize, outputs: usize, gain: f64| {
        let mut generator = random::stream(seed, Use::Policy, u64::MAX, number);
        let bound = gain / (inputs as f64).sqrt();
        let mut draw = |count: usize| -> Vec<f32> {
            (0..count).map(|_| ((2.0 * random::unit(&mut generator) - 1.0) * bound) as f32).collect()
        };
        Dense { inputs, outputs, weight: draw(inputs * outputs), bias: draw(outputs) }
    };
    let graph = ActorGraph {
        hidden: vec![layer(0, 2 * robots, HIDDEN, 1.0), layer(1, HIDDEN, HIDDEN, 1.0)],
        activation: Activation::Relu,
        mean: layer(2, HIDDEN, robots, 8.0),
        log_std: Some(layer(3, HIDDEN, robots, 1.0)),
        log_std_bounds: LOG_STD_BOUNDS,
        metadata: BTreeMap::from([(METADATA_KEY.to_string(), contract.to_json())]),
    };
    (graph.write(), contract)
}

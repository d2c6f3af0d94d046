//! What the tests of this crate share: the binary that tries models, and small actors.
#![allow(dead_code)] // each test file uses its part

use policy::contract::Contract;
use policy::onnx::{Activation, ActorGraph, Dense};
use policy_server::actor::BackEnd;
use policy_server::check::{Limits, Prober};
use std::collections::BTreeMap;

/// Tries models in processes of the real binary.
pub(crate) fn prober() -> Prober {
    Prober {
        program: env!("CARGO_BIN_EXE_policy-server").into(),
        back_end: BackEnd::Embedded,
        limits: Limits::default(),
    }
}

/// A layer whose weights are `weight` and whose biases are `bias`.
pub(crate) fn dense(inputs: usize, outputs: usize, weight: f32, bias: f32) -> Dense {
    Dense { inputs, outputs, weight: vec![weight; inputs * outputs], bias: vec![bias; outputs] }
}

/// An actor for `robots` whose mean is always `mean`.
pub(crate) fn constant_actor(robots: usize, mean: f32) -> ActorGraph {
    ActorGraph {
        hidden: vec![dense(2 * robots, 8, 0.01, 0.1)],
        activation: Activation::Relu,
        mean: dense(8, robots, 0.0, mean),
        log_std: Some(dense(8, robots, 0.0, -1.0)),
        log_std_bounds: (-20.0, 2.0),
        metadata: BTreeMap::new(),
    }
}

/// Its contract.
pub(crate) fn contract(robots: usize) -> Contract {
    Contract::standard(robots, true)
}

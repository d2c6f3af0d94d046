//! Policies that were trained in Python as versions of a policies folder: ONNX, contract, reference set.

use crate::arrays::numbers;
use crate::error::{refused, wrong};
use crate::parity::Actor;
use policy::contract::{ActionMap, Contract, HorizonBounds, METADATA_KEY, Observation};
use policy::folder::PolicyFolder;
use policy::onnx::{Activation, ActorGraph, Dense, Dim};
use pyo3::prelude::*;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;
use vodca::horizon::Horizon;

/// How far what was written may answer differently, absolute.
const TOLERANCE: f64 = 1e-4;

/// What a policy means, beside its layers.
#[derive(FromPyObject)]
pub(crate) struct Meaning {
    #[pyo3(item)]
    name: String,
    #[pyo3(item)]
    robots: usize,
    #[pyo3(item)]
    offset: [f64; 2],
    #[pyo3(item)]
    scale: [f64; 2],
    /// Whether the mean has still to be squashed by tanh.
    #[pyo3(item)]
    squash: bool,
    #[pyo3(item)]
    horizon: [u64; 2],
    #[pyo3(item)]
    trained_from: String,
    /// Positions, m, and the policy's own answers to them: [cases][2 robots] and [cases][robots].
    #[pyo3(item)]
    cases: Vec<(Vec<f64>, Vec<f64>)>,
}

/// Writes an actor given layer by layer, (weight [outputs, inputs], bias [outputs]) in float32, checks that it answers
/// as the policy did, and makes it the current version of `folder`. Gives the version and the largest difference.
#[pyfunction]
pub(crate) fn publish_layers(
    folder: PathBuf,
    layers: Vec<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
    activation: &str,
    meaning: Meaning,
) -> PyResult<(String, f64)> {
    let activation = match activation {
        "relu" => Activation::Relu,
        "tanh" => Activation::Tanh,
        other => return Err(wrong(format!("activation = \"{other}\" is not known; allowed: \"relu\", \"tanh\""))),
    };
    let mut inputs = 2 * meaning.robots;
    let mut dense = Vec::new();
    for (number, (weight, bias)) in layers.iter().enumerate() {
        let outputs = bias.len()?;
        let weight = numbers::<f32>(weight, &format!("the weight of layer {number}"), &[outputs, inputs])?;
        let bias = numbers::<f32>(bias, &format!("the bias of layer {number}"), &[outputs])?;
        dense.push(Dense { inputs, outputs, weight, bias });
        inputs = outputs;
    }
    let mean = dense.pop().ok_or_else(|| wrong("a policy needs one layer at least"))?;
    if mean.outputs != meaning.robots {
        let (has, robots) = (mean.outputs, meaning.robots);
        return Err(wrong(format!("the last layer has {has} outputs; one for each of the {robots} robots is needed")));
    }
    let contract = contract(&meaning);
    let metadata = BTreeMap::from([(METADATA_KEY.to_string(), contract.meaning().to_json())]);
    let graph = ActorGraph { hidden: dense, activation, mean, log_std: None, log_std_bounds: (0.0, 0.0), metadata };
    let model = graph.write();
    let difference = compare(&model, &contract, &meaning)?;
    Ok((publish(folder, &model, &contract, &meaning)?, difference))
}

/// Makes an ONNX file that another exporter wrote, input `state` and output `mean`, the current version of `folder`.
#[pyfunction]
pub(crate) fn publish_model(folder: PathBuf, model: Vec<u8>, meaning: Meaning) -> PyResult<String> {
    publish(folder, &model, &contract(&meaning), &meaning)
}

fn contract(meaning: &Meaning) -> Contract {
    let [min, max] = meaning.horizon;
    let mut contract = Contract::standard(meaning.robots, false);
    contract.name = Some(meaning.name.clone());
    contract.observation = Observation { offset: meaning.offset, scale: meaning.scale, ..Observation::default() };
    contract.action_map = if meaning.squash { ActionMap::Tanh } else { ActionMap::Identity };
    contract.horizon = HorizonBounds { min, max };
    contract.producer = Some(format!("vodca for Python {}", env!("CARGO_PKG_VERSION")));
    contract.trained_from = Some(meaning.trained_from.clone());
    debug_assert!(matches!(contract.input.shape[1], Dim::Fixed(_)));
    contract
}

fn publish(folder: PathBuf, model: &[u8], contract: &Contract, meaning: &Meaning) -> PyResult<String> {
    // The server refuses contracts that this refuses.
    policy::contract::from_json(contract.to_json().as_bytes(), "of the policy").map_err(refused)?;
    let cases = meaning.cases.iter().enumerate().map(|(case, (observation, mean))| {
        let horizon = mean.iter().map(|&mean| contract.horizon(contract.action(mean)));
        let horizon: Option<Vec<Horizon>> = horizon.collect();
        let horizon = horizon.ok_or_else(|| {
            wrong(format!("the policy answers case {case} with a number that is not finite; nothing was written"))
        })?;
        Ok(json!({ "observation": observation, "mean": mean, "horizon": horizon }))
    });
    let cases = cases.collect::<PyResult<Vec<_>>>()?;
    let reference = json!({ "tolerance": TOLERANCE, "cases": cases }).to_string();
    let reference = (!meaning.cases.is_empty()).then_some(reference.as_str());
    let version = PolicyFolder::new(folder).publish(model, contract, reference).map_err(refused)?;
    Ok(version.to_string())
}

/// The largest difference between what was written and the policy's own answers.
fn compare(model: &[u8], contract: &Contract, meaning: &Meaning) -> PyResult<f64> {
    let broken = |reason: String| {
        wrong(format!("what was written cannot be read back: {reason}; please report this as a fault of vodca"))
    };
    let actor = Actor::read(model).map_err(broken)?;
    let mut largest = 0.0f64;
    for (case, (observation, mean)) in meaning.cases.iter().enumerate() {
        let input: Vec<f32> =
            observation.iter().enumerate().map(|(at, &x)| contract.observation.scaled(at % 2, x)).collect();
        let answer = actor.mean(&input).map_err(broken)?;
        for (robot, (answer, &mean)) in answer.iter().zip(mean).enumerate() {
            let difference = (f64::from(*answer) - mean).abs();
            if difference.is_nan() || difference > TOLERANCE {
                return Err(wrong(format!(
                    "the ONNX file answers case {case} for robot {robot} with {answer}, the policy with {mean}; nothing was \
                     written: the layers are not what the policy computes (order of layers, activation = \"relu\" or \"tanh\", \
                     squash)"
                )));
            }
            largest = largest.max(difference);
        }
    }
    Ok(largest)
}

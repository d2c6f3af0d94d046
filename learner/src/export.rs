//! A trained actor as a version of a policies folder: ONNX file, contract and reference set.

use crate::actor::Actor;
use policy::contract::{Contract, METADATA_KEY};
use policy::folder::{FolderError, PolicyFolder, Version};
use policy::onnx::{Activation, ActorGraph, Dense};
use serde::Serialize;
use std::collections::BTreeMap;
use vodca::Position;
use vodca::horizon::Horizon;

/// How far another back-end's mean and log sigma may differ, absolute.
const TOLERANCE: f64 = 1e-4;
/// Most cases of a reference set.
const MOST_CASES: usize = 64;

/// Why an actor cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The contract is of another team.
    #[error(
        "the actor has {observations} inputs and {actions} outputs; a contract for {robots} robots does not fit it"
    )]
    Robots {
        /// Inputs of the actor.
        observations: usize,
        /// Its actions.
        actions: usize,
        /// Robots of the contract.
        robots: usize,
    },
    /// Training diverged.
    #[error("the actor answers state {case} with a number that is not finite; go back to an earlier checkpoint")]
    NotFinite {
        /// Which state of the reference set.
        case: usize,
    },
    /// The folder cannot be written.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// Observations with the answers that the trained actor gives, as the policy server checks them.
#[derive(Serialize)]
struct ReferenceSet {
    tolerance: f64,
    cases: Vec<Case>,
}

#[derive(Serialize)]
struct Case {
    observation: Vec<f64>,
    mean: Vec<f64>,
    log_std: Vec<f64>,
    horizon: Vec<Horizon>,
}

/// Publishes `actor` as the current version of `folder`.
///
/// `contract` says how positions become the actor's input (see [`Contract::standard`]); `states` are
/// positions [x0, y0, x1, ...] (m) that the actor was trained on: at most 64 of them become the
/// reference set that the policy server tries before it serves.
pub fn export(
    actor: &Actor,
    contract: &Contract,
    states: &[Vec<f64>],
    folder: &PolicyFolder,
) -> Result<Version, ExportError> {
    let model = model(actor, contract)?;
    let reference = reference_set(actor, contract, states)?;
    // Only strings, numbers and lists: cannot fail.
    let reference = serde_json::to_string_pretty(&reference).unwrap_or_default();
    let reference = (!states.is_empty()).then_some(reference.as_str());
    Ok(folder.publish(&model, contract, reference)?)
}

/// The bytes of the ONNX file, with the contract inside.
pub fn model(actor: &Actor, contract: &Contract) -> Result<Vec<u8>, ExportError> {
    Ok(graph(actor, contract)?.write())
}

fn graph(actor: &Actor, contract: &Contract) -> Result<ActorGraph, ExportError> {
    let (observations, actions, robots) = (actor.observations(), actor.actions(), contract.robots);
    if observations != 2 * robots || actions != robots {
        return Err(ExportError::Robots { observations, actions, robots });
    }
    let dense = |(weight, bias): (&[f32], &[f32])| {
        let (outputs, weight, bias) = (bias.len(), weight.to_vec(), bias.to_vec());
        Dense { inputs: weight.len() / outputs, outputs, weight, bias }
    };
    let mut hidden: Vec<Dense> = actor.network().layers().map(dense).collect();
    // The last layer is both heads, means first.
    let mut mean = hidden.pop().unwrap_or(Dense { inputs: 0, outputs: 0, weight: Vec::new(), bias: Vec::new() });
    let log_std = Dense {
        inputs: mean.inputs,
        outputs: actions,
        weight: mean.weight.split_off(actions * mean.inputs),
        bias: mean.bias.split_off(actions),
    };
    mean.outputs = actions;
    let bounds = actor.bounds();
    Ok(ActorGraph {
        hidden,
        activation: Activation::Relu,
        mean,
        log_std: Some(log_std),
        log_std_bounds: (bounds.low, bounds.high),
        metadata: BTreeMap::from([(METADATA_KEY.to_string(), contract.meaning().to_json())]),
    })
}

fn reference_set(actor: &Actor, contract: &Contract, states: &[Vec<f64>]) -> Result<ReferenceSet, ExportError> {
    let mut input = vec![0.0f32; actor.observations()];
    let mut cases = Vec::new();
    // Spread over all states when there are more than are kept.
    let stride = states.len().div_ceil(MOST_CASES).max(1);
    for (case, state) in states.iter().step_by(stride).enumerate() {
        let positions: Vec<Position> = state.chunks_exact(2).map(|xy| Position::new(xy[0], xy[1])).collect();
        contract.normalise(&positions, &mut input);
        let (mean, log_std) = actor.answer(&input);
        let wide = |numbers: Vec<f32>| numbers.into_iter().map(f64::from).collect::<Vec<f64>>();
        let (mean, log_std) = (wide(mean), wide(log_std));
        let horizon: Option<Vec<Horizon>> = mean.iter().map(|mean| contract.horizon(contract.action(*mean))).collect();
        let horizon = horizon.filter(|_| log_std.iter().all(|log_std| log_std.is_finite()));
        let horizon = horizon.ok_or(ExportError::NotFinite { case })?;
        cases.push(Case { observation: state.clone(), mean, log_std, horizon });
    }
    Ok(ReferenceSet { tolerance: TOLERANCE, cases })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::wide;
    use crate::settings::Settings;
    use policy::onnx::Model;
    use vodca::random::{Use, stream, unit};

    fn actor() -> Actor {
        Actor::new(28, 14, &Settings { log_std_min: -0.1, ..Settings::default() }, 3)
    }

    fn layer(dense: &Dense, input: &[f64]) -> Vec<f64> {
        let rows = wide(&dense.weight);
        let sum =
            |(row, bias): (&[f64], &f32)| f64::from(*bias) + row.iter().zip(input).map(|(w, x)| w * x).sum::<f64>();
        rows.chunks_exact(dense.inputs).zip(&dense.bias).map(sum).collect()
    }

    #[test]
    fn the_exported_layers_answer_a_thousand_states_as_the_network_does() {
        let actor = actor();
        let graph = graph(&actor, &Contract::standard(14, true)).unwrap();
        let log_std = graph.log_std.as_ref().unwrap();
        assert_eq!((graph.hidden.len(), graph.mean.outputs, log_std.outputs), (2, 14, 14));
        let (mut largest, mut cut) = (0.0f64, 0);
        for state in 0..1000 {
            let mut generator = stream(9, Use::Problem, 0, state);
            let state: Vec<f32> = (0..28).map(|_| 4.0 * unit(&mut generator) as f32 - 2.0).collect();
            let relu = |sums: Vec<f64>| sums.into_iter().map(|sum| sum.max(0.0)).collect::<Vec<f64>>();
            let hidden = graph.hidden.iter().fold(wide(&state), |values, dense| relu(layer(dense, &values)));
            let clip =
                |log_std: f64| log_std.clamp(f64::from(graph.log_std_bounds.0), f64::from(graph.log_std_bounds.1));
            let expected_std: Vec<f64> = layer(log_std, &hidden).into_iter().map(clip).collect();
            let (mean, log_std) = actor.answer(&state);
            cut += log_std.iter().filter(|log_std| **log_std == -0.1).count();
            let both = wide(&mean)
                .into_iter()
                .zip(layer(&graph.mean, &hidden))
                .chain(wide(&log_std).into_iter().zip(expected_std));
            largest = both.fold(largest, |most, (got, expected)| most.max((got - expected).abs()));
        }
        assert!(largest < 5e-6, "{largest}");
        assert!(cut > 0, "the bounds of log sigma were never reached");
    }

    #[test]
    fn a_published_actor_is_a_whole_version() {
        let place = tempfile::tempdir().unwrap();
        let folder = PolicyFolder::new(place.path().join("mine"));
        let states: Vec<Vec<f64>> = (0..100).map(|state| vec![f64::from(state); 28]).collect();
        let version = export(&actor(), &Contract::standard(14, true), &states, &folder).unwrap();
        assert_eq!(folder.current().unwrap(), Some(version));
        let model = std::fs::read(folder.model(version)).unwrap();
        assert!(Model::read(&model).unwrap().metadata.contains_key(METADATA_KEY));
        let reference = std::fs::read(folder.model(version).with_file_name("reference.json")).unwrap();
        let reference: serde_json::Value = serde_json::from_slice(&reference).unwrap();
        assert_eq!(reference["cases"].as_array().unwrap().len(), 50);
        assert_eq!(reference["cases"][1]["observation"][0], 2.0);
    }

    #[test]
    fn the_onnx_checker_accepts_the_file_and_onnx_answers_alike() {
        let place = tempfile::tempdir().unwrap();
        let folder = PolicyFolder::new(place.path().join("mine"));
        let mut contract = Contract::standard(14, true);
        contract.observation.scale = [0.04, 0.05];
        contract.observation.offset = [1.0, -2.0];
        let states: Vec<Vec<f64>> = (0..50).map(|state| vec![f64::from(state) - 25.0; 28]).collect();
        let version = export(&actor(), &contract, &states, &folder).unwrap();
        let (model, script) = (folder.model(version), concat!(env!("CARGO_MANIFEST_DIR"), "/tests/check_model.py"));
        let reference = model.with_file_name("reference.json");
        let output = std::process::Command::new("python3").args([script.as_ref(), &*model, &*reference]).output();
        let Ok(output) = output else { return eprintln!("skipped: there is no python3") };
        let said = String::from_utf8_lossy(&output.stdout);
        if said.starts_with("skipped") {
            return eprintln!("{said}");
        }
        assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(said.trim(), "50 states answered alike");
    }

    #[test]
    fn what_cannot_serve_is_not_exported() {
        let message = |actor: &Actor, robots| {
            let contract = Contract::standard(robots, true);
            let place = tempfile::tempdir().unwrap();
            let folder = PolicyFolder::new(place.path().join("mine"));
            let refused = export(actor, &contract, &[vec![1.0; 2 * robots]], &folder).unwrap_err().to_string();
            assert_eq!(folder.versions().unwrap(), []);
            refused
        };
        let other = Actor::new(6, 3, &Settings::default(), 1);
        assert!(message(&other, 2).contains("a contract for 2 robots does not fit"), "{}", message(&other, 2));
        let mut diverged = actor();
        diverged.network_mut().parameters_mut()[0] = f32::NAN;
        assert!(message(&diverged, 14).contains("is not finite"), "{}", message(&diverged, 14));
    }
}

//! A trained actor as a version of a policies folder: ONNX file, contract and reference set.

use crate::actor::Actor;
use serde::Serialize;
use shared::Position;
use shared::horizon::Horizon;
use shared::policy::contract::{Contract, METADATA_KEY};
use shared::policy::folder::{FolderError, PolicyFolder, Version};
use shared::policy::onnx::{ActorGraph, Dense};
use std::collections::BTreeMap;

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
    let reference = reference_set(actor, contract, states)?;
    // Only strings, numbers and lists: cannot fail.
    let reference = serde_json::to_string_pretty(&reference).unwrap_or_default();
    let reference = (!states.is_empty()).then_some(reference.as_str());
    Ok(folder.publish(&model(actor, contract)?, contract, reference)?)
}

/// The bytes of the ONNX file, with the contract inside.
pub fn model(actor: &Actor, contract: &Contract) -> Result<Vec<u8>, ExportError> {
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
    let graph = ActorGraph {
        hidden,
        mean,
        log_std: Some(log_std),
        log_std_bounds: (bounds.low, bounds.high),
        metadata: BTreeMap::from([(METADATA_KEY.to_string(), contract.meaning().to_json())]),
    };
    Ok(graph.write())
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

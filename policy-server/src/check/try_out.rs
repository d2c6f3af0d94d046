//! Loads a model, warms it up and compares what it answers.

use super::{Limits, ReferenceSet, TryError, canary};
use crate::actor::{Actor, Answer, Runtime};
use policy::contract::Contract;
use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use std::time::Instant;
use vodca::Position;

/// Runs before anything is measured.
const WARM_UP_RUNS: usize = 10;

/// What a trial measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Report {
    /// Load and warm-up, us.
    pub load_us: u64,
    /// Median processor time of one inference on the canary set, ns.
    pub inference_ns: u64,
    /// Observations of the canary set.
    pub canary_cases: usize,
    /// Observations of the reference set.
    pub reference_cases: usize,
}

/// Loads `bytes`, warms it up, runs the canary set and the reference set. The actor is ready to serve.
pub fn try_out(
    runtime: &Runtime,
    bytes: &[u8],
    contract: &Contract,
    reference: Option<&ReferenceSet>,
    limits: &Limits,
) -> Result<(Actor, Report), TryError> {
    let started = Instant::now();
    let mut actor = Actor::load(runtime, bytes, contract)?;
    let mut answer = Answer::default();
    let mut input = vec![0.0f32; 2 * contract.robots];
    for _ in 0..WARM_UP_RUNS {
        actor.infer(&input, &mut answer)?;
    }
    let load_us = started.elapsed().as_micros() as u64;

    let mut times = Vec::new();
    for (case, positions) in canary::positions(contract.robots).enumerate() {
        contract.normalise(&positions, &mut input);
        let before = processor_ns();
        actor.infer(&input, &mut answer)?;
        times.push(processor_ns() - before);
        finite(&answer, "canary", case)?;
    }
    times.sort_unstable();
    let inference_ns = times[times.len() / 2];
    if inference_ns > limits.inference_us * 1_000 {
        return Err(TryError::Slow { us: inference_ns / 1_000, limit_us: limits.inference_us });
    }

    let cases = reference.map_or(&[][..], |set| &set.cases);
    for (index, case) in cases.iter().enumerate() {
        let positions: Vec<Position> =
            case.observation.chunks_exact(2).map(|pair| Position::new(pair[0], pair[1])).collect();
        contract.normalise(&positions, &mut input);
        actor.infer(&input, &mut answer)?;
        finite(&answer, "reference", index)?;
        case.compare(&answer, contract, reference.map_or(0.0, |set| set.tolerance), index)?;
    }
    let report = Report { load_us, inference_ns, canary_cases: times.len(), reference_cases: cases.len() };
    Ok((actor, report))
}

fn finite(answer: &Answer, set: &str, case: usize) -> Result<(), TryError> {
    let bad = |numbers: &[f32]| numbers.iter().position(|number| !number.is_finite());
    match bad(&answer.mean).or_else(|| bad(&answer.log_std)) {
        Some(robot) => Err(TryError::NotFinite { set: set.into(), case, robot }),
        None => Ok(()),
    }
}

/// Processor time of this thread: a busy machine does not make a model slow.
fn processor_ns() -> u64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

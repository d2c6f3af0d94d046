//! Promise: mutated files never make the contract parser or the check panic, hang or eat memory.
//! The number of mutants is fixed and every one follows from its seed.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

mod common;

use chacha20::rand_core::Rng;
use common::{constant_actor, contract, prober};
use policy::contract::from_json;
use policy_server::check::{CheckError, TryError, look_at};
use std::path::Path;
use vodca::random::{self, Use, below};

/// Mutants that only our own look sees.
const LOOKED_AT: u64 = 4_000;
/// Mutants that pass it and are tried in a process of their own.
const TRIED: usize = 12;

fn mutate(original: &[u8], seed: u64) -> Vec<u8> {
    let mut generator = random::stream(seed, Use::Problem, 4, 0);
    let mut bytes = original.to_vec();
    for _ in 0..=below(&mut generator, 4) {
        let at = below(&mut generator, bytes.len().max(1) as u64) as usize;
        match below(&mut generator, 6) {
            _ if bytes.is_empty() => {}
            0 => bytes[at] = generator.next_u64() as u8,
            1 => bytes[at] ^= 1 << below(&mut generator, 8),
            2 => bytes.truncate(at),
            3 => {
                bytes.remove(at);
            }
            4 => bytes.insert(at, generator.next_u64() as u8),
            // The largest lengths and numbers that a varint can say.
            _ => {
                let end = (at + 5).min(bytes.len());
                bytes[at..end].fill(0xff);
            }
        }
    }
    bytes
}

#[test]
fn mutated_contracts_are_read_or_refused() {
    let original = contract(14).to_json().into_bytes();
    let refused = (0..LOOKED_AT).filter(|&seed| from_json(&mutate(&original, seed), "mutant").is_err()).count();
    assert!(refused > LOOKED_AT as usize / 2, "{refused}: the mutants are too tame to show anything");
}

#[test]
fn mutated_models_are_refused_or_survive_a_trial_of_their_own() {
    let original = constant_actor(2, 0.3).write();
    let (mut refused, mut tried) = (0, 0);
    for seed in 0..LOOKED_AT {
        match look_at(Path::new("mutant.onnx"), mutate(&original, seed), None, Some(2)) {
            Err(_) => refused += 1,
            Ok(candidate) if tried < TRIED => {
                tried += 1;
                // A crash of the trial process is survived, too; a trial that never ends is not.
                if let Err(CheckError::Try { source: TryError::Hung { .. }, .. }) = prober().try_out(&candidate) {
                    panic!("mutant {seed} hangs");
                }
            }
            Ok(_) => {}
        }
    }
    assert!(refused > 1_000 && tried == TRIED, "{refused} refused, {tried} tried");
}

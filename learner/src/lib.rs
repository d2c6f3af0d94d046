//! Soft actor-critic on recorded rollouts: what picks the robots' horizons is learnt here.
//!
//! [`sac`] is one update in the paper's order; [`critics`], [`actor`], [`temperature`] and [`squashed`]
//! are its parts, [`network`] and [`adam`] what those are made of. [`replay`] remembers, [`checkpoint`]
//! keeps everything, [`rollouts`] reads what was recorded, [`tensorboard`] draws the curves, [`export`]
//! hands the actor to the policy server.

pub mod actor;
pub mod adam;
pub mod checkpoint;
pub mod cli;
mod commands;
pub mod critics;
pub mod export;
#[cfg(test)]
mod gradient_tests;
pub mod matmul;
pub mod network;
pub mod progress;
#[cfg(test)]
mod pytorch_tests;
#[cfg(test)]
mod reference;
pub mod replay;
pub mod reward_weights;
pub mod rollouts;
pub mod sac;
pub mod settings;
pub mod simd;
#[cfg(test)]
mod small_problem_tests;
pub mod squashed;
pub mod temperature;
pub mod tensorboard;
pub mod train;

pub use actor::Actor;
pub use replay::Transition;
pub use sac::{Learner, Losses};
pub use settings::Settings;

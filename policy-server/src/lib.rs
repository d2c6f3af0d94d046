//! Runs ONNX actors that pick the robots' horizons, and swaps them while the robots drive.
//!
//! A file climbs the ladder of [`check`], in a process of its own where it could do harm; [`loader`]
//! watches the folder of a run in a thread; [`hot_swap`] switches between two ticks; [`sample`] turns
//! answers into horizons. Only [`actor`] knows the inference library.

pub mod actor;
pub mod check;
pub mod cli;
mod commands;
pub mod eval;
pub mod hot_swap;
pub mod loader;
mod means;
pub mod random_actor;
pub mod sample;
pub mod serve;
mod try_error;

//! What a policy file is: the ONNX bytes, the contract beside them and the folder they live in.
//!
//! This module is pure data and needs no inference library, so that the learner can write what the
//! policy server reads without either building the other.

pub mod contract;
pub mod digest;
pub mod encoding;
pub mod environment;
pub mod folder;
pub mod onnx;
pub mod reward;
pub mod rollout;
pub mod session;
pub mod settings;
pub mod tensor_file;

/// Largest model file that is read, bytes (16 MiB). An actor for 64 robots has about 0.5 MiB.
pub const MAX_MODEL_BYTES: u64 = 16 << 20;

/// The policies folder of a run: every version that acted in it.
pub fn run_folder(run: &std::path::Path) -> std::path::PathBuf {
    run.join("policy")
}

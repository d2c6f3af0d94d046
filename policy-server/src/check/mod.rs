//! The ladder a model climbs before it may act. Each rung has one kind of error.
//!
//! 1. [`look`]: our own look at the file, without any back-end: size, sha256, protobuf, operator
//!    set, operators, weights, contract, names, types and shapes.
//! 2. [`try_out`]: load it, run it on the canary set and on its reference set, compare.
//!
//! [`probe`] does the second step in a process of its own, so that a model which crashes, hangs or
//! eats memory ends alone.

mod canary;
mod error;
mod look;
mod ports;
pub mod probe;
mod reference;
mod try_out;

pub use crate::try_error::TryError;
pub use error::CheckError;
pub use look::{Candidate, look, look_at};
pub use probe::Prober;
pub use reference::{Case, ReferenceSet};
pub use try_out::{Report, try_out};

use serde::{Deserialize, Serialize};

/// Newest version of ONNX's operator set that both back-ends were tried with.
pub const MAX_OPSET: i64 = 25;

/// What a model may use.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Largest file, bytes.
    pub bytes: u64,
    /// Largest median of the processor time of one inference, us.
    pub inference_us: u64,
    /// Time after which the trial process is ended, s.
    pub trial_seconds: u64,
    /// Memory of the trial process, bytes.
    pub memory: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { bytes: policy::MAX_MODEL_BYTES, inference_us: 5_000, trial_seconds: 20, memory: 2 << 30 }
    }
}

//! What a model can do wrong once it is loaded and asked.

use serde::{Deserialize, Serialize};

/// Why a model failed when it was tried. Crosses from the trial process as JSON.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TryError {
    /// The back-end refuses it.
    #[error("the back-end cannot load the model: {0}")]
    Load(String),
    /// The back-end cannot compute it.
    #[error("the back-end cannot compute the model: {0}")]
    Run(String),
    /// An output that the file promises and the back-end does not give.
    #[error("the model gives no output `{0}`")]
    MissingOutput(String),
    /// An output of another size than promised.
    #[error("output `{output}` has shape {shape:?} for one observation of {robots} robots; allowed: [1, {robots}]")]
    OutputShape {
        /// The output.
        output: String,
        /// What came.
        shape: Vec<i64>,
        /// Robots of the contract.
        robots: usize,
    },
    /// NaN or infinite outputs.
    #[error("the model answers observation {case} of the {set} set with a number that is not finite (robot {robot})")]
    NotFinite {
        /// canary or reference.
        set: String,
        /// Which observation.
        case: usize,
        /// First robot.
        robot: usize,
    },
    /// Another answer than the reference set says.
    #[error(
        "reference {case}, robot {robot}: {output} is {got}, expected {expected} within {tolerance}; the file is not what was trained"
    )]
    Reference {
        /// Which observation.
        case: usize,
        /// Which robot.
        robot: usize,
        /// mean, log_std or horizon.
        output: String,
        /// What came.
        got: f64,
        /// What the set says.
        expected: f64,
        /// How far they may differ.
        tolerance: f64,
    },
    /// Over the time limit.
    #[error(
        "one inference takes {us} us of processor time (median of the canary set); the limit is {limit_us} us (--max-inference-us)"
    )]
    Slow {
        /// Median, us.
        us: u64,
        /// Limit, us.
        limit_us: u64,
    },
    /// The trial process did not end in time.
    #[error("the model was still being loaded or computed after {seconds} s in a process of its own")]
    Hung {
        /// Limit, s.
        seconds: u64,
    },
    /// The trial process died.
    #[error("the model brought its trial process down ({how}); it may use {memory_mib} MiB")]
    Crashed {
        /// Exit status or signal.
        how: String,
        /// Memory limit, MiB.
        memory_mib: u64,
    },
    /// The trial process could not be started.
    #[error("cannot start the trial process: {0}")]
    NoTrial(String),
}

//! Options that several commands share.

use crate::actor::BackEnd;
use crate::check::{Limits, Prober};
use clap::Args;
use std::path::PathBuf;

/// What computes, and what a model may use.
#[derive(Clone, Debug, Args)]
pub(crate) struct Means {
    /// ONNX Runtime library (1.24 or later) to compute with instead of the embedded back-end
    #[arg(long, value_name = "FILE")]
    onnxruntime: Option<PathBuf>,
    /// Largest model file
    #[arg(long, value_name = "BYTES", default_value_t = Limits::default().bytes)]
    max_bytes: u64,
    /// Largest median processor time of one inference
    #[arg(long, value_name = "US", default_value_t = Limits::default().inference_us)]
    max_inference_us: u64,
}

impl Means {
    /// The back-end that was chosen.
    pub(crate) fn back_end(&self) -> BackEnd {
        self.onnxruntime.clone().map_or(BackEnd::Embedded, BackEnd::Library)
    }

    /// Who tries models: this very program.
    pub(crate) fn prober(&self) -> std::io::Result<Prober> {
        let limits = Limits { bytes: self.max_bytes, inference_us: self.max_inference_us, ..Limits::default() };
        Ok(Prober { program: std::env::current_exe()?, back_end: self.back_end(), limits })
    }
}

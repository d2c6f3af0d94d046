//! An ONNX model, loaded. The only file that imports `ort`.
//!
//! The default back-end, tract, is part of the binary; a real ONNX Runtime library can be named
//! instead. One process has one back-end for its whole life.

use crate::try_error::TryError;
use ort::environment::Environment;
use ort::session::Session;
use ort::session::builder::GraphOptimizationLevel;
use ort::value::TensorRef;
use policy::contract::{Contract, Tensor};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Which program computes a model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum BackEnd {
    /// tract, inside this binary.
    #[default]
    Embedded,
    /// An ONNX Runtime library, version 1.24 or later.
    Library(PathBuf),
}

/// Why a back-end does not start.
#[derive(Clone, Debug, thiserror::Error)]
pub enum BackEndError {
    /// The library cannot be used.
    #[error(
        "cannot use the ONNX Runtime library {file}: {reason}; name a libonnxruntime.so of version 1.24 or later, \
         or leave --onnxruntime out for the embedded back-end"
    )]
    Library {
        /// The library.
        file: String,
        /// Why.
        reason: String,
    },
    /// Another back-end runs already.
    #[error("this process computes with the {running} back-end already; start another one for {wanted}")]
    Another {
        /// What runs.
        running: String,
        /// What was asked for.
        wanted: String,
    },
    /// The back-end refused.
    #[error("the {0} back-end does not start: {1}")]
    Environment(String, String),
}

impl BackEnd {
    /// `embedded` or the library's path.
    pub fn name(&self) -> String {
        match self {
            BackEnd::Embedded => "embedded".into(),
            BackEnd::Library(file) => file.display().to_string(),
        }
    }
}

/// A started back-end; sessions keep it alive.
#[derive(Clone)]
pub struct Runtime {
    environment: Environment,
    back_end: BackEnd,
}

impl Runtime {
    /// Starts `back_end`, or joins it when it runs already.
    pub fn start(back_end: &BackEnd) -> Result<Self, BackEndError> {
        static RUNNING: OnceLock<Result<Runtime, BackEndError>> = OnceLock::new();
        let running = RUNNING.get_or_init(|| {
            let builder = match back_end {
                BackEnd::Embedded => {
                    ort::set_api(ort_tract::api());
                    ort::init()
                }
                BackEnd::Library(file) => load_library(file)?,
            };
            let environment = builder
                .with_telemetry(false)
                .build()
                .map_err(|error| BackEndError::Environment(back_end.name(), error.to_string()))?;
            Ok(Runtime { environment, back_end: back_end.clone() })
        });
        let running = running.clone()?;
        if running.back_end != *back_end {
            return Err(BackEndError::Another { running: running.back_end.name(), wanted: back_end.name() });
        }
        Ok(running)
    }

    /// What runs.
    pub fn back_end(&self) -> &BackEnd {
        &self.back_end
    }
}

fn load_library(file: &Path) -> Result<ort::environment::EnvironmentBuilder, BackEndError> {
    let refuse = |reason: String| BackEndError::Library { file: file.display().to_string(), reason };
    // The loader would also search the system's folders for a bare name; a flag means this file.
    if !file.is_file() {
        return Err(refuse("there is no such file".into()));
    }
    ort::init_from(file).map_err(|error| refuse(error.to_string()))
}

/// What a model says about one observation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// Mean of the raw action, N numbers.
    pub mean: Vec<f32>,
    /// Logarithm of its standard deviation, N numbers; empty when the model has none.
    pub log_std: Vec<f32>,
}

/// A loaded model.
pub struct Actor {
    session: Session,
    contract: Contract,
}

impl Actor {
    /// Loads a model whose bytes and contract were looked at.
    pub fn load(runtime: &Runtime, bytes: &[u8], contract: &Contract) -> Result<Self, TryError> {
        let session = build(runtime, bytes).map_err(|error| TryError::Load(one_line(&error)))?;
        Ok(Self { session, contract: contract.clone() })
    }

    /// Its contract.
    pub fn contract(&self) -> &Contract {
        &self.contract
    }

    /// Computes one normalised observation (2N numbers).
    pub fn infer(&mut self, input: &[f32], answer: &mut Answer) -> Result<(), TryError> {
        let Contract { robots, input: port, outputs, .. } = &self.contract;
        let failed = |error: ort::Error| TryError::Run(one_line(&error));
        let shape = [1i64, input.len() as i64];
        let tensor = TensorRef::from_array_view((shape, input)).map_err(failed)?;
        let found = self.session.run(ort::inputs![port.name.as_str() => tensor]).map_err(failed)?;
        let copy = |port: &Tensor, to: &mut Vec<f32>| {
            // Indexing a missing output would panic.
            let value = found.get(&port.name).ok_or_else(|| TryError::MissingOutput(port.name.clone()))?;
            let (shape, numbers) = value.try_extract_tensor::<f32>().map_err(failed)?;
            if numbers.len() != *robots {
                let shape = shape.to_vec();
                return Err(TryError::OutputShape { output: port.name.clone(), shape, robots: *robots });
            }
            to.clear();
            to.extend_from_slice(numbers);
            Ok(())
        };
        copy(&outputs.mean, &mut answer.mean)?;
        match &outputs.log_std {
            Some(port) => copy(port, &mut answer.log_std),
            None => {
                answer.log_std.clear();
                Ok(())
            }
        }
    }
}

fn build(runtime: &Runtime, bytes: &[u8]) -> Result<Session, ort::Error> {
    let mut builder =
        Session::builder(&runtime.environment)?.with_optimization_level(GraphOptimizationLevel::Level3)?;
    if matches!(runtime.back_end, BackEnd::Library(_)) {
        // An actor is too small to share between threads, and the cores belong to the robots.
        builder = builder.with_intra_threads(1)?.with_inter_threads(1)?;
    }
    builder.commit_from_memory(bytes)
}

/// The back-ends write their reasons over many lines.
fn one_line(error: &ort::Error) -> String {
    const MAX_CHARACTERS: usize = 400;
    let words: Vec<&str> = error.message().split_whitespace().collect();
    words.join(" ").chars().take(MAX_CHARACTERS).collect()
}

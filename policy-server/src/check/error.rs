//! Why a model may not act: one kind of error per rung of the ladder.

use super::MAX_OPSET;
use crate::try_error::TryError;
use policy::contract::ContractError;
use policy::onnx::OnnxError;

/// Why a model may not act.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CheckError {
    /// The file cannot be read.
    #[error("cannot read {file}: {reason}")]
    Unreadable {
        /// The file.
        file: String,
        /// The system's reason.
        reason: String,
    },
    /// Over the size limit.
    #[error("{file} has {bytes} bytes, more than the {limit} that are allowed (--max-bytes)")]
    TooLarge {
        /// The file.
        file: String,
        /// Its size.
        bytes: u64,
        /// Largest size.
        limit: u64,
    },
    /// Not as long as its manifest says.
    #[error("{file} has {has} bytes, its manifest says {says}: it is still being written, or was cut; copy it again")]
    Cut {
        /// The file.
        file: String,
        /// Bytes there.
        has: u64,
        /// Bytes stated.
        says: u64,
    },
    /// Not the bytes that its manifest names.
    #[error("{file} has sha256 {has}, its manifest says {says}: bytes have changed; publish it again")]
    Sha256 {
        /// The file.
        file: String,
        /// What its bytes give.
        has: String,
        /// What is stated.
        says: String,
    },
    /// Not an ONNX file.
    #[error("{file}: {source}")]
    Onnx {
        /// The file.
        file: String,
        /// Why.
        source: OnnxError,
    },
    /// The contract cannot be used.
    #[error(transparent)]
    Contract(#[from] ContractError),
    /// Weights in another file.
    #[error(
        "tensor `{tensor}` of {file} lies in another file; export the model as one file (torch.onnx.export(..., external_data=False))"
    )]
    ExternalData {
        /// The file.
        file: String,
        /// The tensor.
        tensor: String,
    },
    /// An operator set that is too new or missing.
    #[error("{file} needs operator set {has}; allowed: 7..={MAX_OPSET} (torch.onnx.export(..., opset_version=17))")]
    Opset {
        /// The file.
        file: String,
        /// As stated, or `none`.
        has: String,
    },
    /// An operator outside the list.
    #[error(
        "{file} uses operator {operator}, which no actor needs; allowed are plain feed-forward operators (Gemm, MatMul, Add, Relu, Tanh, Clip, ...)"
    )]
    Operator {
        /// The file.
        file: String,
        /// The operator, with its domain.
        operator: String,
    },
    /// NaN or infinite numbers in the file.
    #[error(
        "element {index} of tensor `{tensor}` of {file} is not a finite number; the training run has diverged: publish an earlier actor"
    )]
    Weights {
        /// The file.
        file: String,
        /// The tensor.
        tensor: String,
        /// First element.
        index: usize,
    },
    /// A model for another team.
    #[error("{file} is for {has} robots, this run has {wanted}; choose a policy for {wanted} robots")]
    Robots {
        /// The file.
        file: String,
        /// Robots of the model.
        has: usize,
        /// Robots of the run.
        wanted: usize,
    },
    /// An input or output that is missing.
    #[error("{file} has no {role} `{name}`; it has {has}. Rename it in the contract or export it under that name")]
    Name {
        /// The file.
        file: String,
        /// input or output.
        role: &'static str,
        /// As the contract says.
        name: String,
        /// What there is.
        has: String,
    },
    /// An input or output of the wrong type.
    #[error("{role} `{name}` of {file} is {element}; allowed: float32")]
    Element {
        /// The file.
        file: String,
        /// input or output.
        role: &'static str,
        /// Its name.
        name: String,
        /// Its type.
        element: String,
    },
    /// An input or output of the wrong shape.
    #[error("{role} {port} of {file} does not fit: {robots} robots need [batch, {width}], batch free or 1")]
    Shape {
        /// The file.
        file: String,
        /// input or output.
        role: &'static str,
        /// Name, type and shape.
        port: String,
        /// Robots of the contract.
        robots: usize,
        /// Numbers per observation.
        width: usize,
    },
    /// The reference set cannot be used.
    #[error("reference set {file}: {reason}; write it again or remove it")]
    ReferenceFile {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// Failed when it was tried.
    #[error("{file}: {source}")]
    Try {
        /// The file.
        file: String,
        /// Why.
        source: TryError,
    },
}

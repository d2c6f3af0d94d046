//! Why a contract cannot be used.

use super::SCHEMA;

/// Why a contract cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContractError {
    /// The file cannot be read.
    #[error("cannot read contract {file}: {reason}")]
    Unreadable {
        /// The file.
        file: String,
        /// The system's reason.
        reason: String,
    },
    /// A file beyond the size of any contract.
    #[error("contract {place} is larger than {most} bytes; it holds a few lines of JSON")]
    TooLarge {
        /// File or metadata key.
        place: String,
        /// Largest size.
        most: usize,
    },
    /// Not JSON, or fields that are missing, unknown or of the wrong type.
    #[error("contract {place}: {message}; `policy contract MODEL` prints one to start from")]
    Malformed {
        /// File or metadata key.
        place: String,
        /// Line, column and what was expected.
        message: String,
    },
    /// A format we do not read.
    #[error("contract {place}: schema \"{schema}\" is not known; this program reads \"{SCHEMA}\"")]
    Schema {
        /// File or metadata key.
        place: String,
        /// As written.
        schema: String,
    },
    /// A value outside its range.
    #[error("contract {place}: {field} = {value} is not allowed; allowed: {allowed}")]
    Value {
        /// File or metadata key.
        place: String,
        /// The field.
        field: &'static str,
        /// As written.
        value: String,
        /// What would do.
        allowed: String,
    },
    /// Two contracts of one model that differ.
    #[error(
        "the contract beside the model says {field} = {beside}, the one inside it says {inside}; publish the model again"
    )]
    Disagree {
        /// First field that differs.
        field: String,
        /// Beside the model.
        beside: String,
        /// In its metadata.
        inside: String,
    },
    /// No contract, and the model does not tell.
    #[error(
        "the model has no contract and {missing} cannot be told from it; \
         write NAME.json beside NAME.onnx (`policy contract MODEL` prints one to start from)"
    )]
    CannotInfer {
        /// What is missing.
        missing: String,
    },
}

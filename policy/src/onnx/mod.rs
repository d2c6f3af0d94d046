//! ONNX files without an ONNX library: the few fields we look at before a back-end may load a model,
//! and the writer of our own actors.

mod bounds;
pub mod proto;
mod read;
mod tensor;
mod write;

pub use bounds::WireError;
pub use read::{Dim, Model, Node, OnnxError, Opset, Port};
pub use tensor::{ElementType, Tensor};
pub use write::{Activation, ActorGraph, Dense};

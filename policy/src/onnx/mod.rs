//! ONNX files without an ONNX library: the protobuf wire format, the few fields we look at before a
//! back-end may load a model, and the writer of our own actors.

mod read;
mod tensor;
pub mod wire;
mod write;

pub use read::{Dim, Model, Node, OnnxError, Opset, Port};
pub use tensor::{ElementType, Tensor};
pub use write::{ActorGraph, Dense};

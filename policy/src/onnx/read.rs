//! What we look at in an ONNX file before any back-end sees it.

use super::tensor::{ElementType, Tensor};
use super::wire::{Fields, Value, WireError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Most nodes, initializers, ports or metadata entries of a model: a bound on memory.
const MAX_ENTRIES: usize = 4096;

/// Why bytes are not an ONNX model that we look into.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OnnxError {
    /// Not a protobuf message.
    #[error("not a whole ONNX file: {0}; export or copy it again")]
    Wire(#[from] WireError),
    /// A protobuf message without a graph.
    #[error("not an ONNX file: it holds no graph; export the actor again")]
    NoGraph,
    /// Over `MAX_ENTRIES`.
    #[error("the model has more than {most} {what}; an actor has a few dozen")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many are allowed.
        most: usize,
    },
    /// A tensor of too many dimensions.
    #[error("tensor `{name}` has more than {most} dimensions")]
    Rank {
        /// The tensor.
        name: String,
        /// Largest rank.
        most: usize,
    },
    /// A tensor whose numbers do not fill its shape.
    #[error("tensor `{name}` of shape {dims:?} {element} holds {has} {unit}, which do not fill it; export it again")]
    TensorLength {
        /// The tensor.
        name: String,
        /// Its shape.
        dims: Vec<i64>,
        /// Its type.
        element: ElementType,
        /// What it holds.
        has: usize,
        /// bytes or elements.
        unit: &'static str,
    },
}

/// One dimension of an input or output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Dim {
    /// A number.
    Fixed(i64),
    /// A name or nothing: any size.
    Free(String),
}

impl fmt::Display for Dim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Dim::Fixed(size) => size.fmt(f),
            Dim::Free(name) if name.is_empty() => f.write_str("?"),
            Dim::Free(name) => f.write_str(name),
        }
    }
}

/// An input or output of the graph.
#[derive(Clone, Debug, PartialEq)]
pub struct Port {
    /// Its name.
    pub name: String,
    /// Element type; 0 when it is no tensor.
    pub element: ElementType,
    /// Its shape.
    pub dims: Vec<Dim>,
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let dims: Vec<String> = self.dims.iter().map(Dim::to_string).collect();
        write!(f, "`{}` {} [{}]", self.name, self.element, dims.join(", "))
    }
}

/// One operation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// Its name, often empty.
    pub name: String,
    /// Operator, e.g. `Gemm`.
    pub operator: String,
    /// Operator set; empty for ONNX itself.
    pub domain: String,
    /// Whether it carries a graph of its own (loops and branches).
    pub subgraph: bool,
}

/// A version of an operator set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Opset {
    /// Empty for ONNX itself.
    pub domain: String,
    /// Its version.
    pub version: i64,
}

/// What we look at in an ONNX file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Version of the file format.
    pub ir_version: i64,
    /// Who wrote it, name and version.
    pub producer: String,
    /// Operator sets it needs.
    pub opsets: Vec<Opset>,
    /// metadata_props.
    pub metadata: BTreeMap<String, String>,
    /// Functions defined in the file itself.
    pub functions: usize,
    /// Operations in order.
    pub nodes: Vec<Node>,
    /// Stored tensors: initializers and constants.
    pub tensors: Vec<Tensor>,
    /// Inputs that are no initializers.
    pub inputs: Vec<Port>,
    /// Outputs.
    pub outputs: Vec<Port>,
}

impl Model {
    /// Reads `bytes`. Memory is bounded by a small multiple of their number.
    pub fn read(bytes: &[u8]) -> Result<Self, OnnxError> {
        let mut model = Model::default();
        let mut graph = None;
        let mut version = String::new();
        for field in Fields::new(bytes) {
            match field? {
                (1, Value::Varint(number)) => model.ir_version = number as i64,
                (2, Value::Bytes(name)) => model.producer = text(name),
                (3, Value::Bytes(number)) => version = text(number),
                (7, Value::Bytes(block)) => graph = Some(block),
                (8, Value::Bytes(block)) => push(&mut model.opsets, read_opset(block)?, "operator sets")?,
                (14, Value::Bytes(block)) => {
                    let (key, value) = read_entry(block)?;
                    model.metadata.insert(key, value);
                    if model.metadata.len() > MAX_ENTRIES {
                        return Err(OnnxError::TooMany { what: "metadata entries", most: MAX_ENTRIES });
                    }
                }
                (25, _) => model.functions += 1,
                _ => {}
            }
        }
        if !version.is_empty() {
            model.producer = format!("{} {version}", model.producer);
        }
        model.read_graph(graph.ok_or(OnnxError::NoGraph)?)?;
        Ok(model)
    }

    /// Version of ONNX's own operator set.
    pub fn opset(&self) -> Option<i64> {
        self.opsets.iter().find(|set| is_onnx(&set.domain)).map(|set| set.version)
    }

    fn read_graph(&mut self, bytes: &[u8]) -> Result<(), OnnxError> {
        for field in Fields::new(bytes) {
            match field? {
                (1, Value::Bytes(block)) => {
                    let node = self.read_node(block)?;
                    push(&mut self.nodes, node, "nodes")?;
                }
                (5, Value::Bytes(block)) => push(&mut self.tensors, Tensor::read(block)?, "tensors")?,
                (11, Value::Bytes(block)) => push(&mut self.inputs, read_port(block)?, "inputs")?,
                (12, Value::Bytes(block)) => push(&mut self.outputs, read_port(block)?, "outputs")?,
                // Sparse initializers: no exporter of ours writes them, no check of ours reads them.
                (15, _) => self.functions += 1,
                _ => {}
            }
        }
        // Old exporters list the initializers among the inputs.
        let tensors = &self.tensors;
        self.inputs.retain(|port| tensors.iter().all(|tensor| tensor.name != port.name));
        Ok(())
    }

    fn read_node(&mut self, bytes: &[u8]) -> Result<Node, OnnxError> {
        let mut node = Node { name: String::new(), operator: String::new(), domain: String::new(), subgraph: false };
        for field in Fields::new(bytes) {
            match field? {
                (3, Value::Bytes(name)) => node.name = text(name),
                (4, Value::Bytes(operator)) => node.operator = text(operator),
                (5, Value::Bytes(attribute)) => node.subgraph |= self.read_attribute(attribute)?,
                (7, Value::Bytes(domain)) => node.domain = text(domain),
                _ => {}
            }
        }
        Ok(node)
    }

    /// Notes the tensor of a Constant; tells whether the attribute is a graph.
    fn read_attribute(&mut self, bytes: &[u8]) -> Result<bool, OnnxError> {
        let mut subgraph = false;
        for field in Fields::new(bytes) {
            match field? {
                (5 | 10, Value::Bytes(tensor)) => push(&mut self.tensors, Tensor::read(tensor)?, "tensors")?,
                (6 | 11, Value::Bytes(_)) => subgraph = true,
                _ => {}
            }
        }
        Ok(subgraph)
    }
}

/// Whether `domain` is ONNX's own operator set.
pub(super) fn is_onnx(domain: &str) -> bool {
    domain.is_empty() || domain == "ai.onnx"
}

fn push<T>(list: &mut Vec<T>, item: T, what: &'static str) -> Result<(), OnnxError> {
    if list.len() >= MAX_ENTRIES {
        return Err(OnnxError::TooMany { what, most: MAX_ENTRIES });
    }
    list.push(item);
    Ok(())
}

/// Names are short; a long one is cut so that no error message fills a screen.
pub(super) fn text(bytes: &[u8]) -> String {
    const MAX_NAME: usize = 200;
    String::from_utf8_lossy(&bytes[..bytes.len().min(MAX_NAME)]).into_owned()
}

fn read_opset(bytes: &[u8]) -> Result<Opset, OnnxError> {
    let mut opset = Opset { domain: String::new(), version: 0 };
    for field in Fields::new(bytes) {
        match field? {
            (1, Value::Bytes(domain)) => opset.domain = text(domain),
            (2, Value::Varint(version)) => opset.version = version as i64,
            _ => {}
        }
    }
    Ok(opset)
}

/// A StringStringEntryProto. Values are not cut: the contract lies in one.
fn read_entry(bytes: &[u8]) -> Result<(String, String), OnnxError> {
    let (mut key, mut value) = (String::new(), String::new());
    for field in Fields::new(bytes) {
        match field? {
            (1, Value::Bytes(block)) => key = text(block),
            (2, Value::Bytes(block)) => value = String::from_utf8_lossy(block).into_owned(),
            _ => {}
        }
    }
    Ok((key, value))
}

fn read_port(bytes: &[u8]) -> Result<Port, OnnxError> {
    let mut port = Port { name: String::new(), element: ElementType(0), dims: Vec::new() };
    for field in Fields::new(bytes) {
        match field? {
            (1, Value::Bytes(name)) => port.name = text(name),
            (2, Value::Bytes(kind)) => {
                for field in Fields::new(kind) {
                    if let (1, Value::Bytes(tensor)) = field? {
                        read_tensor_type(tensor, &mut port)?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(port)
}

fn read_tensor_type(bytes: &[u8], port: &mut Port) -> Result<(), OnnxError> {
    for field in Fields::new(bytes) {
        match field? {
            (1, Value::Varint(element)) => port.element = ElementType(element),
            (2, Value::Bytes(shape)) => {
                for field in Fields::new(shape) {
                    if let (1, Value::Bytes(dim)) = field? {
                        push(&mut port.dims, read_dim(dim)?, "dimensions")?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn read_dim(bytes: &[u8]) -> Result<Dim, OnnxError> {
    let mut dim = Dim::Free(String::new());
    for field in Fields::new(bytes) {
        match field? {
            (1, Value::Varint(size)) => dim = Dim::Fixed(size as i64),
            (2, Value::Bytes(name)) => dim = Dim::Free(text(name)),
            _ => {}
        }
    }
    Ok(dim)
}

//! What we look at in an ONNX file before any back-end sees it.

use super::bounds::{self, WireError};
use super::proto::{
    AttributeProto, DecodeError, DimensionProto, GraphProto, Message, ModelProto, NodeProto, OperatorSetIdProto,
    StringStringEntryProto, ValueInfoProto,
};
use super::tensor::{ElementType, Tensor};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Why bytes are not an ONNX model that we look into.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OnnxError {
    /// Not a protobuf message.
    #[error("not a whole ONNX file: {0}; export or copy it again")]
    Wire(#[from] WireError),
    /// A protobuf message without a graph.
    #[error("not an ONNX file: it holds no graph; export the actor again")]
    NoGraph,
    /// More entries of a kind than any actor has: a bound on memory.
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
        bounds::check(bytes)?;
        let file = ModelProto::decode(bytes)?;
        let mut model = Model {
            ir_version: file.ir_version.unwrap_or_default(),
            producer: text(file.producer_name),
            opsets: file.opset_import.into_iter().map(Opset::from).collect(),
            functions: file.functions.len(),
            ..Model::default()
        };
        let version = text(file.producer_version);
        if !version.is_empty() {
            model.producer = format!("{} {version}", model.producer);
        }
        // Values are not cut: the contract lies in one.
        let entry = |entry: StringStringEntryProto| (text(entry.key), entry.value.unwrap_or_default());
        model.metadata = file.metadata_props.into_iter().map(entry).collect();
        model.read_graph(file.graph.ok_or(OnnxError::NoGraph)?)?;
        Ok(model)
    }

    /// Version of ONNX's own operator set.
    pub fn opset(&self) -> Option<i64> {
        self.opsets.iter().find(|set| is_onnx(&set.domain)).map(|set| set.version)
    }

    fn read_graph(&mut self, graph: GraphProto) -> Result<(), OnnxError> {
        for node in graph.node {
            let node = self.read_node(node)?;
            self.nodes.push(node);
        }
        for tensor in graph.initializer {
            self.tensors.push(Tensor::read(tensor)?);
        }
        // Sparse initializers: no exporter of ours writes them, no check of ours reads them.
        self.functions += graph.sparse_initializer.len();
        // Old exporters list the initializers among the inputs.
        let tensors = &self.tensors;
        let stored = |port: &Port| tensors.iter().any(|tensor| tensor.name == port.name);
        self.inputs = graph.input.into_iter().map(Port::from).filter(|port| !stored(port)).collect();
        self.outputs = graph.output.into_iter().map(Port::from).collect();
        Ok(())
    }

    fn read_node(&mut self, node: NodeProto) -> Result<Node, OnnxError> {
        let mut subgraph = false;
        for attribute in node.attribute {
            subgraph |= self.read_attribute(attribute)?;
        }
        Ok(Node { name: text(node.name), operator: text(node.op_type), domain: text(node.domain), subgraph })
    }

    /// Notes the tensor of a Constant; tells whether the attribute is a graph.
    fn read_attribute(&mut self, attribute: AttributeProto) -> Result<bool, OnnxError> {
        for tensor in attribute.t.into_iter().chain(attribute.tensors) {
            self.tensors.push(Tensor::read(tensor)?);
        }
        Ok(attribute.g.is_some() || !attribute.graphs.is_empty())
    }
}

/// Whether `domain` is ONNX's own operator set.
pub(super) fn is_onnx(domain: &str) -> bool {
    domain.is_empty() || domain == "ai.onnx"
}

/// Names are short; a long one is cut so that no error message fills a screen.
pub(super) fn text(name: Option<String>) -> String {
    const MAX_NAME: usize = 200;
    let mut name = name.unwrap_or_default();
    name.truncate(name.floor_char_boundary(MAX_NAME));
    name
}

impl From<OperatorSetIdProto> for Opset {
    fn from(set: OperatorSetIdProto) -> Self {
        Self { domain: text(set.domain), version: set.version.unwrap_or_default() }
    }
}

impl From<ValueInfoProto> for Port {
    fn from(value: ValueInfoProto) -> Self {
        let tensor = value.r#type.and_then(|kind| kind.tensor_type).unwrap_or_default();
        let dims = tensor.shape.unwrap_or_default().dim;
        Self {
            name: text(value.name),
            element: ElementType(tensor.elem_type.unwrap_or_default()),
            dims: dims.into_iter().map(Dim::from).collect(),
        }
    }
}

impl From<DimensionProto> for Dim {
    fn from(dim: DimensionProto) -> Self {
        dim.dim_value.map_or_else(|| Dim::Free(text(dim.dim_param)), Dim::Fixed)
    }
}

impl From<DecodeError> for OnnxError {
    fn from(error: DecodeError) -> Self {
        OnnxError::Wire(error.into())
    }
}

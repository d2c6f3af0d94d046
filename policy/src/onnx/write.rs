//! Writes an actor as an ONNX file: `state` -> Gemm, Relu or Tanh, ... -> `mean`, `log_std`.

use super::proto::{
    AttributeProto, DimensionProto, GraphProto, Message, ModelProto, NodeProto, OperatorSetIdProto,
    StringStringEntryProto, TensorProto, TensorShapeProto, TensorTypeProto, TypeProto, ValueInfoProto,
};
use super::tensor::ElementType;
use std::collections::BTreeMap;

/// Version of the file format that is written.
const IR_VERSION: i64 = 8;
/// Operator set that is written.
const OPSET: i64 = 17;
/// The number of an attribute that is an integer.
const INTEGER: i32 = 2;

/// One fully connected layer: y = W x + b.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    /// Number of inputs.
    pub inputs: usize,
    /// Number of outputs.
    pub outputs: usize,
    /// W, `outputs` rows of `inputs`.
    pub weight: Vec<f32>,
    /// b, `outputs` numbers.
    pub bias: Vec<f32>,
}

/// What follows a hidden layer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Activation {
    /// max(0, x).
    #[default]
    Relu,
    /// tanh x.
    Tanh,
}

impl Activation {
    fn operator(self) -> &'static str {
        match self {
            Self::Relu => "Relu",
            Self::Tanh => "Tanh",
        }
    }
}

/// A squashed-Gaussian actor: hidden layers with ReLU or tanh, then a linear `mean` and, if it can be
/// sampled, a clipped linear `log_std`.
#[derive(Clone, Debug, PartialEq)]
pub struct ActorGraph {
    /// Hidden layers, each followed by the activation.
    pub hidden: Vec<Dense>,
    /// What follows each of them.
    pub activation: Activation,
    /// Mean of the raw action.
    pub mean: Dense,
    /// Logarithm of its standard deviation.
    pub log_std: Option<Dense>,
    /// Bounds of `log_std`.
    pub log_std_bounds: (f32, f32),
    /// metadata_props.
    pub metadata: BTreeMap<String, String>,
}

impl ActorGraph {
    /// Number of observation values, 2N.
    pub fn inputs(&self) -> usize {
        self.hidden.first().unwrap_or(&self.mean).inputs
    }

    /// The bytes of the ONNX file. The layers must fit together (panics in debug builds otherwise).
    pub fn write(&self) -> Vec<u8> {
        let mut graph = GraphProto { name: Some("actor".into()), ..Default::default() };
        let mut from = String::from("state");
        for (layer, dense) in self.hidden.iter().enumerate() {
            let name = format!("hidden{layer}");
            let sum = format!("{name}.sum");
            dense.add_to(&mut graph, &from, &name, &sum);
            graph.node.push(node(self.activation.operator(), &name, &[&sum], &name));
            from = name;
        }
        self.mean.add_to(&mut graph, &from, "mean", "mean");
        graph.input.push(port("state", self.inputs()));
        graph.output.push(port("mean", self.mean.outputs));
        if let Some(log_std) = &self.log_std {
            log_std.add_to(&mut graph, &from, "log_std", "log_std.sum");
            graph.node.push(node("Clip", "log_std.clip", &["log_std.sum", "low", "high"], "log_std"));
            let (low, high) = self.log_std_bounds;
            graph.initializer.extend([tensor("low", &[], &[low]), tensor("high", &[], &[high])]);
            graph.output.push(port("log_std", log_std.outputs));
        }
        let entry = |(key, value): (&String, &String)| StringStringEntryProto {
            key: Some(key.clone()),
            value: Some(value.clone()),
        };
        let model = ModelProto {
            ir_version: Some(IR_VERSION),
            producer_name: Some("vodca".into()),
            producer_version: Some(env!("CARGO_PKG_VERSION").into()),
            graph: Some(graph),
            opset_import: vec![OperatorSetIdProto { domain: Some(String::new()), version: Some(OPSET) }],
            metadata_props: self.metadata.iter().map(entry).collect(),
            functions: Vec::new(),
        };
        model.encode_to_vec()
    }
}

impl Dense {
    /// Appends `to = W from + b` and its tensors.
    fn add_to(&self, graph: &mut GraphProto, from: &str, name: &str, to: &str) {
        debug_assert!(self.inputs > 0 && self.outputs > 0);
        debug_assert_eq!(self.weight.len(), self.inputs * self.outputs);
        debug_assert_eq!(self.bias.len(), self.outputs);
        let (weight, bias) = (format!("{name}.weight"), format!("{name}.bias"));
        let mut gemm = node("Gemm", &format!("{name}.gemm"), &[from, &weight, &bias], to);
        gemm.attribute.push(AttributeProto {
            name: Some("transB".into()),
            i: Some(1),
            r#type: Some(INTEGER),
            ..Default::default()
        });
        graph.node.push(gemm);
        graph.initializer.push(tensor(&weight, &[self.outputs, self.inputs], &self.weight));
        graph.initializer.push(tensor(&bias, &[self.outputs], &self.bias));
    }
}

fn node(operator: &str, name: &str, inputs: &[&str], output: &str) -> NodeProto {
    NodeProto {
        input: inputs.iter().copied().map(String::from).collect(),
        output: vec![output.into()],
        name: Some(name.into()),
        op_type: Some(operator.into()),
        ..Default::default()
    }
}

fn tensor(name: &str, dims: &[usize], numbers: &[f32]) -> TensorProto {
    TensorProto {
        dims: dims.iter().map(|&dim| dim as i64).collect(),
        data_type: Some(ElementType::FLOAT.0),
        name: Some(name.into()),
        raw_data: Some(numbers.iter().flat_map(|number| number.to_le_bytes()).collect()),
        ..Default::default()
    }
}

/// A port of `[batch, width]` float32.
fn port(name: &str, width: usize) -> ValueInfoProto {
    let batch = DimensionProto { dim_value: None, dim_param: Some("batch".into()) };
    let width = DimensionProto { dim_value: Some(width as i64), dim_param: None };
    let tensor_type = TensorTypeProto {
        elem_type: Some(ElementType::FLOAT.0),
        shape: Some(TensorShapeProto { dim: vec![batch, width] }),
    };
    ValueInfoProto { name: Some(name.into()), r#type: Some(TypeProto { tensor_type: Some(tensor_type) }) }
}

#[cfg(test)]
mod tests {
    use super::super::{Dim, ElementType, Model};
    use super::*;

    fn dense(inputs: usize, outputs: usize) -> Dense {
        let weight = (0..inputs * outputs).map(|i| i as f32 / 10.0).collect();
        Dense { inputs, outputs, weight, bias: vec![0.5; outputs] }
    }

    fn actor() -> ActorGraph {
        ActorGraph {
            hidden: vec![dense(4, 8), dense(8, 8)],
            activation: Activation::Relu,
            mean: dense(8, 2),
            log_std: Some(dense(8, 2)),
            log_std_bounds: (-20.0, 2.0),
            metadata: BTreeMap::from([("key".into(), "value".into())]),
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let model = Model::read(&actor().write()).unwrap();
        assert_eq!(model.opset(), Some(17));
        assert_eq!(model.metadata["key"], "value");
        let operators: Vec<_> = model.nodes.iter().map(|node| node.operator.as_str()).collect();
        assert_eq!(operators, ["Gemm", "Relu", "Gemm", "Relu", "Gemm", "Gemm", "Clip"]);
        assert_eq!(model.tensors.len(), 10);
        assert!(model.tensors.iter().all(|t| t.first_not_finite.is_none() && !t.external));
        assert_eq!(model.inputs.len(), 1);
        assert_eq!(model.inputs[0].to_string(), "`state` float32 [batch, 4]");
        let outputs: Vec<_> = model.outputs.iter().map(|port| port.name.as_str()).collect();
        assert_eq!(outputs, ["mean", "log_std"]);
        assert_eq!(model.outputs[1].dims[1], Dim::Fixed(2));
        assert_eq!(model.outputs[1].element, ElementType::FLOAT);
    }

    /// The actor in a file that [`ActorGraph::write`] wrote.
    fn actor_of(file: &ModelProto) -> ActorGraph {
        let graph = file.graph.as_ref().unwrap();
        let numbers = |name: &str| -> Option<Vec<f32>> {
            let stored = graph.initializer.iter().find(|tensor| tensor.name.as_deref() == Some(name))?;
            let raw = stored.raw_data.as_ref()?;
            Some(raw.as_chunks::<4>().0.iter().map(|four| f32::from_le_bytes(*four)).collect())
        };
        let dense = |name: &str| {
            let (weight, bias) = (numbers(&format!("{name}.weight"))?, numbers(&format!("{name}.bias"))?);
            Some(Dense { inputs: weight.len() / bias.len(), outputs: bias.len(), weight, bias })
        };
        let entry = |entry: &StringStringEntryProto| (entry.key.clone().unwrap(), entry.value.clone().unwrap());
        ActorGraph {
            hidden: (0..).map_while(|layer| dense(&format!("hidden{layer}"))).collect(),
            activation: Activation::Relu,
            mean: dense("mean").unwrap(),
            log_std: dense("log_std"),
            log_std_bounds: (numbers("low").unwrap()[0], numbers("high").unwrap()[0]),
            metadata: file.metadata_props.iter().map(entry).collect(),
        }
    }

    #[test]
    fn an_actor_published_long_ago_is_written_to_the_same_bytes() {
        let place = concat!(env!("CARGO_MANIFEST_DIR"), "/../policies/exchange_14/v000008/actor.onnx");
        let bytes = std::fs::read(place).unwrap();
        let file = ModelProto::decode(bytes.as_slice()).unwrap();
        let mut written = ModelProto::decode(actor_of(&file).write().as_slice()).unwrap();
        written.producer_version.clone_from(&file.producer_version); // whatever it was then
        assert!(written.encode_to_vec() == bytes, "the file differs");
    }

    #[test]
    fn a_weight_that_is_not_finite_is_found() {
        let mut graph = actor();
        graph.hidden[1].weight[5] = f32::NAN;
        let model = Model::read(&graph.write()).unwrap();
        let bad: Vec<_> = model.tensors.iter().filter(|tensor| tensor.first_not_finite.is_some()).collect();
        assert_eq!(bad.len(), 1);
        assert_eq!((bad[0].name.as_str(), bad[0].first_not_finite), ("hidden1.weight", Some(5)));
    }

    #[test]
    fn every_cut_of_a_file_is_an_error() {
        let whole = actor().write();
        let graph_end = whole.len() - 40; // The fields after the graph may be missing without notice.
        for length in 0..graph_end {
            assert!(Model::read(&whole[..length]).is_err(), "cut at {length}");
        }
    }
}

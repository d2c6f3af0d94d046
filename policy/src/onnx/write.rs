//! Writes an actor as an ONNX file: `state` -> Gemm, Relu, ... -> `mean`, `log_std`.

use super::wire::Message;
use std::collections::BTreeMap;

/// Version of the file format that is written.
const IR_VERSION: u64 = 8;
/// Operator set that is written.
const OPSET: u64 = 17;
const FLOAT: u64 = 1;

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

/// A squashed-Gaussian actor: hidden layers with ReLU, then a linear `mean` and, if it can be
/// sampled, a clipped linear `log_std`.
#[derive(Clone, Debug, PartialEq)]
pub struct ActorGraph {
    /// Hidden layers, each followed by a ReLU.
    pub hidden: Vec<Dense>,
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
        let mut graph = Message::new();
        let mut from = String::from("state");
        for (layer, dense) in self.hidden.iter().enumerate() {
            let name = format!("hidden{layer}");
            graph = gemm(graph, dense, &from, &name, &format!("{name}.sum"));
            graph = graph.message(1, node("Relu", &name, &[&format!("{name}.sum")], &name));
            from = name;
        }
        graph = gemm(graph, &self.mean, &from, "mean", "mean");
        if let Some(log_std) = &self.log_std {
            graph = gemm(graph, log_std, &from, "log_std", "log_std.sum");
            graph = graph.message(1, node("Clip", "log_std.clip", &["log_std.sum", "low", "high"], "log_std"));
        }
        graph = graph.bytes(2, "actor");
        for dense in self.hidden.iter().chain([&self.mean]).chain(&self.log_std) {
            debug_assert_eq!(dense.weight.len(), dense.inputs * dense.outputs);
            debug_assert_eq!(dense.bias.len(), dense.outputs);
        }
        for (layer, dense) in self.hidden.iter().enumerate() {
            graph = stored(graph, dense, &format!("hidden{layer}"));
        }
        graph = stored(graph, &self.mean, "mean");
        if let Some(log_std) = &self.log_std {
            graph = stored(graph, log_std, "log_std")
                .message(5, tensor("low", &[], &[self.log_std_bounds.0]))
                .message(5, tensor("high", &[], &[self.log_std_bounds.1]));
        }
        graph = graph.message(11, port("state", self.inputs()));
        graph = graph.message(12, port("mean", self.mean.outputs));
        if let Some(log_std) = &self.log_std {
            graph = graph.message(12, port("log_std", log_std.outputs));
        }
        let model = Message::new().varint(1, IR_VERSION).bytes(2, "vodca").bytes(3, env!("CARGO_PKG_VERSION"));
        let model = model.message(7, graph).message(8, Message::new().bytes(1, "").varint(2, OPSET));
        let entry = |model: Message, (key, value): (&String, &String)| {
            model.message(14, Message::new().bytes(1, key).bytes(2, value))
        };
        self.metadata.iter().fold(model, entry).finish()
    }
}

fn node(operator: &str, name: &str, inputs: &[&str], output: &str) -> Message {
    let node = inputs.iter().fold(Message::new(), |node, input| node.bytes(1, input));
    node.bytes(2, output).bytes(3, name).bytes(4, operator)
}

fn gemm(graph: Message, dense: &Dense, from: &str, name: &str, to: &str) -> Message {
    debug_assert!(dense.inputs > 0 && dense.outputs > 0);
    let transposed = Message::new().bytes(1, "transB").varint(3, 1).varint(20, 2);
    let (weight, bias) = (format!("{name}.weight"), format!("{name}.bias"));
    graph.message(1, node("Gemm", &format!("{name}.gemm"), &[from, &weight, &bias], to).message(5, transposed))
}

fn stored(graph: Message, dense: &Dense, name: &str) -> Message {
    let weight = tensor(&format!("{name}.weight"), &[dense.outputs, dense.inputs], &dense.weight);
    graph.message(5, weight).message(5, tensor(&format!("{name}.bias"), &[dense.outputs], &dense.bias))
}

fn tensor(name: &str, dims: &[usize], numbers: &[f32]) -> Message {
    let raw: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let tensor = dims.iter().fold(Message::new(), |tensor, &dim| tensor.varint(1, dim as u64));
    tensor.varint(2, FLOAT).bytes(8, name).bytes(9, raw)
}

fn port(name: &str, width: usize) -> Message {
    let batch = Message::new().bytes(2, "batch");
    let shape = Message::new().message(1, batch).message(1, Message::new().varint(1, width as u64));
    let tensor = Message::new().varint(1, FLOAT).message(2, shape);
    Message::new().bytes(1, name).message(2, Message::new().message(1, tensor))
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

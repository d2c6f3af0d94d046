//! Runs the ONNX file of a multilayer actor, to see that what was written answers as the policy does. A reader of its own:
//! it knows nothing of how the file came about.

use policy::onnx::proto::{GraphProto, Message, ModelProto, NodeProto, TensorProto};
use std::collections::BTreeMap;

/// Values under way, by name: a vector, or a matrix row by row.
type Values = BTreeMap<String, Vec<f32>>;

/// The actor in a file.
pub(crate) struct Actor {
    graph: GraphProto,
    stored: Values,
}

impl Actor {
    /// Reads a file.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        let model = ModelProto::decode(bytes).map_err(|error| error.to_string())?;
        let graph = model.graph.ok_or("there is no graph")?;
        let stored = graph.initializer.iter().map(|tensor| (name(tensor.name.as_ref()), numbers(tensor))).collect();
        Ok(Self { graph, stored })
    }

    /// The output `mean` for `input`.
    pub(crate) fn mean(&self, input: &[f32]) -> Result<Vec<f32>, String> {
        let mut values = self.stored.clone();
        values.insert("state".into(), input.to_vec());
        for node in &self.graph.node {
            let answer = run(node, &values)?;
            values.insert(node.output.first().cloned().unwrap_or_default(), answer);
        }
        values.remove("mean").ok_or_else(|| "there is no output `mean`".into())
    }
}

fn name(name: Option<&String>) -> String {
    name.cloned().unwrap_or_default()
}

fn numbers(tensor: &TensorProto) -> Vec<f32> {
    let raw = tensor.raw_data.as_deref().unwrap_or_default();
    raw.as_chunks::<4>().0.iter().map(|four| f32::from_le_bytes(*four)).collect()
}

fn run(node: &NodeProto, values: &Values) -> Result<Vec<f32>, String> {
    let input = |at: usize| -> Result<&[f32], String> {
        let name = node.input.get(at).ok_or("an input is missing")?;
        values.get(name).map(Vec::as_slice).ok_or_else(|| format!("there is no value `{name}`"))
    };
    let each = |f: fn(f32) -> f32| Ok(input(0)?.iter().map(|&number| f(number)).collect());
    match node.op_type.as_deref().unwrap_or_default() {
        // y = x W^T + b, W by rows of inputs.
        "Gemm" => {
            let (x, weight, bias) = (input(0)?, input(1)?, input(2)?);
            let rows = weight.chunks_exact(x.len()).zip(bias);
            Ok(rows.map(|(row, bias)| row.iter().zip(x).map(|(w, x)| w * x).sum::<f32>() + bias).collect())
        }
        "Relu" => each(|number| number.max(0.0)),
        "Tanh" => each(f32::tanh),
        other => Err(format!("operator {other} is not one of a multilayer actor")),
    }
}

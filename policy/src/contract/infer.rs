//! What a model without a contract tells by itself.

use super::{ActionMap, Contract, ContractError, Found, Outputs, Tensor};
use crate::onnx::{Dim, Model, Port};

/// Infers the contract of a bare export: one input `[batch, 2N]`, an output `mean` (or the only one)
/// and perhaps `log_std`, `[batch, N]` each. What no file can tell is assumed and noted.
pub fn infer(model: &Model) -> Result<Found, ContractError> {
    let missing = |missing: String| ContractError::CannotInfer { missing };
    let [input] = model.inputs.as_slice() else {
        return Err(missing(format!("which of its {} inputs is the observation", model.inputs.len())));
    };
    let width = match input.dims.as_slice() {
        [_, Dim::Fixed(width)] if *width > 0 && width % 2 == 0 => *width as usize,
        _ => return Err(missing(format!("the number of robots (input {input} is not [batch, 2N])"))),
    };
    let robots = width / 2;
    let named = |name: &str| model.outputs.iter().find(|port| port.name == name);
    let squashed = |port: &Port| port.name.contains("action") || port.name.contains("tanh");
    let mean = match (named("mean"), model.outputs.as_slice()) {
        (Some(mean), _) => mean,
        (None, [only]) if !squashed(only) => only,
        (None, [only]) => {
            return Err(missing(format!("whether output {only} is a mean or an action that is squashed already")));
        }
        (None, outputs) => {
            let names: Vec<&str> = outputs.iter().map(|port| port.name.as_str()).collect();
            return Err(missing(format!("which of the outputs {} is the mean", names.join(", "))));
        }
    };
    let log_std = named("log_std");
    let tensor = |port: &Port| Tensor { name: port.name.clone(), shape: port.dims.clone() };
    let mut contract = Contract::standard(robots, log_std.is_some());
    contract.input = tensor(input);
    contract.outputs = Outputs { mean: tensor(mean), log_std: log_std.map(tensor) };
    contract.action_map = ActionMap::Tanh;
    contract.opset = model.opset();
    contract.producer = Some(model.producer.clone()).filter(|producer| !producer.is_empty());
    let notes = vec![
        format!(
            "no contract: {robots} robots, input `{}` and mean `{}` are read from the model",
            input.name, mean.name
        ),
        "assumed: positions in metres enter as they are (scale 1, offset 0)".into(),
        "assumed: the mean is not squashed yet (action_map \"tanh\")".into(),
        "no sha256 is stated, so a flipped byte would not be noticed; `policy publish` adds it".into(),
    ];
    Ok(Found { contract, notes })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::onnx::ElementType;

    fn port(name: &str, width: i64) -> Port {
        let dims = vec![Dim::Free("batch".into()), Dim::Fixed(width)];
        Port { name: name.into(), element: ElementType::FLOAT, dims }
    }

    fn model(outputs: &[&str]) -> Model {
        let outputs = outputs.iter().map(|name| port(name, 14)).collect();
        Model { inputs: vec![port("obs", 28)], outputs, ..Model::default() }
    }

    #[test]
    fn mean_and_log_std_by_name_or_an_only_output_are_enough() {
        let found = infer(&model(&["log_std", "mean"])).unwrap();
        assert_eq!((found.contract.robots, found.contract.input.name.as_str()), (14, "obs"));
        assert_eq!(found.contract.outputs.log_std.as_ref().map(|port| port.name.as_str()), Some("log_std"));
        assert!(found.notes.iter().any(|note| note.contains("scale 1")));
        let found = infer(&model(&["linear_2"])).unwrap();
        assert_eq!((found.contract.outputs.mean.name.as_str(), found.contract.outputs.log_std), ("linear_2", None));
    }

    #[test]
    fn what_cannot_be_told_is_said_with_the_remedy() {
        let message = |model: &Model| infer(model).unwrap_err().to_string();
        assert!(message(&model(&["a", "b"])).contains("which of the outputs a, b is the mean"));
        assert!(message(&model(&["action"])).contains("squashed already cannot be told from it; write NAME.json"));
        let mut odd = model(&["mean"]);
        odd.inputs[0].dims[1] = Dim::Fixed(27);
        assert!(message(&odd).contains("the number of robots (input `obs` float32 [batch, 27] is not [batch, 2N])"));
        odd.inputs.clear();
        assert!(message(&odd).contains("which of its 0 inputs"));
    }
}

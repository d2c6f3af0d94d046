//! Names, types and shapes of a model against its contract. Back-ends do not notice any of these
//! before the first run, and some not even then.

use super::CheckError;
use policy::contract::{Contract, Tensor};
use policy::onnx::{Dim, ElementType, Model, Port};

/// Checks the input and the outputs of `model`, read from `file`.
pub(super) fn check_ports(file: &str, model: &Model, contract: &Contract) -> Result<(), CheckError> {
    let robots = contract.robots;
    check(file, "input", &model.inputs, &contract.input, 2 * robots, robots)?;
    if let Some(extra) = model.inputs.iter().find(|port| port.name != contract.input.name) {
        let port = extra.to_string();
        return Err(CheckError::Shape { file: file.into(), role: "surplus input", port, robots, width: 2 * robots });
    }
    check(file, "output", &model.outputs, &contract.outputs.mean, robots, robots)?;
    match &contract.outputs.log_std {
        Some(log_std) => check(file, "output", &model.outputs, log_std, robots, robots),
        None => Ok(()),
    }
}

fn check(
    file: &str,
    role: &'static str,
    ports: &[Port],
    wanted: &Tensor,
    width: usize,
    robots: usize,
) -> Result<(), CheckError> {
    let Some(port) = ports.iter().find(|port| port.name == wanted.name) else {
        let names: Vec<String> = ports.iter().map(|port| format!("`{}`", port.name)).collect();
        let has = if names.is_empty() { "none".into() } else { names.join(", ") };
        return Err(CheckError::Name { file: file.into(), role, name: wanted.name.clone(), has });
    };
    if port.element != ElementType::FLOAT {
        let element = port.element.to_string();
        return Err(CheckError::Element { file: file.into(), role, name: port.name.clone(), element });
    }
    let batch = |dim: &Dim| matches!(dim, Dim::Free(_) | Dim::Fixed(1));
    // Some exporters leave the width of an output open; then the trial run tells.
    let wide = |dim: &Dim| *dim == Dim::Fixed(width as i64) || (role == "output" && matches!(dim, Dim::Free(_)));
    let fits = match port.dims.as_slice() {
        [first, second] => batch(first) && wide(second),
        [] => role == "output",
        _ => false,
    };
    let stated = wanted.shape.is_empty() || wanted.shape.last() == Some(&Dim::Fixed(width as i64));
    if fits && (stated || matches!(wanted.shape.last(), Some(Dim::Free(_)))) {
        return Ok(());
    }
    Err(CheckError::Shape { file: file.into(), role, port: port.to_string(), robots, width })
}

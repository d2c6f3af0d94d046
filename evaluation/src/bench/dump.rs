//! The measured QPs as JSON, for other solvers (`results/latency/peers.py` reads them).

use super::BenchError;
use coordinator::record::RecordError;
use coordinator::record::folder::replace;
use serde_json::{Value, json};
use std::path::Path;
use vodca::mpc::problem::{Problem, Solution};

/// One problem with its optimal inputs (m/s), or `null` where its hard rows admit none.
pub(super) fn problem(family: &str, rows: usize, problem: &Problem<'_>, plan: Option<&Solution>) -> Value {
    let steps = problem.horizon.steps();
    let pairs = |list: &[vodca::Position]| list[..steps].iter().map(|pair| [pair.x, pair.y]).collect::<Vec<_>>();
    let row = |row: &vodca::mpc::problem::Row| json!({ "step": row.step, "normal": [row.normal.x, row.normal.y], "offset": row.offset, "hard": row.hard });
    json!({
        "family": family,
        "rows_wanted": rows,
        "horizon": steps,
        "position": [problem.position.x, problem.position.y],
        "state_target": pairs(&problem.target.states),
        "input_target": pairs(&problem.target.inputs),
        "rows": problem.rows.iter().map(row).collect::<Vec<_>>(),
        "slack_linear": problem.slack.linear,
        "slack_quadratic": problem.slack.quadratic,
        "sample_time": problem.sample_time,
        "max_speed": problem.max_speed,
        "state_weight": problem.state_weight,
        "input_weight": problem.input_weight,
        "inputs": plan.map(|plan| pairs(&plan.inputs)),
    })
}

/// Writes them into one file.
pub(super) fn write(path: &Path, problems: &[Value]) -> Result<(), BenchError> {
    let text = serde_json::to_string(problems).map_err(|error| RecordError::Encode {
        path: path.to_owned(),
        what: "the QPs",
        reason: error.to_string(),
    })?;
    Ok(replace(path, text.as_bytes())?)
}

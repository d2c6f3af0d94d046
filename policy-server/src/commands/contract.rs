//! `policy contract`: the contract of a model, to be completed and written beside it.

use anyhow::Context;
use policy::contract::{Contract, find};
use policy::folder::resolve;
use policy::onnx::{Dim, Model};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy contract exported.onnx > exported.json")]
pub(crate) struct ContractArgs {
    /// ONNX file
    file: PathBuf,
}

pub(crate) fn run(args: &ContractArgs) -> anyhow::Result<ExitCode> {
    let file = resolve(&args.file)?;
    let limit = policy::MAX_MODEL_BYTES;
    let size = std::fs::metadata(&file).with_context(|| format!("cannot read {}", file.display()))?.len();
    anyhow::ensure!(size <= limit, "{} has {size} bytes, more than the {limit} that are allowed", file.display());
    let model = Model::read(&std::fs::read(&file)?).with_context(|| file.display().to_string())?;
    match find(&model, None) {
        Ok(found) => {
            print!("{}", found.contract.to_json());
            for note in found.notes {
                eprintln!("note: {note}");
            }
        }
        Err(error) => {
            let width = model.inputs.first().and_then(|port| match port.dims.last() {
                Some(Dim::Fixed(width)) => usize::try_from(*width).ok(),
                _ => None,
            });
            print!("{}", Contract::standard(width.unwrap_or(2) / 2, false).to_json());
            eprintln!("note: {error}");
            for port in model.inputs.iter().chain(&model.outputs) {
                eprintln!("note: the model has {port}");
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

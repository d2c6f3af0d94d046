//! `policy publish`: a checked model becomes the newest version of a policies folder.

use crate::loader::import;
use crate::means::Means;
use policy::folder::{PolicyFolder, resolve};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy publish policies/mine exported.onnx")]
pub(crate) struct PublishArgs {
    /// Policies folder; made when it is not there
    folder: PathBuf,
    /// ONNX file with its contract beside or inside it
    file: PathBuf,
    #[command(flatten)]
    means: Means,
}

pub(crate) fn run(args: &PublishArgs) -> anyhow::Result<ExitCode> {
    let (candidate, _) = args.means.prober()?.check(&resolve(&args.file)?, None)?;
    let folder = PolicyFolder::new(&args.folder);
    let version = import(&folder, &candidate)?;
    println!("{version} (sha256 {}) is the current policy of {}", &candidate.sha256[..12], folder.root().display());
    Ok(ExitCode::SUCCESS)
}

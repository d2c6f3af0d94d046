//! `policy status`, `swap` and `rollback` of a run: all through the run's policies folder, so they
//! work on whatever server serves it, now or after a restart.

use crate::cli::Means;
use crate::loader::import;
use anyhow::{Context, bail};
use shared::policy::folder::{PolicyFolder, Status, Version, resolve};
use shared::policy::run_folder;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// How long a server may take to notice, check, load and switch.
const PATIENCE: Duration = Duration::from_secs(30);

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy status runs/20260131-120000-ex14_d-14")]
pub(crate) struct StatusArgs {
    /// Folder of the run
    run: PathBuf,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy swap runs/20260131-120000-ex14_d-14 policies/better")]
pub(crate) struct SwapArgs {
    /// Folder of the run
    run: PathBuf,
    /// ONNX file or policies folder
    new: PathBuf,
    #[command(flatten)]
    means: Means,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy rollback runs/20260131-120000-ex14_d-14")]
pub(crate) struct RollbackArgs {
    /// Folder of the run
    run: PathBuf,
}

pub(crate) fn status(args: &StatusArgs) -> anyhow::Result<ExitCode> {
    let (_, status) = open(&args.run)?;
    println!("{}", serde_json::to_string_pretty(&status)?);
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn swap(args: &SwapArgs) -> anyhow::Result<ExitCode> {
    let (folder, status) = open(&args.run)?;
    let robots = shared::team::Setup::load(&args.run)?.team.robots;
    let (candidate, _) = args.means.prober()?.check(&resolve(&args.new)?, Some(robots))?;
    let version = import(&folder, &candidate)?;
    wait_for(&folder, version, &status)
}

pub(crate) fn rollback(args: &RollbackArgs) -> anyhow::Result<ExitCode> {
    let (folder, status) = open(&args.run)?;
    let Some(previous) = &status.previous else {
        bail!("nothing acted before in {}; `policy swap` lets another model act", args.run.display());
    };
    let version: Version = previous.version.parse()?;
    folder.set_current(version)?;
    wait_for(&folder, version, &status)
}

fn open(run: &Path) -> anyhow::Result<(PolicyFolder, Status)> {
    let folder = PolicyFolder::new(run_folder(run));
    let status = folder
        .read_status()?
        .with_context(|| format!("no policy server has served {}; start the run with --policy PATH", run.display()))?;
    Ok((folder, status))
}

/// Waits until the server says what became of `version`.
fn wait_for(folder: &PolicyFolder, version: Version, before: &Status) -> anyhow::Result<ExitCode> {
    let name = version.to_string();
    let deadline = Instant::now() + PATIENCE;
    while Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(20));
        let Some(status) = folder.read_status()? else { continue };
        if let Some(serving) = status.serving.as_ref().filter(|serving| serving.version == name) {
            let since = serving.since_tick.map_or("the first tick".into(), |tick| format!("tick {tick}"));
            println!("{name} (sha256 {}) acts from {since} on", &serving.sha256[..12]);
            return Ok(ExitCode::SUCCESS);
        }
        let known = before.rejected.iter().filter(|rejected| rejected.version == name).count();
        if let Some(rejected) = status.rejected.iter().filter(|rejected| rejected.version == name).nth(known) {
            bail!("{name} was refused: {}", rejected.error);
        }
    }
    bail!(
        "the server has not taken {name} within {} s; has the run ended? `policy status RUN` tells what it does",
        PATIENCE.as_secs()
    )
}

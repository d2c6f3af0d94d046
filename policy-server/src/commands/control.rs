//! `policy status`, `swap` and `rollback` of a run: all through the run's policies folder, so they
//! work on whatever server serves it, now or after a restart.

use crate::loader::import;
use crate::means::Means;
use anyhow::{Context, bail};
use policy::folder::{PolicyFolder, Serving, Status, Version, resolve};
use policy::run_folder;
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
    /// STATUS.json as the server wrote it
    #[arg(long)]
    json: bool,
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
    match args.json {
        true => println!("{}", serde_json::to_string_pretty(&status)?),
        false => print!("{}", told(&status, alive(&status))),
    }
    Ok(ExitCode::SUCCESS)
}

/// Whether the server that wrote `status` runs.
fn alive(status: &Status) -> bool {
    shared::os::start_time(status.pid).is_some()
}

/// The status in words.
fn told(status: &Status, alive: bool) -> String {
    let named = |serving: &Serving| {
        let name = serving.name.as_ref().map_or(String::new(), |name| format!("{name}, "));
        let since = serving.since_tick.map_or("not asked yet".into(), |tick| format!("since tick {tick}"));
        format!("{} ({name}sha256 {}), {since}", serving.version, serving.sha256.get(..12).unwrap_or_default())
    };
    let server = if alive { "serves" } else { "has ended; the policy is what it served last" };
    let mut text = format!("server      process {} {server}\n", status.pid);
    text += &format!("policy      {}\n", status.serving.as_ref().map_or("nothing".into(), named));
    if let Some(previous) = &status.previous {
        text += &format!("before it   {} (`policy rollback` goes back to it)\n", named(previous));
    }
    for rejected in &status.rejected {
        text += &format!("refused     {}: {}\n", rejected.version, rejected.error);
    }
    if status.own_rollbacks > 0 {
        text += &format!(
            "failed      {} times a model gave no finite answer and the one before took over\n",
            status.own_rollbacks
        );
    }
    text
}

pub(crate) fn swap(args: &SwapArgs) -> anyhow::Result<ExitCode> {
    let (folder, status) = open(&args.run)?;
    let robots = running(&args.run)?;
    let (candidate, _) = args.means.prober()?.check(&resolve(&args.new)?, Some(robots))?;
    let version = import(&folder, &candidate)?;
    wait_for(&folder, version, &status)
}

pub(crate) fn rollback(args: &RollbackArgs) -> anyhow::Result<ExitCode> {
    let (folder, status) = open(&args.run)?;
    running(&args.run)?;
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

/// The number of robots of a run that has not ended.
fn running(run: &Path) -> anyhow::Result<usize> {
    let team = shared::team::Setup::load(run)?.team;
    // Its coordinator takes this folder with it.
    if !Path::new(&team.place.root).exists() {
        bail!("the run {} has ended; models are swapped while the robots drive", run.display());
    }
    Ok(team.robots)
}

/// Waits until the server says what became of `version`.
fn wait_for(folder: &PolicyFolder, version: Version, before: &Status) -> anyhow::Result<ExitCode> {
    let name = version.to_string();
    let deadline = Instant::now() + PATIENCE;
    while Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(20));
        let Some(status) = folder.read_status()? else { continue };
        if !alive(&status) {
            bail!(
                "the run's policy server (process {}) has ended; {name} acts once another is started: \
                 `./run.sh policy serve --run RUN`",
                status.pid
            );
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use policy::folder::Rejected;

    #[test]
    fn a_status_says_what_acts_what_acted_and_what_was_refused() {
        let serving = |version: &str, name: Option<&str>, since_tick| Serving {
            version: version.into(),
            name: name.map(String::from),
            sha256: "0123456789abcdef".into(),
            since_tick,
        };
        let mut status = Status {
            pid: 7,
            serving: Some(serving("v000002", Some("better"), Some(12))),
            previous: Some(serving("v000001", None, None)),
            ..Status::default()
        };
        status.reject(Rejected { version: "v000003".into(), sha256: String::new(), error: "it is cut".into() });
        let lines = [
            "server      process 7 serves",
            "policy      v000002 (better, sha256 0123456789ab), since tick 12",
            "before it   v000001 (sha256 0123456789ab), not asked yet (`policy rollback` goes back to it)",
            "refused     v000003: it is cut",
        ];
        assert_eq!(told(&status, true), lines.join("\n") + "\n");
        assert!(told(&status, false).starts_with("server      process 7 has ended"));
    }
}

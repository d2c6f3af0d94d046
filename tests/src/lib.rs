//! Helpers for tests of whole runs: build the programs once, start a run, wait with a watchdog, and
//! make sure that it left nothing behind.

pub mod fence;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longer than anything here takes on a busy machine: what is still running then hangs.
pub const WATCHDOG: Duration = Duration::from_secs(90);

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Where the release binary `name` is; all are built at the first call.
pub fn program(name: &str) -> PathBuf {
    static PROGRAMS: OnceLock<BTreeMap<String, PathBuf>> = OnceLock::new();
    let programs = PROGRAMS.get_or_init(build);
    programs.get(name).unwrap_or_else(|| panic!("no program {name} among {programs:?}")).clone()
}

fn build() -> BTreeMap<String, PathBuf> {
    let output = Command::new(env!("CARGO"))
        .args(["build", "--release", "--bins", "--message-format=json", "-p", "agent", "-p", "cli", "-p", "tests"])
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .expect("cargo is there");
    assert!(output.status.success(), "the programs do not build");
    let text = String::from_utf8_lossy(&output.stdout);
    let messages = text.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    messages
        .filter_map(|message| {
            let path = message.get("executable")?.as_str()?.to_string();
            Some((message["target"]["name"].as_str()?.to_string(), PathBuf::from(path)))
        })
        .collect()
}

/// Who plays the robots.
#[derive(Clone, Copy)]
pub enum Robots {
    /// The real ones.
    Real,
    /// Fake ones, which fail as `--fault` says.
    Faulty(&'static str),
}

/// Options with which robots drive so slowly that a run lasts until it is ended.
pub const ENDLESS: &str = "--set model.max_speed=0.0001 --max-ticks 1000000";

/// A run in progress. Killed when dropped.
pub struct Run {
    /// Its folder.
    pub folder: PathBuf,
    child: Child,
    home: TempDir,
}

/// A run that has ended.
#[derive(Debug)]
pub struct Finished {
    /// Its exit status.
    pub status: ExitStatus,
    /// What it printed.
    pub stdout: String,
    /// What it complained about.
    pub stderr: String,
    /// What every robot did (`trajectory.csv`).
    pub trajectory: String,
    /// How it went (`summary.json`), null when it was not written.
    pub summary: serde_json::Value,
}

impl Run {
    /// Starts `vodca run ARGUMENTS` in the repository's root, with a folder of its own.
    pub fn start(robots: Robots, arguments: &str) -> Self {
        let home = tempfile::tempdir().expect("a folder for the test");
        let folder = home.path().join("run");
        let file = |name: &str| File::create(home.path().join(name)).expect("a file for the test");
        let coordinator = match robots {
            Robots::Real => program("vodca"),
            Robots::Faulty(fault) => beside_fakes(home.path(), fault),
        };
        let child = Command::new(coordinator)
            .args(["run", "--out"])
            .arg(&folder)
            .args(arguments.split_whitespace())
            .current_dir(root())
            .stdin(Stdio::null())
            .stdout(file("stdout"))
            .stderr(file("stderr"))
            .spawn();
        Self { folder, child: child.expect("the coordinator starts"), home }
    }

    /// The coordinator's process.
    pub fn pid(&self) -> u32 {
        self.child.id()
    }

    /// The robots' processes.
    pub fn robots(&self) -> Vec<u32> {
        robots_of(&self.folder)
    }

    /// What it has printed so far.
    pub fn printed(&self) -> String {
        fs::read_to_string(self.home.path().join("stdout")).unwrap_or_default()
    }

    /// Waits until the robots have finished their first tick.
    pub fn wait_until_driving(&mut self) {
        let child = &mut self.child;
        let trajectory = self.folder.join("trajectory.csv");
        wait_until("the team drives", || {
            assert!(matches!(child.try_wait(), Ok(None)), "the run ended early");
            fs::read_to_string(&trajectory).is_ok_and(|text| text.lines().count() > 1)
        });
    }

    /// Sends `signal` (INT, TERM, KILL, STOP, CONT) to the coordinator.
    pub fn signal(&self, name: &str) {
        signal(self.pid(), name);
    }

    /// Sends `signal` until the coordinator ends, as people press Ctrl-C again: where its parent ignores the signal, one
    /// that comes before the coordinator can catch it is lost.
    pub fn signal_until_ended(&mut self, name: &str) {
        let (pid, child) = (self.child.id(), &mut self.child);
        let mut sent: Option<Instant> = None;
        wait_until("the run ends when asked to", || {
            if sent.is_none_or(|sent| sent.elapsed() > Duration::from_secs(5)) {
                signal(pid, name);
                sent = Some(Instant::now());
            }
            !matches!(child.try_wait(), Ok(None))
        });
    }

    /// Waits for the end and checks that nothing was left behind.
    pub fn finish(mut self) -> Finished {
        let status = self.wait();
        assert_nothing_left(self.pid(), &self.folder);
        let read = |path: PathBuf| fs::read_to_string(path).unwrap_or_default();
        Finished {
            status,
            stdout: read(self.home.path().join("stdout")),
            stderr: read(self.home.path().join("stderr")),
            trajectory: read(self.folder.join("trajectory.csv")),
            summary: serde_json::from_str(&read(self.folder.join("summary.json"))).unwrap_or_default(),
        }
    }

    /// Waits for the end.
    pub fn wait(&mut self) -> ExitStatus {
        let mut status = None;
        let child = &mut self.child;
        wait_until("the run ends", || {
            status = child.try_wait().expect("our own child");
            status.is_some()
        });
        status.expect("it has ended")
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        let _ = self.child.kill(); // has ended in a test that passes
        let _ = self.child.wait();
    }
}

/// The coordinator in a folder where fake robots lie beside it in place of the real ones.
fn beside_fakes(folder: &Path, fault: &str) -> PathBuf {
    let (coordinator, agent) = (folder.join("vodca"), folder.join("agent"));
    fs::copy(program("vodca"), &coordinator).expect("a copy of the coordinator");
    let script = format!("#!/bin/sh\nexec {} --fault {fault} \"$@\"\n", program("fake_agent").display());
    fs::write(&agent, script).expect("a script for the fake robots");
    fs::set_permissions(&agent, fs::Permissions::from_mode(0o755)).expect("it can be executed");
    coordinator
}

/// Sends a signal.
pub fn signal(pid: u32, name: &str) {
    let done = Command::new("kill").args([&format!("-{name}"), &pid.to_string()]).stderr(Stdio::null()).status();
    done.expect("kill is there");
}

/// Waits until `condition` holds.
pub fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < WATCHDOG, "still waiting: {what}");
        sleep(Duration::from_millis(5));
    }
}

/// All processes that belong to the run in `folder`, the coordinator aside.
pub fn robots_of(folder: &Path) -> Vec<u32> {
    let wanted = format!("--run\0{}\0", folder.display());
    let pids = fs::read_dir("/proc").into_iter().flatten().flatten();
    pids.filter_map(|entry| entry.file_name().to_str()?.parse().ok())
        .filter(|pid| {
            let line = fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default();
            String::from_utf8_lossy(&line).contains(&wanted)
        })
        .collect()
}

/// Shared-memory files and folders of sockets that belong to runs of the coordinator `pid`.
pub fn shared_files(pid: u32) -> Vec<PathBuf> {
    let user = shared::os::user_id();
    let folders =
        [("/dev/shm".to_string(), format!("vodca_{pid:x}-")), (format!("/tmp/vodca-{user}"), format!("{pid:x}-"))];
    let of = |(folder, start): (String, String)| {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        entries.filter(move |entry| entry.file_name().to_string_lossy().starts_with(&start)).map(|entry| entry.path())
    };
    folders.into_iter().flat_map(of).collect()
}

/// No robot of the run lives and no shared file of it is left.
pub fn assert_nothing_left(pid: u32, folder: &Path) {
    let robots = robots_of(folder);
    assert!(robots.is_empty(), "these robots outlived their run: {robots:?}");
    let files = shared_files(pid);
    assert!(files.is_empty(), "these files outlived their run: {files:?}");
}

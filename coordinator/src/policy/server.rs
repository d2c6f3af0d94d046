//! The policy server's process: start, watch, end.

use crate::launch;
use shared::os;
use std::fs::{self, File};
use std::io;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Name of the server's program beside the coordinator's.
const PROGRAM: &str = "policy-server";
/// Name of its log in the folder of the run.
const LOG: &str = "logs/policy-server.log";
/// How long it has to end by itself.
const GRACE: Duration = Duration::from_millis(800);

/// Why the policy server does not start.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// The program is not there.
    #[error("the policy server {} is not there; build it with `cargo build --release -p policy-server`", .0.display())]
    NoProgram(PathBuf),
    /// The system refused.
    #[error("cannot start the policy server {}: {source}", path.display())]
    Refused {
        /// The program or its log.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// It ended before it served.
    #[error("the policy server {how} before the first tick: {said} (log: {})", log.display())]
    Ended {
        /// Exit code or signal, in words.
        how: String,
        /// Its last line.
        said: String,
        /// Its log.
        log: PathBuf,
    },
    /// It did not serve in time.
    #[error("the policy server was not ready in time; see its log {}", .0.display())]
    NotReady(PathBuf),
}

/// The server's program: it lies beside the program that runs now.
pub fn server_program() -> Result<PathBuf, ServerError> {
    let path = std::env::current_exe().unwrap_or_default().with_file_name(PROGRAM);
    if path.is_file() { Ok(path) } else { Err(ServerError::NoProgram(path)) }
}

/// A running policy server; ended when dropped.
pub(super) struct ServerProcess {
    child: Child,
    log: PathBuf,
}

impl ServerProcess {
    /// Starts `program` for the run in `run`; it ends with this process at the latest.
    pub(super) fn start(program: &Path, run: &Path) -> Result<Self, ServerError> {
        let log = run.join(LOG);
        let refused = |path: &Path| {
            let path = path.to_owned();
            move |source| ServerError::Refused { path, source }
        };
        if let Some(folder) = log.parent() {
            fs::create_dir_all(folder).map_err(refused(folder))?;
        }
        let stderr = File::create(&log).map_err(refused(&log))?;
        let stdout = stderr.try_clone().map_err(refused(&log))?;
        let child = Command::new(program)
            .args(["serve", "--parent", &std::process::id().to_string(), "--run"])
            .arg(run)
            .stdin(Stdio::null())
            .stdout(stdout)
            .stderr(stderr)
            .process_group(0)
            .spawn()
            .map_err(refused(program))?;
        Ok(Self { child, log })
    }

    /// Whether the process that was started here has ended; another may have been started by hand.
    pub(super) fn has_ended(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(Some(_)) | Err(_))
    }

    /// An error when it has ended or `deadline` has passed.
    pub(super) fn must_live(&mut self, deadline: Instant) -> Result<(), ServerError> {
        if let Ok(Some(status)) = self.child.try_wait() {
            let said = self.last_line().unwrap_or_else(|| "it said nothing".into());
            let how = launch::ending(status);
            return Err(ServerError::Ended { how, said, log: self.log.clone() });
        }
        if Instant::now() > deadline { Err(ServerError::NotReady(self.log.clone())) } else { Ok(()) }
    }

    /// The last thing it said; `None`: nothing.
    pub(super) fn last_line(&self) -> Option<String> {
        let said = fs::read_to_string(&self.log).unwrap_or_default();
        said.lines().map(str::trim).rfind(|line| !line.is_empty()).map(String::from)
    }

    /// Asks it to end, waits for the grace time, kills what is left.
    pub(super) fn end(&mut self) {
        if self.has_ended() {
            return;
        }
        os::terminate(self.child.id());
        let deadline = Instant::now() + GRACE;
        while !self.has_ended() && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(5));
        }
        // Both fail only when it has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for ServerProcess {
    fn drop(&mut self) {
        self.end();
    }
}

//! Starts the robots' processes and tells how they ended.

use std::fs::{self, File};
use std::io;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};

/// Name of the robot's program beside the coordinator's.
const AGENT: &str = "agent";

/// How the robots of a run come to life.
#[derive(Clone, Debug)]
pub enum Agents {
    /// The coordinator starts this program once per robot.
    Launch(Program),
    /// Somebody starts them by hand; the commands are printed.
    ByHand,
}

/// A program that plays a robot.
#[derive(Clone, Debug)]
pub struct Program {
    /// Where it is.
    pub path: PathBuf,
    /// Arguments beside those that every robot gets.
    pub arguments: Vec<String>,
}

/// A robot's process could not be started.
#[derive(Debug, thiserror::Error)]
pub enum LaunchError {
    /// The program is not there.
    #[error("the robots' program {} is not there; build it with `cargo build --release -p agent`", path.display())]
    NoProgram {
        /// Where it should be.
        path: PathBuf,
    },
    /// The system refused.
    #[error("cannot start robot {robot} ({}): {source}; too many processes or too little memory?", path.display())]
    Refused {
        /// Which robot.
        robot: usize,
        /// The program or its log.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// The robots' program: it lies beside the program that runs now.
pub fn agent_program() -> Result<Program, LaunchError> {
    let own = std::env::current_exe().unwrap_or_default();
    let path = own.with_file_name(AGENT);
    if path.is_file() { Ok(Program { path, arguments: Vec::new() }) } else { Err(LaunchError::NoProgram { path }) }
}

/// The command that starts robot `robot` of the run in `run` by hand.
pub fn command_line(run: &Path, robot: usize) -> String {
    let program = agent_program().map_or(AGENT.into(), |program| program.path);
    format!("{} --run {} --robot {robot}", program.display(), run.display())
}

/// Where robot `robot` writes what it has to say.
pub fn log_file(run: &Path, robot: usize) -> PathBuf {
    run.join("logs").join(format!("robot-{robot:03}.log"))
}

/// Starts robot `robot`. It ends with this process at the latest (the kernel sees to it), is no
/// member of the terminal's foreground group (Ctrl-C reaches the coordinator only, which then ends
/// the team in order), and writes its log into the folder of the run.
pub fn start(program: &Program, run: &Path, robot: usize) -> Result<Child, LaunchError> {
    let log = log_file(run, robot);
    let refused = |path: &Path| {
        let path = path.to_owned();
        move |source| LaunchError::Refused { robot, path, source }
    };
    if let Some(folder) = log.parent() {
        fs::create_dir_all(folder).map_err(refused(&log))?;
    }
    let stderr = File::create(&log).map_err(refused(&log))?;
    let stdout = stderr.try_clone().map_err(refused(&log))?;
    Command::new(&program.path)
        .arg("--run")
        .arg(run)
        .args(["--robot", &robot.to_string(), "--parent", &std::process::id().to_string()])
        .args(&program.arguments)
        .stdin(Stdio::null())
        .stdout(stdout)
        .stderr(stderr)
        .process_group(0)
        .spawn()
        .map_err(refused(&program.path))
}

/// The last thing a robot said, without what Rust adds to a panic; `None`: nothing.
pub fn last_line(run: &Path, robot: usize) -> Option<String> {
    let text = fs::read(log_file(run, robot)).ok()?;
    let text = String::from_utf8_lossy(&text);
    let said = |line: &&str| !line.trim().is_empty() && !line.starts_with("note: ");
    text.lines().rev().find(said).map(|line| line.trim().to_string())
}

/// How a process ended, in words.
pub fn ending(status: ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt;
    match (status.code(), status.signal()) {
        (Some(code), _) => format!("ended with exit code {code}"),
        (None, Some(signal)) => format!("was ended by signal {signal}"),
        (None, None) => format!("ended ({status})"),
    }
}

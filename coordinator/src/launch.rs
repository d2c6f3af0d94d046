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
    /// Somebody starts them by hand, with [`command_line`].
    ByHand,
}

/// A program that plays a robot.
#[derive(Clone, Debug)]
pub struct Program {
    /// Where it is.
    pub path: PathBuf,
    /// Arguments before those that every robot gets.
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

/// The command that starts robot `robot` of the run in `run` by hand: for a shell in any folder.
pub fn command_line(run: &Path, robot: usize) -> String {
    let program = agent_program().map_or(AGENT.into(), |program| program.path);
    let run = fs::canonicalize(run).unwrap_or_else(|_| run.to_owned());
    format!("{} --run {} --robot {robot}", quoted(&program), quoted(&run))
}

/// `path` as one word of a shell.
fn quoted(path: &Path) -> String {
    let text = path.to_string_lossy();
    let plain = |c: char| c.is_alphanumeric() || "/._-+:@%,=".contains(c);
    if !text.is_empty() && text.chars().all(plain) { text.into() } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

/// Where robot `robot` writes what it has to say.
pub fn log_file(run: &Path, robot: usize) -> PathBuf {
    run.join("logs").join(format!("robot-{robot:03}.log"))
}

/// Starts robot `robot`. It ends when this process has ended (it watches it), is no
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
    // What an earlier process of this robot said stays.
    let stderr = File::options().create(true).append(true).open(&log).map_err(refused(&log))?;
    let stdout = stderr.try_clone().map_err(refused(&log))?;
    Command::new(&program.path)
        .args(&program.arguments)
        .arg("--run")
        .arg(run)
        .args(["--robot", &robot.to_string(), "--parent", &std::process::id().to_string()])
        .stdin(Stdio::null())
        .stdout(stdout)
        .stderr(stderr)
        .process_group(0)
        .spawn()
        .map_err(refused(&program.path))
}

/// The last thing a robot said; `None`: nothing.
pub fn last_line(run: &Path, robot: usize) -> Option<String> {
    let text = fs::read(log_file(run, robot)).ok()?;
    last_line_of(&String::from_utf8_lossy(&text))
}

/// The last line of a log. Of a panic, whose message is followed by hints and perhaps a backtrace, the
/// message and where it happened.
fn last_line_of(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    match lines.iter().rposition(|line| line.starts_with("thread '") && line.contains(" panicked at ")) {
        Some(at) => {
            let place = lines[at].split_once(" panicked at ").map_or("", |(_, place)| place.trim_end_matches(':'));
            Some(format!("panicked at {place}: {}", lines.get(at + 1)?))
        }
        None => lines.last().map(|line| line.to_string()),
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_line_is_the_last_thing_that_was_said() {
        assert_eq!(last_line_of("starting\nerror: no room\n\n").as_deref(), Some("error: no room"));
        assert_eq!(last_line_of(" \n"), None);
    }

    #[test]
    fn of_a_panic_the_message_counts_and_not_the_backtrace() {
        let text = "warn: late\n\nthread 'main' (12) panicked at src/a.rs:3:5:\nindex out of bounds\n\
                    stack backtrace:\n   0: core::panicking\nnote: run with more\n";
        assert_eq!(last_line_of(text).as_deref(), Some("panicked at src/a.rs:3:5: index out of bounds"));
    }

    #[test]
    fn commands_work_in_a_shell_in_any_folder() {
        let place = std::env::temp_dir().join(format!("vodca's $HOME {}", std::process::id()));
        fs::create_dir_all(&place).unwrap();
        let here = std::env::current_dir().unwrap();
        let up: PathBuf = here.components().skip(1).map(|_| "..").collect();
        let line = command_line(&up.join(place.strip_prefix("/").unwrap()), 3);
        let arguments = line.split_once(" --run ").unwrap().1;
        let output = Command::new("sh").args(["-c", &format!("printf '%s|' {arguments}")]).output().unwrap();
        let canonical = fs::canonicalize(&place).unwrap();
        fs::remove_dir(&place).unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), format!("{}|--robot|3|", canonical.display()));
    }

    #[test]
    fn endings_are_told_in_words() {
        let status = |script| Command::new("sh").args(["-c", script]).status().unwrap();
        assert_eq!(ending(status("exit 7")), "ended with exit code 7");
        assert_eq!(ending(status("kill -9 $$")), "was ended by signal 9");
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let run = std::env::temp_dir().join(format!("vodca-launch-{}", std::process::id()));
        let program = Program { path: "/nowhere/agent".into(), arguments: Vec::new() };
        let message = start(&program, &run, 4).unwrap_err().to_string();
        fs::remove_dir_all(run).unwrap();
        assert!(message.contains("robot 4") && message.contains("/nowhere/agent"), "{message}");
    }
}

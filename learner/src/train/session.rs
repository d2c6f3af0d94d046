//! A team of robot processes that plays rounds of episodes for a trainer: a `rollout` session of the
//! coordinator, told what to do line by line.

use policy::session::{RoundOrder, RoundReport, from_line, to_line};
use shared::stop::StopFlag;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Name of the coordinator's program beside this one.
const PROGRAM: &str = "vodca";
/// How often a waiting trainer looks whether it was asked to stop.
const LOOK_AROUND: Duration = Duration::from_millis(50);
/// How long a round may take, and how much longer with every episode of it: the coordinator ends by itself
/// when a robot hangs, this is for a coordinator that does.
const PATIENCE: Duration = Duration::from_secs(600);
const EPISODE_PATIENCE: Duration = Duration::from_secs(30);
/// How long a session may take to end.
const GRACE: Duration = Duration::from_secs(5);

/// Why a session does not play.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// The coordinator is not there.
    #[error("the coordinator {} is not there; build it with `cargo build --release -p coordinator -p agent`", .0.display())]
    NoProgram(PathBuf),
    /// The system refused.
    #[error("cannot start the rollouts of {}: {source}", folder.display())]
    Refused {
        /// The session's folder.
        folder: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// It ended before it had played its round.
    #[error("the rollouts in {} ended: {said}", folder.display())]
    Ended {
        /// The session's folder.
        folder: PathBuf,
        /// Its last line.
        said: String,
    },
    /// It hangs.
    #[error("the rollouts in {} gave no answer for {seconds} s; see the logs there", folder.display())]
    Silent {
        /// The session's folder.
        folder: PathBuf,
        /// How long somebody waited.
        seconds: u64,
    },
    /// Its answer cannot be read.
    #[error("the rollouts in {} answered `{line}`: {reason}; are coordinator and learner of one version?", folder.display())]
    Strange {
        /// The session's folder.
        folder: PathBuf,
        /// The answer.
        line: String,
        /// What is wrong with it.
        reason: String,
    },
}

/// A running session; ended when dropped.
pub struct Session {
    child: Child,
    orders: Option<ChildStdin>,
    answers: Receiver<String>,
    folder: PathBuf,
    /// How long the ordered round may take.
    patience: Duration,
}

impl Session {
    /// Starts `coordinator rollout ARGUMENTS --rounds-from-stdin --out FOLDER`.
    pub fn start(arguments: &[String], folder: &Path) -> Result<Self, SessionError> {
        let program = std::env::current_exe().unwrap_or_default().with_file_name(PROGRAM);
        if !program.is_file() {
            return Err(SessionError::NoProgram(program));
        }
        let refused = |source| SessionError::Refused { folder: folder.to_owned(), source };
        let log = log_file(folder);
        if let Some(parent) = log.parent() {
            std::fs::create_dir_all(parent).map_err(refused)?;
        }
        let mut child = Command::new(program)
            .arg("rollout")
            .args(arguments)
            .arg("--rounds-from-stdin")
            .arg("--out")
            .arg(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(File::create(log).map_err(refused)?)
            .process_group(0) // Ctrl-C is for the trainer, which ends its sessions in order
            .spawn()
            .map_err(refused)?;
        let (orders, stdout) = (child.stdin.take(), child.stdout.take());
        let (sender, answers) = channel();
        if let Some(stdout) = stdout {
            std::thread::spawn(move || {
                for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                    if sender.send(line).is_err() {
                        return;
                    }
                }
            });
        }
        Ok(Self { child, orders, answers, folder: folder.to_owned(), patience: PATIENCE })
    }

    /// Orders a round; with a policy it begins once that one acts.
    pub fn order(&mut self, order: &RoundOrder) -> Result<(), SessionError> {
        let episodes = u32::try_from(order.episodes.get()).unwrap_or(u32::MAX);
        self.patience = PATIENCE.saturating_add(EPISODE_PATIENCE.saturating_mul(episodes));
        let write = |orders: &mut ChildStdin| {
            writeln!(orders, "{}", to_line(order)?)?;
            orders.flush()
        };
        match self.orders.as_mut().map(write) {
            Some(Ok(())) => Ok(()),
            _ => Err(self.ended()),
        }
    }

    /// Waits for the round that was ordered; `None`: somebody asked to stop.
    pub fn answer(&mut self, stop: &StopFlag) -> Result<Option<RoundReport>, SessionError> {
        let begun = Instant::now();
        while !stop.is_set() {
            if let Some(round) = self.look()? {
                return Ok(Some(round));
            }
            self.in_time(begun)?;
        }
        Ok(None)
    }

    /// Waits for the round that was ordered, even when a stop was asked for.
    pub fn whole_answer(&mut self) -> Result<RoundReport, SessionError> {
        let begun = Instant::now();
        loop {
            if let Some(round) = self.look()? {
                return Ok(round);
            }
            self.in_time(begun)?;
        }
    }

    /// Looks a little while for an answer.
    fn look(&mut self) -> Result<Option<RoundReport>, SessionError> {
        match self.answers.recv_timeout(LOOK_AROUND) {
            Ok(line) => match from_line(&line) {
                Ok(round) => Ok(Some(round)),
                Err(error) => {
                    let (folder, reason) = (self.folder.clone(), error.to_string());
                    Err(SessionError::Strange { folder, line, reason })
                }
            },
            Err(RecvTimeoutError::Disconnected) => Err(self.ended()),
            Err(RecvTimeoutError::Timeout) => Ok(None),
        }
    }

    fn in_time(&self, begun: Instant) -> Result<(), SessionError> {
        let (folder, seconds) = (self.folder.clone(), self.patience.as_secs());
        if begun.elapsed() > self.patience { Err(SessionError::Silent { folder, seconds }) } else { Ok(()) }
    }

    /// The folder in which its policy server keeps the versions it was given.
    pub fn policy_folder(&self) -> PathBuf {
        policy::run_folder(&self.folder.join("session"))
    }

    fn ended(&self) -> SessionError {
        let said = std::fs::read_to_string(log_file(&self.folder)).unwrap_or_default();
        let said = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
        SessionError::Ended { folder: self.folder.clone(), said: said.trim().to_owned() }
    }
}

/// What the session says, beside its folder: the folder must be empty when it starts.
fn log_file(folder: &Path) -> PathBuf {
    folder.with_extension("log")
}

impl Drop for Session {
    /// The end of its orders is the end of the session; what hangs is killed.
    fn drop(&mut self) {
        self.orders = None;
        shared::os::terminate(self.child.id());
        let deadline = Instant::now() + GRACE;
        while matches!(self.child.try_wait(), Ok(None)) && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(5));
        }
        // Both fail only when it has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

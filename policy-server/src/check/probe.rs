//! Tries a model in a process of its own: one that crashes, hangs or eats memory ends alone.
//!
//! The child reads one line of JSON (`Trial`) and then the model's bytes from its standard input and
//! answers with one line of JSON. It limits its own memory and processor time first.

use super::{Candidate, CheckError, Limits, ReferenceSet, Report, TryError, look, try_out};
use crate::actor::{BackEnd, Runtime};
use policy::contract::Contract;
use rustix::process::{Resource, Rlimit, Signal, set_parent_process_death_signal, setrlimit};
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::time::Duration;

/// Who tries models, and with which limits.
#[derive(Clone, Debug)]
pub struct Prober {
    /// The policy-server binary: it is started with the one argument [`TRIAL_COMMAND`].
    pub program: PathBuf,
    /// What the model will be computed with.
    pub back_end: BackEnd,
    /// What it may use.
    pub limits: Limits,
}

/// The hidden command of the trial process.
pub const TRIAL_COMMAND: &str = "trial";

/// Everything the trial process needs besides the bytes.
#[derive(Debug, Serialize, Deserialize)]
struct Trial {
    library: Option<PathBuf>,
    contract: Contract,
    reference: Option<ReferenceSet>,
    limits: Limits,
}

impl Prober {
    /// The whole ladder for the model at `file`.
    pub fn check(&self, file: &Path, robots: Option<usize>) -> Result<(Candidate, Report), CheckError> {
        let candidate = look(file, robots, &self.limits)?;
        let report = self.try_out(&candidate)?;
        Ok((candidate, report))
    }

    /// Tries a model that passed [`look`], in a process of its own.
    pub fn try_out(&self, candidate: &Candidate) -> Result<Report, CheckError> {
        let failed = |source| CheckError::Try { file: candidate.file.display().to_string(), source };
        self.run_trial(candidate).map_err(failed)
    }

    fn run_trial(&self, candidate: &Candidate) -> Result<Report, TryError> {
        let no_trial = |error: io::Error| TryError::NoTrial(error.to_string());
        let library = match &self.back_end {
            BackEnd::Embedded => None,
            BackEnd::Library(file) => Some(file.clone()),
        };
        let (contract, reference) = (candidate.contract.clone(), candidate.reference.clone());
        let trial = Trial { library, contract, reference, limits: self.limits };
        let mut head = serde_json::to_vec(&trial).map_err(|error| no_trial(error.into()))?;
        head.push(b'\n');
        let mut child = Command::new(&self.program)
            .arg(TRIAL_COMMAND)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(no_trial)?;
        let said = feed_and_listen(&mut child, head, candidate.bytes.clone(), self.limits.trial_seconds);
        if said.is_none() {
            // Already dead is as good as killed.
            let _ = child.kill();
        }
        let status = child.wait().map_err(no_trial)?;
        match said {
            None => Err(TryError::Hung { seconds: self.limits.trial_seconds }),
            Some(answer) => serde_json::from_slice(&answer).unwrap_or_else(|_| {
                Err(TryError::Crashed { how: describe(status), memory_mib: self.limits.memory >> 20 })
            }),
        }
    }
}

/// Writes and reads in threads of their own, because either may block; `None` after `seconds`.
fn feed_and_listen(child: &mut Child, head: Vec<u8>, bytes: Vec<u8>, seconds: u64) -> Option<Vec<u8>> {
    let (mut stdin, mut stdout) = (child.stdin.take()?, child.stdout.take()?);
    std::thread::spawn(move || {
        // A child that dies early does not read; what it says instead is looked at below.
        let _ = stdin.write_all(&head).and_then(|()| stdin.write_all(&bytes));
    });
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        const MAX_ANSWER: u64 = 64 << 10;
        let mut answer = Vec::new();
        let _ = stdout.by_ref().take(MAX_ANSWER).read_to_end(&mut answer);
        let _ = sender.send(answer);
    });
    receiver.recv_timeout(Duration::from_secs(seconds)).ok()
}

fn describe(status: ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt;
    match (status.signal(), status.code()) {
        (Some(signal), _) => format!("signal {signal}"),
        (None, Some(code)) => format!("exit code {code}"),
        (None, None) => "no exit status".into(),
    }
}

/// The trial process: reads a `Trial` and a model, answers with the report or the error.
pub fn run_trial_process() -> anyhow::Result<()> {
    set_parent_process_death_signal(Some(Signal::KILL))?;
    let mut stdin = io::stdin().lock();
    let mut head = Vec::new();
    stdin.read_until(b'\n', &mut head)?;
    let trial: Trial = serde_json::from_slice(&head)?;
    let limit = |value: u64| Rlimit { current: Some(value), maximum: Some(value) };
    setrlimit(Resource::As, limit(trial.limits.memory))?;
    setrlimit(Resource::Cpu, limit(trial.limits.trial_seconds))?;
    setrlimit(Resource::Core, limit(0))?;
    let mut bytes = Vec::new();
    stdin.take(trial.limits.bytes).read_to_end(&mut bytes)?;
    let back_end = trial.library.map_or(BackEnd::Embedded, BackEnd::Library);
    let result = Runtime::start(&back_end)
        .map_err(|error| TryError::Load(error.to_string()))
        .and_then(|runtime| try_out(&runtime, &bytes, &trial.contract, trial.reference.as_ref(), &trial.limits))
        .map(|(_, report)| report);
    println!("{}", serde_json::to_string(&result)?);
    Ok(())
}

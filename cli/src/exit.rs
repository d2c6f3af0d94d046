//! How a command ends, and the exit code that says so.

use crate::stdout::PrintError;
use evaluation::sentence::sentence;
use std::error::Error;
use std::io::Write as _;
use std::process::ExitCode;

/// How a command ended when nothing went wrong with the command itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It did what was asked; a run arrived or was asked to stop. Exit code 0.
    Done,
    /// It ran, and the answer is no: not arrived, collided, or files that do not match. Exit code 1.
    Failed,
}

/// Why a command could not do its work.
#[derive(Debug)]
pub enum Failure {
    /// What was asked for does not make sense. Exit code 2.
    Usage(Box<dyn Error + Send + Sync>),
    /// It broke on the way. Exit code 1.
    Broken(Box<dyn Error + Send + Sync>),
    /// A robot's process was lost. Exit code 3.
    PeerLost(Box<dyn Error + Send + Sync>),
}

/// What a command returns.
pub type Ending = Result<Outcome, Failure>;

impl Failure {
    /// For `map_err`: the command line asked for something that does not make sense.
    pub fn usage(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Usage(error.into())
    }

    /// For `map_err`: it broke on the way.
    pub fn broken(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Broken(error.into())
    }

    /// For `map_err`: a robot's process was lost.
    pub fn peer_lost(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::PeerLost(error.into())
    }
}

impl From<PrintError> for Failure {
    fn from(error: PrintError) -> Self {
        Self::broken(error)
    }
}

/// Prints what went wrong, once and with its causes, and gives the exit code.
pub fn report(ending: Ending) -> ExitCode {
    let (code, error) = match ending {
        Ok(Outcome::Done) => return ExitCode::SUCCESS,
        Ok(Outcome::Failed) => return ExitCode::from(1),
        Err(Failure::Broken(error)) => (1, error),
        Err(Failure::Usage(error)) => (2, error),
        Err(Failure::PeerLost(error)) => (3, error),
    };
    let _ = writeln!(std::io::stderr(), "error: {}", sentence(error.as_ref())); // nobody reads it: the code says it
    ExitCode::from(code)
}

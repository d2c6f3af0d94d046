//! What a server tells about itself in STATUS.json.

use super::{FolderError, PolicyFolder, failed, replace};
use serde::{Deserialize, Serialize};
use std::{fs, io};

/// What a policy server does right now.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Status {
    /// Process number of the server.
    pub pid: u32,
    /// What acts.
    pub serving: Option<Serving>,
    /// What acted before and is kept for a rollback.
    pub previous: Option<Serving>,
    /// What was refused, newest last.
    pub rejected: Vec<Rejected>,
    /// Newest trouble in one sentence.
    pub last_error: Option<String>,
    /// Times a model gave numbers that are not finite and the previous one took over.
    pub own_rollbacks: u64,
}

/// A model that acts or acted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Serving {
    /// `v000017`.
    pub version: String,
    /// Its contract's name.
    #[serde(default)]
    pub name: Option<String>,
    /// SHA-256 of its file.
    pub sha256: String,
    /// First tick it answered; `None` before that.
    pub since_tick: Option<u64>,
}

/// A model that was refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rejected {
    /// `v000017`.
    pub version: String,
    /// SHA-256 of its file; empty when it could not be read.
    pub sha256: String,
    /// Why.
    pub error: String,
}

const STATUS_FILE: &str = "STATUS.json";

/// Most refusals that are kept.
const MAX_REJECTED: usize = 32;

impl Status {
    /// Notes a refusal, forgetting the oldest beyond 32.
    pub fn reject(&mut self, rejected: Rejected) {
        self.last_error = Some(rejected.error.clone());
        self.rejected.push(rejected);
        let surplus = self.rejected.len().saturating_sub(MAX_REJECTED);
        self.rejected.drain(..surplus);
    }
}

impl PolicyFolder {
    /// Replaces STATUS.json.
    pub fn write_status(&self, status: &Status) -> Result<(), FolderError> {
        let json = serde_json::to_string_pretty(status).unwrap_or_default() + "\n";
        replace(&self.root.join(STATUS_FILE), json.as_bytes())
    }

    /// Reads STATUS.json; `None` while no server ever served this folder.
    pub fn read_status(&self) -> Result<Option<Status>, FolderError> {
        let file = self.root.join(STATUS_FILE);
        let bytes = match fs::read(&file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            bytes => bytes.map_err(failed("read", &file))?,
        };
        serde_json::from_slice(&bytes).map(Some).map_err(|error| failed("read", &file)(error.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_status_is_read_as_it_was_written_and_keeps_few_refusals() {
        let place = tempfile::tempdir().unwrap();
        let folder = PolicyFolder::new(place.path());
        assert_eq!(folder.read_status().unwrap(), None);
        let mut status = Status { pid: 7, ..Status::default() };
        for number in 0..100 {
            let version = format!("v{number:06}");
            status.reject(Rejected { version, sha256: String::new(), error: "bad".into() });
        }
        folder.write_status(&status).unwrap();
        let read = folder.read_status().unwrap().unwrap();
        assert_eq!(read, status);
        assert_eq!((read.rejected.len(), read.rejected[31].version.as_str()), (32, "v000099"));
    }
}

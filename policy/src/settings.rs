//! `policy.toml` in the folder of a run: how its policy server works. Written by the coordinator
//! before it starts the server, so that one started by hand after a crash works the same.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Name of the file.
pub const FILE: &str = "policy.toml";

/// How the policy server of a run works.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolicySettings {
    /// 1.
    pub version: u32,
    /// Where the policy comes from: an ONNX file or a policies folder, absolute.
    pub policy: PathBuf,
    /// A second policy that sees the same and is only recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shadow: Option<PathBuf>,
    /// Sample actions from this seed; absent: the mean.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample_seed: Option<u64>,
    /// ONNX Runtime library; absent: the embedded back-end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub onnxruntime: Option<PathBuf>,
    /// Time between two looks for a new version, ms.
    pub poll_ms: u64,
}

/// The file cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("cannot use {}: {reason}; is this the folder of a run with a policy?", path.display())]
pub struct SettingsError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub reason: String,
}

impl PolicySettings {
    /// Writes the file into the folder `run`.
    pub fn write(&self, run: &Path) -> Result<(), SettingsError> {
        let path = run.join(FILE);
        let failed = |reason: String| SettingsError { path: path.clone(), reason };
        let text = toml::to_string(self).map_err(|error| failed(error.to_string()))?;
        std::fs::write(&path, text).map_err(|error| failed(error.to_string()))
    }

    /// Reads it from there.
    pub fn read(run: &Path) -> Result<Self, SettingsError> {
        let path = run.join(FILE);
        let failed = |reason: String| SettingsError { path: path.clone(), reason };
        let text = std::fs::read_to_string(&path).map_err(|error| failed(error.to_string()))?;
        let settings: Self = toml::from_str(&text).map_err(|error| failed(error.to_string()))?;
        if settings.version != 1 {
            return Err(failed(format!("version = {} is not known; this program reads 1", settings.version)));
        }
        Ok(settings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_survive_their_file() {
        let place = tempfile::tempdir().unwrap();
        let mut settings = PolicySettings {
            version: 1,
            policy: "/p".into(),
            shadow: Some("/s.onnx".into()),
            sample_seed: Some(3),
            onnxruntime: None,
            poll_ms: 250,
        };
        settings.write(place.path()).unwrap();
        assert_eq!(PolicySettings::read(place.path()).unwrap(), settings);
        settings.version = 2;
        settings.write(place.path()).unwrap();
        assert!(PolicySettings::read(place.path()).unwrap_err().to_string().contains("version = 2 is not known"));
    }
}

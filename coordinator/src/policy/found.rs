//! Policies as users name them: a path, or the name of a folder in `policies/`.

use policy::MAX_MODEL_BYTES;
use policy::contract;
use policy::folder::{self, FolderError, MANIFEST_FILE, MODEL_FILE, resolve};
use policy::onnx::Model;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Why a policy cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FindError {
    /// The system has no absolute path for it, or refuses to open it.
    #[error("cannot use the policy {}: {source}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Nothing has that name, or a folder holds no policy.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file that is no model.
    #[error("{} is no policy: {reason}; `./run.sh policy check` says more", path.display())]
    NoModel {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

/// A model and the team it is for. Whether it may act the policy server finds out when it loads it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundPolicy {
    /// As the user called it.
    pub name: String,
    /// The ONNX file that was current when this was looked for, absolute.
    pub model: PathBuf,
    /// N: a model fits one number of robots.
    pub robots: usize,
}

/// The absolute path of the file or folder that `name` means.
pub fn locate(name: &Path) -> Result<PathBuf, FindError> {
    let path = folder::locate(name)?;
    std::path::absolute(&path).map_err(|source| FindError::Refused { path, source })
}

impl FoundPolicy {
    /// Finds the current model of the policy called `name` and reads how many robots it is for.
    pub fn find(name: &str) -> Result<Self, FindError> {
        let model = resolve(&locate(Path::new(name))?)?;
        let mut bytes = Vec::new();
        File::open(&model)
            .and_then(|file| file.take(MAX_MODEL_BYTES).read_to_end(&mut bytes))
            .map_err(|source| FindError::Refused { path: model.clone(), source })?;
        let unusable = |reason: String| FindError::NoModel { path: model.clone(), reason };
        let parsed = Model::read(&bytes).map_err(|error| unusable(error.to_string()))?;
        // As the server looks: `manifest.json` belongs to a policies folder, NAME.json to a bare file.
        let manifest = model.with_file_name(MANIFEST_FILE);
        let in_folder = model.file_name().is_some_and(|name| name == MODEL_FILE) && manifest.exists();
        let place = if in_folder { manifest } else { model.with_extension("json") };
        let beside = fs::read(&place).ok().map(|json| (json, place.display().to_string()));
        let found = contract::find(&parsed, beside.as_ref().map(|(json, place)| (json.as_slice(), place.as_str())))
            .map_err(|error| unusable(error.to_string()))?;
        Ok(Self { name: name.into(), robots: found.contract.robots, model })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use policy::contract::Contract;
    use policy::folder::PolicyFolder;

    #[test]
    fn what_is_no_policy_is_one_clear_error() {
        let place = tempfile::tempdir().unwrap();
        let message = |path: &Path| FoundPolicy::find(&path.to_string_lossy()).unwrap_err().to_string();
        let absent = message(Path::new("no-such-policy"));
        assert!(
            absent.starts_with("there is no policy no-such-policy: neither no-such-policy nor policies/"),
            "{absent}"
        );
        assert!(message(place.path()).contains("holds no policy"));
        let folder = PolicyFolder::new(place.path().join("mine"));
        folder.publish(b"\xff no model", &Contract::standard(2, true), None).unwrap();
        assert!(message(folder.root()).contains("actor.onnx is no policy"), "{}", message(folder.root()));
    }
}

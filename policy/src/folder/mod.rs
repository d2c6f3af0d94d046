//! A policies folder: versions that never change and one file that names the current one.
//!
//! ```text
//! NAME/v000017/{actor.onnx, manifest.json, reference.json}
//! NAME/CURRENT        one line, `v000017`, replaced by rename: the only trigger
//! NAME/STATUS.json    written by the server that serves it
//! ```
//! A version is written beside, synced and renamed into place, then CURRENT is: whoever reads CURRENT
//! finds a whole version.

mod status;

pub use status::{Rejected, Serving, Status};

use super::contract::Contract;
use super::digest::sha256;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Name of the model in a version's folder.
pub const MODEL_FILE: &str = "actor.onnx";
/// Name of the contract in a version's folder.
pub const MANIFEST_FILE: &str = "manifest.json";
/// Name of the reference set in a version's folder.
pub const REFERENCE_FILE: &str = "reference.json";
const CURRENT_FILE: &str = "CURRENT";
/// Where policies lie that are called by their names alone.
const POLICIES: &str = "policies";

/// Number of a version: `v000017`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Version(pub u32);

impl std::fmt::Display for Version {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "v{:06}", self.0)
    }
}

impl std::str::FromStr for Version {
    type Err = FolderError;
    fn from_str(text: &str) -> Result<Self, FolderError> {
        let digits = text.strip_prefix('v').filter(|digits| digits.len() == 6);
        let number = digits.filter(|digits| digits.bytes().all(|c| c.is_ascii_digit()));
        number.and_then(|digits| digits.parse().ok()).map(Version).ok_or_else(|| FolderError::Version(text.into()))
    }
}

/// Why a policies folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// Not a version's name.
    #[error("`{0}` is no version; versions are called v000001, v000002, ...")]
    Version(String),
    /// A version that is not there.
    #[error("there is no version {version} in {folder}")]
    Missing {
        /// The version.
        version: Version,
        /// The folder.
        folder: String,
    },
    /// Nothing has that name.
    #[error(
        "there is no policy {name}: neither {name} nor {POLICIES}/{name} is there; name an ONNX file or a policies folder \
         (`./run.sh policy new --random --robots N {POLICIES}/try` writes one to try things with)"
    )]
    NotThere {
        /// As given.
        name: String,
    },
    /// A folder that holds no policy.
    #[error("{0} holds no policy: there is no CURRENT and no actor.onnx; `policy publish FOLDER MODEL` writes one")]
    NoPolicy(String),
    /// The system refused.
    #[error("cannot {action} {path}: {source}")]
    Io {
        /// What was tried.
        action: &'static str,
        /// With what.
        path: String,
        /// The system's reason.
        source: io::Error,
    },
}

/// A policies folder.
#[derive(Clone, Debug)]
pub struct PolicyFolder {
    root: PathBuf,
}

impl PolicyFolder {
    /// The folder at `root`, which need not exist yet.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// Where it is.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The model file of `version`.
    pub fn model(&self, version: Version) -> PathBuf {
        self.root.join(version.to_string()).join(MODEL_FILE)
    }

    /// All versions, oldest first. Folders still being written have other names and are not seen.
    pub fn versions(&self) -> Result<Vec<Version>, FolderError> {
        let entries = match fs::read_dir(&self.root) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries.map_err(failed("list", &self.root))?,
        };
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut versions: Vec<Version> = names.filter_map(|name| name.parse().ok()).collect();
        versions.sort();
        Ok(versions)
    }

    /// What CURRENT names; `None` while there is none.
    pub fn current(&self) -> Result<Option<Version>, FolderError> {
        let file = self.root.join(CURRENT_FILE);
        match fs::read_to_string(&file) {
            Ok(text) => text.trim_end().parse().map(Some),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(failed("read", &file)(error)),
        }
    }

    /// Makes `version` the current one, in one rename.
    pub fn set_current(&self, version: Version) -> Result<(), FolderError> {
        if !self.root.join(version.to_string()).is_dir() {
            return Err(FolderError::Missing { version, folder: self.root.display().to_string() });
        }
        replace(&self.root.join(CURRENT_FILE), format!("{version}\n").as_bytes())
    }

    /// Writes a new version; it becomes current only by [`PolicyFolder::set_current`]. The manifest
    /// gets version, sha256 and bytes of what is written.
    pub fn add(&self, model: &[u8], contract: &Contract, reference: Option<&str>) -> Result<Version, FolderError> {
        fs::create_dir_all(&self.root).map_err(failed("create", &self.root))?;
        let beside = self.root.join(format!(".adding-{}", std::process::id()));
        let _ = fs::remove_dir_all(&beside); // What a killed process with this number left.
        fs::create_dir(&beside).map_err(failed("create", &beside))?;
        write(&beside.join(MODEL_FILE), model)?;
        if let Some(reference) = reference {
            write(&beside.join(REFERENCE_FILE), reference.as_bytes())?;
        }
        let mut manifest = Contract {
            sha256: Some(sha256(model)),
            bytes: Some(model.len() as u64),
            created: contract.created.or_else(now),
            ..contract.clone()
        };
        // Another publisher may take the number first: rename refuses, the next one is tried.
        let mut version = Version(self.versions()?.last().map_or(1, |last| last.0 + 1));
        loop {
            manifest.version = Some(version.to_string());
            write(&beside.join(MANIFEST_FILE), manifest.to_json().as_bytes())?;
            sync(&beside)?;
            let place = self.root.join(version.to_string());
            match fs::rename(&beside, &place) {
                Ok(()) => break,
                Err(error) if place.exists() && error.kind() != io::ErrorKind::PermissionDenied => version.0 += 1,
                Err(error) => return Err(failed("create", &place)(error)),
            }
        }
        sync(&self.root)?;
        Ok(version)
    }

    /// Removes the oldest versions beyond `keep`; the current one and its predecessor always stay.
    pub fn prune(&self, keep: usize) -> Result<(), FolderError> {
        let versions = self.versions()?;
        let current = self.current()?.and_then(|current| versions.iter().position(|version| *version == current));
        let oldest_needed = current.map_or(usize::MAX, |current| current.saturating_sub(1));
        let surplus = versions.len().saturating_sub(keep.max(2)).min(oldest_needed);
        for version in &versions[..surplus] {
            let path = self.root.join(version.to_string());
            fs::remove_dir_all(&path).map_err(failed("remove", &path))?;
        }
        Ok(())
    }

    /// [`PolicyFolder::add`], then [`PolicyFolder::set_current`].
    pub fn publish(&self, model: &[u8], contract: &Contract, reference: Option<&str>) -> Result<Version, FolderError> {
        let version = self.add(model, contract, reference)?;
        self.set_current(version)?;
        Ok(version)
    }
}

/// The file or folder that `name` means: itself, or the folder of that name in `policies/`.
pub fn locate(name: &Path) -> Result<PathBuf, FolderError> {
    let places = [name.to_owned(), Path::new(POLICIES).join(name)];
    let there = places.into_iter().find(|path| path.exists());
    there.ok_or_else(|| FolderError::NotThere { name: name.display().to_string() })
}

/// The model that `name` means: a file, the current version of a policies folder, or `actor.onnx` in it.
pub fn resolve(name: &Path) -> Result<PathBuf, FolderError> {
    let path = locate(name)?;
    if !path.is_dir() {
        return Ok(path);
    }
    let folder = PolicyFolder::new(&path);
    match folder.current()? {
        Some(version) => Ok(folder.model(version)),
        None if path.join(MODEL_FILE).exists() => Ok(path.join(MODEL_FILE)),
        None => Err(FolderError::NoPolicy(path.display().to_string())),
    }
}

fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> FolderError {
    let path = path.display().to_string();
    move |source| FolderError::Io { action, path, source }
}

fn now() -> Option<u64> {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).ok().map(|since| since.as_secs())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    let whole = || {
        let mut file = File::create(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    whole().map_err(failed("write", path))
}

fn sync(folder: &Path) -> Result<(), FolderError> {
    File::open(folder).and_then(|folder| folder.sync_all()).map_err(failed("sync", folder))
}

/// Replaces a file so that readers see the old or the new one, never half of it.
fn replace(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}", std::process::id()));
    let beside = path.with_file_name(name);
    write(&beside, bytes)?;
    fs::rename(&beside, path).map_err(failed("replace", path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, PolicyFolder) {
        let place = tempfile::tempdir().unwrap();
        let folder = PolicyFolder::new(place.path().join("mine"));
        (place, folder)
    }

    #[test]
    fn a_published_version_is_current_and_names_its_bytes() {
        let (_place, folder) = folder();
        assert_eq!(folder.current().unwrap(), None);
        let first = folder.publish(b"model", &Contract::standard(2, true), Some("{}")).unwrap();
        assert_eq!((first.to_string().as_str(), folder.current().unwrap()), ("v000001", Some(first)));
        let manifest = fs::read(folder.model(first).with_file_name(MANIFEST_FILE)).unwrap();
        let manifest = super::super::contract::from_json(&manifest, "m").unwrap();
        assert_eq!((manifest.bytes, manifest.version.as_deref()), (Some(5), Some("v000001")));
        assert_eq!(manifest.sha256, Some(sha256(b"model")));
        assert_eq!(resolve(folder.root()).unwrap(), folder.model(first));
    }

    #[test]
    fn a_version_that_is_only_added_is_not_current() {
        let (_place, folder) = folder();
        let contract = Contract::standard(2, true);
        let first = folder.publish(b"one", &contract, None).unwrap();
        let second = folder.add(b"two", &contract, None).unwrap();
        assert_eq!(folder.current().unwrap(), Some(first));
        assert_eq!(folder.versions().unwrap(), [first, second]);
        folder.set_current(second).unwrap();
        assert_eq!(folder.current().unwrap(), Some(second));
        assert!(folder.set_current(Version(9)).unwrap_err().to_string().contains("there is no version v000009"));
    }

    #[test]
    fn the_oldest_versions_go_and_the_current_one_and_its_predecessor_stay() {
        let (_place, folder) = folder();
        let contract = Contract::standard(2, true);
        for model in [b"1", b"2", b"3", b"4", b"5"] {
            folder.publish(model, &contract, None).unwrap();
        }
        folder.prune(3).unwrap();
        assert_eq!(folder.versions().unwrap(), [Version(3), Version(4), Version(5)]);
        folder.set_current(Version(4)).unwrap();
        folder.prune(0).unwrap();
        assert_eq!(folder.versions().unwrap(), [Version(3), Version(4), Version(5)]);
    }

    #[test]
    fn folders_in_the_making_and_strange_names_are_not_versions() {
        let (_place, folder) = folder();
        for name in [".adding-1", "v1", "v00000x", "v0000001", "other"] {
            fs::create_dir_all(folder.root().join(name)).unwrap();
        }
        assert_eq!(folder.versions().unwrap(), []);
        assert!(resolve(folder.root()).unwrap_err().to_string().contains("holds no policy"));
        let message = resolve(Path::new("no-such-policy")).unwrap_err().to_string();
        assert!(message.contains("neither no-such-policy nor policies/no-such-policy is there"), "{message}");
    }
}

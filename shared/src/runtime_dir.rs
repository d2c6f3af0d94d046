//! Where the shared files of one run live, and how leftovers of dead runs are found.
//!
//! The name of a place holds the process that owns it (its number and start time, so that a number
//! used again is no mistake). It is made by one `mkdir`: there is no moment at which a place exists
//! without saying whose it is.

use crate::os;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Every shared-memory file of ours starts like this.
const PREFIX: &str = "vodca_";
/// Name of the file in a place that everybody who takes part has locked.
const ATTENDEES: &str = "attendees";
/// Where shared-memory files appear.
const SHARED_MEMORY: &str = "/dev/shm";

/// Where the shared files of one run live.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuntimeDir {
    /// Start of the names of the run's shared-memory files.
    pub prefix: String,
    /// Folder of its sockets and service descriptions; short, for socket paths end at 107 bytes.
    pub root: String,
}

/// A place could not be made.
#[derive(Debug, thiserror::Error)]
#[error("cannot make the folder {} for the run's sockets: {source}; it must be writable for this user", path.display())]
pub struct RuntimeDirError {
    /// The folder.
    pub path: PathBuf,
    /// What the system said.
    pub source: io::Error,
}

impl fmt::Display for RuntimeDir {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} and {SHARED_MEMORY}/{}*", self.root, self.prefix)
    }
}

/// Folder of all places of this user.
fn base() -> PathBuf {
    PathBuf::from(format!("/tmp/vodca-{}", os::user_id()))
}

impl RuntimeDir {
    /// Makes a place that belongs to this process.
    pub fn create() -> Result<Self, RuntimeDirError> {
        let pid = std::process::id();
        let owner = format!("{pid:x}-{:x}", os::start_time(pid).unwrap_or_default());
        let base = base();
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| RuntimeDirError { path, source }
        };
        fs::create_dir_all(&base).map_err(failed(&base))?;
        // One process may run several teams, one after the other or (in tests) at once.
        for number in 0u32.. {
            let id = format!("{owner}-{number:x}");
            let root = base.join(&id);
            match fs::create_dir(&root) {
                Ok(()) => {
                    return Ok(Self { prefix: format!("{PREFIX}{id}_"), root: root.to_string_lossy().into_owned() });
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                // Another run, ending, took the empty folder with it.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    fs::create_dir_all(&base).map_err(failed(&base))?;
                }
                Err(error) => return Err(failed(&root)(error)),
            }
        }
        unreachable!("fewer than 2^32 teams at once")
    }

    /// Whether the run that owns this place goes on: its process lives and has not tidied up.
    pub fn is_owned(&self) -> bool {
        !owner_is_gone(self.id()) && Path::new(&self.root).is_dir()
    }

    /// Takes part in the run: whoever leaves as the last one after its owner has died tidies up.
    ///
    /// # Errors
    /// The place is gone.
    pub fn attend(&self) -> io::Result<Attendee> {
        let path = Path::new(&self.root).join(ATTENDEES);
        let file = File::options().read(true).write(true).create(true).truncate(false).open(path)?;
        file.lock_shared()?;
        Ok(Attendee { file, place: self.clone() })
    }

    fn id(&self) -> &str {
        self.prefix.trim_start_matches(PREFIX).trim_end_matches('_')
    }

    /// Deletes every file of this place. Call it when all its processes have ended.
    pub fn remove(&self) {
        remove_shared_memory(|prefix| prefix == self.id());
        let _ = fs::remove_dir_all(&self.root);
        let _ = fs::remove_dir(base()); // only when no other run is there
    }
}

/// A process that takes part in a run. Dropping it leaves the run; drop it after everything that uses the run's files.
#[derive(Debug)]
pub struct Attendee {
    /// Locked, shared, as long as this process takes part; the kernel unlocks it however it ends.
    file: File,
    place: RuntimeDir,
}

impl Drop for Attendee {
    fn drop(&mut self) {
        // Of several that leave at once the last one finds nobody's lock: each gives up its own before it looks.
        let alone = |file: &File| file.unlock().is_ok() && file.try_lock().is_ok();
        if !self.place.is_owned() && alone(&self.file) {
            self.place.remove();
        }
    }
}

/// Deletes what runs left whose owner is gone; says how many places that were. Robots of such runs
/// end by themselves (the kernel ends them with their coordinator).
pub fn sweep_leftovers() -> usize {
    let mut swept = 0;
    for entry in fs::read_dir(base()).into_iter().flatten().flatten() {
        if owner_is_gone(&entry.file_name().to_string_lossy()) && fs::remove_dir_all(entry.path()).is_ok() {
            swept += 1;
        }
    }
    remove_shared_memory(owner_is_gone);
    swept
}

/// Whether the owner that the id `PID-START-NUMBER` names has ended; not when it is no such id.
fn owner_is_gone(id: &str) -> bool {
    let mut parts = id.split('-').map(|part| u64::from_str_radix(part, 16));
    match (parts.next(), parts.next(), parts.next(), parts.next()) {
        (Some(Ok(pid)), Some(Ok(start)), Some(Ok(_)), None) => os::start_time(pid as u32) != Some(start),
        _ => false,
    }
}

/// Deletes the shared-memory files whose id (between the common prefix and the next `_`) is `chosen`.
fn remove_shared_memory(chosen: impl Fn(&str) -> bool) {
    for entry in fs::read_dir(SHARED_MEMORY).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let id = name.to_str().and_then(|name| name.strip_prefix(PREFIX)).and_then(|rest| rest.split_once('_'));
        if id.is_some_and(|(id, _)| chosen(id)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_unique_and_leaves_nothing() {
        let (first, second) = (RuntimeDir::create().unwrap(), RuntimeDir::create().unwrap());
        assert_ne!(first, second);
        let shared = format!("{SHARED_MEMORY}/{}x.data", first.prefix);
        fs::write(&shared, "x").unwrap();
        sweep_leftovers();
        assert!(Path::new(&first.root).exists() && Path::new(&shared).exists(), "its owner lives");
        first.remove();
        assert!(!Path::new(&first.root).exists() && !Path::new(&shared).exists());
        assert!(Path::new(&second.root).exists());
        second.remove();
    }

    #[test]
    fn the_last_one_that_leaves_a_run_without_an_owner_tidies_up() {
        let mut owner = std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let id = format!("{:x}-{:x}-0", owner.id(), os::start_time(owner.id()).unwrap());
        let root = base().join(&id);
        fs::create_dir_all(&root).unwrap();
        let place = RuntimeDir { prefix: format!("{PREFIX}{id}_"), root: root.to_string_lossy().into_owned() };
        let mut all: Vec<Attendee> = (0..3).map(|_| place.attend().unwrap()).collect();
        all.pop();
        assert!(root.exists(), "its owner lives and tidies up itself");
        owner.kill().unwrap();
        owner.wait().unwrap();
        drop(all); // a run that starts just now may have swept it already
        assert!(!root.exists());
    }

    #[test]
    fn leftovers_of_the_dead_are_swept_and_nothing_else() {
        // Process 1 lives, but did not start at clock tick 1: its number was used again.
        let id = format!("1-1-{:x}", std::process::id());
        let (root, shared) = (base().join(&id), format!("{SHARED_MEMORY}/{PREFIX}{id}_y.data"));
        let foreign = format!("{SHARED_MEMORY}/{PREFIX}note{}", std::process::id());
        fs::create_dir_all(&root).unwrap();
        fs::write(&shared, "y").unwrap();
        fs::write(&foreign, "not ours").unwrap();
        sweep_leftovers();
        assert!(!root.exists() && !Path::new(&shared).exists());
        assert!(Path::new(&foreign).exists());
        fs::remove_file(foreign).unwrap();
    }
}

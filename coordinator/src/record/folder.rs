//! The folder of a run: where it lies, and files that are either whole or absent.

use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Why a run could not be recorded. What was written before stays readable.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The folder cannot be made, or nothing can be written in it.
    #[error("cannot write to the run folder {}: {source}; choose a writable place with --out DIR", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The folder holds something already.
    #[error(
        "the run folder {} already holds {entry:?}; runs are never overwritten: give a new or an empty folder with --out DIR",
        path.display()
    )]
    NotEmpty {
        /// The folder.
        path: PathBuf,
        /// One of the entries.
        entry: String,
    },
    /// A file cannot be written.
    #[error(
        "cannot write {}: {source}; everything recorded before this stays readable; \
         free some space or choose another place with --out DIR", path.display()
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is there already.
    #[error("{} exists already; results are never written over: give another file with --out FILE", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A shard of rollouts cannot be written.
    #[error("{reason}; the shards written before are whole")]
    Rollout {
        /// What went wrong.
        reason: String,
    },
    /// A value has no form in the file's format.
    #[error("cannot express {what} in {}: {reason}; please report this as a fault of vodca", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What was to be written.
        what: &'static str,
        /// What the library said.
        reason: String,
    },
}

/// The folder of a run, empty when it was opened and locked until it is dropped.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    /// Locked as long as it is open.
    _claim: File,
}

/// Says that a run is writing to the folder: of two runs that are given one folder one can lock it. The lock
/// of a run that was killed ends with it; the file is swept by the next run.
const CLAIM: &str = ".claimed";

impl Drop for RunFolder {
    fn drop(&mut self) {
        let _ = fs::remove_file(self.file(CLAIM)); // best effort: it does no harm in a folder that is full
    }
}

impl RunFolder {
    /// Makes `out`, or `runs/<UTC time>-<scenario>-<robots>` below the current folder.
    pub fn create(out: Option<&Path>, scenario: &str, robots: usize) -> Result<Self, RecordError> {
        match out {
            Some(path) => Self::at(path),
            None => Self::named(None, &format!("{}-{robots}", plain(scenario))),
        }
    }

    /// Makes `out`, or `runs/<UTC time>-<name>` below the current folder.
    pub fn named(out: Option<&Path>, name: &str) -> Result<Self, RecordError> {
        match out {
            Some(path) => Self::at(path),
            None => Self::fresh(Path::new("runs"), &format!("{}-{}", utc_now(), plain(name))),
        }
    }

    /// The folder `path`, made when absent; it must be empty and writable.
    pub fn at(path: &Path) -> Result<Self, RecordError> {
        let refused = |source| RecordError::Folder { path: path.to_owned(), source };
        let not_empty = |entry| RecordError::NotEmpty { path: path.to_owned(), entry };
        let first_entry = || -> Result<Option<String>, RecordError> {
            for entry in fs::read_dir(path).map_err(refused)? {
                let name = entry.map_err(refused)?.file_name().to_string_lossy().into_owned();
                if name != CLAIM {
                    return Ok(Some(name));
                }
            }
            Ok(None)
        };
        fs::create_dir_all(path).map_err(refused)?;
        if let Some(entry) = first_entry()? {
            return Err(not_empty(entry));
        }
        // This also finds out now, rather than after the team has started, whether anything can be written.
        let Some(claim) = claim(&path.join(CLAIM)).map_err(refused)? else { return Err(not_empty(CLAIM.into())) };
        let folder = Self { path: path.to_owned(), _claim: claim };
        // Another run may have come and gone between the look and the claim.
        match first_entry()? {
            Some(entry) => Err(not_empty(entry)),
            None => Ok(folder),
        }
    }

    /// `parent/name`, or `parent/name-2` and so on when another run took that name in the same second.
    fn fresh(parent: &Path, name: &str) -> Result<Self, RecordError> {
        fs::create_dir_all(parent).map_err(|source| RecordError::Folder { path: parent.to_owned(), source })?;
        sweep_claims(parent);
        for attempt in 1.. {
            let path = parent.join(if attempt == 1 { name.to_owned() } else { format!("{name}-{attempt}") });
            match fs::create_dir(&path) {
                Ok(()) => return Self::at(&path),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < 1000 => {}
                Err(source) => return Err(RecordError::Folder { path, source }),
            }
        }
        unreachable!("the loop returns at the latest at its thousandth turn")
    }

    /// Where it lies.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a whole file: beside its place first, then renamed, so that a reader (or a cut run) never
    /// sees half of it.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), RecordError> {
        let (path, beside) = (self.file(name), self.file(&format!(".{name}.part")));
        let written = File::create(&beside)
            .and_then(|mut file| file.write_all(content).and_then(|()| file.sync_all()))
            .and_then(|()| fs::rename(&beside, &path));
        written.map_err(|source| {
            let _ = fs::remove_file(&beside); // best effort: the error that is reported matters more
            RecordError::Write { path, source }
        })
    }
}

/// Makes and locks the file; `None`: somebody else has it.
fn claim(path: &Path) -> io::Result<Option<File>> {
    // A sweep holds the lock of a claim for an instant, too.
    for _ in 0..20 {
        let file = File::options().write(true).create(true).truncate(false).open(path)?;
        match file.try_lock() {
            // It may have been deleted between the two calls: then another file has its name, or none.
            Ok(()) if fs::metadata(path).is_ok_and(|named| Some(named.ino()) == inode(&file)) => return Ok(Some(file)),
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(5)),
            Err(TryLockError::Error(error)) => return Err(error),
        }
    }
    Ok(None)
}

fn inode(file: &File) -> Option<u64> {
    file.metadata().ok().map(|about| about.ino())
}

/// Deletes the claims of runs in `parent` that were killed.
fn sweep_claims(parent: &Path) {
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let path = entry.path().join(CLAIM);
        // Best effort: a claim that stays does no harm.
        let _ = File::open(&path).is_ok_and(|file| file.try_lock().is_ok() && fs::remove_file(&path).is_ok());
    }
}

/// `out`, which must not exist yet, or a new `runs/<UTC time>-<name>.<ending>` whose folder exists.
pub fn new_file(out: Option<&Path>, name: &str, ending: &str) -> Result<PathBuf, RecordError> {
    if let Some(path) = out.map(Path::to_owned) {
        return if path.symlink_metadata().is_ok() { Err(RecordError::Exists { path }) } else { Ok(path) };
    }
    let runs = Path::new("runs");
    fs::create_dir_all(runs).map_err(|source| RecordError::Folder { path: runs.to_owned(), source })?;
    let name = format!("{}-{}", utc_now(), plain(name));
    let numbered = |attempt| {
        runs.join(if attempt == 1 { format!("{name}.{ending}") } else { format!("{name}-{attempt}.{ending}") })
    };
    Ok((1..1000).map(numbered).find(|path| !path.exists()).unwrap_or_else(|| numbered(1000)))
}

/// Writes a file that can be made again at any time, in place of an older one.
pub fn replace(path: &Path, content: &[u8]) -> Result<(), RecordError> {
    fs::write(path, content).map_err(|source| RecordError::Write { path: path.to_owned(), source })
}

/// Writes a file that must not exist yet.
pub fn write_new(path: &Path, content: &[u8]) -> Result<(), RecordError> {
    let written = File::create_new(path).and_then(|mut file| file.write_all(content));
    written.map_err(|source| match source.kind() {
        io::ErrorKind::AlreadyExists => RecordError::Exists { path: path.to_owned() },
        _ => RecordError::Write { path: path.to_owned(), source },
    })
}

/// A file that grows record by record. When a write fails midway the file is cut back to its last whole
/// record, so that a full disk leaves a readable file.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    file: File,
    whole: u64,
}

impl GrowingFile {
    /// Makes the file; it must not exist unless it is a device.
    pub fn create(path: PathBuf) -> Result<Self, RecordError> {
        let is_device = fs::metadata(&path).is_ok_and(|about| !about.is_file() && !about.is_dir());
        let made = if is_device { File::create(&path) } else { File::create_new(&path) };
        match made {
            Ok(file) => Ok(Self { path, file, whole: 0 }),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                let entry = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                Err(RecordError::NotEmpty { path: path.parent().unwrap_or(Path::new(".")).to_owned(), entry })
            }
            Err(source) => Err(RecordError::Write { path, source }),
        }
    }

    /// Appends `record` and hands it to the operating system at once.
    pub fn append(&mut self, record: &[u8]) -> Result<(), RecordError> {
        match self.file.write_all(record) {
            Ok(()) => {
                self.whole += record.len() as u64;
                Ok(())
            }
            Err(source) => {
                let _ = self.file.set_len(self.whole); // devices cannot be cut; the write error is what counts
                Err(RecordError::Write { path: self.path.clone(), source })
            }
        }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes sure that everything is on the disk.
    pub fn sync(&self) -> Result<(), RecordError> {
        self.file.sync_all().map_err(|source| RecordError::Write { path: self.path.clone(), source })
    }
}

/// `name` as part of a file name: `ring:16` becomes `ring-16`.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' }).collect()
}

/// The present second in UTC as `20260131-235959`.
fn utc_now() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    utc(seconds)
}

/// Seconds since 1970 as `20260131-235959` (proleptic Gregorian calendar, years counted from March so
/// that the leap day comes last).
fn utc(seconds: u64) -> String {
    let (days, second) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let era_day = days % 146_097;
    let era_year = (era_day - era_day / 1_460 + era_day / 36_524 - era_day / 146_096) / 365;
    let day_of_year = era_day - (365 * era_year + era_year / 4 - era_year / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    let year = days / 146_097 * 400 + era_year + u64::from(month <= 2);
    let (hour, minute, second) = (second / 3_600, second / 60 % 60, second % 60);
    format!("{year:04}{month:02}{day:02}-{hour:02}{minute:02}{second:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_with_something_in_it_is_refused() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("old.csv"), "kept").unwrap();
        let message = RunFolder::at(place.path()).unwrap_err().to_string();
        assert!(message.contains("old.csv") && message.contains("--out"), "{message}");
        assert_eq!(fs::read(place.path().join("old.csv")).unwrap(), b"kept");
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_one_clear_error() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("file"), "").unwrap();
        let message = RunFolder::at(&place.path().join("file/below")).unwrap_err().to_string();
        assert!(message.starts_with("cannot write to the run folder") && message.contains("--out"), "{message}");
    }

    #[test]
    fn two_runs_in_one_second_get_two_folders() {
        let place = tempfile::tempdir().unwrap();
        let first = RunFolder::fresh(place.path(), "now-ring-4").unwrap();
        let second = RunFolder::fresh(place.path(), "now-ring-4").unwrap();
        assert_ne!(first.path(), second.path());
        assert!(second.path().ends_with("now-ring-4-2"));
    }

    #[test]
    fn a_file_is_whole_and_nothing_stays_beside_it() {
        let place = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(&place.path().join("new/run")).unwrap();
        folder.write("a.txt", b"one").unwrap();
        folder.write("a.txt", b"two").unwrap();
        assert_eq!(fs::read(folder.file("a.txt")).unwrap(), b"two");
        drop(folder);
        assert_eq!(fs::read_dir(place.path().join("new/run")).unwrap().count(), 1);
    }

    #[test]
    fn the_claim_of_a_run_that_was_killed_is_swept_and_that_of_a_living_one_is_not() {
        let place = tempfile::tempdir().unwrap();
        let living = RunFolder::fresh(place.path(), "living").unwrap();
        let killed = place.path().join("killed");
        fs::create_dir(&killed).unwrap();
        fs::write(killed.join(CLAIM), "").unwrap(); // nobody holds its lock
        // Nothing else is in it: a run may have the folder.
        assert!(RunFolder::at(&killed).is_ok());
        fs::write(killed.join(CLAIM), "").unwrap();
        let next = RunFolder::fresh(place.path(), "next").unwrap();
        assert!(!killed.join(CLAIM).exists());
        assert!(living.file(CLAIM).exists() && next.file(CLAIM).exists());
        let message = RunFolder::at(living.path()).unwrap_err().to_string();
        assert!(message.contains("already holds \".claimed\""), "{message}");
    }

    #[test]
    fn of_many_runs_with_one_folder_one_gets_it() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("run");
        let gate = std::sync::Barrier::new(8);
        let open = || {
            gate.wait();
            RunFolder::at(&path)
        };
        let opened: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..8).map(|_| scope.spawn(open)).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!(opened.iter().filter(|folder| folder.is_ok()).count(), 1);
        let refused = opened.into_iter().filter_map(Result::err);
        assert!(refused.into_iter().all(|error| error.to_string().contains("never overwritten")));
    }

    #[test]
    fn a_growing_file_is_never_put_over_another() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("trajectory.csv");
        fs::write(&path, "kept").unwrap();
        let message = GrowingFile::create(path.clone()).unwrap_err().to_string();
        assert!(message.contains("already holds \"trajectory.csv\""), "{message}");
        assert_eq!(fs::read(path).unwrap(), b"kept");
    }

    #[test]
    fn a_full_disk_is_one_clear_error() {
        let mut file = GrowingFile::create(PathBuf::from("/dev/full")).unwrap();
        let message = file.append(b"row\n").unwrap_err().to_string();
        assert!(message.contains("/dev/full") && message.contains("stays readable"), "{message}");
    }

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(utc(0), "19700101-000000");
        assert_eq!(utc(951_827_696), "20000229-123456");
        assert_eq!(utc(1_798_761_599), "20261231-235959");
    }

    #[test]
    fn scenario_names_become_plain_file_names() {
        assert_eq!(plain("box:16:3:7"), "box-16-3-7");
        assert_eq!(plain("../x"), "---x");
    }
}

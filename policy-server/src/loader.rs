//! Watches the folder of a run, checks and loads what becomes current there, and writes STATUS.json.
//! Runs in a thread of its own: loading never touches the serving path.

use crate::actor::{BackEndError, Runtime};
use crate::check::{Candidate, CheckError, Prober, look, try_out};
use crate::hot_swap::{Event, Loaded, Order};
use crate::try_error::TryError;
use policy::folder::{FolderError, PolicyFolder, Rejected, Serving, Status, Version};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, SystemTime};
use tracing::{error, info, warn};

/// Why no model could be loaded at the start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The back-end does not start.
    #[error(transparent)]
    BackEnd(#[from] BackEndError),
    /// No version passes.
    #[error("no version in {folder} may act; the current one: {current}")]
    NoneUsable {
        /// The folder.
        folder: String,
        /// Why the current one may not.
        current: String,
    },
}

/// What is watched, and for whom.
#[derive(Clone, Debug)]
pub struct Watched {
    /// The run's own policies folder.
    pub folder: PolicyFolder,
    /// Number of robots.
    pub robots: usize,
    /// Where the policy came from; a change there is brought in as a new version.
    pub upstream: Option<PathBuf>,
    /// Time between two looks.
    pub poll: Duration,
}

/// A file as it was seen: any change of it is looked at again.
type Seen = Option<(PathBuf, u64, Option<SystemTime>, Option<SystemTime>)>;

/// The thread that loads.
pub struct Loader {
    watched: Watched,
    prober: Prober,
    runtime: Runtime,
    orders: Sender<Order>,
    status: Status,
    /// SHA-256 of models that are not tried again.
    refused: BTreeSet<String>,
    seen: Seen,
    seen_upstream: Seen,
    /// Orders that the serving thread has not carried out yet.
    outstanding: usize,
}

impl Loader {
    /// Starts the back-end and loads the current version or, when that may not act, the newest one
    /// that may. The first order is sent before this returns.
    pub fn start(watched: Watched, prober: Prober, orders: Sender<Order>) -> Result<Self, StartError> {
        let runtime = Runtime::start(&prober.back_end)?;
        let status = Status { pid: std::process::id(), ..Status::default() };
        let seen_upstream = watched.upstream.as_deref().and_then(|path| see(&policy::folder::resolve(path).ok()?));
        let mut loader = Self {
            watched,
            prober,
            runtime,
            orders,
            status,
            refused: BTreeSet::new(),
            seen: None,
            seen_upstream,
            outstanding: 0,
        };
        let folder = &loader.watched.folder;
        let current = folder.current()?.ok_or_else(|| FolderError::NoPolicy(folder.root().display().to_string()))?;
        let mut others = folder.versions()?;
        others.retain(|version| *version != current);
        loader.seen = see(&loader.watched.folder.model(current));
        let first = std::iter::once(current).chain(others.into_iter().rev()).find(|version| loader.take(*version));
        let written = loader.write_status();
        if first.is_none() {
            let current = loader.status.rejected.first().map(|rejected| rejected.error.clone()).unwrap_or_default();
            return Err(StartError::NoneUsable { folder: loader.watched.folder.root().display().to_string(), current });
        }
        written?;
        Ok(loader)
    }

    /// Looks, loads and writes down until the serving thread is gone.
    pub fn run(mut self, events: &Receiver<Event>) {
        loop {
            match events.recv_timeout(self.watched.poll) {
                Ok(event) => self.write_down(event),
                Err(RecvTimeoutError::Timeout) => self.look_around(),
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    fn look_around(&mut self) {
        self.bring_in();
        let version = match self.watched.folder.current() {
            Ok(Some(version)) => version,
            Ok(None) => return,
            Err(trouble) => return self.trouble(trouble.to_string()),
        };
        let now = see(&self.watched.folder.model(version));
        if now == self.seen {
            return;
        }
        self.seen = now;
        self.take(version);
        if let Err(trouble) = self.write_status() {
            warn!("{trouble}");
        }
    }

    /// Copies a changed upstream policy into the run's folder and makes it current there.
    fn bring_in(&mut self) {
        let Some(upstream) = &self.watched.upstream else { return };
        let Ok(file) = policy::folder::resolve(upstream) else { return };
        let now = see(&file);
        if now.is_none() || now == self.seen_upstream {
            return;
        }
        self.seen_upstream = now;
        match look(&file, Some(self.watched.robots), &self.prober.limits) {
            Ok(candidate) => {
                if let Err(trouble) = import(&self.watched.folder, &candidate) {
                    self.trouble(trouble.to_string());
                }
            }
            Err(error) => self.reject(file.display().to_string(), String::new(), &error),
        }
    }

    /// Checks and loads `version` and orders the switch; `false` when it may not act.
    fn take(&mut self, version: Version) -> bool {
        let file = self.watched.folder.model(version);
        let candidate = match look(&file, Some(self.watched.robots), &self.prober.limits) {
            Ok(candidate) => candidate,
            Err(error) => {
                self.reject(version.to_string(), String::new(), &error);
                return false;
            }
        };
        let digest = candidate.sha256.clone();
        if self.refused.contains(&digest) {
            info!("policy {version} has the bytes of a model that was refused before; it is not tried again");
            return false;
        }
        let serves = |serving: &Option<Serving>| serving.as_ref().is_some_and(|serving| serving.sha256 == digest);
        let acting = serves(&self.status.serving)
            && self.status.serving.as_ref().is_some_and(|serving| serving.version == version.to_string());
        // What STATUS says holds only when no order is on its way.
        let order = if acting && self.outstanding == 0 {
            return true;
        } else if serves(&self.status.previous) && self.outstanding == 0 {
            Order::Rollback { version, sha256: digest }
        } else {
            match self.load(&candidate, version) {
                Ok(loaded) => Order::Switch(Box::new(loaded)),
                Err(error) => {
                    self.refused.insert(digest.clone());
                    self.reject(version.to_string(), digest, &error);
                    return false;
                }
            }
        };
        self.outstanding += 1;
        // The serving thread is gone only when the process ends.
        self.orders.send(order).is_ok()
    }

    fn load(&self, candidate: &Candidate, version: Version) -> Result<Loaded, CheckError> {
        self.prober.try_out(candidate)?;
        let failed = |source: TryError| CheckError::Try { file: candidate.file.display().to_string(), source };
        let Candidate { bytes, contract, reference, sha256, .. } = candidate;
        let (actor, report) =
            try_out(&self.runtime, bytes, contract, reference.as_ref(), &self.prober.limits).map_err(failed)?;
        info!(
            "policy {version} (sha256 {}) is warm after {} us, {} us per inference",
            &sha256[..12],
            report.load_us,
            report.inference_ns / 1_000
        );
        Ok(Loaded { actor, version, sha256: sha256.clone(), since_tick: None })
    }

    fn write_down(&mut self, event: Event) {
        match event {
            Event::Switched { tick, serving, previous, retired } => {
                drop(retired);
                self.outstanding = self.outstanding.saturating_sub(1);
                info!("policy {} (sha256 {}) acts from tick {tick} on", serving.version, &serving.sha256[..12]);
                self.status.serving = Some(serving);
                self.status.previous = previous;
            }
            Event::Gone => {
                // Looked at anew, it is loaded from its file.
                self.outstanding = self.outstanding.saturating_sub(1);
                self.seen = None;
            }
            Event::Failed { tick, failed, serving, reason } => {
                error!("policy {} failed at tick {tick}: {reason}; the previous one acts again", failed.version);
                self.refused.insert(failed.sha256.clone());
                self.status.own_rollbacks += 1;
                let error = format!("failed at tick {tick}: {reason}");
                self.status.reject(Rejected { version: failed.version, sha256: failed.sha256, error });
                self.status.previous = None;
                self.go_back_to(&serving);
                self.status.serving = serving;
            }
        }
        if let Err(trouble) = self.write_status() {
            warn!("{trouble}");
        }
    }

    /// CURRENT names what acts, so that a restarted server starts with it.
    fn go_back_to(&mut self, serving: &Option<Serving>) {
        let Some(version) = serving.as_ref().and_then(|serving| serving.version.parse().ok()) else { return };
        match self.watched.folder.set_current(version) {
            Ok(()) => self.seen = see(&self.watched.folder.model(version)),
            Err(trouble) => self.trouble(trouble.to_string()),
        }
    }

    fn reject(&mut self, version: String, sha256: String, error: &CheckError) {
        error!("policy {version} refused: {error}; the one before goes on");
        self.status.reject(Rejected { version, sha256, error: error.to_string() });
    }

    fn trouble(&mut self, trouble: String) {
        if self.status.last_error.as_ref() != Some(&trouble) {
            warn!("{trouble}");
            self.status.last_error = Some(trouble);
        }
    }

    fn write_status(&self) -> Result<(), FolderError> {
        self.watched.folder.write_status(&self.status)
    }
}

/// Adds a model that passed [`look`] to `folder` and makes it current there.
pub fn import(folder: &PolicyFolder, candidate: &Candidate) -> Result<Version, FolderError> {
    let reference = candidate.reference.as_ref().and_then(|set| serde_json::to_string_pretty(set).ok());
    folder.publish(&candidate.bytes, &candidate.contract, reference.as_deref())
}

/// What is there now; `None` when there is no such file.
fn see(model: &std::path::Path) -> Seen {
    let meta = std::fs::metadata(model).ok()?;
    let manifest = std::fs::metadata(model.with_file_name(policy::folder::MANIFEST_FILE)).ok();
    let manifest = manifest.and_then(|meta| meta.modified().ok());
    Some((model.to_path_buf(), meta.len(), meta.modified().ok(), manifest))
}

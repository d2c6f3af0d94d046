//! Requests to stop: SIGINT, SIGTERM and SIGHUP only set a flag; the loops look at it.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that is set once somebody asked this process to stop.
#[derive(Clone, Debug, Default)]
pub struct StopFlag(Arc<AtomicBool>);

impl StopFlag {
    /// Catches the signals from now on. Call it first in `main`: nothing exists yet that an
    /// uncaught signal could leave behind.
    ///
    /// iceoryx2 installs handlers of its own when it first needs them and remembers only the last
    /// signal of any kind, so a request can get lost there; ours go on top of them.
    pub fn install() -> io::Result<Self> {
        crate::services::settle_signal_handlers();
        let flag = Self::default();
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
            signal_hook::flag::register(signal, flag.0.clone())?;
        }
        Ok(flag)
    }

    /// Whether this process shall end.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Asks this process to end, as a signal would.
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

//! A process's part in a run: it ends with the process that started it, even when the robot hangs, and the last one that
//! leaves tidies up after a coordinator that was killed.

use shared::os::{self, ProcessHandle};
use shared::runtime_dir::Attendee;
use shared::stop::StopFlag;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How long a robot has to end by itself when the process that started it has ended.
const GRACE: Duration = Duration::from_secs(1);

/// Takes part until it is dropped.
pub(crate) struct Part(Arc<Mutex<Option<Attendee>>>);

impl Part {
    pub(crate) fn of(attendee: Option<Attendee>) -> Self {
        Self(Arc::new(Mutex::new(attendee)))
    }

    /// Watches process `parent` in a thread of its own: when it ends, this one is asked to stop, and ended if it does
    /// not. `false`: the parent has ended already.
    pub(crate) fn ends_with(&self, parent: u32, stop: &StopFlag) -> bool {
        let Some(handle) = ProcessHandle::open(parent).filter(|_| os::wake_with_parent(parent)) else { return false };
        let (stop, part) = (stop.clone(), Self(self.0.clone()));
        thread::spawn(move || {
            handle.wait();
            stop.set();
            thread::sleep(GRACE);
            drop(part);
            std::process::exit(1);
        });
        true
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
    }
}

//! How many look on. Each viewer has a thread of its own, so their number has a limit.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Most viewers that are served at a time.
const MOST: usize = 8;
/// How long the end of a run waits for viewers to take the last frame.
const FAREWELL: Duration = Duration::from_millis(500);

/// Counts those who are there.
#[derive(Clone, Debug, Default)]
pub(super) struct Viewers(Arc<AtomicUsize>);

/// One of them, until it is dropped.
#[derive(Debug)]
pub(super) struct Guest(Arc<AtomicUsize>);

impl Drop for Guest {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

impl Viewers {
    /// Lets one in; `None`: there are enough.
    pub(super) fn enter(&self) -> Option<Guest> {
        let one_more = |count| (count < MOST).then_some(count + 1);
        self.0.fetch_update(Ordering::AcqRel, Ordering::Acquire, one_more).ok()?;
        Some(Guest(self.0.clone()))
    }

    /// Gives those who are there a moment to leave by themselves.
    pub(super) fn farewell(&self) {
        let start = Instant::now();
        while self.0.load(Ordering::Acquire) > 0 && start.elapsed() < FAREWELL {
            thread::sleep(Duration::from_millis(5));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_room_for_so_many_and_again_when_one_leaves() {
        let viewers = Viewers::default();
        let mut guests: Vec<Guest> = std::iter::from_fn(|| viewers.enter()).collect();
        assert_eq!(guests.len(), MOST);
        guests.pop();
        assert!(viewers.enter().is_some());
    }
}

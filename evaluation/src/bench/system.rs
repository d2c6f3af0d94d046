//! What the floors are made of: a shared page with slots of the size of a plan, futex and eventfd.

use rustix::event::{EventfdFlags, PollFd, PollFlags, Timespec, eventfd, poll};
use shared::messages::Plan;
use shared::raw::{SharedPage, futex_wait};
use std::io;
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd};
use std::path::Path;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// 64-bit words of a plan, the payload that every link and the floor carry.
pub(super) const PLAN_WORDS: usize = size_of::<Plan>() / 8;

/// A shared page: control words, and slots of the size of a plan.
pub(super) struct PlanPage(SharedPage);

impl PlanPage {
    /// Makes the file `path`.
    pub(super) fn create(path: &Path, words: usize, slots: usize) -> io::Result<Self> {
        SharedPage::create(path, words, slots * PLAN_WORDS).map(Self)
    }

    /// Opens a file that [`Self::create`] made with the same numbers.
    pub(super) fn open(path: &Path, words: usize, slots: usize) -> io::Result<Self> {
        SharedPage::open(path, words, slots * PLAN_WORDS).map(Self)
    }

    /// Control word `index`.
    pub(super) fn word(&self, index: usize) -> &AtomicU32 {
        self.0.word(index)
    }

    /// Slot `index`.
    pub(super) fn slot(&self, index: usize) -> &[AtomicU64; PLAN_WORDS] {
        &self.0.numbers().as_chunks().0[index]
    }
}

/// Waits until `done(word)`, for `limit` at most; the last value.
pub(super) fn wait_until(word: &AtomicU32, limit: Duration, done: impl Fn(u32) -> bool) -> Option<u32> {
    let end = Instant::now() + limit;
    loop {
        let value = word.load(Ordering::Acquire);
        if done(value) {
            return Some(value);
        }
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return None;
        }
        futex_wait(word, value, left);
    }
}

/// A counter of the kernel that a child inherits.
#[derive(Debug)]
pub(super) struct EventFd(OwnedFd);

impl EventFd {
    /// A new one.
    pub(super) fn new() -> io::Result<Self> {
        Ok(Self(eventfd(0, EventfdFlags::NONBLOCK)?))
    }

    /// The one that the parent had under this number.
    pub(super) fn inherited(number: i32) -> Self {
        // SAFETY: the parent left it open for this process, and nothing else here knows of it. Of a wrong
        // number every use fails.
        Self(unsafe { OwnedFd::from_raw_fd(number) })
    }

    /// Its number, for a child.
    pub(super) fn number(&self) -> i32 {
        self.0.as_raw_fd()
    }

    /// Counts one up and wakes who waits.
    pub(super) fn signal(&self) -> io::Result<()> {
        rustix::io::write(&self.0, &1u64.to_ne_bytes())?;
        Ok(())
    }

    /// Waits until it was signalled and takes that back; `false`: not within `limit`.
    pub(super) fn wait(&self, limit: Duration) -> io::Result<bool> {
        let limit = Timespec { tv_sec: limit.as_secs() as i64, tv_nsec: i64::from(limit.subsec_nanos()) };
        let mut wanted = [PollFd::new(&self.0, PollFlags::IN)];
        if poll(&mut wanted, Some(&limit)).unwrap_or(0) == 0 {
            return Ok(false);
        }
        rustix::io::read(&self.0, &mut [0u8; 8])?;
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::fd::IntoRawFd;

    #[test]
    fn a_wait_has_an_end_and_sees_what_another_process_counts() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("page");
        let (page, theirs) = (PlanPage::create(&path, 1, 3).unwrap(), PlanPage::open(&path, 1, 3).unwrap());
        assert_eq!(wait_until(page.word(0), Duration::from_millis(5), |value| value > 0), None);
        theirs.slot(2)[PLAN_WORDS - 1].store(9, Ordering::Relaxed);
        theirs.word(0).store(3, Ordering::Release);
        assert_eq!(wait_until(page.word(0), Duration::from_secs(20), |value| value > 0), Some(3));
        assert_eq!(page.slot(2)[PLAN_WORDS - 1].load(Ordering::Relaxed), 9);
        let event = EventFd::new().unwrap();
        assert!(!event.wait(Duration::from_millis(5)).unwrap());
        event.signal().unwrap();
        let inherited = EventFd::inherited(event.0.try_clone().unwrap().into_raw_fd());
        assert!(inherited.wait(Duration::from_secs(20)).unwrap());
    }
}

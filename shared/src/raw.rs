//! Memory that processes share, and how they wake each other: page, futex, eventfd. The only file that
//! imports `libc`.

use crate::messages::Plan;
use std::fs::File;
use std::io;
use std::os::fd::AsRawFd;
use std::path::Path;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::time::Duration;

/// Words of a plan, the payload that everything here carries.
pub const PLAN_WORDS: usize = size_of::<Plan>() / 8;
/// Control words lie on cache lines of their own.
const LINE: usize = 64;

/// Memory that several processes see: control words and slots of the size of a plan.
#[derive(Debug)]
pub struct SharedPage {
    start: NonNull<u8>,
    words: usize,
    slots: usize,
}

// SAFETY: all access goes through atomics, and the mapping belongs to no thread.
unsafe impl Sync for SharedPage {}
// SAFETY: as above.
unsafe impl Send for SharedPage {}

impl SharedPage {
    /// Makes the file `path`, filled with zeros.
    pub fn create(path: &Path, words: usize, slots: usize) -> io::Result<Self> {
        let file = File::options().read(true).write(true).create_new(true).open(path)?;
        file.set_len(Self::size(words, slots) as u64)?;
        Self::map(&file, words, slots)
    }

    /// Opens a file that [`Self::create`] made with the same numbers.
    pub fn open(path: &Path, words: usize, slots: usize) -> io::Result<Self> {
        let file = File::options().read(true).write(true).open(path)?;
        if file.metadata()?.len() < Self::size(words, slots) as u64 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Self::map(&file, words, slots)
    }

    fn size(words: usize, slots: usize) -> usize {
        words * LINE + slots * PLAN_WORDS * 8
    }

    fn map(file: &File, words: usize, slots: usize) -> io::Result<Self> {
        let (size, access) = (Self::size(words, slots), libc::PROT_READ | libc::PROT_WRITE);
        // SAFETY: a new mapping of a file of at least this size; nothing else of ours lies there.
        let start = unsafe { libc::mmap(std::ptr::null_mut(), size, access, libc::MAP_SHARED, file.as_raw_fd(), 0) };
        if start == libc::MAP_FAILED {
            return Err(io::Error::last_os_error());
        }
        let start = NonNull::new(start.cast()).ok_or_else(io::Error::last_os_error)?;
        Ok(Self { start, words, slots })
    }

    /// Control word `index`.
    pub fn word(&self, index: usize) -> &AtomicU32 {
        assert!(index < self.words);
        // SAFETY: inside the mapping, aligned to a line, and only ever accessed as an atomic.
        unsafe { self.start.add(index * LINE).cast().as_ref() }
    }

    /// Slot `index`.
    pub fn slot(&self, index: usize) -> &[AtomicU64; PLAN_WORDS] {
        assert!(index < self.slots);
        // SAFETY: inside the mapping, aligned to 8, and only ever accessed as atomics.
        unsafe { self.start.add(self.words * LINE + index * PLAN_WORDS * 8).cast().as_ref() }
    }
}

impl Drop for SharedPage {
    fn drop(&mut self) {
        // SAFETY: the mapping of `map`, which nobody borrows any more.
        unsafe { libc::munmap(self.start.as_ptr().cast(), Self::size(self.words, self.slots)) };
    }
}

/// Why a wait ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Woken {
    /// The word may have changed.
    Perhaps,
    /// A signal came.
    Signal,
    /// The time was over.
    Late,
}

/// Waits while `word` is `seen`, for `limit` at most.
pub fn futex_wait(word: &AtomicU32, seen: u32, limit: Duration) -> Woken {
    let limit =
        libc::timespec { tv_sec: limit.as_secs() as libc::time_t, tv_nsec: limit.subsec_nanos() as libc::c_long };
    // SAFETY: the word outlives the call; the kernel only compares it.
    let done = unsafe { libc::syscall(libc::SYS_futex, word.as_ptr(), libc::FUTEX_WAIT, seen, &raw const limit) };
    match if done == 0 { None } else { io::Error::last_os_error().raw_os_error() } {
        Some(libc::EINTR) => Woken::Signal,
        Some(libc::ETIMEDOUT) => Woken::Late,
        _ => Woken::Perhaps,
    }
}

/// Wakes up to `count` processes that wait for `word`.
pub fn futex_wake(word: &AtomicU32, count: u32) {
    // SAFETY: the word is only used as an address.
    unsafe { libc::syscall(libc::SYS_futex, word.as_ptr(), libc::FUTEX_WAKE, count) };
}

/// Waits until `done(word)`, for `limit` at most; the last value.
pub fn wait_until(word: &AtomicU32, limit: Duration, done: impl Fn(u32) -> bool) -> Option<u32> {
    let end = std::time::Instant::now() + limit;
    loop {
        let value = word.load(Ordering::Acquire);
        if done(value) {
            return Some(value);
        }
        let left = end.saturating_duration_since(std::time::Instant::now());
        if left.is_zero() {
            return None;
        }
        futex_wait(word, value, left);
    }
}

/// A counter of the kernel that a child inherits. It stays open until the process ends.
#[derive(Clone, Copy, Debug)]
pub struct EventFd(i32);

impl EventFd {
    /// A new one.
    pub fn new() -> io::Result<Self> {
        // SAFETY: takes numbers only.
        let number = unsafe { libc::eventfd(0, libc::EFD_NONBLOCK) };
        if number < 0 { Err(io::Error::last_os_error()) } else { Ok(Self(number)) }
    }

    /// The one that the parent has under this number.
    pub fn inherited(number: i32) -> Self {
        Self(number)
    }

    /// Its number, for a child.
    pub fn number(self) -> i32 {
        self.0
    }

    /// Counts one up and wakes who waits.
    pub fn signal(self) -> io::Result<()> {
        let one = 1u64;
        // SAFETY: eight bytes that live until the call returns.
        let written = unsafe { libc::write(self.0, (&raw const one).cast(), 8) };
        if written == 8 { Ok(()) } else { Err(io::Error::last_os_error()) }
    }

    /// Waits until it was signalled and takes that back; `false`: not within `limit`.
    pub fn wait(self, limit: Duration) -> io::Result<bool> {
        let mut wanted = libc::pollfd { fd: self.0, events: libc::POLLIN, revents: 0 };
        // SAFETY: one entry that lives until the call returns.
        let ready = unsafe { libc::poll(&raw mut wanted, 1, limit.as_millis() as i32) };
        if ready <= 0 {
            return Ok(false);
        }
        let mut count = 0u64;
        // SAFETY: eight bytes that live until the call returns.
        let read = unsafe { libc::read(self.0, (&raw mut count).cast(), 8) };
        if read == 8 { Ok(true) } else { Err(io::Error::last_os_error()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_mappings_of_a_page_are_one_memory() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("page");
        let (ours, theirs) = (SharedPage::create(&path, 2, 3).unwrap(), SharedPage::open(&path, 2, 3).unwrap());
        ours.word(1).store(7, Ordering::Release);
        ours.slot(2)[PLAN_WORDS - 1].store(9, Ordering::Relaxed);
        assert_eq!(theirs.word(1).load(Ordering::Acquire), 7);
        assert_eq!(theirs.slot(2)[PLAN_WORDS - 1].load(Ordering::Relaxed), 9);
        assert!(SharedPage::open(&path, 2, 4).is_err(), "a page that is too small is refused");
    }

    #[test]
    fn a_sleeper_is_woken_and_a_wait_has_an_end() {
        let place = tempfile::tempdir().unwrap();
        let page = SharedPage::create(&place.path().join("page"), 1, 0).unwrap();
        assert_eq!(wait_until(page.word(0), Duration::from_millis(5), |value| value > 0), None);
        std::thread::scope(|scope| {
            let sleeper = scope.spawn(|| wait_until(page.word(0), Duration::from_secs(20), |value| value > 0));
            page.word(0).store(3, Ordering::Release);
            futex_wake(page.word(0), 1);
            assert_eq!(sleeper.join().unwrap(), Some(3));
        });
        let event = EventFd::new().unwrap();
        assert!(!event.wait(Duration::from_millis(5)).unwrap());
        event.signal().unwrap();
        assert!(EventFd::inherited(event.number()).wait(Duration::from_secs(20)).unwrap());
    }
}

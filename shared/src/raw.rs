//! Memory that processes share, and the futexes with which they wake each other. The only file that
//! imports `memmap2`, and the only one of the robots' programs with `unsafe` in it.

use memmap2::{MmapOptions, MmapRaw};
use rustix::io::Errno;
use rustix::thread::futex;
use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicU32, AtomicU64};
use std::time::Duration;

/// Control words lie on cache lines of their own.
const LINE: usize = 64;

/// Memory that several processes see: control words, and a block of numbers behind them.
#[derive(Debug)]
pub struct SharedPage {
    memory: MmapRaw,
    words: usize,
    numbers: usize,
}

impl SharedPage {
    /// Makes the file `path`, filled with zeros: `words` control words and `numbers` numbers.
    pub fn create(path: &Path, words: usize, numbers: usize) -> io::Result<Self> {
        let file = File::options().read(true).write(true).create_new(true).open(path)?;
        file.set_len(Self::size(words, numbers) as u64)?;
        Self::map(&file, words, numbers)
    }

    /// Opens a file that [`Self::create`] made with the same arguments.
    pub fn open(path: &Path, words: usize, numbers: usize) -> io::Result<Self> {
        let file = File::options().read(true).write(true).open(path)?;
        if file.metadata()?.len() < Self::size(words, numbers) as u64 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Self::map(&file, words, numbers)
    }

    fn size(words: usize, numbers: usize) -> usize {
        words * LINE + numbers * size_of::<AtomicU64>()
    }

    fn map(file: &File, words: usize, numbers: usize) -> io::Result<Self> {
        let memory = MmapOptions::new().len(Self::size(words, numbers)).map_raw(file)?;
        Ok(Self { memory, words, numbers })
    }

    /// Control word `index`.
    pub fn word(&self, index: usize) -> &AtomicU32 {
        assert!(index < self.words);
        // SAFETY: inside the mapping, aligned to a line of a page, and only ever accessed as an atomic.
        unsafe { AtomicU32::from_ptr(self.memory.as_mut_ptr().add(index * LINE).cast()) }
    }

    /// The block of numbers.
    pub fn numbers(&self) -> &[AtomicU64] {
        // SAFETY: inside the mapping, aligned to a line of a page, and only ever accessed as atomics.
        unsafe { std::slice::from_raw_parts(self.memory.as_ptr().add(self.words * LINE).cast(), self.numbers) }
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
    let limit = futex::Timespec { tv_sec: limit.as_secs() as i64, tv_nsec: i64::from(limit.subsec_nanos()) };
    match futex::wait(word, futex::Flags::empty(), seen, Some(&limit)) {
        Err(Errno::INTR) => Woken::Signal,
        Err(Errno::TIMEDOUT) => Woken::Late,
        _ => Woken::Perhaps,
    }
}

/// Wakes up to `count` processes that wait for `word`.
pub fn futex_wake(word: &AtomicU32, count: u32) {
    let _ = futex::wake(word, futex::Flags::empty(), count); // fails for no address of a living page
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::Ordering::{Acquire, Release};

    #[test]
    fn two_mappings_of_a_page_are_one_memory() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("page");
        let (ours, theirs) = (SharedPage::create(&path, 2, 300).unwrap(), SharedPage::open(&path, 2, 300).unwrap());
        ours.word(1).store(7, Release);
        ours.numbers()[299].store(9, Release);
        assert_eq!((theirs.word(1).load(Acquire), theirs.numbers()[299].load(Acquire)), (7, 9));
        assert_eq!((theirs.word(0).load(Acquire), theirs.numbers().len()), (0, 300));
        assert!(SharedPage::open(&path, 2, 400).is_err(), "a page that is too small is refused");
    }

    #[test]
    fn a_sleeper_is_woken_and_a_wait_has_an_end() {
        let place = tempfile::tempdir().unwrap();
        let page = SharedPage::create(&place.path().join("page"), 1, 0).unwrap();
        let word = page.word(0);
        assert_eq!(futex_wait(word, 0, Duration::from_millis(5)), Woken::Late);
        assert_eq!(futex_wait(word, 1, Duration::from_secs(20)), Woken::Perhaps);
        std::thread::scope(|scope| {
            let sleeper = scope.spawn(|| {
                while word.load(Acquire) == 0 {
                    futex_wait(word, 0, Duration::from_secs(20));
                }
                word.load(Acquire)
            });
            word.store(3, Release);
            futex_wake(word, 1);
            assert_eq!(sleeper.join().unwrap(), 3);
        });
    }
}

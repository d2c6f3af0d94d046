//! The few things we ask of the operating system beyond the standard library.

use rustix::event::{PollFd, PollFlags, poll};
use rustix::io::Errno;
use rustix::process::{Pid, PidfdFlags, Resource, Signal, getppid, getrlimit, pidfd_open, setrlimit};
use rustix::time::{ClockId, clock_gettime};
use std::os::fd::OwnedFd;

/// Nanoseconds of the monotonic clock: comparable between processes of one host.
pub fn now_ns() -> u64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec as u64 * 1_000_000_000 + now.tv_nsec as u64
}

/// Nanoseconds that this process has spent on the processors, all threads together.
pub fn cpu_ns() -> u64 {
    let spent = clock_gettime(ClockId::ProcessCPUTime);
    spent.tv_sec as u64 * 1_000_000_000 + spent.tv_nsec as u64
}

/// Lets the kernel kill this process when its parent ends, and says whether the parent is still
/// `parent` (it may have ended before we asked).
pub fn die_with_parent(parent: u32) -> bool {
    let asked = rustix::process::set_parent_process_death_signal(Some(Signal::KILL)).is_ok();
    let ours = getppid().is_some_and(|pid| pid.as_raw_nonzero().get() as u32 == parent);
    asked && ours
}

/// A process that can be waited for without a race: its number may be used again, this stays its own.
#[derive(Debug)]
pub struct ProcessHandle(OwnedFd);

impl ProcessHandle {
    /// Of process `pid`; `None` when there is none.
    pub fn open(pid: u32) -> Option<Self> {
        pidfd_open(Pid::from_raw(pid as i32)?, PidfdFlags::empty()).ok().map(Self)
    }

    /// Waits until it has ended.
    pub fn wait(&self) {
        let mut ended = [PollFd::new(&self.0, PollFlags::IN)];
        while poll(&mut ended, None) == Err(Errno::INTR) {}
    }
}

/// Lets the kernel continue this process, should it be stopped, when its parent ends: it has to end then, too. Says
/// whether the parent is still `parent`.
pub fn wake_with_parent(parent: u32) -> bool {
    let asked = rustix::process::set_parent_process_death_signal(Some(Signal::CONT)).is_ok();
    let ours = getppid().is_some_and(|pid| pid.as_raw_nonzero().get() as u32 == parent);
    asked && ours
}

/// Raises the soft limit of open files to the hard one: 200 robots need more than the usual 1,024.
/// Failing is no error here; opening too many files will be.
pub fn raise_file_limit() {
    let mut limit = getrlimit(Resource::Nofile);
    if limit.current != limit.maximum {
        limit.current = limit.maximum;
        let _ = setrlimit(Resource::Nofile, limit);
    }
}

/// When process `pid` started, in clock ticks since boot; `None` when there is none (a zombie has
/// ended as well). Together with `pid` it names a process for good: numbers are used again.
pub fn start_time(pid: u32) -> Option<u64> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The name in parentheses may hold anything, blanks and parentheses too.
    let mut fields = stat.get(stat.rfind(')')? + 1..)?.split_ascii_whitespace();
    if matches!(fields.next()?, "Z" | "X") {
        return None;
    }
    fields.nth(18)?.parse().ok()
}

/// The user this process belongs to.
pub fn user_id() -> u32 {
    rustix::process::getuid().as_raw()
}

/// Asks process `pid` to end (SIGTERM).
pub fn terminate(pid: u32) {
    signal(pid, Signal::TERM);
}

/// Ends process `pid` at once (SIGKILL).
pub fn kill(pid: u32) {
    signal(pid, Signal::KILL);
}

/// Stops process `pid` until [`resume`] (SIGSTOP).
pub fn pause(pid: u32) {
    signal(pid, Signal::STOP);
}

/// Lets a stopped process go on (SIGCONT).
pub fn resume(pid: u32) {
    signal(pid, Signal::CONT);
}

fn signal(pid: u32, signal: Signal) {
    if let Some(pid) = Pid::from_raw(pid as i32) {
        let _ = rustix::process::kill_process(pid, signal); // gone already is fine
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_does_not_run_backwards() {
        let earlier = now_ns();
        assert!(now_ns() >= earlier);
    }

    #[test]
    fn the_end_of_a_process_is_waited_for() {
        let mut child = std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let handle = ProcessHandle::open(child.id()).unwrap();
        kill(child.id());
        handle.wait();
        child.wait().unwrap();
        assert!(ProcessHandle::open(u32::MAX / 2).is_none());
    }

    #[test]
    fn a_process_is_known_by_its_start_time() {
        let own = std::process::id();
        assert!(start_time(own).is_some_and(|time| time > 0));
        assert_eq!(start_time(own), start_time(own));
        assert_eq!(start_time(u32::MAX / 2), None);
    }
}

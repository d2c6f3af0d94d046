//! The few things we ask of the operating system beyond the standard library.

use rustix::process::{Pid, Resource, Signal, getppid, getrlimit, setrlimit};
use rustix::time::{ClockId, clock_gettime};

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
    if let Some(pid) = Pid::from_raw(pid as i32) {
        let _ = rustix::process::kill_process(pid, Signal::TERM); // gone already is fine
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
    fn a_process_is_known_by_its_start_time() {
        let own = std::process::id();
        assert!(start_time(own).is_some_and(|time| time > 0));
        assert_eq!(start_time(own), start_time(own));
        assert_eq!(start_time(u32::MAX / 2), None);
    }
}

//! Waking the team and its coordinator: a page of the run with counters, and futexes on them.
//!
//! An event of iceoryx2 is a datagram per listener and five system calls per wait. A lock-step tick wakes
//! everybody at once and needs its coordinator only when the last report is there: one broadcast and, at
//! the end, one wake-up. Messages still go through iceoryx2; the page only says that there are some.
//! *Invariant*: a message is sent before its counter moves, and a reader notes the counter before it reads.

use super::{Role, ServiceError};
use crate::raw::{SharedPage, Woken, futex_wait, futex_wake};
use crate::runtime_dir::RuntimeDir;
use std::cell::Cell;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering::SeqCst;
use std::time::{Duration, Instant};

// Counters; they wrap around.
/// Announcements so far.
const TICKS: usize = 0;
/// Reports so far.
const REPORTS: usize = 1;
/// The number of reports at which the coordinator wants to be woken.
const WANTED: usize = 2;
const WORDS: usize = 3;
// Numbers behind the counters: how many processes each robot has had.
/// All who wait.
const EVERYBODY: u32 = i32::MAX as u32;

/// The page of a run.
#[derive(Debug)]
pub(super) struct WakePage(SharedPage);

impl WakePage {
    /// Makes or opens it; it is deleted with all files of `place`.
    pub(super) fn new(place: &RuntimeDir, robots: usize, role: Role) -> Result<Self, ServiceError> {
        let path = PathBuf::from(format!("/dev/shm/{}wake", place.prefix));
        let page = match role {
            Role::Create => SharedPage::create(&path, WORDS, robots),
            Role::Open => SharedPage::open(&path, WORDS, robots),
        };
        page.map(Self).map_err(|error| ServiceError {
            what: format!("use the page of wake-ups {}", path.display()),
            reason: error.to_string(),
            place: place.to_string(),
        })
    }

    /// A life for a new process of `robot`, from 1: no two processes get the same.
    pub(super) fn next_life(&self, robot: usize) -> u32 {
        self.0.numbers().get(robot).map_or(0, |lives| lives.fetch_add(1, SeqCst) as u32 + 1)
    }
}

/// The coordinator's notifier for all robots.
#[derive(Debug)]
pub(super) struct TickNotifier(Arc<WakePage>);

impl TickNotifier {
    pub(super) fn new(page: &Arc<WakePage>) -> Self {
        Self(page.clone())
    }

    /// Wakes every robot.
    pub(super) fn ring(&self) {
        let ticks = self.0.0.word(TICKS);
        ticks.fetch_add(1, SeqCst);
        futex_wake(ticks, EVERYBODY);
    }
}

/// A robot's listener for it.
#[derive(Debug)]
pub(super) struct TickListener {
    page: Arc<WakePage>,
    seen: Cell<u32>,
}

impl TickListener {
    pub(super) fn new(page: &Arc<WakePage>) -> Self {
        Self { page: page.clone(), seen: Cell::new(page.0.word(TICKS).load(SeqCst)) }
    }

    /// Takes note of the rings so far.
    pub(super) fn look(&self) {
        self.seen.set(self.page.0.word(TICKS).load(SeqCst));
    }

    /// Waits for a ring after the last look, a signal, or `limit`.
    pub(super) fn wait(&self, limit: Duration) {
        futex_wait(self.page.0.word(TICKS), self.seen.get(), limit);
    }
}

/// A robot's notifier for the coordinator.
#[derive(Debug)]
pub(super) struct ReportNotifier(Arc<WakePage>);

impl ReportNotifier {
    pub(super) fn new(page: &Arc<WakePage>) -> Self {
        Self(page.clone())
    }

    /// Counts one more report; wakes the coordinator if that is the one it waits for.
    pub(super) fn ring(&self) {
        let reports = self.0.0.word(REPORTS);
        let sent = reports.fetch_add(1, SeqCst).wrapping_add(1);
        if reached(sent, self.0.0.word(WANTED).load(SeqCst)) {
            futex_wake(reports, 1);
        }
    }
}

/// The coordinator's listener for reports.
#[derive(Debug)]
pub(super) struct ReportListener {
    page: Arc<WakePage>,
    seen: Cell<u32>,
}

impl ReportListener {
    pub(super) fn new(page: &Arc<WakePage>) -> Self {
        Self { page: page.clone(), seen: Cell::new(page.0.word(REPORTS).load(SeqCst)) }
    }

    /// Takes note of the reports so far.
    pub(super) fn look(&self) {
        self.seen.set(self.page.0.word(REPORTS).load(SeqCst));
    }

    /// Nobody need ring before `reports` more than at the last look were sent. Gives their number.
    pub(super) fn expect(&self, reports: usize) -> u32 {
        let wanted = self.seen.get().wrapping_add(reports as u32);
        self.page.0.word(WANTED).store(wanted, SeqCst);
        wanted
    }

    /// Waits until `reports` more than at the last look were sent, for a signal, or `limit`.
    pub(super) fn wait(&self, reports: usize, limit: Duration) {
        let wanted = self.expect(reports.max(1));
        let (word, end) = (self.page.0.word(REPORTS), Instant::now() + limit);
        loop {
            // Either this load sees the report that reaches the number, or its sender sees the number.
            let sent = word.load(SeqCst);
            let left = end.saturating_duration_since(Instant::now());
            if reached(sent, wanted) || left.is_zero() || futex_wait(word, sent, left) != Woken::Perhaps {
                return;
            }
        }
    }
}

/// Whether a counter that wraps around has come to `wanted`.
fn reached(sent: u32, wanted: u32) -> bool {
    sent.wrapping_sub(wanted) as i32 >= 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    const LONG: Duration = Duration::from_secs(60);

    fn page() -> (RuntimeDir, Arc<WakePage>, Arc<WakePage>) {
        let place = RuntimeDir::create().unwrap();
        let ours = Arc::new(WakePage::new(&place, 2, Role::Create).unwrap());
        let theirs = Arc::new(WakePage::new(&place, 2, Role::Open).unwrap());
        (place, ours, theirs)
    }

    #[test]
    fn a_ring_between_looking_and_waiting_is_not_lost() {
        let (place, ours, theirs) = page();
        let (notifier, listener) = (TickNotifier::new(&ours), TickListener::new(&theirs));
        listener.look();
        notifier.ring();
        listener.wait(LONG);
        let (notifier, listener) = (ReportNotifier::new(&theirs), ReportListener::new(&ours));
        listener.look();
        notifier.ring();
        notifier.ring();
        listener.wait(2, LONG);
        place.remove();
    }

    #[test]
    fn the_coordinator_sleeps_until_the_last_report_and_robots_until_the_tick() {
        let (place, ours, theirs) = page();
        let (listener, ticks) = (ReportListener::new(&ours), TickNotifier::new(&ours));
        for round in 0..200 {
            listener.look();
            listener.expect(3);
            thread::scope(|scope| {
                for _ in 0..3 {
                    let robot = (TickListener::new(&theirs), ReportNotifier::new(&theirs));
                    robot.0.look();
                    scope.spawn(move || {
                        robot.0.wait(LONG);
                        robot.1.ring();
                    });
                }
                ticks.ring();
                listener.wait(3, LONG);
                assert_eq!(ours.0.word(REPORTS).load(SeqCst), 3 * (round + 1));
            });
        }
        place.remove();
    }

    #[test]
    fn no_two_processes_of_a_robot_have_the_same_life() {
        let (place, ours, theirs) = page();
        assert_eq!([ours.next_life(1), theirs.next_life(1), ours.next_life(0), ours.next_life(1)], [1, 2, 1, 3]);
        place.remove();
    }

    #[test]
    fn a_wait_has_an_end() {
        let (place, ours, _) = page();
        let (robot, coordinator) = (TickListener::new(&ours), ReportListener::new(&ours));
        robot.look();
        robot.wait(Duration::from_millis(2));
        ReportNotifier::new(&ours).ring();
        coordinator.look();
        coordinator.wait(1, Duration::from_millis(2));
        place.remove();
    }

    #[test]
    fn counters_may_wrap_around() {
        assert!(reached(5, 5) && reached(6, 5) && !reached(4, 5));
        assert!(reached(2, u32::MAX - 1) && !reached(u32::MAX - 1, 2));
    }
}

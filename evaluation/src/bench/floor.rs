//! The floor of a lock-step tick: a shared page and one futex broadcast, no middleware at all.
//!
//! The same work as an exchange: everybody is woken, reads the plans of all others of the tick before,
//! writes its own and answers; the last one wakes the coordinator.

use super::hop::OwnedPlace;
use super::links::{PATIENCE, read_slot, write_slot};
use super::partner::{Partner, PartnerArgs};
use super::system::{PLAN_WORDS, PlanPage, wait_until};
use super::{BenchError, failed};
use coordinator::latency::Latency;
use shared::raw::futex_wake;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

// Control words of the page.
const TICK: usize = 0;
const ANSWERED: usize = 1;
const READY: usize = 2;
const WORDS: usize = 3;
/// The tick that ends everybody.
const STOP: u32 = u32::MAX;
/// How long the start may take.
const START: Duration = Duration::from_secs(60);
/// How long a member waits for a tick: as long as another measurement may take in between.
const IDLE: Duration = Duration::from_secs(120);

/// Processes that do nothing but exchange plans.
pub(super) struct FloorTeam {
    page: PlanPage,
    members: Vec<Partner>,
    tick: u32,
    _place: OwnedPlace,
}

impl FloorTeam {
    /// Starts `members` processes.
    pub(super) fn start(members: usize) -> Result<Self, BenchError> {
        let place = OwnedPlace::create()?;
        let path = PathBuf::from(format!("/dev/shm/{}floor", place.0.prefix));
        let page = PlanPage::create(&path, WORDS, 2 * members).map_err(failed("make a shared page"))?;
        let start = |member| Partner::start(PartnerArgs::Floor { page: path.clone(), members, member });
        let partners = (0..members).map(start).collect::<Result<Vec<_>, _>>()?;
        let all = |ready| ready as usize == members;
        wait_until(page.word(READY), START, all).ok_or(BenchError::Silent { who: "the team of the floor" })?;
        Ok(Self { page, members: partners, tick: 0, _place: place })
    }

    /// Runs `ticks` ticks as fast as they go.
    pub(super) fn run(&mut self, ticks: u64, latency: &mut Latency) -> Result<(), BenchError> {
        let all = |answered| answered as usize == self.members.len();
        for _ in 0..ticks {
            let start = Instant::now();
            self.tick += 1;
            self.page.word(ANSWERED).store(0, Ordering::Relaxed);
            self.page.word(TICK).store(self.tick, Ordering::Release);
            futex_wake(self.page.word(TICK), u32::MAX >> 1);
            wait_until(self.page.word(ANSWERED), PATIENCE, all)
                .ok_or(BenchError::Silent { who: "the team of the floor" })?;
            latency.record(start.elapsed());
        }
        Ok(())
    }
}

impl Drop for FloorTeam {
    fn drop(&mut self) {
        self.page.word(TICK).store(STOP, Ordering::Release);
        futex_wake(self.page.word(TICK), u32::MAX >> 1);
    }
}

/// One member, until it is stopped.
pub(super) fn take_part(path: &Path, members: usize, member: usize) -> Result<(), BenchError> {
    let page = PlanPage::open(path, WORDS, 2 * members).map_err(failed("open a shared page"))?;
    let mut seen = page.word(TICK).load(Ordering::Acquire);
    answer(&page, READY, members);
    let mut plan = [0; PLAN_WORDS];
    loop {
        let tick = wait_until(page.word(TICK), IDLE, |tick| tick != seen);
        seen = tick.ok_or(BenchError::Silent { who: "the benchmark of the floor" })?;
        if seen == STOP {
            return Ok(());
        }
        let parity = |tick: u32| (tick % 2) as usize * members;
        for other in (0..members).filter(|other| *other != member) {
            read_slot(page.slot(parity(seen - 1) + other), &mut plan);
            black_box(&plan);
        }
        write_slot(page.slot(parity(seen) + member), &[u64::from(seen); PLAN_WORDS]);
        answer(&page, ANSWERED, members);
    }
}

/// Counts one more; the last one wakes the coordinator.
fn answer(page: &PlanPage, word: usize, members: usize) {
    let word = page.word(word);
    if word.fetch_add(1, Ordering::AcqRel) + 1 == members as u32 {
        futex_wake(word, 1);
    }
}

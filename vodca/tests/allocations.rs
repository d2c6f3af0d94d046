//! The closed form and the structured solver allocate nothing once built; own binary, because it
//! counts every allocation of the process.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use vodca::horizon::Horizon;
use vodca::mpc::ladder::Ladder;
use vodca::mpc::problem::{Solution, SolveError};
use vodca::mpc::sample::{Family, Sample};
use vodca::params::Profile;
use vodca::scenario::set_up;
use vodca::step::Level;
use vodca::team::Team;

struct Counting;

thread_local! {
    /// Allocations of this thread; the harness allocates on its own.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // Fails only while the thread ends, when nothing is counted any more.
    let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Solves and returns the level with the number of allocations.
fn counted(ladder: &mut Ladder, sample: &Sample) -> (Result<Level, SolveError>, u64) {
    let mut plan = Solution::default();
    let before = ALLOCATIONS.get();
    let outcome = ladder.solve(&sample.problem(), &mut plan);
    (outcome, ALLOCATIONS.get() - before)
}

#[test]
fn the_first_two_levels_allocate_nothing() {
    let mut ladder = Ladder::default();
    let mut seen = [0u32; 3];
    for family in Family::ALL {
        for n in [1, 2, 10, 20, 49] {
            for rows in [0, 1, 5, 40, 300] {
                for index in 0..4 {
                    let sample = Sample::new(family, Horizon::new(n).unwrap(), rows, 5, index);
                    let before = ladder.counts().given_up;
                    let (outcome, allocations) = counted(&mut ladder, &sample);
                    if ladder.counts().given_up > before {
                        continue;
                    }
                    assert_eq!(allocations, 0, "{family:?}, N = {n}, {rows} rows: {outcome:?}");
                    seen[match outcome {
                        Ok(Level::ClosedForm) => 0,
                        Ok(_) => 1,
                        Err(_) => 2,
                    }] += 1;
                }
            }
        }
    }
    assert!(seen.iter().all(|&n| n > 50), "closed form, structured, infeasible: {seen:?}");
}

#[test]
fn the_counter_counts() {
    let before = ALLOCATIONS.get();
    drop(std::hint::black_box(vec![0u8; 100]));
    assert!(ALLOCATIONS.get() > before);
}

#[test]
fn a_steady_tick_of_all_robots_allocates_nothing() {
    for (profile, scenario) in [
        (Profile::Safe, "ex14_d"),
        (Profile::Safe, "four_gate"),
        (Profile::Safe, "warehouse:12:1"),
        (Profile::Orca, "rand16o3_s0"),
        (Profile::Orca, "warehouse:12:1"),
    ] {
        let (scenario, params) = set_up(Some(scenario), None, profile, &[]).unwrap();
        let mut team = Team::new(&scenario, &params, 0);
        let mut solved = 0;
        // Buffers reach their size in the first ticks.
        let mut horizons = vec![Horizon::MAX; scenario.robots.len()];
        (0..5).for_each(|_| {
            team.step(&horizons);
        });
        let before = ALLOCATIONS.get();
        for tick in 5..80 {
            horizons.iter_mut().enumerate().for_each(|(robot, to)| *to = Horizon::random(1, robot, tick));
            let steps = team.step(&horizons);
            solved += steps.iter().filter(|step| step.rows > 0).count();
        }
        assert_eq!(ALLOCATIONS.get() - before, 0, "{} {profile}", scenario.name);
        assert!(solved > 20, "{} {profile}: {solved} steps had rows", scenario.name);
    }
}

//! A tick at the pace of real time, and how late it begins, beside a team of the floor that sleeps as long.
//!
//! A thousand ticks take 200 s, whatever the size of the team: so all teams drive in the same 200 s, each in a
//! slot of its own of the sample time, in which nothing else happens, with its floor at the end of the slot.
//! Whatever the machine does meanwhile falls on all of them alike.

use super::exchange::WARM_UP;
use super::floor::FloorTeam;
use super::row::{Results, Row};
use super::teams::{Companion, Load, TeamSpec, drive};
use super::{BenchError, Extent, Options, cost};
use coordinator::latency::Latency;
use coordinator::run::RunTick;
use shared::os;
use shared::stop::StopFlag;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Ticks that a row rests on.
const TICKS: u64 = 1_000;
/// One tick per sample time.
const SAMPLE_TIME: Duration = Duration::from_millis(200);
/// The floor's turn begins when this share of a slot is over.
const FLOOR_TURN: f64 = 0.6;
/// How long a team waits for the others to be there.
const PATIENCE: Duration = Duration::from_secs(100);
/// How often who waits looks around.
const LOOK_AROUND: Duration = Duration::from_millis(5);

/// What driving `sizes` in real time is expected to take, s.
pub(super) fn seconds(options: &Options, sizes: &[usize]) -> f64 {
    let starts: f64 = sizes.iter().map(|&robots| 2.0 * cost::start(robots)).sum();
    starts + pace(options.pick(TICKS, 3))
}

/// What `ticks` ticks take, s.
fn pace(ticks: u64) -> f64 {
    (WARM_UP + ticks) as f64 * SAMPLE_TIME.as_secs_f64()
}

/// Measures teams of `sizes` in the form of exchange that is their default.
pub(super) fn run(extent: &Extent<'_>, sizes: &[usize], results: &mut Results) -> Result<(), BenchError> {
    let (gate, ticks) = (Gate::new(sizes.len()), extent.options.pick(TICKS, 3));
    let stop = extent.stop;
    let measured: Vec<Result<Times, BenchError>> = thread::scope(|scope| {
        let teams = sizes.iter().enumerate().map(|(slot, &robots)| {
            let gate = &gate;
            scope.spawn(move || {
                let times = team(robots, gate.slot(slot), ticks, stop);
                gate.given_up.fetch_or(times.is_err(), Ordering::SeqCst);
                times
            })
        });
        let teams: Vec<_> = teams.collect();
        let mut told = 0;
        while teams.iter().any(|team| !team.is_finished()) {
            thread::sleep(LOOK_AROUND);
            let done = gate.ticks.load(Ordering::Relaxed);
            extent.watch.done((done - told) as f64 * SAMPLE_TIME.as_secs_f64());
            told = done;
        }
        teams.into_iter().map(|team| team.join().unwrap_or(Err(BenchError::Stopped))).collect()
    });
    // A team that stopped because another one broke does not know why: what broke comes first.
    let (broken, others): (Vec<_>, Vec<_>) =
        measured.into_iter().partition(|times| matches!(times, Err(error) if !matches!(error, BenchError::Stopped)));
    let times = broken.into_iter().chain(others).collect::<Result<Vec<Times>, _>>()?;
    extent.advance(seconds(extent.options, sizes) - pace(ticks))?;
    for (&robots, times) in sizes.iter().zip(times) {
        times.tell(robots, results);
    }
    Ok(())
}

/// What a team and its floor took.
#[derive(Default)]
struct Times {
    tick: Latency,
    late: Latency,
    floor: Latency,
    floor_late: Latency,
}

impl Times {
    fn tell(self, robots: usize, results: &mut Results) {
        const FLOOR: &str = "futex floor, real time";
        const SLEEPER: &str = "lateness of a bare sleeper";
        let row = |name, latency| Row::new("scale", name, Some(robots), latency);
        results.row(row("tick, safe, real time", self.tick).over(FLOOR, &self.floor));
        results.row(row(FLOOR, self.floor).as_floor());
        results.row(row("lateness, safe, real time", self.late).over(SLEEPER, &self.floor_late));
        results.row(row(SLEEPER, self.floor_late).as_floor());
    }
}

/// Where all teams wait until everybody is there.
struct Gate {
    teams: usize,
    there: AtomicUsize,
    /// One of them broke.
    given_up: AtomicBool,
    origin: OnceLock<Instant>,
    /// Ticks of the team in the first slot, for the progress.
    ticks: AtomicU64,
}

impl Gate {
    fn new(teams: usize) -> Self {
        let (there, given_up, origin, ticks) = Default::default();
        Self { teams, there, given_up, origin, ticks }
    }

    fn slot(&self, index: usize) -> Slot<'_> {
        let length = SAMPLE_TIME / self.teams.max(1) as u32;
        Slot { gate: self, begins: length * index as u32, length }
    }
}

/// The part of the sample time that belongs to one team.
#[derive(Clone, Copy)]
struct Slot<'a> {
    gate: &'a Gate,
    begins: Duration,
    length: Duration,
}

/// A team in real time, with its floor.
struct InSlot<'a> {
    slot: Slot<'a>,
    floor: FloorTeam,
    times: Times,
    stop: &'a StopFlag,
}

fn team(robots: usize, slot: Slot<'_>, ticks: u64, stop: &StopFlag) -> Result<Times, BenchError> {
    let floor = FloorTeam::start(robots)?;
    let mut companion = InSlot { slot, floor, times: Times::default(), stop };
    let scenario = format!("ring:{robots}");
    let spec = TeamSpec { scenario: &scenario, load: Load::Safe, kind: None, real_time: true, ticks: WARM_UP + ticks };
    drive(&spec, stop, &mut companion)?;
    Ok(companion.times)
}

impl Companion for InSlot<'_> {
    /// The first tick decides when all others are due.
    fn ready(&mut self) -> Result<(), BenchError> {
        let gate = self.slot.gate;
        let start = Instant::now();
        gate.there.fetch_add(1, Ordering::SeqCst);
        while gate.there.load(Ordering::SeqCst) < gate.teams {
            if self.stop.is_set() || gate.given_up.load(Ordering::SeqCst) {
                return Err(BenchError::Stopped);
            }
            if start.elapsed() > PATIENCE {
                return Err(BenchError::Silent { who: "another team that should drive in real time" });
            }
            thread::sleep(LOOK_AROUND);
        }
        let origin = gate.origin.get_or_init(|| Instant::now() + SAMPLE_TIME);
        thread::sleep((*origin + self.slot.begins).saturating_duration_since(Instant::now()));
        Ok(())
    }

    fn tick(&mut self, number: u64, tick: &RunTick<'_>) -> Result<(), BenchError> {
        let (gate, times) = (self.slot.gate, &mut self.times);
        if self.slot.begins.is_zero() {
            gate.ticks.fetch_add(1, Ordering::Relaxed);
        }
        if gate.given_up.load(Ordering::SeqCst) {
            return Err(BenchError::Stopped);
        }
        let due = tick.team.moments().announced + self.slot.length.mul_f64(FLOOR_TURN).as_nanos() as u64;
        thread::sleep(Duration::from_nanos(due.saturating_sub(os::now_ns())));
        let late = os::now_ns().saturating_sub(due);
        let mut floor = Latency::new();
        self.floor.run(1, &mut floor)?;
        if number >= WARM_UP {
            times.tick.record_ns(tick.team.moments().collected.saturating_sub(tick.team.moments().announced));
            times.late.record_ns(tick.team.moments().late);
            times.floor.add(&floor);
            times.floor_late.record_ns(late);
        }
        Ok(())
    }
}

//! One robot as a process: waits for ticks, hears the others, plans, moves, tells.
//!
//! Planning and moving are [`Robot::step`], as in a team in one process ([`vodca::team`]): both give the same bytes.

pub use crate::error::RunError;
use crate::part::Part;
use shared::chaos::MessageFault;
use shared::exchange::{self, Exchange, News, Order};
use shared::messages::{Author, Report, Stamps, kind};
use shared::os;
use shared::services::ServiceError;
use shared::stop::StopFlag;
use shared::team::{FIRST_EPOCH, Setup};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::layout::Layout;
use vodca::membership::State;
use vodca::neighbour_estimates::NeighbourEstimates;
use vodca::robot::Robot;
use vodca::step::Step;

/// How long a process waits for another one that drives its robot.
const ADMISSION: Duration = Duration::from_secs(5);
/// How often a waiting robot looks whether it was asked to stop.
const LOOK_AROUND: Duration = Duration::from_millis(100);

/// What a robot's process was told on its command line.
#[derive(Clone, Copy, Debug)]
pub struct Launch<'a> {
    /// Folder of the run.
    pub run: &'a Path,
    /// Which robot, 0-based.
    pub robot: usize,
    /// The process to end with; `None`: started by hand.
    pub parent: Option<u32>,
}

/// What lives in a robot's process: [`Robot`], or something that fails on purpose (tests).
pub trait Drive {
    /// Where it measures itself at the start of the next tick, m.
    fn measured(&self) -> Position;

    /// Plans tick `tick` and moves; `hearing` holds the others' plans of the tick before.
    fn step(&mut self, tick: u64, horizon: Horizon, hearing: &NeighbourEstimates) -> Step;

    /// Begins anew with tick `tick`: it did not take part in the one before, and its body stands at `at`, m.
    fn restart(&mut self, tick: u64, at: Position);

    /// From the next tick on `layout` holds: set-points have changed, or lost robots have become obstacles, or are gone.
    fn lay_out(&mut self, _layout: &Arc<Layout>) {}
}

impl Drive for Robot {
    fn measured(&self) -> Position {
        Robot::measured(self)
    }

    fn step(&mut self, tick: u64, horizon: Horizon, hearing: &NeighbourEstimates) -> Step {
        Robot::step(self, tick, horizon, hearing)
    }

    fn restart(&mut self, tick: u64, at: Position) {
        Robot::restart(self, tick, at);
    }

    fn lay_out(&mut self, layout: &Arc<Layout>) {
        Robot::lay_out(self, layout);
    }
}

/// The robot of a run with the body that the paper's model simulates: what the program `agent` runs.
pub fn simulated(setup: &Setup, robot: usize) -> Robot {
    let Setup { team, scenario, params } = setup;
    let layout = Arc::new(Layout::of(scenario, &params.model));
    Robot::new(robot, scenario, params, &layout, team.seed)
}

/// Runs one robot until the coordinator or a signal ends it; `build` makes what lives in it, anew for
/// every episode.
pub fn run<D: Drive>(launch: Launch<'_>, stop: &StopFlag, build: impl Fn(&Setup, usize) -> D) -> Result<(), RunError> {
    os::raise_file_limit();
    let setup = Setup::load(launch.run)?;
    let (team, robot) = (&setup.team, launch.robot);
    if robot >= team.robots {
        return Err(RunError::NoSuchRobot { robot, last: team.robots - 1 });
    }
    // Who comes too late would make files that nobody deletes any more.
    let ended = || RunError::Ended { run: launch.run.to_owned() };
    if !team.place.is_owned() {
        return Err(ended());
    }
    let part = Part::of(team.place.attend().ok()); // dropped after the exchange
    if let Some(parent) = launch.parent
        && !part.ends_with(parent, stop)
    {
        return Err(RunError::Orphaned { parent });
    }
    let first = Episode::new(&setup, FIRST_EPOCH, robot, &build)?;
    let opened = exchange::open(team.exchange, &team.place, team.robots, robot, FIRST_EPOCH);
    if !team.place.is_owned() {
        return Err(ended()); // the last one out tidies up
    }
    let mut exchange = opened?;
    let author = Author { epoch: FIRST_EPOCH, robot, life: exchange.life() };
    exchange.publish(Report::presence(author, kind::READY, first.drive.measured()))?;
    serve(&setup, author, exchange.as_mut(), first, &build, stop)
}

/// What a robot begins anew with every episode.
struct Episode<D> {
    setup: Setup,
    robot: usize,
    hearing: NeighbourEstimates,
    /// Where lost robots stand, m, by robot number.
    lost: Vec<Option<Position>>,
    drive: D,
}

impl<D: Drive> Episode<D> {
    fn new(setup: &Setup, epoch: u64, robot: usize, build: &impl Fn(&Setup, usize) -> D) -> Result<Self, RunError> {
        let setup = setup.of_episode(epoch)?;
        Ok(Self {
            robot,
            hearing: NeighbourEstimates::new(robot, &setup.scenario, &setup.params.disturbance, setup.team.seed),
            lost: vec![None; setup.scenario.robots.len()],
            drive: build(&setup, robot),
            setup,
        })
    }

    /// Takes in what is told before tick `tick`: who stood during the tick before, and where everybody goes from now on (none
    /// told: where the scenario says).
    fn begin(&mut self, tick: u64, absent: &[(usize, State, Position)], set_points: &[Position]) {
        if absent.iter().any(|(robot, ..)| *robot == self.robot) {
            self.hearing.restart(tick); // before it is told of anybody, as what is told counts
        }
        let known = self.setup.scenario.robots.iter_mut().map(|robot| &mut robot.set_point);
        let mut changed = false;
        for (known, &told) in known.zip(set_points).filter(|(known, told)| **known != **told) {
            *known = told;
            changed = true;
        }
        let lost = |robot| absent.iter().find(|told| told.0 == robot && told.1 == State::Lost).map(|told| told.2);
        if changed || self.lost.iter().enumerate().any(|(robot, known)| *known != lost(robot)) {
            self.lost.iter_mut().enumerate().for_each(|(robot, known)| *known = lost(robot));
            let Setup { scenario, params, .. } = &self.setup;
            self.drive.lay_out(&Arc::new(Layout::with_lost(scenario, &params.model, &self.lost)));
        }
        for &(robot, state, at) in absent {
            self.hearing.note_absent(tick, robot, state, at);
            if robot == self.robot {
                self.drive.restart(tick, at);
            }
        }
    }
}

/// Takes part in every tick until told to stop. [`Robot::step`] allocates nothing in a steady tick
/// (`tests/allocations.rs` counts, for a team in one process); what iceoryx2 does with messages is its own.
fn serve<D: Drive>(
    setup: &Setup,
    mut author: Author,
    exchange: &mut dyn Exchange,
    mut now: Episode<D>,
    build: &impl Fn(&Setup, usize) -> D,
    stop: &StopFlag,
) -> Result<(), RunError> {
    // Looks rather than time: a machine that was stopped as a whole goes on as if nothing had been.
    let (mut quiet, mut last, robot) = (Duration::ZERO, None, author.robot);
    let mut absent = Vec::with_capacity(setup.team.robots);
    let mut set_points = Vec::with_capacity(setup.team.robots);
    let (mut held, started) = (None, Instant::now());
    while !stop.is_set() {
        absent.clear();
        set_points.clear();
        let mut hear = |news: News<'_>| match news {
            News::Plan { sender, tick, plan } => now.hearing.hear(tick, sender, plan),
            News::Absent { robot, state, at } => absent.push((robot, state, at)),
            News::SetPoints(all) => set_points.extend_from_slice(all),
        };
        let order = exchange.next_order(LOOK_AROUND, &mut hear)?;
        if let Some(late) = order.and_then(|_| held.take()) {
            exchange.publish(late)?;
        }
        match order {
            Some(Order::Stop) => break,
            Some(Order::Superseded) => return Err(RunError::Superseded { robot, last }),
            Some(Order::NotYet { taken: true }) if started.elapsed() > ADMISSION => {
                return Err(RunError::NotAdmitted { robot, seconds: ADMISSION.as_secs_f64() });
            }
            Some(Order::NotYet { .. }) => continue,
            Some(Order::Meet) => exchange.publish(Report::presence(author, kind::MET, now.drive.measured()))?,
            Some(Order::Speak) => exchange.publish(Report::presence(author, kind::HERE, now.drive.measured()))?,
            Some(Order::Episode { epoch }) => {
                now = Episode::new(setup, epoch, robot, build)?;
                author.epoch = epoch;
                exchange.publish(Report::presence(author, kind::MET, now.drive.measured()))?;
            }
            Some(Order::Tick { tick, horizon, announced, woken }) => {
                if !absent.is_empty() || !set_points.is_empty() || now.lost.iter().any(Option::is_some) {
                    now.begin(tick, &absent, &set_points);
                }
                let read = os::now_ns();
                let horizon = horizon.ok_or(RunError::NoHorizon { robot, tick })?;
                let step = now.drive.step(tick, horizon, &now.hearing);
                now.hearing.hear(tick, robot, &step.plan); // read from the next tick on, like everybody's
                let planned = os::now_ns();
                let mut report = Report::step(author, tick, &step);
                report.plan.stamp = os::now_ns();
                report.stamps = Stamps { announced, woken, read, planned, ..Stamps::default() };
                publish(exchange, &mut held, report, setup.team.chaos.message(robot, tick))?;
                last = Some(tick);
            }
            None if quiet > setup.team.patience(last.is_some()) => {
                let place = last.map_or("before tick 0".to_string(), |tick| format!("after tick {tick}"));
                return Err(RunError::Silent { seconds: quiet.as_secs_f64(), place });
            }
            None => {
                quiet += LOOK_AROUND;
                continue;
            }
        }
        quiet = Duration::ZERO;
    }
    Ok(())
}

/// Publishes what was done in a tick, or what a fault on purpose leaves of it; `held` comes late.
fn publish(
    exchange: &mut dyn Exchange,
    held: &mut Option<Report>,
    report: Report,
    fault: Option<MessageFault>,
) -> Result<(), ServiceError> {
    match fault {
        Some(MessageFault::Drop) => return Ok(()),
        Some(MessageFault::Delay) => {
            *held = Some(report);
            return Ok(());
        }
        Some(MessageFault::Duplicate) => *held = Some(report), // the second one comes with the next tick
        None => {}
    }
    exchange.publish(report)
}

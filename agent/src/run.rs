//! One robot as a process: waits for ticks, hears the others, plans, moves, tells.
//!
//! Planning and moving are [`Robot::step`], as in a team in one process ([`vodca::team`]): both give the same bytes.

use shared::exchange::{self, Exchange, Order};
use shared::messages::{Report, Stamps, kind};
use shared::os;
use shared::services::ServiceError;
use shared::stop::StopFlag;
use shared::team::{FIRST_EPOCH, Setup, TeamError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::layout::Layout;
use vodca::neighbour_estimates::NeighbourEstimates;
use vodca::robot::Robot;
use vodca::scenario::ScenarioError;
use vodca::step::Step;

/// How often a waiting robot looks whether it was asked to stop.
const LOOK_AROUND: Duration = Duration::from_millis(100);

/// Why a robot's process failed.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The run's folder.
    #[error(transparent)]
    Team(#[from] TeamError),
    /// The layout of an episode.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// There is no such robot.
    #[error("there is no robot {robot}: the team has robots 0..={last}")]
    NoSuchRobot {
        /// The one asked for.
        robot: usize,
        /// The last one.
        last: usize,
    },
    /// The exchange.
    #[error(transparent)]
    Exchange(#[from] ServiceError),
    /// Nothing was announced for too long.
    #[error("the coordinator has announced nothing for {seconds:.1} s ({place}); it has ended or hangs")]
    Silent {
        /// How long, s.
        seconds: f64,
        /// Before the first tick, or after which.
        place: String,
    },
    /// What came with the announcement is no horizon.
    #[error(
        "no horizon in 1..={MAX_HORIZON} for robot {robot} came with the announcement of tick {tick}; is its coordinator of another version?"
    )]
    NoHorizon {
        /// Which robot.
        robot: usize,
        /// k.
        tick: u64,
    },
    /// Nobody is there to drive for.
    #[error("{}: has the run ended? The process that owns it is gone; start robots while it runs", run.display())]
    Ended {
        /// The run's folder.
        run: PathBuf,
    },
    /// The process that started this robot is gone.
    #[error("process {parent}, which started this robot, has ended")]
    Orphaned {
        /// Its number.
        parent: u32,
    },
}

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
}

impl Drive for Robot {
    fn measured(&self) -> Position {
        Robot::measured(self)
    }

    fn step(&mut self, tick: u64, horizon: Horizon, hearing: &NeighbourEstimates) -> Step {
        Robot::step(self, tick, horizon, hearing)
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
    if let Some(parent) = launch.parent
        && !os::die_with_parent(parent)
    {
        return Err(RunError::Orphaned { parent });
    }
    os::raise_file_limit();
    let setup = Setup::load(launch.run)?;
    let (team, robot) = (&setup.team, launch.robot);
    if robot >= team.robots {
        return Err(RunError::NoSuchRobot { robot, last: team.robots - 1 });
    }
    let first = Episode::new(&setup, FIRST_EPOCH, robot, &build)?;
    // Who comes too late would make files that nobody deletes any more.
    let ended = || RunError::Ended { run: launch.run.to_owned() };
    if !team.place.is_owned() {
        return Err(ended());
    }
    let opened = exchange::open(team.exchange, &team.place, team.robots, robot, FIRST_EPOCH);
    if !team.place.is_owned() {
        drop(opened);
        team.place.remove();
        return Err(ended());
    }
    let mut exchange = opened?;
    exchange.publish(Report::presence(FIRST_EPOCH, robot, kind::READY, first.drive.measured()))?;
    serve(&setup, robot, exchange.as_mut(), first, &build, stop)
}

/// What a robot begins anew with every episode.
struct Episode<D> {
    epoch: u64,
    hearing: NeighbourEstimates,
    drive: D,
}

impl<D: Drive> Episode<D> {
    fn new(setup: &Setup, epoch: u64, robot: usize, build: &impl Fn(&Setup, usize) -> D) -> Result<Self, RunError> {
        let setup = setup.of_episode(epoch)?;
        Ok(Self {
            epoch,
            hearing: NeighbourEstimates::new(robot, &setup.scenario, &setup.params.disturbance, setup.team.seed),
            drive: build(&setup, robot),
        })
    }
}

/// Takes part in every tick until told to stop. [`Robot::step`] allocates nothing in a steady tick
/// (`tests/allocations.rs` counts, for a team in one process); what iceoryx2 does with messages is its own.
fn serve<D: Drive>(
    setup: &Setup,
    robot: usize,
    exchange: &mut dyn Exchange,
    mut now: Episode<D>,
    build: &impl Fn(&Setup, usize) -> D,
    stop: &StopFlag,
) -> Result<(), RunError> {
    let (mut heard_at, mut last) = (Instant::now(), None);
    while !stop.is_set() {
        let order = exchange.next_order(LOOK_AROUND, &mut |sender, tick, plan| now.hearing.hear(tick, sender, plan))?;
        match order {
            Some(Order::Stop) => break,
            Some(Order::Meet) => {
                exchange.publish(Report::presence(now.epoch, robot, kind::MET, now.drive.measured()))?
            }
            Some(Order::Episode { epoch }) => {
                now = Episode::new(setup, epoch, robot, build)?;
                exchange.publish(Report::presence(epoch, robot, kind::MET, now.drive.measured()))?;
            }
            Some(Order::Tick { tick, horizon, announced, woken }) => {
                let read = os::now_ns();
                let horizon = horizon.ok_or(RunError::NoHorizon { robot, tick })?;
                let step = now.drive.step(tick, horizon, &now.hearing);
                now.hearing.hear(tick, robot, &step.plan); // read from the next tick on, like everybody's
                let planned = os::now_ns();
                let mut report = Report::step(now.epoch, tick, robot, &step);
                report.plan.stamp = os::now_ns();
                report.stamps = Stamps { announced, woken, read, planned, ..Stamps::default() };
                exchange.publish(report)?;
                last = Some(tick);
            }
            None if heard_at.elapsed() > setup.team.patience(last.is_some()) => {
                let place = last.map_or("before tick 0".to_string(), |tick| format!("after tick {tick}"));
                return Err(RunError::Silent { seconds: heard_at.elapsed().as_secs_f64(), place });
            }
            None => continue,
        }
        heard_at = Instant::now();
    }
    Ok(())
}

//! A team of robot processes: start, lock step, end.
//!
//! One tick: announce it with everybody's horizon, collect what every robot did. Whatever happens, dropping the
//! [`ProcessTeam`] ends every process and deletes every shared file of the run.

use crate::clock::{Clock, Overruns};
use crate::destinations::Destinations;
use crate::launch::{self, Agents};
use crate::members::Members;
use crate::own_runtime_dir::OwnRuntimeDir;
use crate::roster::{PeerLost, Roster};
use crate::run::{OnLoss, Options, Outcome, RunError};
use shared::exchange::{CoordinatorPort, TeamNow};
use shared::messages::{MAX_ROBOTS, Stamps};
use shared::os;
use shared::runtime_dir::{self, RuntimeDir};
use shared::services::{self, ServiceError};
use shared::stop::StopFlag;
use shared::team::{FIRST_EPOCH, Setup, TeamFile, VERSION};
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::membership::State;
use vodca::params::Params;
use vodca::play::Playable;
use vodca::scenario::{Scenario, ScenarioError};
use vodca::step::Step;
use vodca::tasks::Assignment;

mod collect;
mod losses;

use collect::Wanted;

/// How often a waiting coordinator looks for signals and ended processes.
const LOOK_AROUND: Duration = Duration::from_millis(50);
/// How long robots have to end by themselves when all is well.
const GRACE: Duration = Duration::from_millis(1200);
/// And when one of them was lost.
const SHORT_GRACE: Duration = Duration::from_millis(300);

/// What keeps a team from finishing a tick, or from its start.
#[derive(Debug)]
pub enum Interrupt {
    /// Somebody asked for it.
    Stopped,
    /// A robot ended or fell silent.
    Lost(PeerLost),
    /// Something broke.
    Failed(RunError),
}

impl<E: Into<RunError>> From<E> for Interrupt {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

impl Interrupt {
    /// How the run ends because of it.
    pub(crate) fn outcome(self) -> Result<Outcome, RunError> {
        match self {
            Self::Stopped => Ok(Outcome::Stopped),
            Self::Lost(lost) => Ok(Outcome::PeerLost(lost)),
            Self::Failed(error) => Err(error),
        }
    }
}

/// When what happened in a tick, ns of the monotonic clock.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    /// The tick could begin: horizons were asked for.
    pub asked: u64,
    /// It was announced.
    pub announced: u64,
    /// Everybody had been woken.
    pub rung: u64,
    /// The last report had come.
    pub collected: u64,
    /// How late it was announced, ns (real time only).
    pub late: u64,
}

/// The layout of an episode.
pub(crate) struct EpisodeLayout {
    /// Its number, from 0.
    pub(crate) number: u64,
    /// Seed of everything random in it.
    pub(crate) seed: u64,
    /// Where everybody starts.
    pub(crate) scenario: Scenario,
}

/// A team of processes.
pub struct ProcessTeam {
    options: Options,
    /// What the robots were told; [`Setup::of_episode`] gives an episode's own.
    setup: Setup,
    // Dropped in this order: first the processes, then our ports, last the files.
    roster: Roster,
    port: CoordinatorPort,
    place: OwnRuntimeDir,
    stop: StopFlag,
    clock: Clock,
    members: Members,
    destinations: Destinations,
    epoch: u64,
    /// What has come of the tick that is under way.
    reported: Vec<Option<Step>>,
    /// What everybody did in the newest finished tick.
    finished: Vec<Step>,
    /// Where every robot measures itself at the start of the next tick, m.
    measured: Vec<Position>,
    stamps: Vec<Stamps>,
    moments: Moments,
}

impl ProcessTeam {
    /// Makes the exchange and writes `team.toml` and `iceoryx2.toml` into the run's folder; no robot is started.
    pub(crate) fn prepare(
        scenario: &Scenario,
        params: &Params,
        options: Options,
        stop: &StopFlag,
    ) -> Result<Self, RunError> {
        os::raise_file_limit();
        runtime_dir::sweep_leftovers();
        let robots = scenario.robots.len();
        if !(1..=MAX_ROBOTS).contains(&robots) {
            return Err(RunError::Robots { scenario: scenario.name.clone(), robots });
        }
        let place = OwnRuntimeDir(RuntimeDir::create()?);
        let file = TeamFile {
            version: VERSION,
            robots,
            exchange: options.exchange,
            seed: options.seed,
            episodes: options.episodes.clone(),
            start_patience: options.start_patience.as_secs_f64() + 5.0,
            silence_limit: options.tick_deadline.as_secs_f64()
                + params.model.sample_time
                + 5.0
                + options.idle.as_secs_f64(),
            chaos: options.chaos.clone(),
            place: place.0.clone(),
        };
        let path = options.run.join("iceoryx2.toml");
        let text = services::config_text(&place.0)?;
        std::fs::write(&path, text).map_err(|source| RunError::Config { path, source })?;
        let port = CoordinatorPort::create(options.exchange, &place.0, robots, FIRST_EPOCH)?;
        // Only now: who finds this file finds the services as well.
        file.write(&options.run)?;
        let names = scenario.robots.iter().map(|robot| robot.name.clone()).collect();
        let sample_time = params.model.sample_time;
        Ok(Self {
            roster: Roster::new(options.run.clone(), names),
            members: Members::new(scenario),
            destinations: Destinations::new(options.tasks.clone(), &options.run),
            setup: Setup { team: file, scenario: scenario.clone(), params: params.clone() },
            port,
            place,
            stop: stop.clone(),
            clock: if options.real_time { Clock::real_time(sample_time) } else { Clock::lock_step() },
            epoch: FIRST_EPOCH,
            reported: vec![None; robots],
            finished: Vec::with_capacity(robots),
            measured: scenario.robots.iter().map(|robot| robot.start).collect(),
            stamps: vec![Stamps::default(); robots],
            moments: Moments::default(),
            options,
        })
    }

    /// Starts every robot that is not started by hand.
    pub(crate) fn start_robots(&mut self) -> Result<(), RunError> {
        let Agents::Launch(program) = &self.options.agents else { return Ok(()) };
        for robot in 0..self.reported.len() {
            if self.stop.is_set() {
                return Ok(()); // the wait for them sees it, too
            }
            let child = launch::start(program, &self.options.run, robot)?;
            self.roster.started(robot, child);
        }
        Ok(())
    }

    /// Sends on who has arrived, and whoever somebody outside has sent elsewhere.
    fn hand_out(&mut self, tick: u64) {
        self.destinations.hand_out(tick, &self.measured, self.members.membership());
        for &Assignment { robot, set_point, .. } in self.destinations.assigned() {
            self.setup.scenario.robots[robot].set_point = set_point;
        }
    }

    /// Waits until every robot is there, and until all are connected.
    pub(crate) fn gather(&mut self, until: Instant) -> Result<(), Interrupt> {
        for wanted in [Wanted::Ready, Wanted::Met] {
            self.members.expect_all();
            if wanted == Wanted::Met {
                self.port.meet()?;
            }
            self.collect(wanted, until)?;
        }
        Ok(())
    }

    /// The layout of the present episode.
    pub(crate) fn episode(&self) -> Result<EpisodeLayout, ScenarioError> {
        let Setup { team, scenario, .. } = self.setup.of_episode(self.epoch)?;
        Ok(EpisodeLayout { number: team.episodes.number(self.epoch), seed: team.seed, scenario })
    }

    /// Sends everybody back to its start and waits until all are there.
    pub(crate) fn next_episode(&mut self) -> Result<(), Interrupt> {
        self.members.expect_all();
        self.epoch = self.port.next_episode()?;
        self.collect(Wanted::Met, Instant::now() + self.options.tick_deadline)
    }

    /// Ends the team: in order as far as its robots still listen.
    pub(crate) fn end(&mut self, outcome: Option<&Outcome>) -> Result<(), ServiceError> {
        let grace = match outcome {
            Some(Outcome::PeerLost(lost)) => {
                self.roster.kill(lost.robot);
                SHORT_GRACE
            }
            _ if self.members.membership().count(State::Late) > 0 => SHORT_GRACE,
            _ => GRACE,
        };
        self.members.paused().filter_map(|robot| self.roster.pid(robot)).for_each(os::resume);
        let told = self.port.stop();
        self.roster.ask_to_end();
        self.roster.wait_for_end(grace);
        told
    }

    /// The process that drives `robot`, if it lives.
    pub fn pid(&self, robot: usize) -> Option<u32> {
        self.roster.pid(robot)
    }

    /// Who takes part, and all that has changed.
    pub fn members(&self) -> &Members {
        &self.members
    }

    /// When what happened in the newest tick.
    pub fn moments(&self) -> Moments {
        self.moments
    }

    /// When what happened to every robot in the newest tick, by robot number.
    pub fn stamps(&self) -> &[Stamps] {
        &self.stamps
    }

    /// Ticks that began late so far (real time only).
    pub fn overruns(&self) -> Overruns {
        self.clock.overruns()
    }

    /// Where the run's shared files are.
    pub fn place(&self) -> &RuntimeDir {
        &self.place.0
    }

    pub(crate) fn params(&self) -> &Params {
        &self.setup.params
    }

    pub(crate) fn seed(&self) -> u64 {
        self.setup.team.seed
    }

    pub(crate) fn epoch(&self) -> u64 {
        self.epoch
    }
}

impl Playable for ProcessTeam {
    type Error = Interrupt;

    fn await_tick(&mut self, tick: u64) -> Result<(), Interrupt> {
        loop {
            if self.stop.is_set() {
                return Err(Interrupt::Stopped);
            }
            let remaining = Duration::from_nanos(self.clock.remaining());
            if remaining.is_zero() {
                self.wait_for_late(tick)?;
                self.moments.asked = os::now_ns();
                return Ok(());
            }
            std::thread::sleep(remaining.min(LOOK_AROUND));
            if self.options.on_loss == OnLoss::Stop {
                self.look_for_ended(Wanted::Tick(tick))?;
            }
        }
    }

    fn measured(&self) -> &[Position] {
        &self.measured
    }

    fn tick(&mut self, tick: u64, horizons: &[Horizon]) -> Result<(), Interrupt> {
        self.welcome(tick)?;
        let killed = self.strike(tick);
        self.members.begin(tick);
        self.hand_out(tick);
        self.moments.announced = self.port.announce(
            tick,
            horizons,
            &TeamNow {
                members: self.members.membership().members(),
                bodies: self.members.bodies(),
                set_points: self.destinations.set_points(),
            },
        )?;
        self.moments.rung = os::now_ns();
        self.moments.late = self.clock.begin(self.moments.announced);
        self.miss_on_purpose(tick);
        self.end_silent(tick)?;
        if killed {
            self.look_for_ended(Wanted::Tick(tick))?;
        }
        self.collect(Wanted::Tick(tick), Instant::now() + self.options.tick_deadline)?;
        self.moments.collected = os::now_ns();
        self.members.end();
        self.finish(tick, horizons);
        Ok(())
    }

    fn steps(&self) -> &[Step] {
        &self.finished
    }

    fn assigned(&self) -> &[Assignment] {
        self.destinations.assigned()
    }

    fn awaits_somebody(&self) -> bool {
        self.members.awaits_somebody() || self.destinations.is_pending(self.members.membership())
    }
}

//! Runs a team of robot processes: start, lock step, end.
//!
//! One tick: announce it, collect what every robot did, hand that to the observer. Whatever happens,
//! dropping the [`Team`] ends every process and deletes every shared file of the run.

use crate::clock::{Clock, Overruns};
use crate::launch::{self, Agents, LaunchError};
use crate::own_place::OwnPlace;
use crate::policy::{PolicyError, PolicyOptions, PolicySource, PolicySummary};
use crate::record::RecordError;
use crate::roster::{PeerLost, Roster};
use crate::stdout::{self, PrintError};
use agent::hearing::measured;
use shared::Position;
use shared::exchange::{Hub, Kind};
use shared::messages::{MAX_ROBOTS, Report, Stamps, kind};
use shared::os;
use shared::params::Params;
use shared::place::{self, Place, PlaceError};
use shared::scenario::Scenario;
use shared::services::{self, ServiceError};
use shared::step::Step;
use shared::stop::StopFlag;
use shared::team::{TeamError, TeamFile};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How often a waiting coordinator looks for signals and ended processes.
const LOOK_AROUND: Duration = Duration::from_millis(50);
/// The usual [`Options::tick_deadline`]: a robot that hangs ends the run within 2 s, ending included.
pub const TICK_DEADLINE: Duration = Duration::from_millis(1200);
/// How long no further robot may come during the start.
pub const STALL: Duration = Duration::from_secs(3);
/// How long robots have to end by themselves when all is well.
const GRACE: Duration = Duration::from_millis(1200);
/// And when one of them was lost.
const SHORT_GRACE: Duration = Duration::from_millis(300);

/// What one run is told beyond its scenario and parameters.
#[derive(Clone, Debug)]
pub struct Options {
    /// The run's folder; `scenario.toml` and `params.toml` are in it already.
    pub run: PathBuf,
    /// How robots come to life.
    pub agents: Agents,
    /// The form of the exchange.
    pub exchange: Kind,
    /// SPEC of the horizons' source, or [`shared::team::POLICY`].
    pub horizons: String,
    /// The policy that chooses them; then `horizons` is [`shared::team::POLICY`].
    pub policy: Option<PolicyOptions>,
    /// Seed of everything random.
    pub seed: u64,
    /// One tick per sample time rather than as fast as possible.
    pub real_time: bool,
    /// K, the most ticks.
    pub max_ticks: u64,
    /// How long a tick may take before a robot that has not answered is lost.
    pub tick_deadline: Duration,
    /// How long the start may take. Of robots that are started here one is lost when, after the first
    /// was there, no further one comes for [`STALL`].
    pub start_patience: Duration,
}

impl Options {
    /// The usual values for `scenario`, run in `run` by robots that are started here.
    pub fn new(run: &Path, scenario: &Scenario) -> Result<Self, LaunchError> {
        Ok(Self {
            run: run.to_owned(),
            agents: Agents::Launch(launch::agent_program()?),
            exchange: Kind::default_for(scenario.robots.len()),
            horizons: "fixed:20".into(),
            policy: None,
            seed: scenario.seed,
            real_time: false,
            max_ticks: scenario.max_ticks,
            tick_deadline: TICK_DEADLINE,
            start_patience: Duration::from_secs(30),
        })
    }
}

/// Why a run could not be done. A run that was done, however it went, has an [`Outcome`].
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Too many robots, or none.
    #[error("the scenario {scenario} has {robots} robots; a run can have 1..={MAX_ROBOTS}")]
    Robots {
        /// Its name.
        scenario: String,
        /// How many.
        robots: usize,
    },
    /// The place of its shared files.
    #[error(transparent)]
    Place(#[from] PlaceError),
    /// A file in its folder.
    #[error(transparent)]
    Team(#[from] TeamError),
    /// The robots' program.
    #[error(transparent)]
    Launch(#[from] LaunchError),
    /// The exchange.
    #[error(transparent)]
    Exchange(#[from] ServiceError),
    /// The policy server.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The robots' commands cannot be printed.
    #[error(transparent)]
    Print(#[from] PrintError),
    /// The observer could not record a tick.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// `iceoryx2.toml` cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Config {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The observer had seen enough: everybody has arrived.
    Completed,
    /// All ticks were used up.
    TimedOut,
    /// Somebody asked for it.
    Stopped,
    /// A robot ended or fell silent.
    PeerLost(PeerLost),
}

/// What the observer of a tick wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The next tick.
    Continue,
    /// The end: everybody has arrived.
    Arrived,
}

/// Sees every tick that everybody has finished and decides what comes next.
pub type Observer<'a> = dyn FnMut(&Tick<'_>) -> Result<Verdict, RecordError> + 'a;

/// One tick, finished.
#[derive(Debug)]
pub struct Tick<'a> {
    /// k.
    pub tick: u64,
    /// What every robot did, by robot number.
    pub steps: &'a [Step],
    /// When what happened to every robot, by robot number.
    pub stamps: &'a [Stamps],
    /// When the tick was announced, ns of the monotonic clock.
    pub announced: u64,
    /// When the last report had come, ns.
    pub collected: u64,
    /// How late it was announced (real time only), ns.
    pub late: u64,
}

/// How a run went.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// How it ended.
    pub outcome: Outcome,
    /// Ticks that were finished by everybody.
    pub ticks: u64,
    /// Ticks that began late (real time only).
    pub overruns: Overruns,
    /// What the policy did.
    pub policy: Option<PolicySummary>,
}

/// What a tick or the start came to.
enum Wait {
    Done,
    Stopped,
    Lost(PeerLost),
}

/// What a report may change.
struct Heard<'a> {
    roster: &'a mut Roster,
    steps: &'a mut [Option<Step>],
    stamps: &'a mut [Stamps],
    deadline: &'a mut Instant,
}

/// A team of processes.
pub struct Team {
    options: Options,
    sample_time: f64,
    // Dropped in this order: first the processes, then our ports, last the files.
    roster: Roster,
    policy: Option<PolicySource>,
    hub: Hub,
    place: OwnPlace,
    /// What a policy observes besides the robots' own reports.
    measuring: Measuring,
    steps: Vec<Option<Step>>,
    stamps: Vec<Stamps>,
}

/// Where robots are at the start of the next tick, and how well that is measured.
struct Measuring {
    positions: Vec<Position>,
    noise: f64,
    seed: u64,
}

impl Measuring {
    /// What each robot measures of itself at `tick`: the same draw that the robot makes.
    fn measured(&self, tick: u64) -> impl Iterator<Item = Position> + '_ {
        let Self { positions, noise, seed } = self;
        positions.iter().enumerate().map(move |(robot, &at)| measured(at, *noise, *seed, robot, tick))
    }
}

impl Team {
    /// Makes the exchange, writes `team.toml` and `iceoryx2.toml` into the run's folder and starts the
    /// robots. Sweeps away what earlier runs left that were killed.
    pub fn launch(scenario: &Scenario, params: &Params, options: Options, stop: &StopFlag) -> Result<Self, RunError> {
        os::raise_file_limit();
        place::sweep_leftovers();
        let robots = scenario.robots.len();
        if !(1..=MAX_ROBOTS).contains(&robots) {
            return Err(RunError::Robots { scenario: scenario.name.clone(), robots });
        }
        let place = OwnPlace(Place::create()?);
        let file = TeamFile {
            version: 1,
            robots,
            exchange: options.exchange,
            horizons: options.horizons.clone(),
            seed: options.seed,
            epoch: 1,
            start_patience: options.start_patience.as_secs_f64() + 5.0,
            silence_limit: options.tick_deadline.as_secs_f64() + params.model.sample_time + 5.0,
            place: place.0.clone(),
        };
        let path = options.run.join("iceoryx2.toml");
        let text = services::config_text(&place.0)?;
        std::fs::write(&path, text).map_err(|source| RunError::Config { path, source })?;
        let hub = Hub::create(options.exchange, &place.0, robots, file.epoch)?;
        // Only now: who finds this file finds the services as well.
        file.write(&options.run)?;
        let policy = match options.policy.clone() {
            Some(policy) => Some(PolicySource::start(policy, &place.0, &options.run, robots, file.epoch)?),
            None => None,
        };
        let names = scenario.robots.iter().map(|robot| robot.name.clone()).collect();
        let mut team = Self {
            roster: Roster::new(options.run.clone(), names),
            sample_time: params.model.sample_time,
            policy,
            hub,
            place,
            measuring: Measuring {
                positions: scenario.robots.iter().map(|robot| robot.start).collect(),
                noise: params.disturbance.noise,
                seed: options.seed,
            },
            steps: vec![None; robots],
            stamps: vec![Stamps::default(); robots],
            options,
        };
        team.start_robots(robots, stop)?;
        Ok(team)
    }

    fn start_robots(&mut self, robots: usize, stop: &StopFlag) -> Result<(), RunError> {
        for robot in 0..robots {
            match &self.options.agents {
                Agents::ByHand => stdout::line(launch::command_line(&self.options.run, robot))?,
                Agents::Launch(_) if stop.is_set() => return Ok(()), // `run` sees it, too
                Agents::Launch(program) => {
                    let child = launch::start(program, &self.options.run, robot)?;
                    self.roster.started(robot, child);
                }
            }
        }
        Ok(())
    }

    /// Runs all ticks, and ends the team in order whatever became of them.
    pub fn run(mut self, stop: &StopFlag, observer: &mut Observer<'_>) -> Result<Ended, RunError> {
        let mut clock = if self.options.real_time { Clock::real_time(self.sample_time) } else { Clock::lock_step() };
        let mut ticks = 0;
        let outcome = match self.gather(stop) {
            Ok(Wait::Done) => self.tick_on(stop, observer, &mut clock, &mut ticks),
            Ok(Wait::Stopped) => Ok(Outcome::Stopped),
            Ok(Wait::Lost(lost)) => Ok(Outcome::PeerLost(lost)),
            Err(error) => Err(error),
        };
        let policy = self.policy.take().map(PolicySource::end).transpose();
        let told = self.end(outcome.as_ref().ok());
        let outcome = outcome?; // what went wrong first is what counts
        told?;
        Ok(Ended { outcome, ticks, overruns: clock.overruns(), policy: policy? })
    }

    /// Waits until every robot is there, and until all are connected.
    fn gather(&mut self, stop: &StopFlag) -> Result<Wait, RunError> {
        let end = Instant::now() + self.options.start_patience;
        if let Some(policy) = &mut self.policy
            && !policy.gather(end, stop)?
        {
            return Ok(Wait::Stopped);
        }
        let stall = if matches!(self.options.agents, Agents::ByHand) { self.options.start_patience } else { STALL };
        for wanted in [kind::READY, kind::MET] {
            self.roster.expect_all();
            if wanted == kind::MET {
                self.hub.meet()?;
            }
            let done = self.collect(None, end, stop, |heard, robot, report| {
                heard.roster.seen(robot, report.pid);
                if report.kind == wanted && heard.roster.answer(robot) && wanted == kind::READY {
                    *heard.deadline = end.min(Instant::now() + stall);
                }
                Ok(())
            })?;
            let Wait::Done = done else { return Ok(done) };
        }
        Ok(Wait::Done)
    }

    fn tick_on(
        &mut self,
        stop: &StopFlag,
        observer: &mut Observer<'_>,
        clock: &mut Clock,
        ticks: &mut u64,
    ) -> Result<Outcome, RunError> {
        let mut finished = Vec::with_capacity(self.steps.len());
        for tick in 0..self.options.max_ticks {
            match self.pause(clock, tick, stop)? {
                Wait::Done => {}
                Wait::Stopped => return Ok(Outcome::Stopped),
                Wait::Lost(lost) => return Ok(Outcome::PeerLost(lost)),
            }
            self.roster.expect_all();
            // Empty: robots ask their own source.
            let horizons = match &mut self.policy {
                Some(policy) => policy.choose(tick, self.measuring.measured(tick), stop)?,
                None => &[],
            };
            let announced = self.hub.announce(tick, horizons)?;
            let late = clock.begin(announced);
            let deadline = Instant::now() + self.options.tick_deadline;
            let done = self.collect(Some(tick), deadline, stop, |heard, robot, report| {
                if report.kind != kind::STEP || report.plan.tick != tick || !heard.roster.answer(robot) {
                    return Ok(());
                }
                heard.stamps[robot] = report.stamps;
                heard.steps[robot] = report.to_step();
                let strange = "sent a report that means nothing here; is its program of another version?";
                let understood = heard.steps[robot].is_some();
                if understood { Ok(()) } else { Err(heard.roster.lost(robot, Some(tick), strange.into())) }
            })?;
            match done {
                Wait::Done => {}
                Wait::Stopped => return Ok(Outcome::Stopped),
                Wait::Lost(lost) => return Ok(Outcome::PeerLost(lost)),
            }
            let collected = os::now_ns();
            finished.clear();
            finished.extend(self.steps.iter_mut().filter_map(Option::take));
            for (position, step) in self.measuring.positions.iter_mut().zip(&finished) {
                *position = step.next_position;
            }
            *ticks = tick + 1;
            let seen = Tick { tick, steps: &finished, stamps: &self.stamps, announced, collected, late };
            match observer(&seen)? {
                Verdict::Continue => {}
                Verdict::Arrived => return Ok(Outcome::Completed),
            }
        }
        Ok(Outcome::TimedOut)
    }

    /// Waits until tick `tick` may begin.
    fn pause(&mut self, clock: &Clock, tick: u64, stop: &StopFlag) -> Result<Wait, ServiceError> {
        loop {
            if stop.is_set() {
                return Ok(Wait::Stopped);
            }
            let remaining = Duration::from_nanos(clock.remaining());
            if remaining.is_zero() {
                return Ok(Wait::Done);
            }
            self.hub.wait(remaining.min(LOOK_AROUND))?;
            if let Some(lost) = self.roster.find_ended(Some(tick)) {
                return Ok(Wait::Lost(lost));
            }
        }
    }

    /// Hands reports to `take` until nobody's answer is missing.
    fn collect(
        &mut self,
        tick: Option<u64>,
        mut deadline: Instant,
        stop: &StopFlag,
        mut take: impl FnMut(&mut Heard<'_>, usize, &Report) -> Result<(), PeerLost>,
    ) -> Result<Wait, ServiceError> {
        let start = Instant::now();
        let mut looked = start;
        loop {
            let (mut taken, mut lost) = (0, None);
            let Self { roster, hub, steps, stamps, .. } = self;
            let mut heard = Heard { roster, steps, stamps, deadline: &mut deadline };
            hub.collect(|robot, report| {
                taken += 1;
                lost = lost.take().or(take(&mut heard, robot, report).err());
            })?;
            if let Some(lost) = lost {
                return Ok(Wait::Lost(lost));
            }
            if self.roster.missing() == 0 {
                return Ok(Wait::Done);
            }
            if stop.is_set() {
                return Ok(Wait::Stopped);
            }
            // Looking costs a call per robot: only when nothing comes, or now and then.
            let now = Instant::now();
            if taken == 0 && now - looked >= LOOK_AROUND {
                looked = now;
                if let Some(lost) = self.roster.find_ended(tick) {
                    return Ok(Wait::Lost(lost));
                }
            }
            if now >= deadline {
                let how = format!("gave no answer for {:.1} s", (now - start).as_secs_f64());
                return Ok(self.roster.first_missing(tick, how).map_or(Wait::Done, Wait::Lost));
            }
            self.hub.wait((deadline - now).min(LOOK_AROUND))?;
        }
    }

    /// Ends the team: in order as far as its robots still listen.
    fn end(&mut self, outcome: Option<&Outcome>) -> Result<(), ServiceError> {
        let grace = match outcome {
            Some(Outcome::PeerLost(lost)) => {
                self.roster.kill(lost.robot);
                SHORT_GRACE
            }
            _ => GRACE,
        };
        let told = self.hub.stop();
        self.roster.ask_to_end();
        self.roster.wait_for_end(grace);
        told
    }

    /// Where the run's shared files are.
    pub fn place(&self) -> &Place {
        &self.place.0
    }
}

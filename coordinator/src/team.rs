//! Runs a team of robot processes: start, lock step, end.
//!
//! One tick: announce it, collect what every robot did, hand that to the director. Whatever happens,
//! dropping the [`Team`] ends every process and deletes every shared file of the run.

use crate::clock::Clock;
use crate::launch::{self, Agents};
use crate::own_place::OwnPlace;
use crate::policy::PolicySource;
use crate::record::RecordError;
use crate::roster::{PeerLost, Roster};
use crate::run::{Director, Ended, Episode, Observer, Options, Outcome, RunError, STALL, Tick, Verdict};
use shared::exchange::Hub;
use shared::messages::{MAX_ROBOTS, Report, Stamps, kind};
use shared::os;
use shared::place::{self, Place};
use shared::services::{self, ServiceError};
use shared::stop::StopFlag;
use shared::team::{FIRST_EPOCH, Setup, TeamFile};
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::hearing::measured;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;

/// How often a waiting coordinator looks for signals and ended processes.
const LOOK_AROUND: Duration = Duration::from_millis(50);
/// How long robots have to end by themselves when all is well.
const GRACE: Duration = Duration::from_millis(1200);
/// And when one of them was lost.
const SHORT_GRACE: Duration = Duration::from_millis(300);

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
    /// What the robots were told; [`Setup::of_episode`] gives an episode's own.
    setup: Setup,
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

/// The director of a single episode.
struct Once<'a, 'b>(&'a mut Observer<'b>);

impl Director for Once<'_, '_> {
    fn begin(&mut self, _: &Episode<'_>) -> Result<Option<[u8; 32]>, RecordError> {
        Ok(None)
    }

    fn tick(&mut self, tick: &Tick<'_>) -> Result<Verdict, RecordError> {
        (self.0)(tick)
    }

    fn another(&mut self, _: &Outcome) -> Result<bool, RecordError> {
        Ok(false)
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
            episodes: options.episodes.clone(),
            start_patience: options.start_patience.as_secs_f64() + 5.0,
            silence_limit: options.tick_deadline.as_secs_f64()
                + params.model.sample_time
                + 5.0
                + options.idle.as_secs_f64(),
            place: place.0.clone(),
        };
        let path = options.run.join("iceoryx2.toml");
        let text = services::config_text(&place.0)?;
        std::fs::write(&path, text).map_err(|source| RunError::Config { path, source })?;
        let hub = Hub::create(options.exchange, &place.0, robots, FIRST_EPOCH)?;
        // Only now: who finds this file finds the services as well.
        file.write(&options.run)?;
        let policy = match options.policy.clone() {
            Some(policy) => Some(PolicySource::start(policy, &place.0, &options.run, robots)?),
            None => None,
        };
        let names = scenario.robots.iter().map(|robot| robot.name.clone()).collect();
        let mut team = Self {
            roster: Roster::new(options.run.clone(), names),
            setup: Setup { team: file, scenario: scenario.clone(), params: params.clone() },
            policy,
            hub,
            place,
            measuring: Measuring { positions: Vec::new(), noise: params.disturbance.noise, seed: options.seed },
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
                Agents::ByHand => {}
                Agents::Launch(_) if stop.is_set() => return Ok(()), // `run` sees it, too
                Agents::Launch(program) => {
                    let child = launch::start(program, &self.options.run, robot)?;
                    self.roster.started(robot, child);
                }
            }
        }
        Ok(())
    }

    /// Runs one episode, and ends the team in order whatever became of it.
    pub fn run(self, stop: &StopFlag, observer: &mut Observer<'_>) -> Result<Ended, RunError> {
        self.play(stop, &mut Once(observer))
    }

    /// Runs episode after episode until the director has enough or one of them does not come to its
    /// end, and ends the team in order whatever became of it.
    pub fn play(mut self, stop: &StopFlag, director: &mut dyn Director) -> Result<Ended, RunError> {
        let sample_time = self.setup.params.model.sample_time;
        let mut clock = if self.options.real_time { Clock::real_time(sample_time) } else { Clock::lock_step() };
        let mut ticks = 0;
        let outcome = match self.gather(stop) {
            Ok(Wait::Done) => self.episodes(stop, director, &mut clock, &mut ticks),
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

    fn episodes(
        &mut self,
        stop: &StopFlag,
        director: &mut dyn Director,
        clock: &mut Clock,
        ticks: &mut u64,
    ) -> Result<Outcome, RunError> {
        let mut epoch = FIRST_EPOCH;
        loop {
            let setup = self.setup.of_episode(epoch)?;
            let (number, seed) = (self.setup.team.episodes.number(epoch), setup.team.seed);
            self.measuring.seed = seed;
            self.measuring.positions.clear();
            self.measuring.positions.extend(setup.scenario.robots.iter().map(|robot| robot.start));
            let wanted = director.begin(&Episode { number, seed, scenario: &setup.scenario })?;
            if let (Some(policy), Some(wanted)) = (&mut self.policy, wanted)
                && !policy.await_version(&wanted, &self.measuring.positions, stop)?
            {
                return Ok(Outcome::Stopped);
            }
            let outcome = self.tick_on(stop, director, clock, ticks)?;
            if !matches!(outcome, Outcome::Completed | Outcome::TimedOut) || !director.another(&outcome)? {
                return Ok(outcome);
            }
            epoch = match self.next_episode(stop)? {
                (epoch, Wait::Done) => epoch,
                (_, Wait::Stopped) => return Ok(Outcome::Stopped),
                (_, Wait::Lost(lost)) => return Ok(Outcome::PeerLost(lost)),
            };
        }
    }

    /// Sends everybody back to its start and waits until all are there.
    fn next_episode(&mut self, stop: &StopFlag) -> Result<(u64, Wait), RunError> {
        self.roster.expect_all();
        let epoch = self.hub.next_episode()?;
        if let Some(policy) = &mut self.policy {
            policy.next_episode(epoch);
        }
        let deadline = Instant::now() + self.options.tick_deadline;
        let done = self.collect(None, deadline, stop, |heard, robot, report| {
            if report.kind == kind::MET {
                heard.roster.answer(robot);
            }
            Ok(())
        })?;
        Ok((epoch, done))
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
        director: &mut dyn Director,
        clock: &mut Clock,
        ticks: &mut u64,
    ) -> Result<Outcome, RunError> {
        let mut finished = Vec::with_capacity(self.steps.len());
        let mut seen_at = Vec::with_capacity(self.steps.len());
        for tick in 0..self.options.max_ticks {
            match self.pause(clock, tick, stop)? {
                Wait::Done => {}
                Wait::Stopped => return Ok(Outcome::Stopped),
                Wait::Lost(lost) => return Ok(Outcome::PeerLost(lost)),
            }
            self.roster.expect_all();
            seen_at.clear();
            seen_at.extend(self.measuring.measured(tick));
            let asked = os::now_ns();
            // Empty: robots ask their own source.
            let horizons = match &mut self.policy {
                Some(policy) => policy.choose(tick, &seen_at, stop)?,
                None => &[],
            };
            let announced = self.hub.announce(tick, horizons)?;
            let rung = os::now_ns();
            let late = clock.begin(announced);
            let deadline = Instant::now() + self.options.tick_deadline;
            let done = self.collect(Some(tick), deadline, stop, |heard, robot, report| {
                if report.kind != kind::STEP || report.plan.tick != tick || !heard.roster.answer(robot) {
                    return Ok(());
                }
                heard.stamps[robot] = Stamps { collected: os::now_ns(), ..report.stamps };
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
            *ticks += 1;
            let actions = self.policy.as_ref().map_or(&[][..], PolicySource::actions);
            let measured = &seen_at;
            let (steps, stamps) = (&finished, &self.stamps);
            let acting = self.policy.as_ref().and_then(PolicySource::acting);
            let seen = Tick { tick, steps, measured, actions, stamps, asked, announced, rung, collected, late, acting };
            match director.tick(&seen)? {
                Verdict::Continue => {}
                Verdict::Over => return Ok(Outcome::Completed),
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
            std::thread::sleep(remaining.min(LOOK_AROUND));
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
            self.hub.wait(self.roster.missing(), (deadline - now).min(LOOK_AROUND));
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

//! Kills one robot's process of a team at a random moment of a random tick, run after run, and counts what that costs
//! the others.

use crate::text_table::TextTable;
use coordinator::horizons::RunHorizons;
use coordinator::record::{RecordError, RunFolder, write_setup};
use coordinator::run::{OnLoss, Options, Outcome, Run, RunError, RunTick};
use coordinator::team::ProcessTeam;
use shared::os;
use shared::runtime_dir::RuntimeDir;
use shared::stop::StopFlag;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;
use vodca::horizon_source::HorizonSpec;
use vodca::membership::State;
use vodca::metrics::{RunMetrics, RunSummary};
use vodca::params::Profile;
use vodca::play::{Observer, Verdict};
use vodca::random::{self, Use};
use vodca::scenario::{SetupError, set_up};

/// Ticks within which the kill falls; teams need about as many to arrive.
const WITHIN: u64 = 80;
/// The kill comes up to so long after the tick before has ended, us: before, in the midst of and after planning.
const DELAY_US: u64 = 2_000;
/// Robots of a team.
const ROBOTS: u64 = 14;

/// Why a run could not be done.
#[derive(Debug, thiserror::Error)]
pub enum FaultsError {
    /// Its scenario.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// Its folder.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A folder for it.
    #[error("cannot make a folder for a run: {0}")]
    Folder(#[from] std::io::Error),
}

/// One kill, and what it cost.
#[derive(Clone, Debug)]
pub struct Kill {
    /// Which run, from 0; everything random follows from it.
    pub number: u64,
    /// The layout.
    pub scenario: String,
    /// Who is killed.
    pub robot: usize,
    /// After this tick.
    pub tick: u64,
    /// So long after it, us.
    pub delay_us: u64,
    /// Whether it is started anew.
    pub respawn: bool,
    /// The run came to its end with everybody settled.
    pub settled: bool,
    /// Robots that were lost besides.
    pub other_deaths: usize,
    /// From the kill until the first new plan of the robot was there, ms.
    pub rejoin_ms: Option<f64>,
    /// Files of the run that were left.
    pub left: usize,
    /// The figures of the run.
    pub summary: RunSummary,
}

impl Kill {
    /// Robots that arrived.
    pub fn arrived(&self) -> usize {
        self.summary.robots.iter().filter(|robot| robot.arrived_tick.is_some()).count()
    }

    /// Robots that live and might have arrived, but did not.
    pub fn missing(&self) -> usize {
        let lost = self.summary.statuses.lost > 0 && !self.respawn;
        let dead = usize::from(lost && self.summary.robots[self.robot].arrived_tick.is_none());
        self.summary.robots.len() - self.arrived() - dead - self.summary.shut_off as usize
    }

    /// Whether nobody but the robot that was killed suffered from it.
    pub fn is_good(&self) -> bool {
        self.settled
            && self.other_deaths == 0
            && self.missing() == 0
            && self.left == 0
            && self.summary.pairs_below_min_separation == 0
    }
}

/// Kill number `number`; every second one with a restart.
///
/// # Errors
/// The run could not be done; how it went is no error.
pub fn kill(number: u64, stop: &StopFlag) -> Result<Kill, FaultsError> {
    let mut draw = random::stream(number, Use::Fault, ROBOTS, WITHIN);
    let robot = random::below(&mut draw, ROBOTS) as usize;
    let (tick, delay_us) = (random::below(&mut draw, WITHIN), random::below(&mut draw, DELAY_US));
    let respawn = number % 2 == 1;
    let name = if number % 4 < 2 { "ex14_d".to_string() } else { format!("box:{ROBOTS}:3:{number}") };
    let (scenario, params) = set_up(Some(&name), None, Profile::Safe, &[])?;
    let home = tempfile::tempdir()?;
    let folder = RunFolder::at(&home.path().join("run"))?;
    write_setup(&folder, &scenario, &params)?;
    let mut options = Options::new(folder.path(), &scenario).map_err(RunError::from)?;
    options.on_loss = OnLoss::Continue { respawn: u32::from(respawn) };
    options.horizons = HorizonSpec::Random(Some(number));
    let run = Run::launch(&scenario, &params, options, stop)?;
    let place = run.place().clone();
    let mut killer = Killer { robot, tick, delay_us, killed_at: Arc::default(), missed: false, rejoin_ms: None };
    let mut metrics = RunMetrics::new(&scenario, &params);
    let ended = run.play(&mut [&mut killer], &mut metrics)?;
    let was_killed = killer.killed_at.load(Ordering::Acquire) > 0;
    let lost = ended.changes.iter().filter(|change| change.state == State::Lost && change.robot != robot).count();
    Ok(Kill {
        number,
        scenario: name,
        robot,
        tick,
        delay_us,
        respawn,
        settled: ended.outcome == Outcome::Completed && (was_killed || metrics.arrived_all()),
        other_deaths: lost,
        rejoin_ms: killer.rejoin_ms,
        left: left(&place),
        summary: metrics.finish(),
    })
}

/// Kills a robot's process after a certain tick and sees when it is back.
struct Killer {
    robot: usize,
    tick: u64,
    delay_us: u64,
    /// ns of the monotonic clock; 0: not yet.
    killed_at: Arc<AtomicU64>,
    missed: bool,
    rejoin_ms: Option<f64>,
}

impl Observer<ProcessTeam, RunHorizons> for Killer {
    type Error = RecordError;

    fn tick(&mut self, seen: &RunTick<'_>) -> Result<Verdict, RecordError> {
        let took_part = seen.steps[self.robot].status.took_part();
        if seen.tick == self.tick
            && let Some(pid) = seen.team.pid(self.robot)
        {
            let (killed_at, delay) = (self.killed_at.clone(), Duration::from_micros(self.delay_us));
            thread::spawn(move || {
                thread::sleep(delay);
                killed_at.store(os::now_ns(), Ordering::Release);
                os::kill(pid);
            });
        }
        if self.missed && took_part && self.rejoin_ms.is_none() {
            let since = self.killed_at.load(Ordering::Acquire);
            self.rejoin_ms = Some(os::now_ns().saturating_sub(since) as f64 / 1e6);
        }
        self.missed |= !took_part;
        Ok(Verdict::Continue)
    }
}

/// Files of a run that are still there.
fn left(place: &RuntimeDir) -> usize {
    let shared = std::fs::read_dir("/dev/shm").into_iter().flatten().flatten();
    let ours = shared.filter(|entry| entry.file_name().to_string_lossy().starts_with(&place.prefix)).count();
    ours + usize::from(Path::new(&place.root).exists())
}

/// All kills as a table, a row each.
pub fn table(kills: &[Kill]) -> TextTable {
    let mut table = TextTable::new(&[
        "run",
        "scenario",
        "robot",
        "tick",
        "delay_us",
        "respawn",
        "settled",
        "other_deaths",
        "pairs_below",
        "min_separation",
        "arrived",
        "shut_off",
        "missing",
        "rejoin_ms",
        "left",
    ]);
    for kill in kills {
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.3}"));
        table.row([
            kill.number.to_string(),
            kill.scenario.clone(),
            kill.robot.to_string(),
            kill.tick.to_string(),
            kill.delay_us.to_string(),
            kill.respawn.to_string(),
            kill.settled.to_string(),
            kill.other_deaths.to_string(),
            kill.summary.pairs_below_min_separation.to_string(),
            kill.summary.min_separation.map_or(String::new(), |least| format!("{least:.6}")),
            kill.arrived().to_string(),
            kill.summary.shut_off.to_string(),
            kill.missing().to_string(),
            number(kill.rejoin_ms),
            kill.left.to_string(),
        ]);
    }
    table
}

/// What one kill cost the others.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// Whether the robot was started anew.
    pub respawn: bool,
    /// Robots that were lost besides.
    pub other_deaths: u64,
    /// Pairs that came below r_min.
    pub pairs_below: u64,
    /// The smallest separation, m.
    pub min_separation: Option<f64>,
    /// Robots that live and might have arrived, but did not.
    pub missing: u64,
    /// Robots whose set-point the body closes.
    pub shut_off: u64,
    /// Files that were left.
    pub left: u64,
    /// From the kill until the first new plan of the robot was there, ms.
    pub rejoin_ms: Option<f64>,
}

impl From<&Kill> for Cost {
    fn from(kill: &Kill) -> Self {
        Self {
            respawn: kill.respawn,
            other_deaths: kill.other_deaths as u64,
            pairs_below: kill.summary.pairs_below_min_separation,
            min_separation: kill.summary.min_separation,
            missing: kill.missing() as u64,
            shut_off: kill.summary.shut_off,
            left: kill.left as u64,
            rejoin_ms: kill.rejoin_ms,
        }
    }
}

/// The sums over kills, without and with a restart.
pub fn sums(costs: &[Cost]) -> TextTable {
    let mut table = TextTable::new(&[
        "restart",
        "runs",
        "other deaths",
        "pairs below",
        "least m",
        "living robots late",
        "set-points closed by the body",
        "files left",
        "rejoin p50, most (ms)",
    ]);
    for (respawn, title) in [(false, "none"), (true, "once")] {
        let chosen: Vec<&Cost> = costs.iter().filter(|cost| cost.respawn == respawn).collect();
        let sum = |of: fn(&Cost) -> u64| chosen.iter().map(|cost| of(cost)).sum::<u64>().to_string();
        let told = |value: Option<f64>, digits: usize| value.map_or("-".into(), |value| format!("{value:.digits$}"));
        let mut rejoins: Vec<f64> = chosen.iter().filter_map(|cost| cost.rejoin_ms).collect();
        rejoins.sort_by(f64::total_cmp);
        let [middle, most] = [rejoins.get(rejoins.len() / 2), rejoins.last()].map(|time| told(time.copied(), 0));
        table.row([
            title.into(),
            chosen.len().to_string(),
            sum(|cost| cost.other_deaths),
            sum(|cost| cost.pairs_below),
            told(chosen.iter().filter_map(|cost| cost.min_separation).reduce(f64::min), 6),
            sum(|cost| cost.missing),
            sum(|cost| cost.shut_off),
            sum(|cost| cost.left),
            format!("{middle}, {most}"),
        ]);
    }
    table
}

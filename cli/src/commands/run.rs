//! `run`: a team with one process per robot.

use super::parameter_args::{ParameterArgs, TeamArgs};
use super::run_losses::LossArgs;
use super::run_policy::PolicyArgs;
use super::run_tasks::TaskArgs;
use crate::commands::report as page;
use crate::exit::{self, Ending, Failure};
use crate::progress::Progress;
use crate::report::report;
use crate::stdout;
use coordinator::launch::{self, Agents};
use coordinator::record::about::{Machine, Versions};
use coordinator::record::{About, RunFolder};
use coordinator::run::{Options, Outcome, Run, RunTick};
use coordinator::session::Session;
use coordinator::summary::{End, Summary};
use coordinator::view::{Views, Wanted};
use evaluation::page::recorded::Recorded;
use shared::exchange::Kind;
use shared::messages::MAX_ROBOTS;
use shared::stop::StopFlag;
use std::path::{Path, PathBuf};
use std::time::Duration;
use vodca::horizon_source::{HorizonSource, HorizonSpec};
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::play::Verdict;
use vodca::scenario::{Scenario, set_up};
use vodca::tasks::Tasks;

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh 14                                      fourteen robots change sides around three obstacles
  ./run.sh 4 --scenario four_gate --horizon random:3
  ./run.sh 2 --profile paper --horizon fixed:9,40
  ./run.sh 8 --scenario my_layout.toml --set vodca.rows=each --out my_run
  ./run.sh 14 --policy policies/exchange_14
  ./run.sh 14 --real-time --respawn 3 --chaos kill:0.002,drop:0.01,seed:7
  ./run.sh 14 --tasks random:1 --max-ticks 3000
  ./run.sh 14 --horizon script:runs/20260131-120000-ex14_d-14/horizons.csv
Without --scenario: 2 two_setpoint, 4 four_gate, 14 ex14_d, otherwise a ring.
Exit codes: 0 arrived, or asked to stop; 1 not arrived, collided or lost on the way; 2 wrong usage; 3 a robot's process
was lost before the first tick, or with --on-loss stop.")]
pub struct Args {
    /// Number of robots
    #[arg(value_name = "N", required_unless_present = "scenario", value_parser = number_of_robots)]
    robots: Option<usize>,
    /// Scenario: file, built-in name (`scenario list`) or family (ring:16, box:16:3:7)
    #[arg(long, value_name = "FILE|NAME")]
    scenario: Option<String>,
    /// Where horizons come from: fixed:20, fixed:9,40 (one per robot), random:SEED, script:FILE
    #[arg(long, value_name = "SPEC", default_value = "fixed:20")]
    horizon: HorizonSpec,
    /// ONNX file or policies folder that chooses the horizons at every tick, instead of --horizon
    #[arg(long, value_name = "PATH", conflicts_with = "horizon")]
    pub(crate) policy: Option<PathBuf>,
    #[command(flatten)]
    use_policy: PolicyArgs,
    #[command(flatten)]
    parameters: ParameterArgs,
    #[command(flatten)]
    team: TeamArgs,
    /// Seed of everything random, instead of the scenario's
    #[arg(long)]
    seed: Option<u64>,
    /// Folder of the run, new or empty; left out: `runs/UTC-SCENARIO-N`
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// One tick per sample time instead of as fast as everybody answers
    #[arg(long)]
    real_time: bool,
    /// Write the run's page for a browser as soon as it has ended, as `report` does
    #[arg(long)]
    report: bool,
    /// Show the team in this terminal while it drives
    #[arg(long)]
    tui: bool,
    /// Serve the scene to a browser on this machine while the team drives, best with --real-time; 0: any free port
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "0")]
    live: Option<u16>,
    /// When the run has ended, repeat it in this process with every QP solved by Clarabel as well, and tell
    /// the largest difference of an input
    #[arg(long)]
    check_solver: bool,
    /// Serve the scene to Foxglove or Lichtblick on this machine (ws://127.0.0.1:PORT) while the team drives
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "8765")]
    pub(crate) foxglove: Option<u16>,
    #[command(flatten)]
    losses: LossArgs,
    #[command(flatten)]
    tasks: TaskArgs,
    /// Print the robots' commands and wait for them to be started by hand
    #[arg(long)]
    by_hand: bool,
}

fn number_of_robots(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| format!("`{text}` is not a number of robots; write a whole number in 1..={MAX_ROBOTS}"))
}

/// Runs the team and reports.
pub fn run(args: Args) -> Ending {
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let (mut scenario, params) =
        set_up(args.scenario.as_deref(), args.robots, args.parameters.profile, &args.parameters.set)
            .map_err(Failure::usage)?;
    params.warnings().iter().for_each(|warning| tracing::warn!("{warning}"));
    scenario.seed = args.seed.unwrap_or(scenario.seed);
    scenario.max_ticks = args.team.max_ticks.unwrap_or(scenario.max_ticks);
    // Whether there are horizons for all is said before anything is made.
    HorizonSource::new(&args.horizon, scenario.robots.len(), scenario.seed, params.horizon.jitter)
        .map_err(Failure::usage)?;
    let tasks = args.tasks.tasks(&scenario, &params)?;
    let folder =
        RunFolder::create(args.out.as_deref(), &scenario.name, scenario.robots.len()).map_err(Failure::usage)?;
    let mut options = options(&args, &scenario, &folder)?;
    options.tasks = Some(tasks);
    if let Some(policy) = &args.policy {
        options.policy = Some(args.use_policy.options(policy, &scenario)?);
    }
    let wanted =
        Wanted { terminal: args.tui, browser: args.live, foxglove: args.foxglove, horizons: source_of_horizons(&args) };
    let views = Views::open(wanted, &scenario, &params).map_err(Failure::usage)?;
    for (view, address) in views.addresses() {
        stdout::line(format_args!("{view:<16}{address}"))?;
    }
    let session = Session::start(folder, &scenario, &params, about(&args, &scenario, options.exchange))
        .map_err(Failure::broken)?;
    // Two would draw over each other.
    let progress = if args.tui { Progress::hidden() } else { Progress::of_run(scenario.max_ticks) };
    let folder = session.path().to_owned();
    let ending = play(session, views, &progress, &scenario, &params, options, &stop);
    let ending = if args.check_solver { check_solver(&folder, ending) } else { ending };
    // A team that did not start has left nothing to see.
    if !matches!(ending, Err(Failure::Broken(_))) {
        point_to_page(&folder, args.report)?;
    }
    ending
}

fn options(args: &Args, scenario: &Scenario, folder: &RunFolder) -> Result<Options, Failure> {
    let mut options = Options::new(folder.path(), scenario).map_err(Failure::broken)?;
    options.horizons = args.horizon.clone();
    options.real_time = args.real_time;
    args.losses.apply(&mut options)?;
    if let Some(exchange) = args.team.exchange() {
        options.exchange = exchange;
    }
    if args.by_hand {
        options.agents = Agents::ByHand;
        options.start_patience = Duration::from_secs(600);
    }
    Ok(options)
}

/// As records and views name it.
fn source_of_horizons(args: &Args) -> String {
    match &args.policy {
        Some(policy) => format!("policy:{}", policy.display()),
        None => args.horizon.to_string(),
    }
}

fn about(args: &Args, scenario: &Scenario, exchange: Kind) -> About {
    About {
        version: 1,
        scenario: scenario.name.clone(),
        robots: scenario.robots.len(),
        profile: args.parameters.profile.to_string(),
        horizon: source_of_horizons(args),
        seed: scenario.seed,
        exchange: match exchange {
            Kind::Peer => "peer".into(),
            Kind::Relay => "relay".into(),
        },
        real_time: args.real_time,
        chaos: args.losses.chaos(),
        command: std::iter::once("./run.sh".to_string()).chain(std::env::args().skip(1)).collect(),
        versions: Versions::here(),
        machine: Machine::here(),
    }
}

/// Repeats what was recorded with both solvers, adds what was found to the summary, and prints it. A run
/// whose QPs differ has failed.
fn check_solver(folder: &Path, ending: Ending) -> Ending {
    let (repetition, check) = evaluation::replay::repeat(folder, true).map_err(Failure::broken)?;
    let Some(check) = check else { return ending };
    if let Some(difference) = repetition.difference {
        stdout::line(format_args!("{:<16}checked other QPs than the run's: {difference}", "solver"))?;
        return Ok(exit::Outcome::Failed);
    }
    Summary::add_solver_check(folder, check).map_err(Failure::broken)?;
    stdout::line(format_args!("{:<16}{check}", "solver"))?;
    if check.passed() { ending } else { ending.and(Ok(exit::Outcome::Failed)) }
}

/// Starts the processes, lets session and views watch them and says how it ended.
fn play(
    mut session: Session,
    mut views: Views,
    progress: &Progress,
    scenario: &Scenario,
    params: &Params,
    options: Options,
    stop: &StopFlag,
) -> Ending {
    let by_hand = matches!(options.agents, Agents::ByHand);
    let endless = options.tasks.as_ref().is_some_and(Tasks::is_endless);
    let run = Run::launch(scenario, params, options, stop).map_err(Failure::broken)?;
    for robot in (0..scenario.robots.len()).filter(|_| by_hand) {
        stdout::line(launch::command_line(session.path(), robot))?;
    }
    let mut told = |seen: &RunTick<'_>| {
        let RunTick { tick, steps, metrics, .. } = *seen;
        progress.tick(tick + 1, metrics.arrived(), steps.len(), metrics.min_separation());
        Ok(Verdict::Continue)
    };
    let metrics = RunMetrics::new(scenario, params);
    let mut metrics = if endless { metrics.endless() } else { metrics };
    let ended = run.play(&mut [&mut session, &mut views, &mut told], &mut metrics);
    progress.finish();
    views.close(); // the terminal first: what follows is to be read
    let ended = ended.map_err(Failure::broken)?;
    let end = match &ended.outcome {
        Outcome::Completed => End::Arrived,
        Outcome::TimedOut => End::OutOfTicks,
        Outcome::Stopped => End::Interrupted,
        Outcome::PeerLost(_) => End::PeerLost,
    };
    let (summary, folder) = session.finish(end, &metrics, ended.policy.clone()).map_err(Failure::broken)?;
    stdout::text(report(&summary, &folder))?;
    if ended.overruns.count > 0 {
        stdout::line(format_args!(
            "{:<16}{} ticks began late, the worst by {:.1} ms",
            "real time",
            ended.overruns.count,
            ended.overruns.worst_ns as f64 / 1e6
        ))?;
    }
    match ended.outcome {
        Outcome::PeerLost(lost) => Err(Failure::peer_lost(lost)),
        _ if summary.guarantee_broken => Ok(exit::Outcome::Failed),
        Outcome::Stopped => Ok(exit::Outcome::Done),
        _ if summary.run.success => Ok(exit::Outcome::Done),
        _ => Ok(exit::Outcome::Failed),
    }
}

/// Says how to see the run in a browser, or has written its page already.
fn point_to_page(folder: &Path, wanted: bool) -> Result<(), Failure> {
    if !wanted {
        stdout::line(format_args!("{:<16}./run.sh report {}", "to see it", folder.display()))?;
        return Ok(());
    }
    let path = folder.join(page::PAGE);
    let recorded = Recorded::read(folder).map_err(Failure::broken)?;
    page::write(&path, &[recorded]).map_err(Failure::broken)?;
    stdout::line(format_args!("{:<16}{}", "page", path.display()))?;
    Ok(())
}

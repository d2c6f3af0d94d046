//! `rollout`: episodes for a learner.

use super::length::metres;
use super::parameter_args::{ParameterArgs, TeamArgs};
use super::run_policy::PolicyArgs;
use crate::exit::{self, Ending, Failure};
use crate::progress::Progress;
use crate::stdout;
use coordinator::policy::PolicyOptions;
use coordinator::record::{RecordError, RunFolder, write_setup};
use coordinator::rollout::{Orders, Recorder, Until};
use coordinator::run::{Options, Outcome, Run};
use evaluation::text_table::TextTable;
use policy::rollout::{About, SCHEMA};
use policy::session::{Played, RoundReport, to_line};
use shared::stop::StopFlag;
use shared::team::Episodes;
use std::path::PathBuf;
use std::time::Duration;
use vodca::horizon_source::{HorizonSource, HorizonSpec};
use vodca::scenario::{Scenario, set_up};

/// What marks a family: every episode has a layout of its own.
const ANY_SEED: &str = ":any";
/// Rows after which a shard is full.
const ROWS: u64 = 10_000;

/// Arguments of `rollout`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh rollout --scenario two_setpoint --profile paper --horizon random --episodes 20 --out rollouts/two
  ./run.sh rollout --scenario ex14_d --start-jitter 0.2 --policy policies/exchange_14 --stochastic --episodes 50 --out rollouts/ex
  ./run.sh rollout --scenario box:8:3:any --horizon fixed:20 --episodes 100 --out rollouts/boxes
In Python: safetensors.numpy.load_file(\"rollouts/two/000000.safetensors\")[\"observation\"]")]
pub struct Args {
    /// Scenario: file, built-in name or family; with `any` as its seed (box:8:3:any) every episode has a layout of its own
    #[arg(long, value_name = "FILE|NAME|FAMILY")]
    scenario: String,
    /// Number of episodes
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..))]
    episodes: u64,
    /// Number of the first episode: seeds follow from it
    #[arg(long, value_name = "N", default_value_t = 0)]
    first: u64,
    /// Read rounds from standard input, `{"round": 0, "episodes": 10, "policy": "SHA256"}` a line, and write a shard for each
    #[arg(long, conflicts_with = "episodes")]
    rounds_from_stdin: bool,
    /// Begin again with the first episode after so many: an evaluation
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    cycle: Option<u64>,
    /// Only play and count: write no shards
    #[arg(long)]
    discard: bool,
    /// Folder of the shards, new or empty
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Where horizons come from: fixed:20, random, script:FILE
    #[arg(long, value_name = "SPEC", default_value = "random")]
    horizon: HorizonSpec,
    /// ONNX file or policies folder that chooses the horizons instead
    #[arg(long, value_name = "PATH", conflicts_with = "horizon")]
    pub(crate) policy: Option<PathBuf>,
    #[command(flatten)]
    use_policy: PolicyArgs,
    #[command(flatten)]
    parameters: ParameterArgs,
    #[command(flatten)]
    team: TeamArgs,
    /// Seed of everything random
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Move every start by up to so much per axis, m
    #[arg(long, value_name = "METRES", default_value_t = 0.0, value_parser = metres)]
    start_jitter: f64,
    /// Cut an episode off so many ticks after everybody has arrived; left out: play on to the last tick, as in the paper
    #[arg(long, value_name = "TICKS")]
    after_arrival: Option<u64>,
}

/// Plays and records.
pub fn run(args: Args) -> Ending {
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let family = args.scenario.strip_suffix(ANY_SEED);
    // Of a family any layout tells the number of robots and the parameters.
    let spec = family.map_or(args.scenario.clone(), |family| format!("{family}:0"));
    let (mut scenario, params) =
        set_up(Some(&spec), None, args.parameters.profile, &args.parameters.set).map_err(Failure::usage)?;
    scenario.seed = args.seed;
    scenario.max_ticks = args.team.max_ticks.unwrap_or(scenario.max_ticks);
    HorizonSource::new(&args.horizon, scenario.robots.len(), args.seed, params.horizon.jitter)
        .map_err(Failure::usage)?;
    let episodes = Episodes {
        start_jitter: args.start_jitter,
        first: args.first,
        cycle: args.cycle,
        family: family.map(str::to_owned),
    };
    episodes.scenario(&scenario, &params, args.seed).map_err(Failure::usage)?; // an impossible one is told now
    let out = RunFolder::at(&args.out).map_err(Failure::usage)?;
    // What a run needs in its folder lies beside the shards.
    let run = RunFolder::at(&out.file("session")).map_err(Failure::broken)?;
    write_setup(&run, &scenario, &params).map_err(Failure::broken)?;
    let options = options(&args, &scenario, &run, episodes)?;
    let about = about(&args, &scenario, options.policy.as_ref());
    let orders = match args.rounds_from_stdin {
        true => Orders::from_stdin(&stop),
        false => Orders::Fixed {
            next: 0,
            episodes: args.episodes,
            per_round: (ROWS / scenario.max_ticks).clamp(1, args.episodes),
        },
    };
    let until = args.after_arrival.map_or(Until::LastTick, |ticks| Until::Arrived { ticks });
    let progress = Progress::of_work(if args.rounds_from_stdin { 0 } else { args.episodes as usize });
    let mut all: Vec<Played> = Vec::new();
    let (mut seconds, mut trouble) = (0.0, None);
    let mut written = |report: &RoundReport| -> Result<(), RecordError> {
        report.episodes.iter().for_each(|_| progress.advance());
        seconds += report.seconds;
        if args.rounds_from_stdin {
            let line = to_line(report).map_err(|error| RecordError::Rollout { reason: error.to_string() })?;
            trouble = trouble.take().or(stdout::line(line).err());
        } else {
            all.extend(&report.episodes); // a trainer's session may go on for days
        }
        Ok(())
    };
    let keep = (!args.discard).then(|| args.out.clone());
    let Some(mut recorder) = Recorder::new(&params, about, orders, keep, until, &mut written) else {
        return Ok(exit::Outcome::Done);
    };
    let run = Run::launch(&scenario, &params, options, &stop).map_err(Failure::broken)?;
    let ended = run.play_episodes(&mut recorder).map_err(Failure::broken)?;
    drop(recorder);
    progress.finish();
    trouble.map_or(Ok(()), |error| Err(Failure::from(error)))?;
    if !args.rounds_from_stdin {
        stdout::text(table(&all, seconds))?;
        stdout::line(format_args!("{:<16}{}", "folder", args.out.display()))?;
    }
    match ended.outcome {
        Outcome::PeerLost(lost) => Err(Failure::peer_lost(lost)),
        _ => Ok(exit::Outcome::Done),
    }
}

fn options(args: &Args, scenario: &Scenario, run: &RunFolder, episodes: Episodes) -> Result<Options, Failure> {
    let mut options = Options::new(run.path(), scenario).map_err(Failure::broken)?;
    options.horizons = args.horizon.clone();
    options.seed = args.seed;
    options.episodes = episodes;
    options.exchange = args.team.exchange().unwrap_or(options.exchange);
    if args.rounds_from_stdin {
        options.idle = Duration::from_secs(3600); // a trainer may take its time; robots end with us anyway
    }
    if let Some(policy) = &args.policy {
        let policy = args.use_policy.options(policy, scenario)?;
        options.policy = Some(PolicyOptions { record: false, ..policy });
    }
    Ok(options)
}

fn about(args: &Args, scenario: &Scenario, policy: Option<&PolicyOptions>) -> About {
    About {
        schema: SCHEMA.into(),
        scenario: args.scenario.clone(),
        robots: scenario.robots.len(),
        profile: args.parameters.profile.to_string(),
        horizons: if policy.is_some() { policy::rollout::POLICY.into() } else { args.horizon.to_string() },
        seed: args.seed,
        start_jitter: args.start_jitter,
        max_ticks: scenario.max_ticks,
        policy_sha256: String::new(),
    }
}

/// What was played, in one row.
fn table(played: &[Played], seconds: f64) -> String {
    let ticks: u64 = played.iter().map(|one| one.ticks).sum();
    let mean = played.iter().map(|one| one.total).sum::<f64>() / played.len().max(1) as f64;
    let mut paths: Vec<f64> = played.iter().filter(|one| one.success).map(|one| one.path).collect();
    paths.sort_by(f64::total_cmp);
    let mut table = TextTable::new(&["episodes", "ticks", "success", "mean return", "median path m", "ticks/s"]);
    table.row([
        played.len().to_string(),
        ticks.to_string(),
        paths.len().to_string(),
        format!("{mean:.0}"),
        paths.get(paths.len() / 2).map_or("-".into(), |path| format!("{path:.2}")),
        format!("{:.0}", ticks as f64 / seconds.max(1e-9)),
    ]);
    table.aligned()
}

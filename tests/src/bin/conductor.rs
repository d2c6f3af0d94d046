//! A bare coordinator for tests and measurements: runs a team, records nothing but what robots did.

use anyhow::Context;
use clap::Parser;
use coordinator::launch::{Agents, Program};
use coordinator::run::{Options, Outcome, TICK_DEADLINE, Team, Verdict};
use shared::exchange::Kind;
use shared::params::Profile;
use shared::scenario;
use shared::stop::StopFlag;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

#[derive(Parser)]
struct Args {
    /// Name or file of the scenario
    #[arg(long)]
    scenario: String,
    /// An empty folder for the run
    #[arg(long)]
    out: PathBuf,
    /// Program of the robots; by hand when missing
    #[arg(long)]
    agent: Option<PathBuf>,
    /// ROBOT:KIND:TICK, for the fake robot
    #[arg(long)]
    fault: Option<String>,
    #[arg(long, default_value = "fixed:20")]
    horizon: String,
    #[arg(long, default_value_t = 350)]
    max_ticks: u64,
    #[arg(long)]
    relay: bool,
    #[arg(long)]
    real_time: bool,
    /// Run on until the last tick, arrived or not
    #[arg(long)]
    to_the_end: bool,
    /// Show latencies
    #[arg(long)]
    latency: bool,
}

fn main() -> ExitCode {
    match run() {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> anyhow::Result<ExitCode> {
    let stop = StopFlag::install()?;
    let args = Args::parse();
    let (scenario, params) = scenario::set_up(Some(&args.scenario), None, Profile::Safe, &[])?;
    std::fs::create_dir_all(&args.out)?;
    std::fs::write(args.out.join("scenario.toml"), scenario.to_toml()?)?;
    std::fs::write(args.out.join("params.toml"), params.to_toml())?;
    let options = Options {
        run: args.out.clone(),
        agents: match args.agent {
            None => Agents::ByHand,
            Some(path) => {
                let arguments = args.fault.map(|fault| format!("--fault={fault}")).into_iter().collect();
                Agents::Launch(Program { path, arguments })
            }
        },
        exchange: if args.relay { Kind::Relay } else { Kind::Peer },
        horizons: args.horizon,
        seed: 7,
        real_time: args.real_time,
        max_ticks: args.max_ticks,
        tick_deadline: TICK_DEADLINE,
        start_patience: Duration::from_secs(30),
    };
    let began = Instant::now();
    let team = Team::launch(&scenario, &params, options, &stop)?;
    let (mut text, mut durations, mut first) = (String::new(), Vec::new(), None);
    let mut parts: [Vec<u64>; 4] = Default::default();
    let ended = team.run(&stop, &mut |tick| {
        if tick.tick == 0 {
            println!("the team drives");
        }
        first.get_or_insert_with(|| began.elapsed());
        durations.push(tick.collected - tick.announced);
        for stamps in tick.stamps {
            let instants = [tick.announced, stamps.woken, stamps.read, stamps.planned, tick.collected];
            for (part, pair) in parts.iter_mut().zip(instants.windows(2)) {
                part.push(pair[1].saturating_sub(pair[0]));
            }
        }
        let mut arrived = !args.to_the_end;
        for (robot, step) in tick.steps.iter().enumerate() {
            let (p, u) = (step.next_position, step.input);
            let _ = writeln!(text, "{},{robot},{:?},{:?},{:?},{:?},{}", tick.tick, p.x, p.y, u.x, u.y, step.horizon);
            arrived &= (p - scenario.robots[robot].set_point).norm() < params.episode.arrival_tolerance;
        }
        if arrived { Verdict::Arrived } else { Verdict::Continue }
    })?;
    std::fs::write(args.out.join("steps.csv"), text).context("steps.csv")?;
    if args.latency {
        let show = |name: &str, values: &mut Vec<u64>| {
            values.sort_unstable();
            let at = |share: f64| values.get((values.len() as f64 * share) as usize).map_or(0.0, |ns| *ns as f64 / 1e3);
            println!("{name:10} p50 {:9.1}  p99 {:9.1} us", at(0.5), at(0.99));
        };
        println!("first tick finished {:.3} s after the launch", first.unwrap_or_default().as_secs_f64());
        show("tick", &mut durations);
        for (name, part) in ["wake", "read", "plan", "collect"].iter().zip(&mut parts) {
            show(name, part);
        }
    }
    println!("{:?} after {} ticks, {} overruns", ended.outcome, ended.ticks, ended.overruns.count);
    Ok(match ended.outcome {
        Outcome::Completed | Outcome::Stopped => ExitCode::SUCCESS,
        Outcome::TimedOut | Outcome::Abandoned => ExitCode::from(1),
        Outcome::PeerLost(lost) => {
            eprintln!("error: {lost}");
            ExitCode::from(3)
        }
    })
}

//! `learner bench`: updates per second on random rows, as CSV.

use crate::replay::Transition;
use crate::sac::Learner;
use crate::settings::Settings;
use shared::os::cpu_ns;
use std::time::Instant;
use vodca::random::{Use, stream, unit};

/// Rows to draw from.
const ROWS: usize = 10_000;
/// Updates before the clock starts.
const WARM_UP: u64 = 20;

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example:\n  ./run.sh learner bench --robots 14 --threads 2\n\nlearner/bench/compare.sh runs it beside PyTorch."
)]
pub(crate) struct Args {
    /// Number of robots
    #[arg(long, default_value_t = 14, value_parser = clap::value_parser!(u64).range(1..=200))]
    robots: u64,
    /// Updates that are timed
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u64).range(1..))]
    updates: u64,
    /// Threads of an update
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// A setting of the learner, as printed by `learner settings`
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Leave out the heading
    #[arg(long)]
    no_heading: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let start = Settings { replay_rows: ROWS, threads: args.threads, ..Settings::default() };
    start.validate()?;
    let settings = args.set.iter().try_fold(start, |settings, assignment| settings.with(assignment))?;
    let (robots, batch) = (args.robots as usize, settings.batch);
    let mut learner = Learner::new(2 * robots, robots, settings, 1);
    let mut generator = stream(1, Use::Problem, 0, 0);
    let mut draw = |count| -> Vec<f32> { (0..count).map(|_| 2.0 * unit(&mut generator) as f32 - 1.0).collect() };
    for _ in 0..ROWS {
        let (observation, action, next_observation) = (draw(2 * robots), draw(robots), draw(2 * robots));
        learner.remember(Transition {
            observation: &observation,
            reward: 100.0 * action[0],
            action: &action,
            terminated: false,
            next_observation: &next_observation,
        });
    }
    (0..WARM_UP).for_each(|_| {
        learner.update();
    });
    let (clock, cpu) = (Instant::now(), cpu_ns());
    (0..args.updates).for_each(|_| {
        learner.update();
    });
    let (seconds, cpu_seconds) = (clock.elapsed().as_secs_f64(), (cpu_ns() - cpu) as f64 * 1e-9);
    if !args.no_heading {
        println!("program,robots,batch,threads,updates,seconds,cpu_seconds,updates_per_second,updates_per_cpu_second");
    }
    let (updates, threads) = (args.updates, args.threads);
    let (speed, cpu_speed) = (updates as f64 / seconds, updates as f64 / cpu_seconds);
    println!("vodca,{robots},{batch},{threads},{updates},{seconds:.3},{cpu_seconds:.3},{speed:.1},{cpu_speed:.1}");
    Ok(())
}

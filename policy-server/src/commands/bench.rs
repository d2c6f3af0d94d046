//! `policy bench`: how long loading and inference take, as JSON. `./run.sh bench policy` asks for it.

use crate::actor::{Actor, Answer, Runtime};
use crate::means::Means;
use crate::random_actor::random_actor;
use serde::Serialize;
use std::process::ExitCode;
use std::time::Instant;
use vodca::Position;
use vodca::random::{self, Use};
use vodca::scenario::MAX_ROBOTS;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy bench --robots 14\n\
    `./run.sh bench policy` makes a table of it.")]
pub(crate) struct BenchArgs {
    /// Number of robots
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=MAX_ROBOTS as u64))]
    robots: u64,
    /// Inferences that are measured
    #[arg(long, default_value_t = 1_000, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    count: u64,
    #[command(flatten)]
    means: Means,
}

/// What was measured, ns.
#[derive(Serialize)]
struct Measured {
    /// Starting the back-end.
    start_ns: u64,
    /// Loading the model.
    load_ns: u64,
    /// The first inference, which warms it up.
    first_ns: u64,
    /// Normalising and computing one observation each.
    inference_ns: Vec<u64>,
}

pub(crate) fn run(args: &BenchArgs) -> anyhow::Result<ExitCode> {
    let robots = args.robots as usize;
    let (model, contract) = random_actor(robots, 1);
    let since = |start: Instant| start.elapsed().as_nanos() as u64;
    let start = Instant::now();
    let runtime = Runtime::start(&args.means.back_end())?;
    let start_ns = since(start);
    let start = Instant::now();
    let mut actor = Actor::load(&runtime, &model, &contract)?;
    let load_ns = since(start);
    let (mut input, mut answer) = (vec![0.0f32; 2 * robots], Answer::default());
    let mut times = Vec::with_capacity(args.count as usize + 1);
    for case in 0..=args.count {
        let mut generator = random::stream(1, Use::Policy, u64::MAX - 1, case);
        let mut draw = || 80.0 * random::unit(&mut generator) - 40.0;
        let positions: Vec<Position> = (0..robots).map(|_| Position::new(draw(), draw())).collect();
        let start = Instant::now();
        actor.contract().normalise(&positions, &mut input);
        actor.infer(&input, &mut answer)?;
        times.push(since(start));
    }
    let first_ns = times.remove(0);
    println!("{}", serde_json::to_string(&Measured { start_ns, load_ns, first_ns, inference_ns: times })?);
    Ok(ExitCode::SUCCESS)
}

//! Benchmarks that can be trusted: every figure beside its floor or its peer, measured by one command.
//!
//! Every distribution rests on at least 20,000 samples (1,000 at the pace of real time), and a percentile is
//! told only where at least ten samples lie beyond it. What is compared is measured in turns, so that whatever
//! else the machine does falls on both sides, and waits in the same way: who spins is compared with who spins,
//! who sleeps with who sleeps. Read ratios first: digits belong to the machine that `machine.toml` describes.

mod compare;
mod cost;
mod dump;
mod exchange;
mod floor;
mod hop;
mod iceoryx_links;
mod links;
mod load;
mod machine;
mod markdown;
pub mod partner;
mod plots;
mod policy;
mod qp;
mod real_time;
pub mod row;
mod scale;
mod step;
mod still;
mod stored;
mod system;
mod tables;
mod teams;
mod ticks;

pub use compare::Earlier;
pub use load::LoadAverage;
pub use markdown::{Section, sections};
pub use row::Results;
pub use stored::StoredError;

use coordinator::record::RecordError;
use coordinator::run::RunError;
use shared::runtime_dir::RuntimeDirError;
use shared::services::ServiceError;
use shared::stop::StopFlag;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What can be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Part {
    /// One QP: our solver beside Clarabel, by horizon and rows
    Solver,
    /// A robot's whole step in a closed loop; changing horizons; ORCA
    Step,
    /// A tick of the team, by number of robots, form and load, beside a futex floor
    Exchange,
    /// One message between two processes, beside floors of the system
    Hop,
    /// Large teams: start, real time; ticks per second of the environment
    Scale,
    /// Inference, and from the observation to the horizons
    Policy,
    /// Everything
    All,
}

impl Part {
    /// Its name, also of its rows.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solver => "solver",
            Self::Step => "step",
            Self::Exchange => "exchange",
            Self::Hop => "hop",
            Self::Scale => "scale",
            Self::Policy => "policy",
            Self::All => "all",
        }
    }
}

/// What to measure, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// What.
    pub part: Part,
    /// So briefly that only the form of the results means anything.
    pub quick: bool,
    /// Sizes of teams, instead of the usual ones.
    pub robots: Option<Vec<usize>>,
    /// Where the QPs are written that `solver` measures, as JSON.
    pub dump: Option<PathBuf>,
    /// The ONNX Runtime library to measure beside the embedded back-end.
    pub onnxruntime: Option<PathBuf>,
    /// Neither histograms nor plots are written.
    pub tables_only: bool,
}

/// Why a benchmark could not be done.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// Somebody asked for it.
    #[error("the benchmark was asked to stop; nothing was written")]
    Stopped,
    /// The system refused.
    #[error("cannot {what} for the benchmark: {source}; is /dev/shm writable, and are enough processes allowed?")]
    System {
        /// What was attempted.
        what: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// A process does not answer.
    #[error("no answer came from {who}; is the machine so busy that processes starve? Try again when it is quieter")]
    Silent {
        /// From whom.
        who: &'static str,
    },
    /// A team did not finish.
    #[error("a measured team of {robots} robots did not finish: {reason}")]
    Team {
        /// How many.
        robots: usize,
        /// How it ended.
        reason: String,
    },
    /// The policy server's own benchmark.
    #[error("the policy server could not be measured: {0}; try `./run.sh policy --help`")]
    Policy(String),
    /// A team.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A robot.
    #[error(transparent)]
    Robot(#[from] agent::run::RunError),
    /// A file.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The place of shared files.
    #[error(transparent)]
    RuntimeDir(#[from] RuntimeDirError),
    /// The exchange.
    #[error(transparent)]
    Service(#[from] ServiceError),
    /// Horizons.
    #[error(transparent)]
    Horizons(#[from] vodca::horizon_source::HorizonSourceError),
    /// A scenario or parameters.
    #[error(transparent)]
    SetUp(#[from] vodca::scenario::SetupError),
}

/// For `map_err`: the system refused `what`.
fn failed(what: &'static str) -> impl Fn(std::io::Error) -> BenchError {
    move |source| BenchError::System { what, source }
}

impl Options {
    /// The whole of `part`.
    pub fn whole(part: Part) -> Self {
        Self { part, quick: false, robots: None, dump: None, onnxruntime: None, tables_only: false }
    }

    /// `full`, or `quick` where only the form counts.
    fn pick<T>(&self, full: T, quick: T) -> T {
        if self.quick { quick } else { full }
    }

    /// Sizes of teams: what was asked for, or `full`, or `quick` where only the form counts.
    fn sizes(&self, full: &[usize], quick: &[usize]) -> Vec<usize> {
        match &self.robots {
            Some(robots) => robots.clone(),
            None => self.pick(full, quick).to_vec(),
        }
    }
}

/// Hears how far a benchmark is.
pub trait Watch {
    /// Part `name` begins.
    fn part(&self, name: &'static str);
    /// Something is done that was expected to take `seconds`, a share of what [`estimate`] gave.
    fn done(&self, seconds: f64);
}

/// How much is measured, and how that is told.
struct Extent<'a> {
    options: &'a Options,
    stop: &'a StopFlag,
    watch: &'a dyn Watch,
}

impl Extent<'_> {
    /// Part `name` begins.
    fn tell(&self, name: &'static str) {
        self.watch.part(name);
    }

    /// What was expected to take `seconds` is done.
    fn advance(&self, seconds: f64) -> Result<(), BenchError> {
        self.watch.done(seconds);
        if self.stop.is_set() { Err(BenchError::Stopped) } else { Ok(()) }
    }
}

/// A piece of a benchmark: its part, what it is expected to take (s), and how it is measured.
type Piece = (Part, fn(&Options) -> f64, fn(&Extent<'_>, &mut Results) -> Result<(), BenchError>);

/// All pieces, in their order: what takes long, and what needs many processes, comes last.
const PIECES: [Piece; 7] = [
    (Part::Solver, qp::seconds, qp::run),
    (Part::Step, step::seconds, step::run),
    (Part::Hop, hop::seconds, hop::run),
    (Part::Policy, policy::seconds, policy::run),
    (Part::Exchange, exchange::seconds, exchange::run),
    (Part::Scale, scale::seconds, scale::run),
    (Part::Scale, ticks::seconds, ticks::run),
];

fn pieces(wanted: Part) -> impl Iterator<Item = Piece> {
    PIECES.into_iter().filter(move |(part, ..)| wanted == *part || wanted == Part::All)
}

/// How long measuring will take on two quiet cores.
pub fn estimate(options: &Options) -> Duration {
    Duration::from_secs_f64(pieces(options.part).map(|(_, seconds, _)| seconds(options)).sum())
}

/// Measures what `options` name. `load`: the machine's before anything of this benchmark ran.
pub fn measure(
    options: &Options,
    load: LoadAverage,
    stop: &StopFlag,
    watch: &dyn Watch,
) -> Result<Results, BenchError> {
    let extent = Extent { options, stop, watch };
    let start = Instant::now();
    let mut results = Results { load_before: load, ..Results::default() };
    for (_, _, run) in pieces(options.part) {
        run(&extent, &mut results)?;
    }
    results.load_after = LoadAverage::now();
    results.seconds = start.elapsed().as_secs_f64();
    Ok(results)
}

/// Writes the results into `folder`: tables and the machine, and unless only tables are wanted histograms and
/// plots.
pub fn write(results: &Results, folder: &coordinator::record::RunFolder, options: &Options) -> Result<(), BenchError> {
    folder.write("rows.csv", results.rows_table().csv().as_bytes())?;
    folder.write("figures.csv", results.figures_table().csv().as_bytes())?;
    folder.write("machine.toml", machine::describe(options, results).as_bytes())?;
    if options.tables_only {
        return Ok(());
    }
    folder.write("histograms.csv", results.histograms().as_bytes())?;
    for (name, svg) in plots::all(results) {
        folder.write(&name, svg.as_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[derive(Default)]
    struct Sum(Cell<f64>);

    impl Watch for Sum {
        fn part(&self, _: &'static str) {}

        fn done(&self, seconds: f64) {
            self.0.set(self.0.get() + seconds);
        }
    }

    #[test]
    fn what_is_told_to_be_done_adds_up_to_the_estimate() {
        for part in [Part::Solver, Part::Step] {
            let (options, sum) = (Options { quick: true, ..Options::whole(part) }, Sum::default());
            measure(&options, LoadAverage::default(), &StopFlag::default(), &sum).unwrap();
            let share = sum.0.get() / estimate(&options).as_secs_f64();
            assert!((share - 1.0).abs() < 0.01, "{part:?}: {share}");
        }
    }

    #[test]
    fn the_whole_benchmark_takes_about_twenty_minutes() {
        let minutes = estimate(&Options::whole(Part::All)).as_secs_f64() / 60.0;
        assert!((10.0..22.0).contains(&minutes), "{minutes}");
    }
}

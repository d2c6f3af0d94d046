//! Benchmarks that can be trusted: every figure beside its floor or its peer, measured by one command.
//!
//! Parts that compare processes run interleaved, so that whatever else the machine does falls on both
//! sides. Read ratios first: digits belong to the machine that `machine.toml` describes.

mod compare;
mod dump;
mod exchange;
mod floor;
mod hop;
mod links;
mod machine;
pub mod partner;
mod plots;
mod policy;
mod qp;
pub mod row;
mod scale;
mod step;
mod still;
mod teams;
mod ticks;

pub use compare::{CompareError, Earlier};
pub use row::Results;

use coordinator::record::RecordError;
use coordinator::run::RunError;
use shared::place::PlaceError;
use shared::services::ServiceError;
use shared::stop::StopFlag;
use std::path::PathBuf;

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
    /// Large teams: start and real time; ticks per second of the environment
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
    Place(#[from] PlaceError),
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

/// Hears how far a benchmark is.
pub trait Watch {
    /// Part `name` begins, which has `steps` steps.
    fn part(&self, name: &'static str, steps: usize);
    /// One of them is done.
    fn step(&self);
}

/// How much is measured, and how that is told.
struct Extent<'a> {
    options: &'a Options,
    stop: &'a StopFlag,
    watch: &'a dyn Watch,
}

impl Extent<'_> {
    /// `full`, or `quick` where only the form counts.
    fn pick<T>(&self, full: T, quick: T) -> T {
        if self.options.quick { quick } else { full }
    }

    /// Sizes of teams: what was asked for, or `full`, or `quick` where only the form counts.
    fn sizes(&self, full: &[usize], quick: &[usize]) -> Vec<usize> {
        match &self.options.robots {
            Some(robots) => robots.clone(),
            None => self.pick(full, quick).to_vec(),
        }
    }

    /// Part `name` has `steps` steps.
    fn tell(&self, name: &'static str, steps: usize) {
        self.watch.part(name, steps);
    }

    /// One of them is done.
    fn advance(&self) -> Result<(), BenchError> {
        self.watch.step();
        if self.stop.is_set() { Err(BenchError::Stopped) } else { Ok(()) }
    }
}

/// Measures what `options` name.
pub fn measure(options: &Options, stop: &StopFlag, watch: &dyn Watch) -> Result<Results, BenchError> {
    let extent = Extent { options, stop, watch };
    let mut results = Results::default();
    let wanted = |part| options.part == part || options.part == Part::All;
    if wanted(Part::Solver) {
        qp::run(&extent, &mut results)?;
    }
    if wanted(Part::Step) {
        step::run(&extent, &mut results)?;
    }
    if wanted(Part::Hop) {
        hop::run(&extent, &mut results)?;
    }
    if wanted(Part::Exchange) {
        exchange::run(&extent, &mut results)?;
    }
    if wanted(Part::Scale) {
        scale::run(&extent, &mut results)?;
        ticks::run(&extent, &mut results)?;
    }
    if wanted(Part::Policy) {
        policy::run(&extent, &mut results)?;
    }
    Ok(results)
}

/// Writes the results into `folder`: tables, histograms, plots and the machine.
pub fn write(results: &Results, folder: &coordinator::record::RunFolder, options: &Options) -> Result<(), BenchError> {
    folder.write("rows.csv", results.rows_table(None).csv().as_bytes())?;
    folder.write("figures.csv", results.figures_table().csv().as_bytes())?;
    folder.write("histograms.csv", results.histograms().as_bytes())?;
    folder.write("machine.toml", machine::describe(options).as_bytes())?;
    for (name, svg) in plots::all(results) {
        folder.write(&name, svg.as_bytes())?;
    }
    Ok(())
}

//! `bench`: latencies beside their floors, and times beside those of others.

use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Parts;
use crate::stdout::{self, PrintError};
use coordinator::record::RunFolder;
use evaluation::bench::row::TICK_PARTS;
use evaluation::bench::{self, Earlier, LoadAverage, Options, Part, Results};
use shared::messages::MAX_ROBOTS;
use shared::stop::StopFlag;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The load average forgets a build of two processes within this time.
const SETTLING: Duration = Duration::from_secs(120);

/// Arguments of `bench`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh bench solver
  ./run.sh bench exchange --out before
  ./run.sh bench exchange --compare before
  ./run.sh bench exchange --robots 14,50
  ./run.sh bench all --onnxruntime /usr/lib/libonnxruntime.so
  ./run.sh bench all --tables-only --out results/latency
  ./run.sh bench --markdown results/latency
Writes rows.csv, figures.csv, machine.toml, histograms.csv and plots (SVG). Every row rests on at least 20,000
samples, at the pace of real time on 1,000; a percentile with fewer than ten samples beyond it is `-`. Read ratios
first, and let nothing else run meanwhile: digits belong to the machine, and one whose load does not fall to 0.5
within two minutes before it begins is called busy. `all` takes about twenty minutes.")]
pub struct Args {
    /// What to measure
    #[arg(default_value = "all")]
    pub(crate) part: Part,
    /// So briefly that only the form of the results means anything (for tests)
    #[arg(long)]
    quick: bool,
    /// Folder of the results, new or empty; left out: `runs/UTC-bench-PART`
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of an earlier benchmark: tables get a column with p50 now over p50 then
    #[arg(long, value_name = "DIR")]
    compare: Option<PathBuf>,
    /// Sizes of teams to measure (exchange, scale, policy), instead of the usual ones
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = size_of_team)]
    robots: Option<Vec<usize>>,
    /// Write the QPs that `solver` measures as JSON, for other solvers
    #[arg(long, value_name = "FILE")]
    dump: Option<PathBuf>,
    /// ONNX Runtime library (1.24 or later) to measure beside the embedded back-end
    #[arg(long, value_name = "FILE")]
    onnxruntime: Option<PathBuf>,
    /// Write neither histograms nor plots: what is small enough to keep
    #[arg(long)]
    tables_only: bool,
    /// Measure nothing: print the tables of an earlier benchmark as Markdown
    #[arg(long, value_name = "DIR", exclusive = true)]
    markdown: Option<PathBuf>,
}

fn size_of_team(text: &str) -> Result<usize, String> {
    let size = text.parse().ok().filter(|size| (1..=MAX_ROBOTS).contains(size));
    size.ok_or_else(|| format!("`{text}` is not a number of robots; write whole numbers in 1..={MAX_ROBOTS}"))
}

/// Measures, writes and prints.
pub fn run(args: Args) -> Ending {
    if let Some(folder) = &args.markdown {
        return print_markdown(folder);
    }
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let earlier = match &args.compare {
        Some(folder) => Earlier::read(folder).map_err(Failure::usage)?,
        None => Earlier::default(),
    };
    let name = format!("bench-{}", args.part.name());
    let folder = RunFolder::named(args.out.as_deref(), &name).map_err(Failure::usage)?;
    let options = Options {
        part: args.part,
        quick: args.quick,
        robots: args.robots,
        dump: args.dump,
        onnxruntime: args.onnxruntime,
        tables_only: args.tables_only,
    };
    let expected = bench::estimate(&options);
    let load = if options.quick { LoadAverage::now() } else { begin(expected, &stop) };
    let results = {
        let parts = Parts::expected(expected);
        let measured = bench::measure(&options, load, &stop, &parts);
        parts.finish();
        measured.map_err(Failure::broken)?
    };
    // Whatever becomes of the terminal, the results are kept.
    bench::write(&results, &folder, &options).map_err(Failure::broken)?;
    print(&results, &earlier)?;
    stdout::line(folder.path().display())?;
    Ok(Outcome::Done)
}

/// Says how long it will take, lets the load of the build that came before settle, and returns what is left of it.
fn begin(expected: Duration, stop: &StopFlag) -> LoadAverage {
    let seconds = expected.as_secs();
    let time = if seconds < 100 { format!("{seconds} s") } else { format!("{} minutes", (seconds + 30) / 60) };
    let mut stderr = std::io::stderr();
    // That nobody reads it is no reason not to measure.
    let _ = writeln!(stderr, "takes about {time} on two quiet cores");
    let (began, mut load) = (Instant::now(), LoadAverage::now());
    if load.is_busy() {
        let _ =
            writeln!(stderr, "the load is {}: waiting up to {} s for it to settle", load.text(), SETTLING.as_secs());
    }
    while load.is_busy() && began.elapsed() < SETTLING && !stop.is_set() {
        std::thread::sleep(Duration::from_millis(200));
        load = LoadAverage::now();
    }
    if load.is_busy() {
        let _ = writeln!(stderr, "the load is still {}: the tables will call this machine busy", load.text());
    }
    load
}

fn print(results: &Results, earlier: &Earlier) -> Result<(), PrintError> {
    let machine = format!(
        "{} machine: load {} before, {} after",
        results.load_before.verdict(),
        results.load_before.text(),
        results.load_after.text()
    );
    stdout::line(&machine)?;
    for part in results.parts() {
        stdout::line(format_args!("{part} ({} machine)", results.load_before.verdict()))?;
        if part == TICK_PARTS {
            stdout::line(results.tick_parts_table().aligned())?;
            continue;
        }
        stdout::line(results.part_table(part, earlier).aligned())?;
    }
    if !results.figures.is_empty() {
        stdout::line(results.figures_table().aligned())?;
    }
    Ok(())
}

fn print_markdown(folder: &Path) -> Ending {
    for section in bench::sections(folder).map_err(Failure::usage)? {
        stdout::line(format_args!("### {}\n\n{}\n\n{}", section.name, section.caption, section.table))?;
    }
    Ok(Outcome::Done)
}

//! `bench`: latencies beside their floors, and times beside those of others.

use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Parts;
use crate::stdout;
use coordinator::record::RunFolder;
use evaluation::bench::row::TICK_PARTS;
use evaluation::bench::{self, Earlier, Options, Part};
use shared::messages::MAX_ROBOTS;
use shared::stop::StopFlag;
use std::path::PathBuf;

/// Arguments of `bench`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh bench solver
  ./run.sh bench exchange --out before
  ./run.sh bench exchange --compare before
  ./run.sh bench exchange --robots 14,50
  ./run.sh bench all --onnxruntime /usr/lib/libonnxruntime.so
Writes rows.csv, figures.csv, histograms.csv, machine.toml and plots (SVG). Read ratios first, and let nothing
else run meanwhile: digits belong to the machine. `all` takes a quarter of an hour.")]
pub struct Args {
    /// What to measure
    #[arg(default_value = "all")]
    part: Part,
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
}

fn size_of_team(text: &str) -> Result<usize, String> {
    let size = text.parse().ok().filter(|size| (1..=MAX_ROBOTS).contains(size));
    size.ok_or_else(|| format!("`{text}` is not a number of robots; write whole numbers in 1..={MAX_ROBOTS}"))
}

/// Measures, writes and prints.
pub fn run(args: Args) -> Ending {
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
    };
    let results = {
        let parts = Parts::new();
        let measured = bench::measure(&options, &stop, &parts);
        parts.finish();
        measured.map_err(Failure::broken)?
    };
    // Whatever becomes of the terminal, the results are kept.
    bench::write(&results, &folder, &options).map_err(Failure::broken)?;
    for part in results.parts() {
        stdout::line(format_args!("{part}"))?;
        if part == TICK_PARTS {
            stdout::line(results.tick_parts_table().aligned())?;
            continue;
        }
        stdout::line(results.compared_table(part, &earlier).aligned())?;
    }
    if !results.figures.is_empty() {
        stdout::line(results.figures_table().aligned())?;
    }
    stdout::line(folder.path().display())?;
    Ok(Outcome::Done)
}

//! `report`: recorded runs as one page for a browser.

use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use coordinator::record::folder::{RecordError, replace};
use evaluation::page;
use evaluation::page::recorded::Recorded;
use std::path::{Path, PathBuf};

/// Name of the page that a run's own folder gets.
pub const PAGE: &str = "report.html";

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh report runs/20260131-120000-ex14_d-14
  ./run.sh report runs/safe runs/paper --out safe_and_paper.html
The page holds everything it needs: open it in any browser, or send it by mail.")]
pub struct Args {
    /// Folders of recorded runs; several are shown side by side
    #[arg(required = true, value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// The page to write; left out, `report.html` in the first run's folder
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Writes the page.
pub fn run(args: Args) -> Ending {
    let runs: Vec<Recorded> =
        args.runs.iter().map(|run| Recorded::read(run)).collect::<Result<_, _>>().map_err(Failure::broken)?;
    let path = args.out.unwrap_or_else(|| args.runs[0].join(PAGE));
    let size = write(&path, &runs).map_err(Failure::broken)?;
    stdout::line(format_args!("{} ({:.0} kB): open it in a browser", path.display(), size as f64 / 1e3))?;
    Ok(Outcome::Done)
}

/// Writes the page of `runs`; returns its size in bytes.
pub fn write(path: &Path, runs: &[Recorded]) -> Result<usize, RecordError> {
    let page = page::report(runs);
    replace(path, page.as_bytes())?;
    Ok(page.len())
}

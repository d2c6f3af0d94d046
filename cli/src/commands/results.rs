//! `results`: the tables of the documents, from what `results/` keeps; and how that was measured.

use crate::cli::Cli;
use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use clap::Parser;
use coordinator::record::folder::replace;
use evaluation::results::{DOCUMENTS, FOLDER, Medians, Part, filled, parts, tables};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Arguments of `results`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh results
  ./run.sh results --list
  ./run.sh results --measure suite/quality
  ./run.sh results --take suite/random=runs/20260131-120000-compare/runs.csv
Without --measure it only writes the tables of README.md and docs/RESULTS.md, between their marks, from results/.
Every part of results/ is made by a command of results/parts.toml; medians are kept, runs are not: they repeat.")]
pub struct Args {
    /// Runs the command of a part anew and keeps its medians (repeatable)
    #[arg(long, value_name = "PART")]
    pub(crate) measure: Vec<String>,
    /// Keeps the medians of runs that are there: the CSV file of an earlier compare or evaluate (repeatable)
    #[arg(long, value_name = "PART=FILE", value_parser = part_and_file)]
    take: Vec<(String, PathBuf)>,
    /// Lists the parts with their commands
    #[arg(long, conflicts_with_all = ["measure", "take"])]
    list: bool,
    /// The folder of the repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
}

/// There is no such part.
#[derive(Debug, thiserror::Error)]
#[error("there is no part `{name}`; the parts are: {known}")]
struct NoPart {
    name: String,
    known: String,
}

/// Measures what was asked for, then writes the tables.
pub fn run(args: Args) -> Ending {
    let all = parts(&args.root).map_err(Failure::usage)?;
    if args.list {
        for Part { name, shows, command } in &all {
            stdout::line(format_args!("{name}: {shows}\n    ./run.sh {}", command.join(" ")))?;
        }
        return Ok(Outcome::Done);
    }
    let find = |name: &str| {
        all.iter().find(|part| part.name == name).ok_or_else(|| {
            let known = all.iter().map(|part| part.name.as_str()).collect::<Vec<_>>().join(", ");
            Failure::usage(NoPart { name: name.into(), known })
        })
    };
    let wanted = args.measure.iter().map(|name| find(name)).collect::<Result<Vec<_>, _>>()?;
    for (name, file) in &args.take {
        keep(&args.root, find(name)?, &medians_of(file)?)?;
    }
    for part in wanted {
        keep(&args.root, part, &measure(part)?)?;
    }
    let count = write_documents(&args.root).map_err(Failure::broken)?;
    stdout::line(format_args!("{count} tables in {}", DOCUMENTS.join(", ")))?;
    Ok(Outcome::Done)
}

fn part_and_file(text: &str) -> Result<(String, PathBuf), String> {
    let (part, file) = text.split_once('=').ok_or("write PART=FILE, for example suite/random=runs.csv")?;
    Ok((part.into(), file.into()))
}

fn keep(root: &Path, part: &Part, medians: &Medians) -> Result<(), Failure> {
    let path = root.join(FOLDER).join(format!("{}.csv", part.name));
    replace(&path, medians.csv().as_bytes()).map_err(Failure::broken)?;
    Ok(stdout::line(format_args!("{} rows in {}", medians.rows().len(), path.display()))?)
}

/// Runs the command of `part` into a folder of its own and takes the medians of its runs.
fn measure(part: &Part) -> Result<Medians, Failure> {
    let place = tempfile::tempdir().map_err(Failure::broken)?;
    let out = place.path().join("out");
    let words = ["run.sh"].into_iter().chain(part.command.iter().map(String::as_str));
    let command = words.chain(["--out"]).map(Into::into).chain([out.clone().into_os_string()]);
    Cli::try_parse_from(command).map_err(Failure::usage)?.run()?;
    let file = if out.is_dir() { out.join("runs.csv") } else { out };
    medians_of(&file)
}

fn medians_of(file: &Path) -> Result<Medians, Failure> {
    let broken = |reason: String| Failure::broken(format!("{}: {reason}", file.display()));
    let runs = std::fs::read_to_string(file).map_err(|error| broken(error.to_string()))?;
    Medians::of_runs(&runs).map_err(broken)
}

fn write_documents(root: &Path) -> Result<usize, Box<dyn Error + Send + Sync>> {
    let tables = tables(root)?;
    for document in DOCUMENTS {
        let path = root.join(document);
        let text = std::fs::read_to_string(&path)?;
        replace(&path, filled(document, &text, &tables)?.as_bytes())?;
    }
    Ok(tables.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_a_command_that_is_accepted() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for part in parts(&root).unwrap() {
            let words = ["run.sh"].into_iter().chain(part.command.iter().map(String::as_str));
            let parsed = Cli::try_parse_from(words.chain(["--out", "somewhere"]));
            assert!(
                parsed.is_ok(),
                "{}: {}",
                part.name,
                parsed.err().map_or_else(String::new, |error| error.to_string())
            );
        }
    }
}

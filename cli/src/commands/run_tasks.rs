//! The argument of `run` about set-points at run time.

use crate::exit::Failure;
use std::path::PathBuf;
use std::str::FromStr;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::task_list;
use vodca::tasks::{Tasks, Then};

/// Where robots go that have arrived.
#[derive(Debug, clap::Args)]
pub(super) struct TaskArgs {
    /// Where robots go that have arrived: a list (FILE.csv with robot,x,y,after), random:SEED (without end), or orders (they
    /// wait for `go`)
    #[arg(long, value_name = "FILE|random:SEED|orders")]
    tasks: Option<Source>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Source {
    List(PathBuf),
    Random(u64),
    Orders,
}

impl FromStr for Source {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.strip_prefix("random:") {
            Some(seed) => {
                let seed =
                    seed.parse().map_err(|_| format!("`{seed}` is no seed; write random: and a whole number"))?;
                Ok(Self::Random(seed))
            }
            None if text == "orders" => Ok(Self::Orders),
            None if text == "random" => Err("write random: and a seed, as in random:1".into()),
            None => Ok(Self::List(text.into())),
        }
    }
}

impl TaskArgs {
    /// The tasks of a run.
    pub(super) fn tasks(&self, scenario: &Scenario, params: &Params) -> Result<Tasks, Failure> {
        let mut tasks = Tasks::new(scenario, params);
        match &self.tasks {
            None => {}
            Some(Source::Random(seed)) => tasks = tasks.then(Then::Random(*seed)),
            Some(Source::Orders) => tasks = tasks.then(Then::Wait),
            Some(Source::List(path)) => {
                let unreadable =
                    |error| Failure::usage(format!("cannot read the tasks in {}: {error}", path.display()));
                let text = std::fs::read_to_string(path).map_err(unreadable)?;
                let list = task_list::parse(&text, scenario, params.model.min_separation)
                    .map_err(|error| Failure::usage(format!("{}: {error}", path.display())))?;
                list.into_iter().for_each(|task| tasks.add(task));
            }
        }
        Ok(tasks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_is_a_word_a_seed_or_a_file() {
        assert_eq!("random:7".parse(), Ok(Source::Random(7)));
        assert_eq!("orders".parse(), Ok(Source::Orders));
        assert_eq!("tasks.csv".parse(), Ok(Source::List("tasks.csv".into())));
        assert!("random:x".parse::<Source>().unwrap_err().contains("whole number"));
        assert!("random".parse::<Source>().unwrap_err().contains("random:1"));
    }
}

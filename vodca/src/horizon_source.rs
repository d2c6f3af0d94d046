//! Where the horizons of a run come from: `fixed:20`, `fixed:9,40`, `random:SEED`, `script:FILE`.
//!
//! A policy server answers anew at every tick and is therefore no table that could be read here; it
//! hands its answers through [`HorizonSource::jitter`], so that the jitter is the same for all. A script
//! alone is never jittered: it says exactly what is used, so the record of a run repeats the run.

use crate::Position;
use crate::horizon::{Horizon, MAX_HORIZON};
use std::convert::Infallible;
use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Largest script, MiB: over 100000 ticks of the largest team. A device or a pipe without an end is refused
/// instead of filling the memory.
const MAX_SCRIPT_MIB: u64 = 64;

/// Chooses the horizons of a tick.
pub trait Horizons {
    /// Why there are none.
    type Error;

    /// Writes N_i^k for every robot i of tick k = `tick` into `out`; the robots measure themselves at
    /// `measured` (m, by robot number). Called once per tick, ticks in order.
    ///
    /// # Errors
    /// The run cannot go on without horizons.
    fn choose(&mut self, tick: u64, measured: &[Position], out: &mut [Horizon]) -> Result<(), Self::Error>;

    /// The raw actions in [-1, 1] that the newest horizons were made of, by robot; empty where there were none.
    fn actions(&self) -> &[f32] {
        &[]
    }
}

impl Horizons for HorizonSource {
    type Error = Infallible;

    fn choose(&mut self, tick: u64, _: &[Position], out: &mut [Horizon]) -> Result<(), Infallible> {
        for (robot, to) in out.iter_mut().enumerate() {
            *to = self.horizon(robot, tick);
        }
        Ok(())
    }
}

/// What the user asked for, `--horizon SPEC`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HorizonSpec {
    /// `fixed:20` for all robots, `fixed:9,40` one per robot.
    Fixed(Vec<Horizon>),
    /// `random:SEED`, or `random` with the run's seed: uniform over 1..=49 per robot and tick.
    Random(Option<u64>),
    /// `script:FILE`: CSV with the tick and one horizon per robot in each line.
    Script(PathBuf),
}

/// Why there are no horizons. Each names the SPEC, the place and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum HorizonSourceError {
    /// Not a SPEC.
    #[error(
        "--horizon {spec}: {reason}; the forms are fixed:20, fixed:9,40 (one per robot), random, random:SEED, \
         script:FILE with horizons in 1..={MAX_HORIZON}"
    )]
    Spec {
        /// As written.
        spec: String,
        /// What is wrong.
        reason: String,
    },
    /// Not one horizon per robot.
    #[error("--horizon {spec}: {given} horizons for {robots} robots; give one for all, or one per robot")]
    Count {
        /// As written.
        spec: String,
        /// Horizons given.
        given: usize,
        /// Robots of the run.
        robots: usize,
    },
    /// The script cannot be read.
    #[error("--horizon script:{}: cannot read the file: {source}; check the path", .file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The script has no end, or is no script.
    #[error(
        "--horizon script:{}: the file is larger than {MAX_SCRIPT_MIB} MiB, the most that a script of horizons can have; \
         check the path",
        .file.display()
    )]
    TooLarge {
        /// The file.
        file: PathBuf,
    },
    /// A line of the script.
    #[error(
        "--horizon script:{}: line {line}: {reason}; each line is a tick (0, 1, 2, ...) and {robots} horizons in \
         1..={MAX_HORIZON}, separated by commas",
        .file.display()
    )]
    Line {
        /// The file.
        file: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
        /// Robots of the run.
        robots: usize,
    },
}

impl FromStr for HorizonSpec {
    type Err = HorizonSourceError;

    fn from_str(spec: &str) -> Result<Self, HorizonSourceError> {
        let wrong = |reason: String| HorizonSourceError::Spec { spec: spec.into(), reason };
        let (kind, argument) = match spec.split_once(':') {
            Some((kind, argument)) => (kind, Some(argument)),
            None => (spec, None),
        };
        match (kind, argument) {
            ("fixed", Some(list)) => list
                .split(',')
                .map(|text| parse_horizon(text).map_err(wrong))
                .collect::<Result<_, _>>()
                .map(Self::Fixed),
            ("random", None) => Ok(Self::Random(None)),
            ("random", Some(seed)) => match seed.parse() {
                Ok(seed) => Ok(Self::Random(Some(seed))),
                Err(_) => Err(wrong(format!("the seed `{seed}` is not a whole number in 0..={}", u64::MAX))),
            },
            ("script", Some(file)) if !file.is_empty() => Ok(Self::Script(file.into())),
            ("fixed" | "script", _) => Err(wrong(format!("`{kind}` needs an argument"))),
            _ => Err(wrong(format!("`{kind}` is not known"))),
        }
    }
}

impl fmt::Display for HorizonSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(list) => {
                let list: Vec<String> = list.iter().map(Horizon::to_string).collect();
                write!(f, "fixed:{}", list.join(","))
            }
            Self::Random(None) => f.write_str("random"),
            Self::Random(Some(seed)) => write!(f, "random:{seed}"),
            Self::Script(file) => write!(f, "script:{}", file.display()),
        }
    }
}

fn parse_horizon(text: &str) -> Result<Horizon, String> {
    let text = text.trim();
    let steps: u64 = text.parse().map_err(|_| format!("`{text}` is not a horizon"))?;
    Horizon::new(steps).map_err(|error| error.to_string())
}

/// The horizons of a run. Everything that can fail has been checked when it exists.
#[derive(Clone, Debug)]
pub struct HorizonSource {
    table: Table,
    jitter: u64,
    seed: u64,
}

#[derive(Clone, Debug)]
enum Table {
    /// By robot.
    Fixed(Vec<Horizon>),
    /// Drawn from this seed.
    Random(u64),
    /// `rows[tick * robots + robot]`; the last row holds for later ticks.
    Script { robots: usize, rows: Vec<Horizon> },
}

impl HorizonSource {
    /// Makes the source for `robots` robots. `seed` is the run's: of a bare `random` and of the jitter;
    /// `jitter` is `Params.horizon.jitter`, steps.
    pub fn new(spec: &HorizonSpec, robots: usize, seed: u64, jitter: u64) -> Result<Self, HorizonSourceError> {
        let table = match spec {
            HorizonSpec::Fixed(list) if list.len() == 1 => Table::Fixed(vec![list[0]; robots]),
            HorizonSpec::Fixed(list) if list.len() == robots => Table::Fixed(list.clone()),
            HorizonSpec::Fixed(list) => {
                return Err(HorizonSourceError::Count { spec: spec.to_string(), given: list.len(), robots });
            }
            HorizonSpec::Random(own) => Table::Random(own.unwrap_or(seed)),
            HorizonSpec::Script(file) => {
                let text = read_script(file)?;
                let rows = parse_script(&text, robots).map_err(|(line, reason)| HorizonSourceError::Line {
                    file: file.clone(),
                    line,
                    reason,
                    robots,
                })?;
                Table::Script { robots, rows }
            }
        };
        Ok(Self { table, jitter, seed })
    }

    /// N_i^k of `robot` at `tick`: jittered, or exactly what the script says.
    pub fn horizon(&self, robot: usize, tick: u64) -> Horizon {
        match &self.table {
            Table::Fixed(by_robot) => self.jitter(by_robot[robot], robot, tick),
            Table::Random(seed) => self.jitter(Horizon::random(*seed, robot, tick), robot, tick),
            Table::Script { robots, rows } => {
                let last = rows.len() / robots - 1;
                rows[usize::try_from(tick).map_or(last, |tick| tick.min(last)) * robots + robot]
            }
        }
    }

    /// `horizon` moved by this run's jitter, for horizons that come from elsewhere.
    pub fn jitter(&self, horizon: Horizon, robot: usize, tick: u64) -> Horizon {
        horizon.jittered(self.jitter, self.seed, robot, tick)
    }
}

/// The text of a script, of bounded size.
fn read_script(file: &Path) -> Result<String, HorizonSourceError> {
    let mut text = String::new();
    let most = MAX_SCRIPT_MIB << 20;
    match File::open(file).and_then(|opened| opened.take(most + 1).read_to_string(&mut text)) {
        Ok(read) if read as u64 > most => Err(HorizonSourceError::TooLarge { file: file.into() }),
        Ok(_) => Ok(text),
        Err(source) => Err(HorizonSourceError::Unreadable { file: file.into(), source }),
    }
}

/// All rows of a script, tick after tick, or the line and what is wrong with it. The first line may
/// be a header.
fn parse_script(text: &str, robots: usize) -> Result<Vec<Horizon>, (usize, String)> {
    let mut rows = Vec::new();
    let mut expected: u64 = 0;
    for (index, line) in text.lines().enumerate() {
        let wrong = |reason: String| (index + 1, reason);
        let mut cells = line.split(',').map(str::trim);
        let first = cells.next().unwrap_or_default();
        let tick = match first.parse::<u64>() {
            Ok(tick) => tick,
            Err(_) if line.trim().is_empty() || (index == 0 && first.starts_with(char::is_alphabetic)) => continue,
            Err(_) => return Err(wrong(format!("`{first}` is not a tick"))),
        };
        if tick != expected {
            return Err(wrong(format!("tick {expected} should be here, found {tick}: tick {expected} has no row")));
        }
        let before = rows.len();
        for cell in cells {
            rows.push(parse_horizon(cell).map_err(wrong)?);
        }
        if rows.len() - before != robots {
            return Err(wrong(format!("{} horizons for {robots} robots", rows.len() - before)));
        }
        expected += 1;
    }
    if rows.is_empty() { Err((1, "the file has no rows".into())) } else { Ok(rows) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(spec: &str, robots: usize) -> Result<HorizonSource, String> {
        let spec: HorizonSpec = spec.parse().map_err(|error: HorizonSourceError| error.to_string())?;
        HorizonSource::new(&spec, robots, 5, 0).map_err(|error| error.to_string())
    }

    fn steps(source: &HorizonSource, robot: usize, tick: u64) -> usize {
        source.horizon(robot, tick).steps()
    }

    #[test]
    fn specs_print_as_they_are_written() {
        for text in ["fixed:20", "fixed:9,40", "random", "random:7", "script:a/b.csv"] {
            assert_eq!(text.parse::<HorizonSpec>().unwrap().to_string(), text);
        }
    }

    #[test]
    fn one_fixed_horizon_is_for_all_and_a_list_is_by_robot() {
        let same = source("fixed:20", 3).unwrap();
        assert_eq!([steps(&same, 0, 0), steps(&same, 2, 9)], [20, 20]);
        let own = source("fixed:9, 40", 2).unwrap();
        assert_eq!([steps(&own, 0, 3), steps(&own, 1, 3)], [9, 40]);
    }

    #[test]
    fn random_draws_take_their_own_seed_or_the_runs() {
        let (own, runs) = (source("random:7", 2).unwrap(), source("random", 2).unwrap());
        for tick in 0..50 {
            assert_eq!(own.horizon(1, tick), Horizon::random(7, 1, tick));
            assert_eq!(runs.horizon(1, tick), Horizon::random(5, 1, tick));
        }
    }

    #[test]
    fn jitter_moves_horizons_that_are_fixed_or_drawn() {
        let jittered = |spec: &str| HorizonSource::new(&spec.parse().unwrap(), 2, 5, 2).unwrap();
        let (fixed, random) = (jittered("fixed:20"), jittered("random:7"));
        let all: Vec<usize> = (0..100).map(|tick| steps(&fixed, 1, tick)).collect();
        assert!(all.iter().all(|n| (18..=22).contains(n)) && all.iter().any(|&n| n != 20));
        assert_eq!(fixed.horizon(1, 3), fixed.jitter(Horizon::saturating(20), 1, 3));
        assert!((0..100).any(|tick| random.horizon(0, tick) != Horizon::random(7, 0, tick)));
    }

    #[test]
    fn the_recorded_horizons_of_a_jittered_run_repeat_it_as_a_script() {
        let spec: HorizonSpec = "fixed:20".parse().unwrap();
        let run = HorizonSource::new(&spec, 2, 5, 2).unwrap();
        let record: String = (0..100).map(|k| format!("{k},{},{}\n", run.horizon(0, k), run.horizon(1, k))).collect();
        let file = std::env::temp_dir().join(format!("vodca-script-{}.csv", std::process::id()));
        std::fs::write(&file, record).unwrap();
        let again = HorizonSource::new(&HorizonSpec::Script(file.clone()), 2, 5, 2);
        std::fs::remove_file(file).unwrap();
        let again = again.unwrap();
        for (robot, tick) in (0..100).flat_map(|tick| [(0, tick), (1, tick)]) {
            assert_eq!(again.horizon(robot, tick), run.horizon(robot, tick), "robot {robot}, tick {tick}");
        }
    }

    #[test]
    fn a_script_without_end_is_refused() {
        let message = source("script:/dev/zero", 2).unwrap_err();
        assert!(message.starts_with("--horizon script:/dev/zero: the file is larger than 64 MiB"), "{message}");
    }

    #[test]
    fn specs_that_cannot_be_used_say_where_and_what_is_allowed() {
        let cases = [
            ("fixed:50", "--horizon fixed:50: horizon 50 is outside 1..=49; the forms are fixed:20"),
            ("fixed:9,x", "`x` is not a horizon"),
            ("fixed", "`fixed` needs an argument"),
            ("script:", "`script` needs an argument"),
            ("random:-1", "the seed `-1` is not a whole number"),
            ("twenty", "`twenty` is not known"),
            ("fixed:9,40", "--horizon fixed:9,40: 2 horizons for 3 robots"),
            ("script:no/such.csv", "--horizon script:no/such.csv: cannot read the file"),
        ];
        for (spec, part) in cases {
            let message = source(spec, 3).unwrap_err();
            assert!(message.contains(part), "{spec}: {message}");
        }
    }

    #[test]
    fn the_last_row_of_a_script_holds_for_later_ticks() {
        let text = "tick,a,b\n0, 9, 40\n1,10,41\n\n";
        let source = HorizonSource {
            table: Table::Script { robots: 2, rows: parse_script(text, 2).unwrap() },
            jitter: 0,
            seed: 0,
        };
        assert_eq!([steps(&source, 0, 0), steps(&source, 1, 0)], [9, 40]);
        assert_eq!([steps(&source, 0, 1), steps(&source, 1, u64::MAX)], [10, 41]);
        assert_eq!(parse_script("0,9\n1,8", 1).unwrap().len(), 2, "the header may be missing");
    }

    #[test]
    fn mistakes_in_a_script_name_their_line() {
        let cases = [
            ("0,9,40\n2,9,40", 2, "tick 1 has no row"),
            ("0,9,40\n0,9,40", 2, "tick 1 should be here, found 0"),
            ("tick,a,b\n0,9", 2, "1 horizons for 2 robots"),
            ("0,9,40,3", 1, "3 horizons for 2 robots"),
            ("0,9,50", 1, "horizon 50 is outside 1..=49"),
            ("0,9,40\nx,9,40", 2, "`x` is not a tick"),
            ("tick,a,b\n", 1, "no rows"),
        ];
        for (text, line, part) in cases {
            let (at, reason) = parse_script(text, 2).unwrap_err();
            assert_eq!(at, line, "{text}");
            assert!(reason.contains(part), "{text}: {reason}");
        }
    }
}

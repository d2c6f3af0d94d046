//! Reads a run's folder back for its page. A run that was cut gives what it recorded.

use coordinator::record::{PARAMS_FILE, SCENARIO_FILE, SUMMARY_FILE, about, latency, mcap, trajectory};
use std::fs;
use std::path::{Path, PathBuf};
use vodca::horizon::Horizon;
use vodca::params::Params;
use vodca::prediction::Prediction;
use vodca::scenario::Scenario;
use vodca::step::{Level, Status, Step};
use vodca::{Input, Position};

/// Why a run has no page.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// A file of the run cannot be read.
    #[error("cannot read {}: {source}; give the folder of a recorded run", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file of the run is not what it should be.
    #[error("{} cannot be shown: {reason}; `verify` says more about a recorded run", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// A recorded run.
#[derive(Debug)]
pub struct Recorded {
    /// Its folder.
    pub folder: PathBuf,
    /// The effective scenario.
    pub scenario: Scenario,
    /// The effective parameters.
    pub params: Params,
    /// How it came about (`run.toml`).
    pub about: serde_json::Value,
    /// How it went (`summary.json`); null when it was cut.
    pub summary: serde_json::Value,
    /// `ticks[k][i]`: what robot i did in tick k. Plans that are not in the log hold one step.
    pub ticks: Vec<Vec<Step>>,
    /// Duration of each tick, ns, as far as recorded.
    pub tick_ns: Vec<u64>,
}

impl Recorded {
    /// Reads the run in `folder`.
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let text = |name: &str| {
            let path = folder.join(name);
            fs::read_to_string(&path).map_err(|source| ReadError::Unreadable { path, source })
        };
        let malformed = |name: &str, reason: String| ReadError::Malformed { path: folder.join(name), reason };
        let about = toml::from_str::<about::About>(&text(about::FILE)?)
            .map_err(|error| malformed(about::FILE, error.to_string()))?;
        let scenario = Scenario::from_toml(&text(SCENARIO_FILE)?, &about.scenario, SCENARIO_FILE)
            .map_err(|error| malformed(SCENARIO_FILE, error.to_string()))?;
        let params = Params::from_toml(&text(PARAMS_FILE)?, PARAMS_FILE)
            .map_err(|error| malformed(PARAMS_FILE, error.to_string()))?;
        let mut ticks = steps(&text(trajectory::FILE)?, &scenario, params.model.sample_time)
            .map_err(|reason| malformed(trajectory::FILE, reason))?;
        add_plans(&mut ticks, &fs::read(folder.join(mcap::FILE)).unwrap_or_default());
        let tick_ns = add_latency(&mut ticks, &text(latency::FILE).unwrap_or_default());
        let summary = text(SUMMARY_FILE).ok().and_then(|text| serde_json::from_str(&text).ok());
        let about = serde_json::to_value(about).map_err(|error| malformed(about::FILE, error.to_string()))?;
        let summary = summary.unwrap_or_default();
        Ok(Self { folder: folder.to_owned(), scenario, params, about, summary, ticks, tick_ns })
    }
}

/// The rows of `trajectory.csv` that have an input; a tick that is not whole ends them.
fn steps(text: &str, scenario: &Scenario, sample_time: f64) -> Result<Vec<Vec<Step>>, String> {
    let robots = scenario.robots.len();
    let mut lines = text.split_inclusive('\n').filter_map(|line| line.strip_suffix('\n'));
    if lines.next() != Some(trajectory::HEADER) {
        return Err(format!("its first line is not {:?}", trajectory::HEADER));
    }
    let rows: Vec<&str> = lines.filter(|line| !line.ends_with(",,,,,,")).collect();
    let step = |(number, line): (usize, &&str)| {
        let set_point = scenario.robots[number % robots].set_point;
        read_step(line, set_point, sample_time).ok_or_else(|| format!("line {} is {line:?}", number + 2))
    };
    let steps: Vec<Step> = rows.iter().enumerate().map(step).collect::<Result<_, _>>()?;
    Ok(steps.chunks_exact(robots).map(<[Step]>::to_vec).collect())
}

fn read_step(line: &str, set_point: Position, sample_time: f64) -> Option<Step> {
    let fields: Vec<&str> = line.split(',').collect();
    let number = |n: usize| fields.get(n)?.parse::<f64>().ok();
    let position = Position::new(number(2)?, number(3)?);
    let input = Input::new(number(4)?, number(5)?);
    let next_position = position + input * sample_time;
    Some(Step {
        position,
        measured: position,
        input,
        next_position,
        next_measured: next_position,
        horizon: Horizon::new(fields.get(6)?.parse().ok()?).ok()?,
        rows: fields.get(7)?.parse().ok()?,
        level: Level::from_word(fields.get(8)?)?,
        status: Status::from_word(fields.get(9)?)?,
        filtered: false,
        plan: Prediction::roll_out(position, set_point, sample_time, &[input]),
        detect_ns: 0,
        solve_ns: 0,
        step_ns: 0,
    })
}

fn add_plans(ticks: &mut [Vec<Step>], log: &[u8]) {
    let mut ticks = ticks.iter_mut();
    mcap::read_plans(log, |plans| {
        let Some(steps) = ticks.next() else { return };
        for (step, states) in steps.iter_mut().zip(plans).filter(|(_, states)| states.len() > 1) {
            step.plan = Prediction::from_states(&states, step.plan.set_point);
        }
    });
}

fn add_latency(ticks: &mut [Vec<Step>], text: &str) -> Vec<u64> {
    let mut durations = Vec::with_capacity(ticks.len());
    for (steps, line) in ticks.iter_mut().zip(text.lines().skip(1)) {
        let mut numbers = line.split(',').skip(1).map_while(|field| field.parse().ok());
        let Some(duration) = numbers.next() else { break };
        durations.push(duration);
        steps.iter_mut().zip(numbers).for_each(|(step, nanoseconds)| step.step_ns = nanoseconds);
    }
    durations
}

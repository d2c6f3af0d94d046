//! An independent check of a recorded run.
//!
//! It recomputes everything from `trajectory.csv`, the scenario and the parameters. On purpose it shares no
//! code with what planned, measured and wrote the run: it reads the CSV itself (`table`) and has its own
//! formula for the separation (`geometry`), so that one mistake cannot hide another.

mod geometry;
mod outline;
mod table;
#[cfg(test)]
mod tests;

use geometry::PredictedMotion;
use serde_json::Value;
use std::fmt;
use std::path::{Path, PathBuf};
use table::Table;
use vodca::params::Params;
use vodca::scenario::Scenario;

/// What paths that touch exactly min_separation may lose to rounding, m.
const TOUCH: f64 = 1e-6;
/// What rounding may add to an input bound, m/s.
const BOUND: f64 = 1e-9;
/// Relative difference that another order of summation may cause.
const SUM: f64 = 1e-9;

/// Why a run could not be checked.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// A file of the run cannot be read.
    #[error("cannot read {}: {source}; give the folder of a recorded run", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The run's scenario, parameters or summary are not what they should be.
    #[error("{} cannot be used: {reason}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// Where something is off.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RuntimeDir {
    /// Line of trajectory.csv, from 1.
    pub line: Option<usize>,
    /// k.
    pub tick: Option<u64>,
    /// Robot number, from 0.
    pub robot: Option<usize>,
}

impl RuntimeDir {
    fn line(line: usize) -> Self {
        Self { line: Some(line), ..Self::default() }
    }

    fn at(tick: usize, robot: usize) -> Self {
        Self { line: None, tick: Some(tick as u64), robot: Some(robot) }
    }
}

/// Something that is off.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Where.
    pub place: RuntimeDir,
    /// What was checked.
    pub what: String,
    /// What was found.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
}

impl Finding {
    fn new(place: RuntimeDir, what: &str, value: &str, allowed: &str) -> Self {
        Self { place, what: what.into(), value: value.into(), allowed: allowed.into() }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, what, value, allowed } = self;
        if let Some(line) = place.line {
            write!(f, "line {line}: ")?;
        }
        if let Some(tick) = place.tick {
            write!(f, "tick {tick}: ")?;
        }
        if let Some(robot) = place.robot {
            write!(f, "robot {robot}: ")?;
        }
        write!(f, "{what} is {value}, allowed: {allowed}")
    }
}

/// What a check found out.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Everything that is off, at most one finding per kind.
    pub findings: Vec<Finding>,
    /// Ticks in the record.
    pub ticks: usize,
    /// Smallest separation, m, radii beyond min_separation / 2 taken off.
    pub min_separation: f64,
    /// Robots within the arrival tolerance at the end.
    pub arrived: usize,
    /// Robots.
    pub robots: usize,
    /// There is no summary.json: the run was cut, and its whole ticks alone were checked.
    pub cut: bool,
}

/// Checks the run in `folder`. Of a run that was killed, and so has no summary.json, the whole ticks in
/// trajectory.csv are checked.
///
/// # Errors
/// A file of the run cannot be read. Whatever is wrong *in* the trajectory is a finding.
pub fn verify(folder: &Path) -> Result<Report, VerifyError> {
    let read = |name: &str| {
        let path = folder.join(name);
        std::fs::read_to_string(&path).map_err(|source| VerifyError::Unreadable { path, source })
    };
    let malformed = |name: &str, reason: String| VerifyError::Malformed { path: folder.join(name), reason };
    let mut scenario = Scenario::from_toml(&read("scenario.toml")?, "recorded", "scenario.toml")
        .map_err(|error| malformed("scenario.toml", error.to_string()))?;
    let params = Params::from_toml(&read("params.toml")?, "params.toml")
        .map_err(|error| malformed("params.toml", error.to_string()))?;
    let summary = match read("summary.json") {
        Ok(text) => Some(serde_json::from_str(&text).map_err(|error| malformed("summary.json", error.to_string()))?),
        Err(VerifyError::Unreadable { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    match read("set_points.csv") {
        Ok(text) => send_on(&mut scenario, &text)
            .map_err(|line| malformed("set_points.csv", format!("line {line} is no tick,robot,x,y of this team")))?,
        Err(VerifyError::Unreadable { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {}
        Err(error) => return Err(error),
    }
    Ok(check(&read("trajectory.csv")?, &read("horizons.csv")?, &scenario, &params, summary.as_ref()))
}

/// Gives everybody its last set-point; `Err`: the first line of `text` that means nothing, from 1.
fn send_on(scenario: &mut Scenario, text: &str) -> Result<(), usize> {
    for (at, line) in text.lines().enumerate().skip(1) {
        let fields: Vec<f64> = line.split(',').map_while(|field| field.parse().ok()).collect();
        let [_, robot, x, y] = fields[..] else { return Err(at + 1) };
        scenario.robots.get_mut(robot as usize).ok_or(at + 1)?.set_point = [x, y].into();
    }
    Ok(())
}

/// Checks a record that was read already; `summary`: none when the run was cut.
fn check(trajectory: &str, horizons: &str, scenario: &Scenario, params: &Params, summary: Option<&Value>) -> Report {
    let (robots, cut) = (scenario.robots.len(), summary.is_none());
    let read = if cut {
        let starts: Vec<_> = scenario.robots.iter().map(|robot| [robot.start.x, robot.start.y]).collect();
        table::read_cut(trajectory, &starts, params.model.sample_time)
    } else {
        table::read(trajectory, robots)
    };
    let table = match read {
        Ok(table) => table,
        Err(finding) => return Report { findings: vec![finding], robots, cut, ..Report::default() },
    };
    let course = PredictedMotion::follow(&table, scenario, params);
    let findings = [
        starts(&table, scenario),
        bounds(&table, scenario, params),
        motion(&table, params),
        absent(&table),
        chosen_horizons(&table, horizons, cut),
        guarantee(&course, scenario, params),
    ];
    let mut findings: Vec<Finding> = findings.into_iter().flatten().collect();
    if let Some(summary) = summary {
        findings.extend(claims(&table, &course, params, summary));
    }
    Report {
        findings,
        ticks: table.ticks.len(),
        min_separation: course.min_separation,
        arrived: course.distances.iter().filter(|&&left| left < params.episode.arrival_tolerance).count(),
        robots,
        cut,
    }
}

/// Everybody starts where the scenario says.
fn starts(table: &Table, scenario: &Scenario) -> Option<Finding> {
    scenario.robots.iter().enumerate().find_map(|(i, robot)| {
        let [x, y] = table.position(0, i);
        let off = x != robot.start.x || y != robot.start.y;
        let allowed = format!("[{}, {}] m", robot.start.x, robot.start.y);
        off.then(|| Finding::new(RuntimeDir::at(0, i), "start", &format!("[{x}, {y}] m"), &allowed))
    })
}

/// Every input is within its bound per axis.
fn bounds(table: &Table, scenario: &Scenario, params: &Params) -> Option<Finding> {
    first(table, |k, i, row| {
        let most = scenario.robots[i].max_speed.unwrap_or(params.model.max_speed);
        let over = row.ux.abs().max(row.uy.abs());
        let allowed = format!("at most {most} m/s per axis");
        (over > most + BOUND)
            .then(|| Finding::new(RuntimeDir::at(k, i), "input", &format!("[{}, {}] m/s", row.ux, row.uy), &allowed))
    })
}

/// Every position follows from the one before, x[k+1] = x[k] + h u[k], to the last bit: the record holds
/// exact numbers and the model is one multiplication and one addition.
fn motion(table: &Table, params: &Params) -> Option<Finding> {
    let h = params.model.sample_time;
    first(table, |k, i, row| {
        let [x, y] = table.position(k + 1, i);
        let (model_x, model_y) = (row.x + row.ux * h, row.y + row.uy * h);
        let allowed = format!("[{model_x}, {model_y}] m by the model from tick {k}");
        (x != model_x || y != model_y)
            .then(|| Finding::new(RuntimeDir::at(k + 1, i), "position", &format!("[{x}, {y}] m"), &allowed))
    })
}

/// Who does not take part in a tick stands in it.
fn absent(table: &Table) -> Option<Finding> {
    first(table, |k, i, row| {
        let moves = !row.took_part() && (row.ux != 0.0 || row.uy != 0.0 || row.level != "fallback" || row.rows != 0);
        let value = format!("[{}, {}] m/s, {}, {} rows", row.ux, row.uy, row.level, row.rows);
        moves.then(|| {
            let what = format!("what a robot did that was {}", row.status);
            Finding::new(RuntimeDir::at(k, i), &what, &value, "[0, 0] m/s, fallback, 0 rows")
        })
    })
}

/// The horizons are those of `horizons.csv`. The record of a tick begins with trajectory.csv: in a run that
/// was `cut` between the two files the last line here is missing or begun.
fn chosen_horizons(table: &Table, horizons: &str, cut: bool) -> Option<Finding> {
    let mut lines = horizons.split_inclusive('\n').skip(1);
    for (k, rows) in table.ticks.iter().enumerate() {
        let line = lines.next().unwrap_or_default();
        if cut && k + 1 == table.ticks.len() && !line.ends_with('\n') {
            return None;
        }
        let line = line.trim_end_matches('\n');
        let own = rows.iter().fold(k.to_string(), |line, row| format!("{line},{}", row.horizon));
        if own != line {
            let robot = own.split(',').zip(line.split(',')).position(|(a, b)| a != b).unwrap_or(1).saturating_sub(1);
            let value = rows.get(robot).map_or(String::new(), |row| row.horizon.to_string());
            let allowed = line.split(',').nth(robot + 1).unwrap_or("missing");
            return Some(Finding::new(
                RuntimeDir::at(k, robot),
                "horizon",
                &value,
                &format!("{allowed} (horizons.csv)"),
            ));
        }
    }
    None
}

/// With cells on, nobody comes nearer than they keep, unless positions are measured worse than the cells
/// allow for. See [`PredictedMotion::follow`] for starts that were nearer already.
fn guarantee(course: &PredictedMotion, scenario: &Scenario, params: &Params) -> Option<Finding> {
    let loss = course.loss.filter(|_| promised(params))?;
    let what = match loss.hazard.checked_sub(scenario.robots.len()) {
        None => format!("separation from robot {}", loss.hazard),
        Some(obstacle) => format!("separation from obstacle {obstacle}"),
    };
    let (value, allowed) = (format!("{} m", loss.separation), format!("at least {} m", loss.kept));
    Some(Finding::new(RuntimeDir::at(loss.tick, loss.robot), &what, &value, &allowed))
}

/// Whether the parameters promise a separation at all.
fn promised(params: &Params) -> bool {
    params.cell.enabled && params.disturbance.noise <= params.cell.noise_bound
}

/// What the summary claims is what the trajectory shows.
fn claims(table: &Table, course: &PredictedMotion, params: &Params, summary: &Value) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut compare = |name: &str, claimed: &Value, own: Value| {
        let equal = match (claimed.as_f64(), own.as_f64()) {
            (Some(claimed), Some(own)) => (claimed - own).abs() <= SUM * own.abs().max(1.0),
            _ => *claimed == own,
        };
        if !equal {
            let what = format!("{name} in summary.json");
            findings.push(Finding::new(
                RuntimeDir::default(),
                &what,
                &claimed.to_string(),
                &format!("{own} (recomputed)"),
            ));
        }
    };
    let arrived = course.distances.iter().all(|&left| left < params.episode.arrival_tolerance);
    let kept = !promised(params) || course.loss.is_none();
    let lost = table.ticks.last().is_some_and(|rows| rows.iter().any(|row| row.status == "lost"));
    let endless = summary["tasks"]["endless"] == true;
    let success = (arrived || endless) && course.pairs_collided == 0 && kept && !lost;
    compare("success", &summary["success"], success.into());
    compare("ticks", &summary["ticks"], table.ticks.len().into());
    compare("path_cost", &summary["path_cost"], course.path.iter().sum::<f64>().into());
    compare("min_separation", &summary["min_separation"], finite(course.min_separation));
    compare("ticks_below_min_separation", &summary["ticks_below_min_separation"], course.ticks_below.into());
    compare("collisions", &summary["collisions"], course.pairs_collided.into());
    let activations: u64 = table.ticks.iter().flatten().map(|row| row.rows).sum();
    compare("activations", &summary["activations"], activations.into());
    for (level, count) in table.count(|row| &row.level) {
        compare(&format!("solver_levels.{level}"), &summary["solver_levels"][level], count.into());
    }
    for (status, count) in table.count(|row| &row.status) {
        compare(&format!("statuses.{status}"), &summary["statuses"][status], count.into());
    }
    findings
}

/// JSON has no infinity: nothing to meet is null.
fn finite(value: f64) -> Value {
    if value.is_finite() { value.into() } else { Value::Null }
}

fn first(table: &Table, find: impl Fn(usize, usize, &table::Row) -> Option<Finding>) -> Option<Finding> {
    let rows =
        table.ticks.iter().enumerate().flat_map(|(k, rows)| rows.iter().enumerate().map(move |(i, row)| (k, i, row)));
    rows.into_iter().find_map(|(k, i, row)| find(k, i, row))
}

//! The verifier's own reading of `trajectory.csv`, on purpose not shared with the code that writes it.

use super::{Finding, RuntimeDir};
use std::collections::BTreeMap;

/// One row with an input.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) ux: f64,
    pub(super) uy: f64,
    pub(super) horizon: u64,
    pub(super) rows: u64,
    pub(super) level: String,
    pub(super) status: String,
}

impl Row {
    /// Whether the robot took part in the tick.
    pub(super) fn took_part(&self) -> bool {
        !matches!(self.status.as_str(), "late" | "lost")
    }
}

/// The whole file: `ticks[k][i]` and the last positions.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pub(super) ticks: Vec<Vec<Row>>,
    pub(super) last: Vec<[f64; 2]>,
}

const COLUMNS: [&str; 10] = ["tick", "robot", "x", "y", "ux", "uy", "horizon", "rows", "level", "status"];
const LEVELS: [&str; 5] = ["closed_form", "structured", "clarabel", "fallback", "baseline"];
const STATUSES: [&str; 7] = ["solved", "relaxed", "held", "shifted", "stopped", "late", "lost"];

/// Reads `text` for a team of `robots`; the first thing that is off ends the reading, because every
/// row after it would be off too.
pub(super) fn read(text: &str, robots: usize) -> Result<Table, Finding> {
    let table = read_rows(text, robots)?;
    if table.last.len() != robots {
        let place = RuntimeDir { tick: Some(table.ticks.len() as u64), ..RuntimeDir::default() };
        let what = "number of last positions (a run that was cut has none, and no summary.json)";
        return Err(Finding::new(place, what, &table.last.len().to_string(), &robots.to_string()));
    }
    Ok(table)
}

/// Reads the whole ticks of a record whose end may be missing. Without last positions they are those
/// that the model gives after the last whole tick (the step lasts `sample_time` s), or the `starts`.
pub(super) fn read_cut(text: &str, starts: &[[f64; 2]], sample_time: f64) -> Result<Table, Finding> {
    let whole = text.rfind('\n').map_or(0, |at| at + 1);
    let mut table = read_rows(&text[..whole], starts.len())?;
    if table.last.len() < starts.len() {
        table.ticks.pop_if(|rows| rows.len() < starts.len());
        let after = |row: &Row| [row.x + row.ux * sample_time, row.y + row.uy * sample_time];
        table.last = table.ticks.last().map_or(starts.to_vec(), |rows| rows.iter().map(after).collect());
    }
    Ok(table)
}

fn read_rows(text: &str, robots: usize) -> Result<Table, Finding> {
    let mut lines = text.split_terminator('\n').enumerate();
    let header = lines.next().map_or("", |(_, line)| line);
    if header != COLUMNS.join(",") {
        return Err(Finding::new(RuntimeDir::line(1), "header", header, &COLUMNS.join(",")));
    }
    if !text.ends_with('\n') {
        let last = text.lines().count();
        return Err(Finding::new(RuntimeDir::line(last), "end of the file", "a cut line", "a whole line"));
    }
    let mut table = Table::default();
    for (n, line) in lines {
        let (tick, robot) = ((n - 1) / robots, (n - 1) % robots);
        let place = RuntimeDir { line: Some(n + 1), tick: Some(tick as u64), robot: Some(robot) };
        let fields: Vec<&str> = line.split(',').collect();
        if fields.len() != COLUMNS.len() {
            return Err(Finding::new(place, "number of fields", &fields.len().to_string(), "10"));
        }
        let field = Field { place: &place, fields: &fields };
        field.expect(0, &tick.to_string())?;
        field.expect(1, &robot.to_string())?;
        let (x, y) = (field.number(2)?, field.number(3)?);
        let is_last = fields[4..].iter().all(|field| field.is_empty());
        if is_last && (robot == 0 || !table.last.is_empty()) {
            table.last.push([x, y]);
            continue;
        }
        if !table.last.is_empty() {
            return Err(Finding::new(place, "row", line, "no input after the last positions began"));
        }
        if robot == 0 {
            table.ticks.push(Vec::with_capacity(robots));
        }
        let row = Row {
            x,
            y,
            ux: field.number(4)?,
            uy: field.number(5)?,
            horizon: field.whole(6, 1, 49)?,
            rows: field.whole(7, 0, 1_000_000)?,
            level: field.word(8, &LEVELS)?,
            status: field.word(9, &STATUSES)?,
        };
        if let Some(tick) = table.ticks.last_mut() {
            tick.push(row);
        }
    }
    Ok(table)
}

impl Table {
    /// Position of a robot at the start of `tick`; after the last tick its last position.
    pub(super) fn position(&self, tick: usize, robot: usize) -> [f64; 2] {
        self.ticks.get(tick).map_or(self.last[robot], |rows| [rows[robot].x, rows[robot].y])
    }

    /// How often each word stands in a column.
    pub(super) fn count<'a>(&'a self, word: impl Fn(&'a Row) -> &'a str) -> BTreeMap<&'a str, u64> {
        let mut counts = BTreeMap::new();
        self.ticks.iter().flatten().for_each(|row| *counts.entry(word(row)).or_default() += 1);
        counts
    }
}

struct Field<'a> {
    place: &'a RuntimeDir,
    fields: &'a [&'a str],
}

impl Field<'_> {
    fn off(&self, column: usize, allowed: &str) -> Finding {
        Finding::new(self.place.clone(), COLUMNS[column], self.fields[column], allowed)
    }

    fn expect(&self, column: usize, text: &str) -> Result<(), Finding> {
        if self.fields[column] == text { Ok(()) } else { Err(self.off(column, text)) }
    }

    fn number(&self, column: usize) -> Result<f64, Finding> {
        let value = self.fields[column].parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| self.off(column, "a finite number"))
    }

    fn whole(&self, column: usize, low: u64, high: u64) -> Result<u64, Finding> {
        let value = self.fields[column].parse().ok().filter(|value| (low..=high).contains(value));
        value.ok_or_else(|| self.off(column, &format!("a whole number in {low}..={high}")))
    }

    fn word(&self, column: usize, known: &[&str]) -> Result<String, Finding> {
        let word = self.fields[column];
        if known.contains(&word) { Ok(word.into()) } else { Err(self.off(column, &known.join(" | "))) }
    }
}

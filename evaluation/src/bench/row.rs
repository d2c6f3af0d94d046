//! What was measured: distributions and single figures, and how they are printed and written.

use super::compare::Earlier;
use crate::text_table::TextTable;
use coordinator::latency::Latency;
use coordinator::tick_parts::PARTS;
use std::fmt::Write as _;

/// Part of the rows that say where the time of a tick goes.
pub const TICK_PARTS: &str = "tick parts";

/// A distribution of durations.
#[derive(Clone, Debug)]
pub struct Row {
    /// The benchmark's part, `hop` for instance.
    pub part: &'static str,
    /// What was measured.
    pub name: String,
    /// Number of robots, or the horizon, where it has one.
    pub size: Option<usize>,
    /// The durations.
    pub latency: Latency,
    /// p50 of what it is compared with, us.
    pub floor: Option<f64>,
}

/// A single number.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The benchmark's part.
    pub part: &'static str,
    /// What it is.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// All that was measured.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Distributions, in the order of measurement.
    pub rows: Vec<Row>,
    /// Single numbers.
    pub figures: Vec<Figure>,
}

impl Row {
    /// A distribution.
    pub fn new(part: &'static str, name: impl Into<String>, size: Option<usize>, latency: Latency) -> Self {
        Self { part, name: name.into(), size, latency, floor: None }
    }

    /// The same, compared with something whose p50 is `floor` us.
    pub fn over(self, floor: Option<f64>) -> Self {
        Self { floor: floor.filter(|floor| *floor > 0.0), ..self }
    }

    /// p50 over that of what it is compared with.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.latency.percentiles().p50_us / self.floor?)
    }
}

/// Three digits that count, for every size of number.
fn digits(value: f64) -> String {
    if value > 0.0 && value < 1e-3 {
        return format!("{value:.1e}");
    }
    let places = if value >= 100.0 { 0 } else { 2 - value.max(0.01).log10().floor() as i32 };
    format!("{value:.*}", places.clamp(0, 4) as usize)
}

impl Results {
    /// Adds a distribution.
    pub fn row(&mut self, row: Row) {
        self.rows.push(row);
    }

    /// Adds a number.
    pub fn figure(&mut self, part: &'static str, name: impl Into<String>, value: f64, unit: &'static str) {
        self.figures.push(Figure { part, name: name.into(), value, unit });
    }

    /// The parts that have rows, each once, in order.
    pub fn parts(&self) -> Vec<&'static str> {
        let mut parts = Vec::new();
        for row in &self.rows {
            if !parts.contains(&row.part) {
                parts.push(row.part);
            }
        }
        parts
    }

    /// All rows, or those of `part`.
    pub fn rows_table(&self, part: Option<&str>) -> TextTable {
        let wanted = |row: &&Row| part.is_none_or(|part| row.part == part);
        self.table(self.rows.iter().filter(wanted), &Earlier::default(), part.is_none())
    }

    /// The rows of `part`, with their p50 over that of an earlier run.
    pub fn compared_table(&self, part: &str, earlier: &Earlier) -> TextTable {
        self.table(self.rows.iter().filter(|row| row.part == part), earlier, false)
    }

    fn table<'a>(&self, rows: impl Iterator<Item = &'a Row>, earlier: &Earlier, with_part: bool) -> TextTable {
        let mut header =
            vec!["what", "n", "count", "p50_us", "p90_us", "p99_us", "p999_us", "max_us", "floor_us", "ratio"];
        if with_part {
            header.insert(0, "part");
        }
        if !earlier.is_empty() {
            header.push("now/then");
        }
        let mut table = TextTable::new(&header);
        for row in rows {
            let figures = row.latency.percentiles();
            let times = [figures.p50_us, figures.p90_us, figures.p99_us, figures.p999_us, figures.max_us];
            let mut cells: Vec<String> = Vec::new();
            if with_part {
                cells.push(row.part.into());
            }
            cells.push(row.name.clone());
            cells.push(row.size.map_or(String::new(), |size| size.to_string()));
            cells.push(figures.count.to_string());
            cells.extend(times.map(digits));
            cells.push(row.floor.map_or(String::new(), digits));
            cells.push(row.ratio().map_or(String::new(), |ratio| format!("{ratio:.2}")));
            if !earlier.is_empty() {
                let then = earlier.p50(row.part, &row.name, row.size);
                cells.push(then.map_or("new".into(), |then| format!("{:.2}", figures.p50_us / then)));
            }
            table.row(cells);
        }
        table
    }

    /// p50 of the parts of a tick, us: a row per team.
    pub fn tick_parts_table(&self) -> TextTable {
        let mut table = TextTable::new(&[&["team", "n"], &PARTS[..]].concat());
        let mut teams: Vec<(&str, Option<usize>)> = Vec::new();
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.part == TICK_PARTS).collect();
        for row in &rows {
            let Some((team, _)) = row.name.rsplit_once(": ") else { continue };
            if !teams.contains(&(team, row.size)) {
                teams.push((team, row.size));
            }
        }
        for (team, size) in teams {
            let cell = |part: &str| {
                let wanted = |row: &&&Row| row.size == size && row.name.rsplit_once(": ") == Some((team, part));
                rows.iter().find(wanted).map_or(String::new(), |row| digits(row.latency.percentiles().p50_us))
            };
            let size = size.map_or(String::new(), |size| size.to_string());
            table.row([team.to_owned(), size].into_iter().chain(PARTS.map(cell)));
        }
        table
    }

    /// The single numbers.
    pub fn figures_table(&self) -> TextTable {
        let mut table = TextTable::new(&["part", "what", "value", "unit"]);
        for figure in &self.figures {
            table.row([figure.part.into(), figure.name.clone(), digits(figure.value), figure.unit.into()]);
        }
        table
    }

    /// Every distribution as CSV: how many durations were no longer than each bound.
    pub fn histograms(&self) -> String {
        let mut text = String::from("part,what,n,up_to_ns,count\n");
        for row in &self.rows {
            let size = row.size.map_or(String::new(), |size| size.to_string());
            let name = row.name.replace('"', "'");
            for (bound, count) in row.latency.buckets() {
                // Writing to a String cannot fail.
                let _ = writeln!(text, "{},\"{name}\",{size},{bound},{count}", row.part);
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn results() -> Results {
        let mut latency = Latency::new();
        (1..=100).for_each(|n| latency.record_ns(n * 100));
        let mut results = Results::default();
        results.row(Row::new("hop", "a, busy", None, latency.clone()).over(Some(2.0)));
        results.row(Row::new("exchange", "peer", Some(14), latency.clone()));
        results.row(Row::new("hop", "b", None, latency));
        results.figure("scale", "start", 1.25, "s");
        results
    }

    #[test]
    fn tables_hold_percentiles_and_the_ratio_to_the_floor() {
        let text = results().rows_table(None).csv();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "part,what,n,count,p50_us,p90_us,p99_us,p999_us,max_us,floor_us,ratio");
        assert_eq!(lines[1], "hop,\"a, busy\",,100,5.00,9.01,9.90,10.0,10.0,2.00,2.50");
        assert_eq!(lines[2], "exchange,peer,14,100,5.00,9.01,9.90,10.0,10.0,,");
        assert_eq!(results().rows_table(Some("hop")).csv().lines().count(), 3);
        assert_eq!(results().parts(), ["hop", "exchange"]);
    }

    #[test]
    fn parts_of_a_tick_stand_beside_each_other() {
        let mut results = Results::default();
        for (part, time) in PARTS.into_iter().zip(1..) {
            let mut latency = Latency::new();
            latency.record_ns(time * 1_000);
            results.row(Row::new(TICK_PARTS, format!("peer, safe: {part}"), Some(14), latency));
        }
        let text = results.tick_parts_table().csv();
        assert_eq!(text.lines().nth(1), Some("\"peer, safe\",14,1.00,2.00,3.00,4.00,5.00,6.00,7.00"), "{text}");
    }

    #[test]
    fn histograms_hold_every_duration() {
        let text = results().histograms();
        let hop = text.lines().filter(|line| line.starts_with("hop,"));
        let count: u64 = hop.filter_map(|line| line.rsplit(',').next()?.parse::<u64>().ok()).sum();
        assert_eq!(count, 200);
    }

    #[test]
    fn numbers_have_three_digits_that_count() {
        assert_eq!(
            [0.0, 3.2e-9, 0.123_45, 1.234_5, 12.345, 1234.5].map(digits),
            ["0.0000", "3.2e-9", "0.123", "1.23", "12.3", "1234"]
        );
    }
}

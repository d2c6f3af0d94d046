//! Results as tables: for the terminal with `-`, as CSV with nothing, where there are too few samples.

use super::compare::Earlier;
use super::row::{Results, Row, TICK_PARTS};
use crate::text_table::TextTable;
use coordinator::tick_parts::PARTS;
use std::fmt::Write as _;

/// Columns of `rows.csv`. The first five are what an earlier run is recognised by.
const COLUMNS: [&str; 13] = [
    "part", "what", "n", "count", "p50_us", "p90_us", "p99_us", "p999_us", "max_us", "floor", "floor_us", "ratio",
    "machine",
];
/// What tells of too few samples, or of no floor, where people read.
const NOTHING: &str = "-";

/// Three digits that count, for every size of number.
pub(super) fn digits(value: f64) -> String {
    if value > 0.0 && value < 1e-3 {
        return format!("{value:.1e}");
    }
    let places = if value >= 100.0 { 0 } else { 2 - value.max(0.01).log10().floor() as i32 };
    format!("{value:.*}", places.clamp(0, 4) as usize)
}

/// The cells of a row; `nothing` where there is nothing to tell.
fn cells(row: &Row, nothing: &str) -> [String; 11] {
    let or_nothing = |text: Option<String>| text.unwrap_or_else(|| nothing.to_owned());
    let [p50, p90, p99, p999, longest] = row.told().map(|figure| or_nothing(figure.map(digits)));
    let floor = row.floor.as_ref();
    [
        row.name.clone(),
        row.size.map_or(String::new(), |size| size.to_string()),
        row.latency.percentiles().count.to_string(),
        p50,
        p90,
        p99,
        p999,
        longest,
        or_nothing(floor.map(|floor| floor.name.clone())),
        or_nothing(floor.map(|floor| digits(floor.p50_us))),
        or_nothing(row.ratio().map(|ratio| format!("{ratio:.2}"))),
    ]
}

impl Results {
    /// All rows, for a file.
    pub fn rows_table(&self) -> TextTable {
        let mut table = TextTable::new(&COLUMNS);
        for row in &self.rows {
            let ends = (row.part.to_owned(), self.load_before.verdict().to_owned());
            table.row([ends.0].into_iter().chain(cells(row, "")).chain([ends.1]));
        }
        table
    }

    /// The rows of `part`, for people; with their p50 over that of an earlier run where there is one.
    pub fn part_table(&self, part: &str, earlier: &Earlier) -> TextTable {
        let then = (!earlier.is_empty()).then_some("now/then");
        let header: Vec<&str> = COLUMNS[1..COLUMNS.len() - 1].iter().copied().chain(then).collect();
        let mut table = TextTable::new(&header);
        for row in self.rows.iter().filter(|row| row.part == part) {
            let compared = then.map(|_| match earlier.p50(row.part, &row.name, row.size) {
                Some(then) => format!("{:.2}", row.latency.percentiles().p50_us / then),
                None => "new".into(),
            });
            table.row(cells(row, NOTHING).into_iter().chain(compared));
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
                rows.iter().find(wanted).map_or(NOTHING.into(), |row| digits(row.latency.percentiles().p50_us))
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
    use coordinator::latency::Latency;

    fn results() -> Results {
        let (mut latency, mut floor) = (Latency::new(), Latency::new());
        (1..=100).for_each(|n| latency.record_ns(n * 100));
        floor.record_ns(2_000);
        let mut results = Results { load_before: "0.10 0 0 1/1 1".into(), ..Results::default() };
        results.row(Row::new("hop", "a, busy", None, latency.clone()).over("page, busy", &floor));
        results.row(Row::new("exchange", "peer", Some(14), latency.clone()));
        results.row(Row::new("hop", "b", None, latency));
        results.figure("scale", "start", 1.25, "s");
        results
    }

    #[test]
    fn files_leave_empty_what_too_few_samples_cannot_tell() {
        let text = results().rows_table().csv();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], COLUMNS.join(","));
        assert_eq!(lines[1], "hop,\"a, busy\",,100,5.00,9.01,,,10.0,\"page, busy\",2.00,2.50,quiet");
        assert_eq!(lines[2], "exchange,peer,14,100,5.00,9.01,,,10.0,,,,quiet");
        assert_eq!(results().parts(), ["hop", "exchange"]);
        let busy = Results { load_before: "1.10 0 0 1/1 1".into(), ..results() };
        assert!(busy.rows_table().csv().lines().skip(1).all(|line| line.ends_with(",busy")));
    }

    #[test]
    fn people_read_a_dash_there() {
        let text = results().part_table("hop", &Earlier::default()).csv();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], COLUMNS[1..12].join(","));
        assert_eq!(lines[1], "\"a, busy\",,100,5.00,9.01,-,-,10.0,\"page, busy\",2.00,2.50");
        assert_eq!(lines[2..], ["b,,100,5.00,9.01,-,-,10.0,-,-,-"]);
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

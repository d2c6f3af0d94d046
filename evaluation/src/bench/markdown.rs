//! The tables of a benchmark as Markdown, from the files in its folder: rows.csv, figures.csv, machine.toml and,
//! where `peers.csv` lies beside them, other solvers on the same QPs.

use super::stored::{Line, StoredError, StoredTable};
use crate::text_table::TextTable;
use std::path::Path;

/// Shown where a row is not there, or had too few samples.
const NOTHING: &str = "-";
/// Horizons and numbers of rows of the solver's table.
const QPS: [(&str, &str); 4] = [("safe", "20"), ("safe", "49"), ("paper", "20"), ("paper", "49")];

/// A table with its caption.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// What it is called where tables are put into a document: `solver`, `step`, `hop`, `exchange`, `scale`,
    /// `policy`, `figures`.
    pub name: &'static str,
    /// What it shows, in a sentence or two of Markdown; says when the machine was busy.
    pub caption: String,
    /// The table, Markdown.
    pub table: String,
}

/// All tables of the benchmark in `folder`; without those of parts it did not measure.
///
/// # Errors
/// A folder without `rows.csv`, or with files that cannot be read.
pub fn sections(folder: &Path) -> Result<Vec<Section>, StoredError> {
    let stored = Stored {
        rows: StoredTable::rows(folder)?,
        figures: StoredTable::perhaps(folder, "figures.csv")?,
        peers: StoredTable::perhaps(folder, "peers.csv")?,
    };
    let machine = machine(folder, &stored);
    let all = [
        (
            "solver",
            "One QP, p50 in us. Every problem is solved once by each of the first two, in turns; other solvers, where there \
             are any, are given the shortest of five solutions, on the first hundred problems.",
            stored.solver(),
        ),
        (
            "step",
            "One step of a robot among fourteen, us; `over orca` is its p50 over that of plain ORCA, in turns.",
            stored.distributions("step", "profile, horizons", "over orca"),
        ),
        (
            "hop",
            "One message of the size of a plan from a process to another, one way, us. Rows called busy spin, all \
             others sleep; each is compared with the floor that waits as it does.",
            stored.distributions("hop", "one way, two processes", "over the floor"),
        ),
        (
            "exchange",
            "A tick of a team at full speed, us. The floor: as many processes, one shared page, one futex \
             broadcast; everybody reads the plans of all others, as in the product. Floor and product take turns \
             and both sleep until they are woken; each row is compared with the floor of its own turns.",
            stored.distributions("exchange", "tick of the team", "over the floor"),
        ),
        (
            "scale",
            "A tick at the pace of real time, one per 200 ms, and how late it begins, us. All teams drive in the \
             same minutes, each in a slot of its own of the 200 ms, its floor at the end of the slot.",
            stored.distributions("scale", "real time", "over the floor"),
        ),
        (
            "policy",
            "A policy: inference alone, and from the published observation to the horizons, us.",
            stored.distributions("policy", "policy", "over inference"),
        ),
        ("figures", "Single numbers.", stored.figures()),
    ];
    let wanted = all.into_iter().filter_map(|(name, caption, table)| Some((name, caption, table?)));
    let section = |(name, caption, table): (_, &str, TextTable)| Section {
        name,
        caption: format!("{caption} {machine}"),
        table: table.markdown(),
    };
    Ok(wanted.map(section).collect())
}

/// One sentence about the machine.
fn machine(folder: &Path, stored: &Stored) -> String {
    let text = std::fs::read_to_string(folder.join("machine.toml")).unwrap_or_default();
    let known: toml::Table = toml::from_str(&text).unwrap_or_default();
    let word = |key: &str| known.get(key).and_then(toml::Value::as_str).unwrap_or("unknown").to_owned();
    let cores = known.get("processors").and_then(toml::Value::as_integer).map_or("?".into(), |n| n.to_string());
    let busy = stored.rows.lines().any(|line| line.cell("machine") == Some("busy"));
    let load = word("load_before");
    let minute = load.split(' ').next().unwrap_or_default();
    let verdict = if busy { "**A busy machine**" } else { "A quiet machine" };
    format!("{verdict}: {cores} cores ({}), load {minute} before it began.", word("processor"))
}

struct Stored {
    rows: StoredTable,
    figures: StoredTable,
    peers: StoredTable,
}

impl Stored {
    fn row(&self, part: &str, what: &str, n: &str) -> Option<Line<'_>> {
        let wanted = [("part", part), ("what", what), ("n", n)];
        self.rows.lines().find(|line| wanted.iter().all(|(column, value)| line.cell(column) == Some(value)))
    }

    /// Every row of `part` with its sample count, percentiles, floor and ratio.
    fn distributions(&self, part: &str, what: &str, over: &str) -> Option<TextTable> {
        let header = [what, "n", "samples", "p50", "p90", "p99", "p99.9", "longest", "floor", "floor p50", over];
        let columns =
            ["what", "n", "count", "p50_us", "p90_us", "p99_us", "p999_us", "max_us", "floor", "floor_us", "ratio"];
        let mut table = TextTable::new(&header);
        let rows: Vec<Line<'_>> = self.rows.lines().filter(|line| line.cell("part") == Some(part)).collect();
        for row in &rows {
            table.row(columns.map(|column| row.cell(column).unwrap_or(NOTHING).to_owned()));
        }
        (!rows.is_empty()).then_some(table)
    }

    /// One line per kind of QP: the ladder, Clarabel over it, and the peers that were measured elsewhere.
    fn solver(&self) -> Option<TextTable> {
        let mut others: Vec<&str> = Vec::new();
        for name in self.peers.lines().filter_map(|line| line.cell("what")?.split_once(": ").map(|(_, name)| name)) {
            if !others.contains(&name) {
                others.push(name);
            }
        }
        let mut table = TextTable::new(
            &[&["QP", "N", "samples", "ours", "ours p99", "Clarabel, tuned", "over ours"], &others[..]].concat(),
        );
        let mut any = false;
        for (family, n) in QPS {
            for rows in [0, 3, 10] {
                let case = format!("{family}, {rows} rows");
                let Some(ours) = self.row("solver", &format!("{case}: ladder"), n) else { continue };
                let theirs = self.row("solver", &format!("{case}: Clarabel"), n);
                let of = |line: Option<Line<'_>>, column| {
                    line.and_then(|line| line.cell(column)).unwrap_or(NOTHING).to_owned()
                };
                let peers = others.iter().map(|name| of(self.peer(&format!("{case}: {name}"), n), "p50_us"));
                let cells = [
                    case.clone(),
                    n.to_owned(),
                    of(Some(ours), "count"),
                    of(Some(ours), "p50_us"),
                    of(Some(ours), "p99_us"),
                    of(theirs, "p50_us"),
                    of(theirs, "ratio"),
                ];
                table.row(cells.into_iter().chain(peers));
                any = true;
            }
        }
        any.then_some(table)
    }

    fn peer(&self, what: &str, n: &str) -> Option<Line<'_>> {
        self.peers.lines().find(|line| line.cell("what") == Some(what) && line.cell("n") == Some(n))
    }

    fn figures(&self) -> Option<TextTable> {
        let mut table = TextTable::new(&["part", "figure", "value", "unit"]);
        let figures: Vec<Line<'_>> = self.figures.lines().collect();
        for figure in &figures {
            let cell = |column| figure.cell(column).unwrap_or_default().to_owned();
            table.row(["part", "what", "value", "unit"].map(cell));
        }
        (!figures.is_empty()).then_some(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: &str = "part,what,n,count,p50_us,p90_us,p99_us,p999_us,max_us,floor,floor_us,ratio,machine
solver,\"safe, 3 rows: ladder\",20,20000,3.10,4.50,8.00,28.9,30.1,\"safe, 0 rows: ladder\",0.110,28.18,busy
solver,\"safe, 3 rows: Clarabel\",20,20000,203,221,240,325,400,\"safe, 3 rows: ladder\",3.10,65.48,busy
exchange,\"peer, safe, full speed\",14,999,282,381,,,531,\"futex floor, full speed\",136,2.07,busy
";

    fn folder() -> tempfile::TempDir {
        let place = tempfile::tempdir().unwrap();
        std::fs::write(place.path().join("rows.csv"), ROWS).unwrap();
        let machine = "processors = 2\nprocessor = \"EPYC\"\nload_before = \"0.73 0.1 0.1 1/9 1\"\n";
        std::fs::write(place.path().join("machine.toml"), machine).unwrap();
        place
    }

    #[test]
    fn every_row_stands_with_its_count_its_floor_and_its_ratio() {
        let place = folder();
        let sections = sections(place.path()).unwrap();
        let names: Vec<&str> = sections.iter().map(|section| section.name).collect();
        assert_eq!(names, ["solver", "exchange"]);
        let line = "| safe, 3 rows | 20 | 20000 | 3.10 | 8.00 | 203 | 65.48 |";
        assert!(sections[0].table.contains(line), "{}", sections[0].table);
        let line =
            "| peer, safe, full speed | 14 | 999 | 282 | 381 | - | - | 531 | futex floor, full speed | 136 | 2.07 |";
        assert!(sections[1].table.contains(line), "{}", sections[1].table);
        assert!(sections[1].caption.contains("**A busy machine**: 2 cores (EPYC), load 0.73"), "{:?}", sections[1]);
    }

    #[test]
    fn other_solvers_stand_in_columns_of_their_own() {
        let place = folder();
        std::fs::write(place.path().join("peers.csv"), "what,n,count,p50_us\n\"safe, 3 rows: OSQP\",20,100,903.0\n")
            .unwrap();
        let sections = sections(place.path()).unwrap();
        assert!(
            sections[0]
                .table
                .starts_with("| QP | N | samples | ours | ours p99 | Clarabel, tuned | over ours | OSQP |")
        );
        assert!(sections[0].table.contains("| 65.48 | 903.0 |"), "{}", sections[0].table);
    }
}

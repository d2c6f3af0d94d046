//! The table of the policies that ship, beside fixed, random and searched horizons.

use super::medians::{Medians, Row};
use super::{FOLDER, ResultsError};
use crate::text_table::TextTable;
use std::path::Path;

/// The policies of `policies/`.
const NAMES: [&str; 4] = ["two_setpoint", "four_gate", "exchange_14", "ring_8"];
/// The paper's grid of fixed horizons.
pub(super) const GRID: [u8; 10] = [5, 10, 15, 20, 25, 30, 35, 40, 45, 49];

pub(super) fn table(root: &Path) -> Result<TextTable, ResultsError> {
    let header = [
        "policy",
        "start",
        "policy",
        "fixed 20",
        "best fixed of the grid",
        "best fixed of 49",
        "random",
        "constants, searched",
    ];
    let mut table = TextTable::new(&header);
    for name in NAMES {
        let medians = Medians::load(&root.join(FOLDER).join("policies").join(format!("{name}.csv")))?;
        for moved in medians.families() {
            let start = if moved == "0" { "as it is".into() } else { format!("moved by {moved} m") };
            let one = |horizons: &str| medians.row(moved, horizons).map_or("-".into(), cell);
            let best = |horizons: &mut dyn Iterator<Item = u8>| {
                let rows = horizons.filter_map(|steps| medians.row(moved, &format!("fixed:{steps}")));
                rows.min_by(|a, b| rank(a).partial_cmp(&rank(b)).unwrap_or(std::cmp::Ordering::Equal))
                    .map_or("-".into(), |row| {
                        format!("{}, N={}", cell(row), row.controller.trim_start_matches("fixed:"))
                    })
            };
            table.row([
                format!("`{name}`"),
                start,
                one("policy"),
                one("fixed:20"),
                best(&mut GRID.into_iter()),
                best(&mut (1..=49)),
                one("random"),
                one("constants"),
            ]);
        }
    }
    Ok(table)
}

/// More successes first, then the shorter path.
fn rank(row: &Row) -> (i64, f64) {
    (-(row.successes as i64), row.path().map_or(f64::INFINITY, |path| path.median))
}

/// Median path and ticks of the runs that succeeded, and how many did.
fn cell(row: &Row) -> String {
    let arrived = format!("({}/{})", row.successes, row.runs);
    match row.path().zip(row.ticks()) {
        Some((path, ticks)) => format!("{:.1} m, {:.0} {arrived}", path.median, ticks.median),
        None => format!("- {arrived}"),
    }
}

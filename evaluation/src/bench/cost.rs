//! What samples cost on a machine with two quiet cores: how long a benchmark will take is told from these
//! before it begins. A test holds them against the benchmark that `results/latency` keeps.

use super::teams::Load;
use shared::exchange::Kind;

/// A tick of the team by number of robots, us.
type Curve = &'static [(f64, f64)];

const FLOOR: Curve = &[(2.0, 48.0), (14.0, 114.0), (50.0, 280.0), (100.0, 720.0), (200.0, 1356.0)];
const PEER_NO_QP: Curve = &[(2.0, 72.0), (14.0, 192.0), (50.0, 1794.0), (100.0, 8544.0)];
const PEER_SAFE: Curve = &[(2.0, 52.0), (14.0, 321.0), (50.0, 2961.0), (100.0, 10756.0)];
const RELAY_NO_QP: Curve = &[(2.0, 70.0), (14.0, 186.0), (50.0, 547.0), (100.0, 1905.0), (200.0, 7401.0)];
const RELAY_SAFE: Curve = &[(2.0, 52.0), (14.0, 282.0), (50.0, 1506.0), (100.0, 5214.0), (200.0, 13263.0)];

/// Starting a process that takes part in an exchange, and ending it, s.
const PROCESS: f64 = 0.007;
/// A round of a link whose ends sleep, s.
pub(super) const SLEEPING_ROUND: f64 = 72e-6;
/// A round of a link whose ends spin, s.
pub(super) const SPINNING_ROUND: f64 = 1e-6;
/// Starting both ends of a link, s.
pub(super) const LINK: f64 = 0.02;
/// A QP drawn at random, s.
pub(super) const DRAWN: f64 = 15e-6;
/// A QP solved by the ladder, s.
pub(super) const LADDER: f64 = 7e-6;
/// A QP solved by Clarabel, s.
pub(super) const CLARABEL: f64 = 270e-6;
/// A step of one robot of fourteen in one process, s.
pub(super) const STEP: f64 = 7e-6;
/// An inference, s.
pub(super) const INFERENCE: f64 = 12e-6;
/// Starting a policy server and loading its policy, s.
pub(super) const SERVER: f64 = 0.3;

/// A tick of a team of `robots` at full speed, s.
pub(super) fn tick(kind: Kind, load: Load, robots: usize) -> f64 {
    let curve = match (kind, load) {
        (Kind::Peer, Load::NoQp) => PEER_NO_QP,
        (Kind::Peer, Load::Safe) => PEER_SAFE,
        (Kind::Relay, Load::NoQp) => RELAY_NO_QP,
        (Kind::Relay, Load::Safe) => RELAY_SAFE,
    };
    at(curve, robots)
}

/// A tick of the floor of `robots` at full speed, s.
pub(super) fn floor_tick(robots: usize) -> f64 {
    at(FLOOR, robots)
}

/// Starting and ending a team of `robots`, s.
pub(super) fn start(robots: usize) -> f64 {
    robots as f64 * PROCESS
}

/// Between two known sizes, and beyond them, cost grows with a power of the number of robots. In s.
fn at(curve: Curve, robots: usize) -> f64 {
    let robots = robots.max(1) as f64;
    let next = curve.iter().position(|(size, _)| *size >= robots).unwrap_or(curve.len() - 1).max(1);
    let ((from, low), (to, high)) = (curve[next - 1], curve[next]);
    let power = (high / low).ln() / (to / from).ln();
    1e-6 * low * (robots / from).powf(power)
}

#[cfg(test)]
mod tests {
    use super::super::stored::StoredTable;
    use super::super::{Options, Part, estimate};
    use super::*;
    use std::path::Path;

    #[test]
    fn a_curve_meets_what_was_measured_and_grows_between() {
        for (size, time) in RELAY_NO_QP {
            assert!((1e6 * at(RELAY_NO_QP, *size as usize) - time).abs() < 1e-6);
        }
        let between: Vec<f64> = (2..=200).map(|robots| at(RELAY_NO_QP, robots)).collect();
        assert!(between.is_sorted(), "{between:?}");
        assert!(at(PEER_NO_QP, 200) > at(PEER_NO_QP, 100) && at(FLOOR, 1) > 0.0);
    }

    /// The benchmark that is kept: its `machine.toml`, and its rows. `None` in a tree without one.
    fn kept() -> Option<(toml::Table, StoredTable)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../results/latency");
        let text = std::fs::read_to_string(folder.join("machine.toml")).ok()?;
        Some((toml::from_str(&text).expect("TOML"), StoredTable::rows(&folder).expect("its rows")))
    }

    #[test]
    fn the_benchmark_that_is_kept_took_about_as_long_as_these_costs_say() {
        let Some((machine, _)) = kept() else { return };
        let word = |key: &str| machine.get(key).and_then(toml::Value::as_str).unwrap_or_default();
        let took = machine.get("seconds").and_then(toml::Value::as_integer).expect("seconds") as f64;
        let library = word("command").contains("--onnxruntime").then(|| "onnxruntime".into());
        let expected = estimate(&Options { onnxruntime: library, ..Options::whole(Part::All) }).as_secs_f64();
        // A busy machine may take any time longer.
        let most = if word("machine") == "quiet" { 1.4 } else { f64::INFINITY };
        assert_eq!(word("part"), "all");
        assert!((0.6..most).contains(&(took / expected)), "took {took} s instead of {expected} s");
    }

    #[test]
    fn every_row_of_the_benchmark_that_is_kept_has_the_samples_it_needs() {
        let Some((_, rows)) = kept() else { return };
        for row in rows.lines() {
            let what = row.cell("what").unwrap_or_default();
            let real_time = row.cell("part") == Some("scale");
            let enough = if real_time { 1_000.0 } else { 20_000.0 };
            assert!(row.number("count").is_some_and(|count| count >= enough), "{what}");
            assert!(row.number("p99_us").is_some() && row.number("p999_us").is_none() == real_time, "{what}");
        }
    }
}

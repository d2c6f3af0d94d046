//! `bench` measures every part and writes its files. What the times are is not asked here.

use std::fs;
use std::path::Path;
use std::process::Command;
use tests::program;

const HEADER: &str = "part,what,n,count,p50_us,p90_us,p99_us,p999_us,max_us,floor,floor_us,ratio,machine";
/// Columns, and the samples from which on a percentile is told.
const TOLD: [(usize, u64); 3] = [(5, 100), (6, 1_000), (7, 10_000)];

fn bench(arguments: &[&str], out: &Path) -> String {
    let output = Command::new(program("vodca"))
        .arg("bench")
        .args(arguments)
        .args(["--quick", "--out"])
        .arg(out)
        .output()
        .expect("the coordinator starts");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty(), "progress is for terminals: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// The cells of a line of CSV; commas between quotes belong to a cell.
fn cells(line: &str) -> Vec<String> {
    let mut quoted = false;
    let split = line.split(|character: char| {
        quoted ^= character == '"';
        character == ',' && !quoted
    });
    split.map(|cell| cell.trim_matches('"').to_owned()).collect()
}

/// Times grow with their percentile; one with too few samples is left out; a floor comes with its ratio; and
/// whether the machine was busy is said.
fn row_is_in_form(row: &[String]) {
    assert_eq!(row.len(), HEADER.split(',').count(), "{row:?}");
    let count: u64 = row[3].parse().expect("a count");
    let times: Vec<f64> = row[4..9].iter().filter_map(|cell| cell.parse().ok()).collect();
    assert!(count >= 1 && times.is_sorted(), "{row:?}");
    assert_eq!(times.len(), 2 + TOLD.iter().filter(|(_, enough)| count >= *enough).count(), "{row:?}");
    for (column, enough) in TOLD {
        assert_eq!(row[column].is_empty(), count < enough, "{row:?}");
    }
    assert!(row[9..12].iter().all(|cell| cell.is_empty()) || row[9..12].iter().all(|cell| !cell.is_empty()), "{row:?}");
    assert!(["quiet", "busy"].contains(&row[12].as_str()), "{row:?}");
}

#[test]
fn every_part_writes_its_tables_histograms_plots_and_the_machine() {
    let home = tempfile::tempdir().expect("a folder for the test");
    let parts: [(&str, &[&str]); 5] = [
        ("solver", &["safe, 3 rows: ladder", "paper, 10 rows: Clarabel", "safe, 3 rows, horizon changing 1..=49"]),
        ("step", &["safe, fixed:20: step", "paper, fixed:49: solve", "orca, fixed:20: step"]),
        ("hop", &["futex", "eventfd", "unix datagram", "iceoryx2, busy", "iceoryx2, event"]),
        ("exchange", &["futex floor, full speed", "peer, no QP, full speed", "relay, safe, full speed"]),
        ("scale", &["tick, safe, real time", "futex floor, real time", "lateness, safe, real time"]),
    ];
    for (part, names) in parts {
        let out = home.path().join(part);
        let printed = bench(&[part], &out);
        let read = |name: &str| fs::read_to_string(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let table = read("rows.csv");
        assert_eq!(table.lines().next(), Some(HEADER));
        let rows: Vec<Vec<String>> = table.lines().skip(1).map(cells).collect();
        rows.iter().for_each(|row| row_is_in_form(row));
        for name in names {
            assert!(rows.iter().any(|row| row[0] == part && row[1] == *name), "{part}: no row {name}\n{table}");
            assert!(printed.contains(name), "{part}: {name} is not printed\n{printed}");
        }
        let histograms = read("histograms.csv");
        assert_eq!(histograms.lines().next(), Some("part,what,n,up_to_ns,count"));
        let counted: u64 = histograms.lines().skip(1).map(|line| cells(line)[4].parse::<u64>().expect("a count")).sum();
        let wanted: u64 = rows.iter().map(|row| row[3].parse::<u64>().expect("a count")).sum();
        assert_eq!(counted, wanted, "{part}: every duration is in one bucket");
        let machine: toml::Table = toml::from_str(&read("machine.toml")).expect("TOML");
        let keys = ["command", "commit", "rustc", "processor", "processors", "governor", "kernel", "machine"];
        for key in keys.iter().chain(&["load_before", "load_after", "seconds_expected", "seconds"]) {
            assert!(machine.contains_key(*key), "{part}: {key}");
        }
        assert!(printed.contains(" before, ") && printed.contains(" machine)"), "{part}: the load\n{printed}");
        assert!(read(&format!("histogram_{part}.svg")).starts_with("<svg"), "{part}");
        assert_eq!(read("figures.csv").lines().next(), Some("part,what,value,unit"));
    }
}

#[test]
fn the_benchmark_that_is_kept_consists_of_tables_and_they_become_markdown() {
    let home = tempfile::tempdir().expect("a folder for the test");
    let out = home.path().join("out");
    bench(&["hop", "--tables-only"], &out);
    let mut names: Vec<String> = fs::read_dir(&out)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| !name.starts_with('.'))
        .collect();
    names.sort();
    assert_eq!(names, ["figures.csv", "machine.toml", "rows.csv"]);
    let output = Command::new(program("vodca")).args(["bench", "--markdown"]).arg(&out).output().expect("it starts");
    let markdown = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success() && markdown.starts_with("### hop"), "{markdown}");
    assert!(markdown.contains("| samples | p50 | p90 | p99 | p99.9 | longest | floor | floor p50 |"), "{markdown}");
}

#[test]
fn an_earlier_run_is_compared_row_by_row_and_qps_are_written_for_others() {
    let home = tempfile::tempdir().expect("a folder for the test");
    let (first, second, qps) = (home.path().join("first"), home.path().join("second"), home.path().join("qps.json"));
    bench(&["solver", "--dump", &qps.to_string_lossy()], &first);
    let printed = bench(&["solver", "--compare", &first.to_string_lossy()], &second);
    assert!(printed.lines().any(|line| line.ends_with("now/then")), "{printed}");
    assert!(!printed.contains("new"), "every row has its earlier one\n{printed}");
    let problems: serde_json::Value = serde_json::from_str(&fs::read_to_string(qps).expect("a file")).expect("JSON");
    let problems = problems.as_array().expect("a list");
    assert_eq!(problems.len(), 2 * 2 * 3 * 4);
    for problem in problems {
        let steps = problem["horizon"].as_u64().expect("a horizon") as usize;
        assert_eq!(problem["state_target"].as_array().map(Vec::len), Some(steps));
    }
}

#[test]
fn what_is_no_earlier_run_is_refused_before_any_work() {
    let home = tempfile::tempdir().expect("a folder for the test");
    let out = home.path().join("out");
    let output = Command::new(program("vodca"))
        .args(["bench", "all", "--compare", "/nowhere", "--out"])
        .arg(&out)
        .output()
        .expect("the coordinator starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("/nowhere/rows.csv"));
    assert!(!out.exists());
}

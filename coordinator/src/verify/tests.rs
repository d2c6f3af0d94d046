use super::*;
use crate::record::samples;

struct Run {
    trajectory: String,
    horizons: String,
    scenario: Scenario,
    params: Params,
    summary: Value,
}

fn recorded(params: Params) -> Run {
    let place = tempfile::tempdir().unwrap();
    samples::record_run(place.path(), "ring:5", &params);
    assert_eq!(verify(place.path()).unwrap().findings, []);
    let read = |name: &str| std::fs::read_to_string(place.path().join(name)).unwrap();
    Run {
        trajectory: read("trajectory.csv"),
        horizons: read("horizons.csv"),
        scenario: Scenario::from_toml(&read("scenario.toml"), "x", "x").unwrap(),
        params,
        summary: serde_json::from_str(&read("summary.json")).unwrap(),
    }
}

impl Run {
    fn findings(&self) -> Vec<Finding> {
        check(&self.trajectory, &self.horizons, &self.scenario, &self.params, &self.summary).findings
    }

    /// With `change` applied to one cell of the trajectory.
    fn changed(&self, line: usize, column: usize, change: impl Fn(&str) -> String) -> Vec<Finding> {
        let mut lines: Vec<String> = self.trajectory.lines().map(String::from).collect();
        let mut cells: Vec<String> = lines[line].split(',').map(String::from).collect();
        cells[column] = change(&cells[column]);
        lines[line] = cells.join(",");
        let text = lines.join("\n") + "\n";
        check(&text, &self.horizons, &self.scenario, &self.params, &self.summary).findings
    }
}

/// The cell with its last digit changed.
/// `cell` with its last digit, or its 15th of a long number, changed: further digits may not change the f64.
fn last_digit(cell: &str) -> String {
    let at = cell.len().min(16) - 1;
    let digit = if cell[at..].starts_with('5') { '6' } else { '5' };
    format!("{}{digit}{}", &cell[..at], &cell[at + 1..])
}

#[test]
fn both_profiles_pass() {
    assert_eq!(recorded(Params::safe()).findings(), []);
    assert_eq!(recorded(Params::paper()).findings(), []);
}

#[test]
fn a_changed_byte_is_found_in_every_column() {
    let run = recorded(Params::safe());
    let (robots, tick, robot) = (5, 12, 3);
    let line = 1 + tick * robots + robot;
    let word = |from: &str| if from == "closed_form" || from == "solved" { "held" } else { "solved" }.to_string();
    for column in 0..8 {
        let findings = run.changed(line, column, last_digit);
        assert!(!findings.is_empty(), "column {column}");
        if column < 4 {
            assert_eq!(findings[0].place.robot, Some(robot), "{}", findings[0]);
            assert!(findings[0].place.tick.is_some_and(|at| (11..=13).contains(&at)), "{}", findings[0]);
        }
    }
    assert!(!run.changed(line, 8, |_| "fallback".into()).is_empty());
    assert!(!run.changed(line, 9, word).is_empty());
    let last = run.trajectory.lines().count() - 1;
    assert!(!run.changed(last, 2, last_digit).is_empty());
}

#[test]
fn a_finding_names_tick_robot_value_and_what_is_allowed() {
    let run = recorded(Params::safe());
    let findings = run.changed(1 + 12 * 5 + 3, 4, |_| "1.75".into());
    let text = findings[0].to_string();
    assert!(text.starts_with("tick 12: robot 3: input is [1.75, "), "{text}");
    assert!(text.ends_with("allowed: at most 1.5 m/s per axis"), "{text}");
}

#[test]
fn missing_swapped_and_cut_rows_are_found() {
    let run = recorded(Params::safe());
    let lines: Vec<&str> = run.trajectory.split_inclusive('\n').collect();
    let without: String = lines.iter().enumerate().filter(|(n, _)| *n != 40).map(|(_, line)| *line).collect();
    let mut swapped = lines.clone();
    swapped.swap(40, 41);
    let cut = run.trajectory[..run.trajectory.len() - 4].to_string();
    let no_end: String = lines[..lines.len() - 5].concat();
    for text in [without, swapped.concat(), cut, no_end] {
        let findings = check(&text, &run.horizons, &run.scenario, &run.params, &run.summary).findings;
        assert_eq!(findings.len(), 1);
    }
}

#[test]
fn a_summary_that_claims_too_much_is_found() {
    let run = recorded(Params::paper());
    let numbers = ["ticks", "path_cost", "min_separation", "ticks_below_min_separation", "collisions", "activations"];
    for name in numbers {
        let mut summary = run.summary.clone();
        summary[name] = (summary[name].as_f64().unwrap() + 0.001).into();
        let findings = check(&run.trajectory, &run.horizons, &run.scenario, &run.params, &summary).findings;
        assert_eq!(findings.len(), 1, "{name}");
        assert!(findings[0].to_string().contains(name), "{}", findings[0]);
    }
    let mut summary = run.summary.clone();
    summary["success"] = (!summary["success"].as_bool().unwrap()).into();
    assert_eq!(check(&run.trajectory, &run.horizons, &run.scenario, &run.params, &summary).findings.len(), 1);
}

#[test]
fn a_broken_guarantee_is_found_and_none_is_demanded_where_none_was_given() {
    let mut run = recorded(Params::paper());
    let least = run.summary["min_separation"].as_f64().unwrap();
    assert!(least < 1.4, "this run must come near for the test: {least}");
    assert_eq!(run.findings(), []);
    run.params.cell.enabled = true;
    let findings = run.findings();
    assert_eq!(findings.len(), 1);
    assert!(findings[0].to_string().contains("separation from robot"), "{}", findings[0]);
}

use super::*;
use crate::samples;

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
        check(&self.trajectory, &self.horizons, &self.scenario, &self.params, Some(&self.summary)).findings
    }

    /// With `change` applied to one cell of the trajectory.
    fn changed(&self, line: usize, column: usize, change: impl Fn(&str) -> String) -> Vec<Finding> {
        let mut lines: Vec<String> = self.trajectory.lines().map(String::from).collect();
        let mut cells: Vec<String> = lines[line].split(',').map(String::from).collect();
        cells[column] = change(&cells[column]);
        lines[line] = cells.join(",");
        let text = lines.join("\n") + "\n";
        check(&text, &self.horizons, &self.scenario, &self.params, Some(&self.summary)).findings
    }
}

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
fn a_robot_that_is_called_lost_and_moves_is_found() {
    let run = recorded(Params::safe());
    for status in ["late", "lost"] {
        let findings = run.changed(1 + 12 * 5 + 3, 9, |_| status.into());
        let found = findings.iter().find(|finding| finding.what == format!("what a robot did that was {status}"));
        let place = found.map(|finding| (finding.place.tick, finding.place.robot));
        assert_eq!(place, Some((Some(12), Some(3))), "{findings:?}");
    }
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
        let findings = check(&text, &run.horizons, &run.scenario, &run.params, Some(&run.summary)).findings;
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
        let findings = check(&run.trajectory, &run.horizons, &run.scenario, &run.params, Some(&summary)).findings;
        assert_eq!(findings.len(), 1, "{name}");
        assert!(findings[0].to_string().contains(name), "{}", findings[0]);
    }
    let mut summary = run.summary.clone();
    summary["success"] = (!summary["success"].as_bool().unwrap()).into();
    assert_eq!(check(&run.trajectory, &run.horizons, &run.scenario, &run.params, Some(&summary)).findings.len(), 1);
}

#[test]
fn a_broken_guarantee_is_found_and_none_is_demanded_where_none_was_given() {
    let mut run = recorded(Params::paper());
    let least = run.summary["min_separation"].as_f64().unwrap();
    assert!(least < 1.4, "this run must come near for the test: {least}");
    assert_eq!(run.findings(), []);
    run.params.cell.enabled = true;
    let findings = run.findings();
    assert_eq!(findings.len(), 2);
    assert!(findings[0].to_string().contains("separation from robot"), "{}", findings[0]);
    assert!(findings[1].to_string().starts_with("success in summary.json is true"), "{}", findings[1]);
}

#[test]
fn a_run_that_was_stopped_before_its_first_tick_ended_is_honest() {
    let place = tempfile::tempdir().unwrap();
    samples::record_ticks(place.path(), "ring:5", &Params::safe(), 0);
    let report = verify(place.path()).unwrap();
    assert_eq!((report.findings, report.ticks), (vec![], 0));
    assert!(report.min_separation.is_finite());
}

#[test]
fn of_a_run_that_was_cut_the_whole_ticks_are_checked() {
    let run = recorded(Params::safe());
    let cut_at = |lines: usize, more: usize, horizons: usize| {
        let end: usize = run.trajectory.split_inclusive('\n').take(lines).map(str::len).sum();
        let horizons: String = run.horizons.split_inclusive('\n').take(horizons).collect();
        check(&run.trajectory[..end + more], &horizons, &run.scenario, &run.params, None)
    };
    // Ten whole ticks; the same and three rows and a half more; without the last line of horizons.csv; none.
    for (lines, more, horizons, ticks) in [(51, 0, 11, 10), (54, 9, 12, 10), (51, 0, 10, 10), (1, 0, 1, 0)] {
        let report = cut_at(lines, more, horizons);
        assert_eq!((report.findings, report.ticks, report.cut), (vec![], ticks, true));
    }
    assert_eq!(cut_at(51, 0, 5).findings.len(), 1, "horizons are missing");
    let whole = check(&run.trajectory, &run.horizons, &run.scenario, &run.params, None);
    assert_eq!((whole.findings, whole.cut), (vec![], true));
    let edited = run.trajectory.replacen(",1,", ",2,", 1);
    assert!(!check(&edited, &run.horizons, &run.scenario, &run.params, None).findings.is_empty());
}

#[test]
fn a_folder_without_a_summary_is_a_run_that_was_cut() {
    let place = tempfile::tempdir().unwrap();
    samples::record_run(place.path(), "ring:5", &Params::safe());
    std::fs::remove_file(place.path().join("summary.json")).unwrap();
    let report = verify(place.path()).unwrap();
    assert_eq!((report.findings, report.cut), (vec![], true));
}

/// Two robots on the x axis; robot 0 stands at 0 and robot 1 goes to each of `places`.
fn loss_on_the_way(places: &[f64], noise: f64) -> Option<geometry::Loss> {
    let mut scenario = coordinator::record::samples::scenario(2);
    scenario.obstacles.clear();
    scenario.allow_close_start = true;
    let mut params = Params::safe();
    (params.disturbance.noise, params.cell.noise_bound) = (noise, noise);
    let row = |tick: usize, robot: usize, x: f64, rest: &str| format!("{tick},{robot},{x},0,{rest}\n");
    let mut text = "tick,robot,x,y,ux,uy,horizon,rows,level,status\n".to_string();
    for (tick, &x) in places.iter().enumerate() {
        let rest = if tick + 1 == places.len() { ",,,,," } else { "0,0,3,0,closed_form,solved" };
        text += &row(tick, 0, 0.0, rest);
        text += &row(tick, 1, x, rest);
    }
    PredictedMotion::follow(&table::read(&text, 2).unwrap(), &scenario, &params).loss
}

#[test]
fn of_a_close_start_no_distance_shrinks_and_none_falls_again() {
    assert_eq!(loss_on_the_way(&[1.0, 1.0, 1.2, 1.6, 1.5], 0.0), None);
    let shrunk = loss_on_the_way(&[1.0, 1.2, 1.1, 1.3], 0.0).unwrap();
    assert_eq!((shrunk.tick, shrunk.separation, shrunk.kept), (1, 1.1, 1.2));
    let fell = loss_on_the_way(&[1.0, 1.7, 1.4], 0.0).unwrap();
    assert_eq!((fell.tick, fell.separation, fell.kept), (1, 1.4, 1.5));
    // Straight through the other between two samples: seen, unless the promise is about samples only.
    assert_eq!(loss_on_the_way(&[1.6, -1.6], 0.0).unwrap().separation, 0.0);
    assert_eq!(loss_on_the_way(&[1.6, -1.6], 0.01), None);
    assert_eq!(loss_on_the_way(&[1.6, 1.4], 0.01).unwrap().separation, 1.4);
}

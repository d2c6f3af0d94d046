//! What a user reads at the end of a run: a line per robot, and how it went.

use coordinator::latency::Percentiles;
use coordinator::policy::{PolicySummary, VersionSummary};
use coordinator::summary::{Absence, End, Summary};
use coordinator::tick_parts::PARTS;
use evaluation::text_table::TextTable;
use std::fmt::Write as _;
use std::path::Path;
use vodca::membership::State;
use vodca::metrics::TaskSummary;
use vodca::way::LowerBound;

/// The table and the summary of a run recorded in `folder`.
pub fn report(summary: &Summary, folder: &Path) -> String {
    format!("{}\n{}", robots(summary), figures(summary, folder))
}

fn robots(summary: &Summary) -> String {
    let mut table = TextTable::new(&[
        "robot",
        "name",
        "arrived",
        "path m",
        "straight m",
        "activations",
        "fallback",
        "QP p50 us",
        "longest us",
    ]);
    for (number, (robot, solve)) in summary.run.robots.iter().zip(&summary.solve_latency).enumerate() {
        table.row([
            number.to_string(),
            robot.name.clone(),
            robot.arrived_tick.map_or("-".into(), |tick| tick.to_string()),
            format!("{:.2}", robot.path_length),
            format!("{:.2}", robot.straight_line),
            robot.activations.to_string(),
            robot.fallback_steps.to_string(),
            format!("{:.1}", solve.p50_us),
            format!("{:.1}", solve.max_us),
        ]);
    }
    table.aligned()
}

fn figures(summary: &Summary, folder: &Path) -> String {
    let run = &summary.run;
    let metres = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.6} m"));
    let ended = match summary.end {
        _ if summary.guarantee_broken => "no: the guaranteed separation was broken".into(),
        End::Arrived if run.success => "yes".into(),
        End::Arrived if lost(summary).next().is_none() && arrived(summary) == run.robots.len() => {
            "no: everybody arrived, but not without collision".into()
        }
        End::Arrived => format!("no: {} of {} arrived{}", arrived(summary), run.robots.len(), who_was_lost(summary)),
        End::OutOfTicks if run.success => "yes: all ticks were used up, and nobody touched anything".into(),
        End::OutOfTicks => {
            format!("no: {} of {} arrived in time{}", arrived(summary), run.robots.len(), who_was_lost(summary))
        }
        End::Interrupted => format!("no: asked to stop when {} of {} had arrived", arrived(summary), run.robots.len()),
        End::PeerLost => "no: a robot's process was lost".into(),
    };
    let bound = summary.lower_bound.map_or(
        "- (for up to 16 robots whose set-points stay)".into(),
        |LowerBound { path, time }| {
            match run.completion_time {
                Some(time_s) => {
                    format!(
                        "{path:.2} m, {:.3} of it here; {time:.1} s, {:.3} of it here",
                        run.path_cost / path,
                        time_s / time
                    )
                }
                // A part of the way says nothing about the whole.
                None => format!("{path:.2} m; {time:.1} s"),
            }
        },
    );
    let lines = [
        ("success", ended),
        ("ticks", run.ticks.to_string()),
        ("completion time", run.completion_time.map_or("-".into(), |time| format!("{time:.1} s"))),
        (
            "path",
            format!(
                "{:.2} m, {} of the straight lines ({:.2} m)",
                run.path_cost,
                run.path_ratio.map_or("-".into(), |ratio| format!("{ratio:.4}")),
                run.straight_line
            ),
        ),
        ("at the least", bound),
        ("min separation", format!("{} (between samples)", metres(run.min_separation))),
        ("below r_min", format!("{} ticks, {} pairs", run.ticks_below_min_separation, run.pairs_below_min_separation)),
        ("collisions", format!("{} pairs", run.collisions)),
        ("guarantee", summary.guarantee.clone()),
    ];
    let policy = summary.policy.as_ref().map(policy_lines).unwrap_or_default();
    let tasks = run.tasks.as_ref().map(task_line);
    let last = [("folder", folder.display().to_string())];
    lines
        .iter()
        .chain(&tasks)
        .chain(&absence_lines(summary))
        .chain(&time_lines(summary))
        .chain(&policy)
        .chain(&last)
        .fold(String::new(), |mut text, (name, value)| {
            let _ = writeln!(text, "{name:<16}{value}"); // writing to a String cannot fail
            text
        })
}

fn task_line(tasks: &TaskSummary) -> (&'static str, String) {
    let or_dash = |figure: Option<String>| figure.unwrap_or("-".into());
    let per_minute = or_dash(tasks.per_minute.map(|rate| format!("{rate:.1}")));
    let wait = or_dash(tasks.mean_wait.map(|wait| format!("{wait:.1} s")));
    let path = or_dash(tasks.path_per_arrival.map(|path| format!("{path:.2} m")));
    ("tasks", format!("{} arrivals, {per_minute} per minute, {path} each; next set-point after {wait}", tasks.arrivals))
}

fn time_lines(summary: &Summary) -> Vec<(&'static str, String)> {
    let mut lines = vec![("tick", spread(&summary.tick_latency))];
    let part = |name: &&str| summary.tick_parts.get(*name).map(|figures| format!("{name} {:.1}", figures.p50_us));
    let parts: Vec<String> = PARTS.iter().filter_map(part).collect();
    if !parts.is_empty() {
        lines.push(("of a robot's", format!("{} us (p50 each)", parts.join(", "))));
    }
    if let Some(late) = &summary.lateness {
        lines.push(("lateness", spread(late)));
    }
    lines
}

/// Percentiles with the number of durations that they rest on; p99 only where there are enough of them.
fn spread(figures: &Percentiles) -> String {
    let p99 = figures.p99().map_or(String::new(), |p99| format!("p99 {p99:.0} us, "));
    format!("p50 {:.0} us, {p99}longest {:.0} us ({} times)", figures.p50_us, figures.max_us, figures.count)
}

fn policy_lines(policy: &PolicySummary) -> Vec<(&'static str, String)> {
    let version = |acted: &VersionSummary| {
        format!("{} {}, ticks {} to {}", acted.version, &acted.sha256[..12], acted.from_tick, acted.to_tick)
    };
    let (versions, speed) = (policy.versions.iter().map(version), &policy.inference);
    let mut lines = vec![
        ("policy", format!("{} ({})", policy.source.display(), versions.collect::<Vec<_>>().join("; "))),
        ("inference", spread(speed)),
        (
            "answers",
            format!(
                "{} in time, {} late (horizons held {} ticks, default {} ticks)",
                policy.answered, policy.late, policy.held, policy.default_used
            ),
        ),
    ];
    if let Some(shadow) = &policy.shadow {
        let share = 100.0 * shadow.differing as f64 / shadow.compared.max(1) as f64;
        let value = format!(
            "differs in {share:.1} % of {} horizons, by {:.2} steps on average, at most {}",
            shadow.compared, shadow.mean_distance, shadow.max_distance
        );
        lines.push(("shadow", value));
    }
    lines
}

/// Robots that were lost and did not come back.
fn lost(summary: &Summary) -> impl Iterator<Item = &Absence> {
    summary.absences.iter().filter(|absence| absence.state == State::Lost && absence.until.is_none())
}

fn who_was_lost(summary: &Summary) -> String {
    lost(summary).map(|absence| format!(", {} lost at tick {}", absence.name, absence.tick)).collect()
}

/// A line per absence; of many only the first.
fn absence_lines(summary: &Summary) -> Vec<(&'static str, String)> {
    const SHOWN: usize = 10;
    let line = |absence: &Absence| ("absent", absence.to_string());
    let mut lines: Vec<_> = summary.absences.iter().take(SHOWN).map(line).collect();
    if let Some(more) = summary.absences.len().checked_sub(SHOWN + 1) {
        lines.push(("absent", format!("{} more, see membership.csv", more + 1)));
    }
    lines
}

fn arrived(summary: &Summary) -> usize {
    summary.run.robots.iter().filter(|robot| robot.arrived_tick.is_some()).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use coordinator::record::samples;
    use coordinator::summary::Timings;
    use coordinator::tick_parts::TickTimes;
    use shared::messages::Stamps;
    use vodca::metrics::RunMetrics;
    use vodca::params::Params;

    const STAMPS: Stamps =
        Stamps { announced: 0, woken: 40_000, read: 50_000, planned: 60_000, reported: 67_000, collected: 99_000 };

    fn summary() -> Summary {
        let (scenario, params) = (samples::scenario(2), Params::safe());
        let (mut metrics, mut timings) = (RunMetrics::new(&scenario, &params), Timings::new(2));
        for tick in 0..3 {
            let steps = samples::steps(2, tick);
            metrics.observe(tick, &steps);
            timings.observe(&TickTimes { duration_ns: 150_000, stamps: &[STAMPS; 2], ..TickTimes::default() }, &steps);
        }
        Summary::new(&scenario, &params, ("safe", "fixed:3"), End::OutOfTicks, metrics.finish(), &timings)
    }

    #[test]
    fn columns_stand_under_their_names() {
        let text = report(&summary(), Path::new("runs/x"));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("robot  name  arrived  path m  straight m  activations"), "{text}");
        assert_eq!(lines[0].find("path m").map(|at| at + 6), lines[1].find("0.91").map(|at| at + 4), "{text}");
        assert!(lines[1].ends_with("0.4         0.4"), "{text}");
    }

    #[test]
    fn only_a_whole_way_is_held_against_the_least_one() {
        let mut summary = summary();
        summary.lower_bound = Some(LowerBound { path: 10.0, time: 4.0 });
        assert!(report(&summary, Path::new("x")).contains("at the least    10.00 m; 4.0 s\n"));
        (summary.run.completion_time, summary.run.path_cost) = (Some(5.0), 12.0);
        let text = report(&summary, Path::new("x"));
        assert!(text.contains("10.00 m, 1.200 of it here; 4.0 s, 1.250 of it here"), "{text}");
    }

    #[test]
    fn the_summary_says_why_it_failed_and_where_the_record_is() {
        let text = report(&summary(), Path::new("runs/x"));
        for part in [
            "success         no: 0 of 2 arrived in time",
            "ticks           3",
            "folder          runs/x",
            "p50 150 us",
            "wake 40.0, read 10.0,",
            "collect 32.0 us",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }

    #[test]
    fn the_json_holds_what_readers_look_for_and_reads_back() {
        let summary = summary();
        let json = serde_json::to_value(&summary).unwrap();
        for name in [
            "success",
            "ticks",
            "completion_time",
            "path_cost",
            "path_ratio",
            "min_separation",
            "ticks_below_min_separation",
            "collisions",
            "activations",
            "solver_levels",
            "tick_parts",
            "robots",
            "version",
        ] {
            assert!(json.get(name).is_some(), "{name}");
        }
        assert_eq!(serde_json::from_value::<Summary>(json).unwrap(), summary);
    }
}

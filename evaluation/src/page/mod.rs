//! Pages for a browser: one HTML file each, with style, scripts and data inside, that needs no network.
//!
//! The files beside this one are what a browser sees: `*.html` are frames in which `{{NAME}}` stands for
//! a part, `*.js` are plain scripts that share one page, `style.css` holds both colour schemes.

pub mod recorded;
pub mod run_data;

use crate::compare::{Comparison, Job, Plan, Run};
use coordinator::page::{SCENE_SCRIPTS, fill};
use recorded::Recorded;
use serde_json::{Value, json};

/// The page of one or several runs side by side.
pub fn report(runs: &[Recorded]) -> String {
    let title = runs.iter().map(|run| run.scenario.name.as_str()).collect::<Vec<_>>().join(", ");
    let data = json!({ "runs": runs.iter().map(run_data::run).collect::<Vec<Value>>() });
    let own = [include_str!("chart.js"), include_str!("report_charts.js"), include_str!("report.js")];
    let scripts = [&SCENE_SCRIPTS[..], &own[..]].concat();
    fill(include_str!("report.html"), &title, &scripts, &data)
}

/// The page of a comparison: `runs` are the results of `jobs` in their order.
pub fn compare(comparison: &Comparison, plan: &Plan, jobs: &[Job], runs: &[Run]) -> String {
    let rows = &comparison.rows;
    let row_of = |job: &Job| {
        let (family, controller) = (&plan.entries[job.entry].family, plan.contenders[job.contender].to_string());
        rows.iter().position(|row| row.family == *family && row.controller == controller)
    };
    let values: Vec<Value> = jobs
        .iter()
        .zip(runs)
        .map(|(job, Run { summary, step_us, .. })| {
            json!({
                "row": row_of(job), "success": summary.success, "path": summary.path_cost,
                "time": summary.completion_time, "separation": summary.min_separation, "stepUs": step_us,
            })
        })
        .collect();
    let min_separation = jobs.first().map(Job::min_separation);
    let data = json!({ "comparison": comparison, "runs": values, "minSeparation": min_separation });
    let scripts = [include_str!("chart.js"), include_str!("compare.js")];
    fill(include_str!("compare.html"), "Comparison of controllers", &scripts, &data)
}

//! Pages for a browser: one HTML file each, with style, scripts and data inside, that needs no network.
//!
//! The files beside this one are what a browser sees: `*.html` are frames in which `{{NAME}}` stands for
//! a part, `*.js` are plain scripts that share one page, `style.css` holds both colour schemes.

pub mod recorded;
pub mod run_data;

use crate::compare::{Comparison, Experiment, Run};
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

/// The page of a comparison.
pub fn compare(comparison: &Comparison, experiment: &Experiment, runs: &[Run]) -> String {
    let (_, family_of) = experiment.families();
    let controllers = experiment.controllers.len();
    let values: Vec<Value> = runs
        .iter()
        .map(|Run { job, summary, step_us, .. }| {
            let variant = experiment.variant(job);
            json!({
                "row": family_of[job.entry] * controllers + job.controller, "layout": job.entry,
                "success": summary.success, "path": summary.path_cost, "ratio": summary.path_ratio,
                "time": summary.completion_time, "separation": summary.min_separation, "stepUs": step_us,
                "variant": (!variant.is_empty()).then_some(variant),
            })
        })
        .collect();
    let layouts: Vec<&str> = experiment.entries.iter().map(|entry| entry.spec.as_str()).collect();
    let min_separation = runs.first().map(|run| run.job.min_separation());
    let data = json!({ "comparison": comparison, "layouts": layouts, "runs": values, "minSeparation": min_separation });
    let scripts = [include_str!("chart.js"), include_str!("compare_bars.js"), include_str!("compare.js")];
    fill(include_str!("compare.html"), "Comparison of controllers", &scripts, &data)
}

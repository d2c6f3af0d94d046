//! Pages for a browser: one HTML file each, with style, scripts and data inside, that needs no network.
//!
//! The files beside this one are what a browser sees: `*.html` are frames in which `{{NAME}}` stands for
//! a part, `*.js` are plain scripts that share one page, `style.css` holds both colour schemes.

pub(crate) mod base64;
pub mod recorded;
mod rows;
pub mod run_data;

use crate::compare::{Comparison, Job, Plan, Run};
use recorded::Recorded;
use serde_json::{Value, json};
use shared::params::Params;
use shared::scenario::Scenario;

const STYLE: &str = include_str!("style.css");
/// What report and live page share, in the order in which one needs the other.
const SCENE_SCRIPTS: [&str; 2] = [include_str!("data.js"), include_str!("scene.js")];

/// The page of one or several runs side by side.
pub fn report(runs: &[Recorded]) -> String {
    let title = runs.iter().map(|run| run.scenario.name.as_str()).collect::<Vec<_>>().join(", ");
    let data = json!({ "runs": runs.iter().map(run_data::run).collect::<Vec<Value>>() });
    let own = [include_str!("chart.js"), include_str!("report_charts.js"), include_str!("report.js")];
    let scripts = [&SCENE_SCRIPTS[..], &own[..]].concat();
    fill(include_str!("report.html"), &title, &scripts, &data)
}

/// The page that shows a run while it goes on; frames come from `frames` beside it.
pub fn live(scenario: &Scenario, params: &Params, horizons: &str) -> String {
    let data = json!({ "layout": run_data::layout(scenario, params), "horizons": horizons });
    let scripts = [&SCENE_SCRIPTS[..], &[include_str!("live.js")]].concat();
    fill(include_str!("live.html"), &scenario.name, &scripts, &data)
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

/// Puts the parts into a frame. Data cannot end its element early: `<` is written as an escape.
fn fill(frame: &str, title: &str, scripts: &[&str], data: &Value) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let data = data.to_string().replace('<', "\\u003c");
    let mut page = String::with_capacity(frame.len() + STYLE.len() + data.len() + 65_536);
    let mut rest = frame;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        page.push_str(before);
        match name {
            "TITLE" => page.push_str(&title),
            "STYLE" => page.push_str(STYLE),
            "SCRIPTS" => scripts.iter().for_each(|script| page.push_str(script)),
            "DATA" => page.push_str(&data),
            _ => {}
        }
        rest = after;
    }
    page.push_str(rest);
    page
}

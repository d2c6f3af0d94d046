//! Pages for a browser: one HTML file each, with style, scripts and data inside, that needs no network.
//!
//! The files beside this one are what every page shares and what the live page is made of: `*.html` are frames
//! in which `{{NAME}}` stands for a part, `*.js` are plain scripts that share one page, `style.css` holds both
//! colour schemes.

pub mod scene;

use serde_json::{Value, json};
use vodca::params::Params;
use vodca::scenario::Scenario;

const STYLE: &str = include_str!("style.css");
/// What report and live page share, in the order in which one needs the other.
pub const SCENE_SCRIPTS: [&str; 2] = [include_str!("data.js"), include_str!("scene.js")];

/// The page that shows a run while it goes on; frames come from `frames` beside it.
pub fn live(scenario: &Scenario, params: &Params, horizons: &str) -> String {
    let data = json!({ "layout": scene::layout(scenario, params), "horizons": horizons });
    let scripts = [&SCENE_SCRIPTS[..], &[include_str!("live.js")]].concat();
    fill(include_str!("live.html"), &scenario.name, &scripts, &data)
}

/// Puts the parts into a frame. Data cannot end its element early: `<` is written as an escape.
pub fn fill(frame: &str, title: &str, scripts: &[&str], data: &Value) -> String {
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

//! The figures of the paper's results section and of the README, run and drawn anew.
//!
//! VH is the run with variable horizons: of the policy in `policies` (`two_setpoint`, `four_gate`,
//! `exchange_14`) where that folder is there, as in the paper; otherwise the best of twenty runs with random
//! horizons, the same controller without training.

mod animation;
mod films;
mod kept_run;
pub(crate) mod svg;

use animation::{Look, animation};
use films::FILMS;
use kept_run::{KeptRun, Setting};
use std::error::Error;
use svg::{COLOURS, Chart, FAILED, Labels};
use vodca::params::Profile;

type Failed = Box<dyn Error + Send + Sync>;

/// A figure: the name of its file and its SVG.
pub type Figure = (&'static str, String);

/// Random runs from which the best is shown.
const SEEDS: u64 = 20;
/// The fixed horizons of the paper's bars.
const HORIZONS: [u64; 10] = [5, 10, 15, 20, 25, 30, 35, 40, 45, 49];

const TWO: Setting = Setting {
    scenario: "two_setpoint",
    profile: Profile::Paper,
    set: Some("vodca.infeasible=hold"),
    policy: Some("two_setpoint"),
};
const FOUR: Setting = Setting { scenario: "four_gate", profile: Profile::Paper, set: None, policy: Some("four_gate") };
const FOURTEEN: Setting =
    Setting { scenario: "ex14_d", profile: Profile::Paper, set: Some("vodca.rows=each"), policy: Some("exchange_14") };
const SAFE: Setting = Setting { scenario: "ex14_d", profile: Profile::Safe, set: None, policy: None };

/// Runs and draws all of them. Everything but computation times is the same on every repetition.
pub fn all(mut done: impl FnMut(&str)) -> Result<Vec<Figure>, Failed> {
    let mut figures = two_robots()?;
    done("two robots");
    figures.extend(fourteen_robots()?);
    done("fourteen robots");
    let four = FOUR.variable(SEEDS)?;
    figures.push(("four_motion.svg", motion(&FOUR, &four, "Four robots through a gate")));
    let mut runs = fixed_runs(&FOUR)?;
    runs.push(four);
    let path = |kept: &KeptRun| kept.summary.path_cost;
    figures.push(("four_path.svg", bars(&FOUR, &runs, "Four robots through a gate: path cost", "path cost (m)", path)));
    figures.push(("safe_motion.svg", motion(&SAFE, &SAFE.run("fixed:20")?, "Fourteen robots, safe profile")));
    done("four robots, safe profile");
    let variable = SAFE.run("random:1")?;
    let title = format!(
        "{} robots change sides with horizons drawn anew at every tick: {:.1} s, shown at twice the speed",
        variable.scenario.robots.len(),
        variable.ticks.len() as f64 * variable.params.model.sample_time
    );
    figures.push(("fourteen.svg", animation(&SAFE, &variable, &Look::FULL, &title)));
    done("the moving picture");
    for film in FILMS {
        figures.push((film.file, film.draw()?));
        done(film.file);
    }
    Ok(figures)
}

fn two_robots() -> Result<Vec<Figure>, Failed> {
    let variable = TWO.variable(SEEDS)?;
    let mut runs = fixed_runs(&TWO)?;
    let mut figures = vec![
        ("two_motion_variable.svg", motion(&TWO, &variable, "Two robots, variable horizon")),
        ("two_inputs_variable.svg", inputs(&TWO, &variable)),
        ("two_horizon.svg", horizons(&TWO, &variable)),
    ];
    if let Some(fixed) = runs.iter().find(|kept| kept.horizon == "fixed:30") {
        figures.push(("two_motion_fh30.svg", motion(&TWO, fixed, "Two robots, FH30")));
        figures.push(("two_inputs_fh30.svg", inputs(&TWO, fixed)));
    }
    runs.push(variable);
    let rows = |kept: &KeptRun| kept.summary.activations as f64;
    figures.push(("two_activations.svg", bars(&TWO, &runs, "Two robots: collision rows", "collision rows", rows)));
    Ok(figures)
}

fn fourteen_robots() -> Result<Vec<Figure>, Failed> {
    let mut runs = fixed_runs(&FOURTEEN)?;
    runs.push(FOURTEEN.variable(SEEDS)?);
    let moved = runs.last().map(|kept| motion(&FOURTEEN, kept, "Fourteen robots, variable horizon"));
    let bars = |title, y, value: fn(&KeptRun) -> f64| bars(&FOURTEEN, &runs, title, y, value);
    let completion = |kept: &KeptRun| kept.summary.ticks as f64 * kept.params.model.sample_time;
    Ok(vec![
        ("fourteen_motion.svg", moved.unwrap_or_default()),
        ("fourteen_path.svg", bars("Fourteen robots: path cost", "path cost (m)", |kept| kept.summary.path_cost)),
        (
            "fourteen_computation.svg",
            bars("Fourteen robots: planning time, mean of a robot and tick", "time (us)", KeptRun::mean_step_us),
        ),
        ("fourteen_completion.svg", bars("Fourteen robots: task completion", "time (s)", completion)),
    ])
}

fn fixed_runs(setting: &Setting) -> Result<Vec<KeptRun>, Failed> {
    HORIZONS.iter().map(|steps| setting.run(&format!("fixed:{steps}"))).collect()
}

fn motion(setting: &Setting, kept: &KeptRun, title: &str) -> String {
    let half = kept.params.model.min_separation / 2.0;
    let mut corners = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let states = kept.ticks.iter().flatten().map(|step| step.next_position);
    let places = kept.scenario.robots.iter().flat_map(|robot| [robot.start, robot.set_point]);
    let discs = kept.scenario.obstacles.iter().map(|obstacle| obstacle.position);
    let rings = kept.scenario.shapes.iter().flat_map(|shape| shape.rings().iter().flatten().copied());
    for place in states.chain(places).chain(discs).chain(rings) {
        for axis in 0..2 {
            corners[0][axis] = corners[0][axis].min(place[axis] - 2.0 * half);
            corners[1][axis] = corners[1][axis].max(place[axis] + 2.0 * half);
        }
    }
    let path = format!("{title} ({}, path {:.1} m)", kept.horizon, kept.summary.path_cost);
    let labels = Labels { title: &path, x: "x (m)", y: "y (m)", command: &setting.command(&kept.horizon) };
    let [low, high] = corners;
    let mut chart = Chart::new(&labels, [low[0], high[0]], [low[1], high[1]], true);
    chart.number_x();
    for shape in &kept.scenario.shapes {
        let rings: Vec<Vec<[f64; 2]>> =
            shape.rings().iter().map(|ring| ring.iter().map(|at| [at.x, at.y]).collect()).collect();
        chart.shape(&rings, shape.radius(), "#8c8c8c");
    }
    for obstacle in &kept.scenario.obstacles {
        let at = [obstacle.position.x, obstacle.position.y];
        chart.disc(at, obstacle.radius.unwrap_or(half), "#8c8c8c", true);
    }
    for (i, robot) in kept.scenario.robots.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let dash = if i < COLOURS.len() { "" } else { "6 3" };
        let mut points = vec![[robot.start.x, robot.start.y]];
        points.extend(kept.ticks.iter().map(|steps| [steps[i].next_position.x, steps[i].next_position.y]));
        chart.line(&points, colour, dash);
        chart.disc([robot.set_point.x, robot.set_point.y], robot.radius.unwrap_or(half), colour, false);
        chart.disc([robot.start.x, robot.start.y], 0.12, colour, true);
    }
    // As in the paper: a moment half-way, robots with their horizon in brackets.
    if let Some(steps) = kept.ticks.get(kept.ticks.len() / 3) {
        for (i, step) in steps.iter().enumerate() {
            let at = [step.position.x, step.position.y];
            chart.disc(at, half, COLOURS[i % COLOURS.len()], false);
            chart.word(at, &format!("{i} [{}]", step.horizon));
        }
    }
    chart.finish()
}

fn held(kept: &KeptRun, value: impl Fn(&[vodca::step::Step]) -> f64) -> Vec<[f64; 2]> {
    let h = kept.params.model.sample_time;
    let corners = |(tick, steps): (usize, &Vec<_>)| {
        let value = value(steps);
        [[tick as f64 * h, value], [(tick + 1) as f64 * h, value]]
    };
    kept.ticks.iter().enumerate().flat_map(corners).collect()
}

fn inputs(setting: &Setting, kept: &KeptRun) -> String {
    let title = format!("Control inputs ({})", kept.horizon);
    let labels = Labels { title: &title, x: "time (s)", y: "input (m/s)", command: &setting.command(&kept.horizon) };
    let bound = 1.1 * kept.params.model.max_speed;
    let mut chart = Chart::new(&labels, [0.0, end(kept)], [-bound, bound], false);
    chart.number_x();
    let mut entries = Vec::new();
    for (robot, axis, name) in [(0, 0, "ux 0"), (0, 1, "uy 0"), (1, 0, "ux 1"), (1, 1, "uy 1")] {
        let colour = COLOURS[2 * robot + axis];
        let dash = if robot == 0 { "" } else { "6 3" };
        chart.line(&held(kept, |steps| steps[robot].input[axis]), colour, dash);
        entries.push((colour, name.to_string()));
    }
    chart.legend(&entries);
    chart.finish()
}

fn horizons(setting: &Setting, kept: &KeptRun) -> String {
    let title = format!("Prediction horizon ({})", kept.horizon);
    let labels =
        Labels { title: &title, x: "time (s)", y: "horizon N (ticks)", command: &setting.command(&kept.horizon) };
    let mut chart = Chart::new(&labels, [0.0, end(kept)], [0.0, 50.0], false);
    chart.number_x();
    let mut entries = Vec::new();
    for (robot, colour) in COLOURS.iter().take(kept.scenario.robots.len()).enumerate() {
        chart.line(&held(kept, |steps| steps[robot].horizon.steps() as f64), colour, "");
        entries.push((*colour, format!("robot {robot}")));
    }
    chart.legend(&entries);
    chart.finish()
}

fn end(kept: &KeptRun) -> f64 {
    kept.ticks.len() as f64 * kept.params.model.sample_time
}

fn bars(setting: &Setting, runs: &[KeptRun], title: &str, y: &str, value: impl Fn(&KeptRun) -> f64) -> String {
    let most = runs.iter().map(&value).fold(f64::MIN_POSITIVE, f64::max);
    let labels = Labels { title, x: "horizon", y, command: &setting.command("fixed:5 (and so on)") };
    let mut chart = Chart::new(&labels, [-0.6, runs.len() as f64 - 0.4], [0.0, 1.12 * most], false);
    for (index, kept) in runs.iter().enumerate() {
        let colour = if kept.summary.success { COLOURS[0] } else { FAILED };
        chart.bar(index, value(kept), colour, &kept.name());
    }
    chart.legend(&[(COLOURS[0], "completed".into()), (FAILED, "failed".into())]);
    chart.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_failed_is_drawn_in_red() {
        let runs = [TWO.run("fixed:6").unwrap(), TWO.run("fixed:20").unwrap()];
        assert_eq!(runs.each_ref().map(|kept| kept.summary.success), [false, true]);
        let text = bars(&TWO, &runs, "rows", "rows", |kept| kept.summary.activations as f64);
        assert_eq!(text.matches(FAILED).count(), 2, "a bar and the legend: {text}");
        assert!(text.contains(">FH6<") && text.contains(">FH20<"));
    }

    #[test]
    fn a_motion_plot_shows_every_robot_with_its_horizon_in_brackets() {
        let text = motion(&TWO, &TWO.run("fixed:20").unwrap(), "Two");
        assert!(text.contains(">0 [20]<") && text.contains(">1 [20]<"), "{text}");
    }
}

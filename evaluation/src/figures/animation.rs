//! A run as a moving SVG (SMIL): it plays wherever a picture is shown, a README included, without a script.

use super::kept_run::{KeptRun, Setting};
use super::svg::{COLOURS, escaped};
use std::fmt::Write as _;
use vodca::Position;
use vodca::prediction::Prediction;

/// Pixels per metre.
const SCALE: f64 = 26.0;
/// Free space around everything that is drawn, m.
const MARGIN: f64 = 0.4;
/// Seconds of the run per second of the animation.
const SPEED: f64 = 2.0;
/// Ticks for which the last picture stands still before the run begins again.
const REST: usize = 8;
/// Points that a plan is drawn through, whatever its horizon: SMIL moves paths of equally many points only.
const PLAN_POINTS: usize = 6;
/// Share of the run that viewers without animation show.
const STILL: f64 = 0.4;
const FOOT: f64 = 24.0;
const STYLE: &str = "svg{background:#fff}text{font:12px sans-serif;fill:#16181d}.o{fill:#c9ced6}.w{stroke-opacity:.25}\
@media(prefers-color-scheme:dark){svg{background:#14161a}text{fill:#eceef2}.o{fill:#3a3f48}}";

/// Where metres lie in the picture.
struct Frame {
    low: Position,
    high: Position,
}

/// Draws `kept`: discs of half the separation, the way each has come, its set-point, and its plan ahead. A disc is
/// filled while its robot has collision rows.
pub(super) fn animation(setting: &Setting, kept: &KeptRun, title: &str) -> String {
    let half = kept.params.model.min_separation / 2.0;
    let frame = Frame::around(kept, half);
    let seconds = (kept.ticks.len() + REST) as f64 * kept.params.model.sample_time / SPEED;
    let [width, height] = [frame.x(frame.high.x) + MARGIN * SCALE, frame.y(frame.low.y) + MARGIN * SCALE];
    let mut body = format!("<desc>{}</desc>\n", escaped(&setting.command(&kept.horizon)));
    for obstacle in &kept.scenario.obstacles {
        let radius = obstacle.radius.unwrap_or(half) * SCALE;
        let [x, y] = frame.at(obstacle.position);
        line(&mut body, format_args!("<circle class=\"o\" cx=\"{x:.0}\" cy=\"{y:.0}\" r=\"{radius:.1}\"/>"));
    }
    for robot in 0..kept.scenario.robots.len() {
        draw_robot(&mut body, kept, &frame, robot, half, seconds);
    }
    let foot = height + FOOT - 9.0;
    line(&mut body, format_args!("<text x=\"10\" y=\"{foot:.0}\">{}</text>", escaped(title)));
    let bar: Vec<String> =
        shown(kept).map(|tick| format!("{:.0}", width * tick as f64 / kept.ticks.len() as f64)).collect();
    line(
        &mut body,
        format_args!(
            "<rect y=\"{:.0}\" height=\"3\" fill=\"#8a909c\">{}</rect>",
            height + FOOT - 3.0,
            animate("width", &bar, seconds, "linear")
        ),
    );
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {:.0}\" role=\"img\">\n<style>{STYLE}</style>\n\
         {body}</svg>\n",
        height + FOOT
    )
}

fn draw_robot(body: &mut String, kept: &KeptRun, frame: &Frame, robot: usize, half: f64, seconds: f64) {
    let colour = COLOURS[robot % COLOURS.len()];
    let entry = &kept.scenario.robots[robot];
    let radius = entry.radius.unwrap_or(half) * SCALE;
    let still = (STILL * kept.ticks.len() as f64) as usize;
    let [x, y] = frame.at(entry.set_point);
    line(
        body,
        format_args!(
            "<circle class=\"w\" cx=\"{x:.0}\" cy=\"{y:.0}\" r=\"{radius:.1}\" fill=\"none\" stroke=\"{colour}\"/>"
        ),
    );
    let places: Vec<[f64; 2]> = shown(kept).map(|tick| frame.at(place(kept, robot, tick))).collect();
    draw_way(body, &places[..=kept.ticks.len()], still, colour, seconds);
    let plans: Vec<String> = shown(kept).map(|tick| plan(kept, frame, robot, tick)).collect();
    line(
        body,
        format_args!(
            "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" stroke-dasharray=\"1 3\" d=\"{}\">{}</path>",
            plans[still],
            animate("d", &plans, seconds, "linear")
        ),
    );
    let axis = |axis: usize| places.iter().map(|place| format!("{:.1}", place[axis])).collect::<Vec<_>>();
    let (xs, ys) = (axis(0), axis(1));
    let full: Vec<String> = shown(kept).map(|tick| opacity(kept, robot, tick)).collect();
    line(
        body,
        format_args!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{radius:.1}\" fill=\"{colour}\" stroke=\"{colour}\" fill-opacity=\"{}\">{}{}{}</circle>",
            xs[still],
            ys[still],
            full[still],
            animate("cx", &xs, seconds, "linear"),
            animate("cy", &ys, seconds, "linear"),
            animate("fill-opacity", &full, seconds, "discrete")
        ),
    );
}

/// The way so far: one path through `places`, of which a growing part is drawn.
fn draw_way(body: &mut String, places: &[[f64; 2]], still: usize, colour: &str, seconds: f64) {
    let mut gone = vec![0.0];
    for pair in places.windows(2) {
        gone.push(gone[gone.len() - 1] + (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]));
    }
    let length = gone[gone.len() - 1];
    let end = std::iter::repeat_n(length, REST - 1);
    let left: Vec<String> = gone.iter().copied().chain(end).map(|gone| format!("{:.0}", length - gone)).collect();
    let path: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
    line(
        body,
        format_args!(
            "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" stroke-opacity=\".5\" stroke-dasharray=\"{length:.0}\" \
             stroke-dashoffset=\"{}\" d=\"M{}\">{}</path>",
            left[still],
            path.join(" "),
            animate("stroke-dashoffset", &left, seconds, "linear")
        ),
    );
}

/// The ticks that are shown one after another: all of them, then the end for a while.
fn shown(kept: &KeptRun) -> impl Iterator<Item = usize> {
    let end = kept.ticks.len();
    (0..end + REST).map(move |tick| tick.min(end))
}

/// Where `robot` is at the start of `tick`; after the last one, where it ended.
fn place(kept: &KeptRun, robot: usize, tick: usize) -> Position {
    match kept.ticks.get(tick) {
        Some(steps) => steps[robot].position,
        None => kept.ticks.last().map_or(kept.scenario.robots[robot].start, |steps| steps[robot].next_position),
    }
}

fn plan(kept: &KeptRun, frame: &Frame, robot: usize, tick: usize) -> String {
    let last = place(kept, robot, tick);
    let points = (0..PLAN_POINTS).map(|point| match kept.ticks.get(tick) {
        Some(steps) => frame.at(along(&steps[robot].plan, point)),
        None => frame.at(last),
    });
    let text: Vec<String> = points.map(|[x, y]| format!("{x:.0} {y:.0}")).collect();
    format!("M{}", text.join(" "))
}

/// Point `point` of [`PLAN_POINTS`] that divide a plan into equally many steps, as nearly as whole steps allow.
fn along(plan: &Prediction, point: usize) -> Position {
    plan.state(point * plan.horizon().steps() / (PLAN_POINTS - 1))
}

fn opacity(kept: &KeptRun, robot: usize, tick: usize) -> String {
    let rows = kept.ticks.get(tick).map_or(0, |steps| steps[robot].rows);
    if rows > 0 { ".75".into() } else { ".2".into() }
}

fn animate(attribute: &str, values: &[String], seconds: f64, mode: &str) -> String {
    format!(
        "<animate attributeName=\"{attribute}\" calcMode=\"{mode}\" dur=\"{seconds:.1}s\" repeatCount=\"indefinite\" \
         values=\"{}\"/>",
        values.join(";")
    )
}

fn line(body: &mut String, element: std::fmt::Arguments<'_>) {
    let _ = writeln!(body, "{element}"); // writing to a String cannot fail
}

impl Frame {
    fn around(kept: &KeptRun, half: f64) -> Self {
        let robots = kept.scenario.robots.iter().flat_map(|robot| [robot.start, robot.set_point]);
        let states = kept.ticks.iter().flatten().map(|step| step.next_position);
        let places = robots.chain(states).chain(kept.scenario.obstacles.iter().map(|obstacle| obstacle.position));
        let edge = Position::repeat(half + MARGIN);
        let none = (Position::repeat(f64::INFINITY), Position::repeat(f64::NEG_INFINITY));
        let (low, high) = places.fold(none, |(low, high), place| (low.inf(&(place - edge)), high.sup(&(place + edge))));
        Self { low, high }
    }

    fn x(&self, x: f64) -> f64 {
        (x - self.low.x) * SCALE
    }

    fn y(&self, y: f64) -> f64 {
        (self.high.y - y) * SCALE
    }

    fn at(&self, place: Position) -> [f64; 2] {
        [self.x(place.x), self.y(place.y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::SAFE;

    #[test]
    fn every_robot_moves_from_its_start_to_its_set_point_and_the_file_stays_small() {
        let kept = SAFE.run("fixed:20").unwrap();
        let text = animation(&SAFE, &kept, "fourteen");
        assert!(text.len() < 300_000, "{} bytes", text.len());
        assert_eq!(text.matches("attributeName=\"cx\"").count(), 14);
        let values = |attribute: &str| {
            let from = text.split(&format!("attributeName=\"{attribute}\"")).nth(1).unwrap();
            let list = from.split("values=\"").nth(1).unwrap().split('"').next().unwrap();
            list.split(';').map(String::from).collect::<Vec<_>>()
        };
        let frame = Frame::around(&kept, kept.params.model.min_separation / 2.0);
        let robot = &kept.scenario.robots[0];
        let (xs, ys) = (values("cx"), values("cy"));
        assert_eq!(xs.len(), kept.ticks.len() + REST);
        assert_eq!(
            [&xs[0], &ys[0]].map(|text| text.parse::<f64>().unwrap()),
            frame.at(robot.start).map(|at| (at * 10.0).round() / 10.0)
        );
        let end = [&xs, &ys].map(|list| list.last().unwrap().parse::<f64>().unwrap());
        let wanted = frame.at(robot.set_point);
        let off = (end[0] - wanted[0]).hypot(end[1] - wanted[1]) / SCALE;
        assert!(off < kept.params.episode.arrival_tolerance + 0.01, "{off} m");
    }
}

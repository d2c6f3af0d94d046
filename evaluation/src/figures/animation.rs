//! A run as a moving SVG (SMIL): it plays wherever a picture is shown, a README included, without a script.

use super::kept_run::{KeptRun, Setting};
use super::svg::{COLOURS, escaped, rings_path};
use std::fmt::Write as _;
use vodca::Position;
use vodca::prediction::Prediction;

/// Free space around everything that is drawn, m.
const MARGIN: f64 = 0.4;
/// Ticks for which the last picture stands still before the run begins again.
const REST: usize = 8;
/// Points that a plan is drawn through, whatever its horizon: SMIL moves paths of equally many points only.
const PLAN_POINTS: usize = 6;
/// Share of the run that viewers without animation show.
const STILL: f64 = 0.4;
const FOOT: f64 = 24.0;
const STYLE: &str = "svg{background:#fff}text{font:12px sans-serif;fill:#16181d}.o{fill:#c9ced6}.l{fill:none;stroke:#c9ced6;stroke-linejoin:round}.w{stroke-opacity:.25}\
@media(prefers-color-scheme:dark){svg{background:#14161a}text{fill:#eceef2}.o{fill:#3a3f48}.l{stroke:#3a3f48}}";

/// How a run is shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// Pixels per metre.
    pub(super) scale: f64,
    /// Seconds of the run per second of the animation.
    pub(super) speed: f64,
    /// Ticks from one moment that is written down to the next; in between places are interpolated.
    pub(super) every: usize,
    /// Whether plans are drawn.
    pub(super) plans: bool,
}

impl Look {
    /// Small teams and short runs: everything.
    pub(super) const FULL: Self = Self { scale: 26.0, speed: 2.0, every: 1, plans: true };
}

/// Where metres lie in the picture.
struct Frame {
    low: Position,
    high: Position,
    scale: f64,
}

/// What is drawn.
struct Film<'a> {
    kept: &'a KeptRun,
    frame: Frame,
    /// The ticks that are written down one after another: every so many, then the end for a while.
    shown: Vec<usize>,
    /// Which of them viewers without animation show.
    still: usize,
    seconds: f64,
    half: f64,
    plans: bool,
}

impl<'a> Film<'a> {
    fn new(kept: &'a KeptRun, look: &Look) -> Self {
        let (end, half) = (kept.ticks.len(), kept.params.model.min_separation / 2.0);
        let shown: Vec<usize> = (0..end + REST).step_by(look.every).map(|tick| tick.min(end)).collect();
        Self {
            kept,
            frame: Frame::around(kept, half, look.scale),
            still: (STILL * end as f64) as usize / look.every,
            shown,
            seconds: (end + REST) as f64 * kept.params.model.sample_time / look.speed,
            half,
            plans: look.plans,
        }
    }

    /// The text of `value` at every moment.
    fn values(&self, value: impl Fn(usize) -> String) -> Vec<String> {
        self.shown.iter().map(|tick| value(*tick)).collect()
    }

    fn animate(&self, attribute: &str, values: &[String], mode: &str) -> String {
        format!(
            "<animate attributeName=\"{attribute}\" calcMode=\"{mode}\" dur=\"{:.1}s\" repeatCount=\"indefinite\" \
             values=\"{}\"/>",
            self.seconds,
            values.join(";")
        )
    }
}

/// Draws `kept`: discs of half the separation, the way each has come, its set-point, and its plan ahead. A disc is
/// filled while its robot has collision rows.
pub(super) fn animation(setting: &Setting, kept: &KeptRun, look: &Look, title: &str) -> String {
    let film = Film::new(kept, look);
    let Film { frame, half, .. } = &film;
    let margin = MARGIN * frame.scale;
    let [width, height] = [frame.x(frame.high.x) + margin, frame.y(frame.low.y) + margin];
    let mut body = format!("<desc>{}</desc>\n", escaped(&setting.command(&kept.horizon)));
    for shape in &kept.scenario.shapes {
        let rings: Vec<Vec<[f64; 2]>> =
            shape.rings().iter().map(|ring| ring.iter().map(|at| (*at).into()).collect()).collect();
        let path = rings_path(&rings, |[x, y]| frame.at(Position::new(x, y)));
        let width = 2.0 * shape.radius() * frame.scale;
        let class = if width > 0.0 { "l" } else { "o" };
        line(
            &mut body,
            format_args!("<path class=\"{class}\" fill-rule=\"evenodd\" stroke-width=\"{width:.1}\" d=\"{path}\"/>"),
        );
    }
    for obstacle in &kept.scenario.obstacles {
        let radius = obstacle.radius.unwrap_or(*half) * frame.scale;
        let [x, y] = frame.at(obstacle.position);
        line(&mut body, format_args!("<circle class=\"o\" cx=\"{x:.0}\" cy=\"{y:.0}\" r=\"{radius:.1}\"/>"));
    }
    for robot in 0..kept.scenario.robots.len() {
        draw_robot(&mut body, &film, robot);
    }
    let foot = height + FOOT - 9.0;
    line(&mut body, format_args!("<text x=\"10\" y=\"{foot:.0}\">{}</text>", escaped(title)));
    let bar = film.values(|tick| format!("{:.0}", width * tick as f64 / kept.ticks.len() as f64));
    line(
        &mut body,
        format_args!(
            "<rect y=\"{:.0}\" height=\"3\" fill=\"#8a909c\">{}</rect>",
            height + FOOT - 3.0,
            film.animate("width", &bar, "linear")
        ),
    );
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {:.0}\" role=\"img\">\n<style>{STYLE}</style>\n\
         {body}</svg>\n",
        height + FOOT
    )
}

fn draw_robot(body: &mut String, film: &Film<'_>, robot: usize) {
    let Film { kept, frame, still, .. } = film;
    let colour = COLOURS[robot % COLOURS.len()];
    let entry = &kept.scenario.robots[robot];
    let radius = entry.radius.unwrap_or(film.half) * frame.scale;
    let [x, y] = frame.at(entry.set_point);
    line(
        body,
        format_args!(
            "<circle class=\"w\" cx=\"{x:.0}\" cy=\"{y:.0}\" r=\"{radius:.1}\" fill=\"none\" stroke=\"{colour}\"/>"
        ),
    );
    let places: Vec<[f64; 2]> = film.shown.iter().map(|tick| frame.at(place(kept, robot, *tick))).collect();
    draw_way(body, film, &places, colour);
    if film.plans {
        let plans = film.values(|tick| plan(kept, frame, robot, tick));
        line(
            body,
            format_args!(
                "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" stroke-dasharray=\"1 3\" d=\"{}\">{}</path>",
                plans[*still],
                film.animate("d", &plans, "linear")
            ),
        );
    }
    let axis = |axis: usize| places.iter().map(|place| format!("{:.1}", place[axis])).collect::<Vec<_>>();
    let (xs, ys) = (axis(0), axis(1));
    let full = film.values(|tick| opacity(kept, robot, tick));
    line(
        body,
        format_args!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{radius:.1}\" fill=\"{colour}\" stroke=\"{colour}\" fill-opacity=\"{}\">{}{}{}</circle>",
            xs[*still],
            ys[*still],
            full[*still],
            film.animate("cx", &xs, "linear"),
            film.animate("cy", &ys, "linear"),
            film.animate("fill-opacity", &full, "discrete")
        ),
    );
}

/// The way so far: one path through `places`, of which a growing part is drawn.
fn draw_way(body: &mut String, film: &Film<'_>, places: &[[f64; 2]], colour: &str) {
    let mut gone = vec![0.0];
    for pair in places.windows(2) {
        gone.push(gone[gone.len() - 1] + (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]));
    }
    let length = gone[gone.len() - 1];
    let left: Vec<String> = gone.iter().map(|gone| format!("{:.0}", length - gone)).collect();
    let end = film.shown.iter().take_while(|tick| **tick < film.kept.ticks.len()).count();
    let path: Vec<String> = places[..=end].iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
    line(
        body,
        format_args!(
            "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" stroke-opacity=\".5\" stroke-dasharray=\"{length:.0}\" \
             stroke-dashoffset=\"{}\" d=\"M{}\">{}</path>",
            left[film.still],
            path.join(" "),
            film.animate("stroke-dashoffset", &left, "linear")
        ),
    );
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

fn line(body: &mut String, element: std::fmt::Arguments<'_>) {
    let _ = writeln!(body, "{element}"); // writing to a String cannot fail
}

impl Frame {
    fn around(kept: &KeptRun, half: f64, scale: f64) -> Self {
        let edge = Position::repeat(half + MARGIN);
        let [low, high] = kept.scenario.bounds(0.0);
        let discs = kept.scenario.obstacles.iter().map(|disc| disc.position);
        let states = kept.ticks.iter().flatten().map(|step| step.next_position).chain(discs);
        let ends = kept.scenario.robots.iter().flat_map(|robot| [robot.start, robot.set_point]);
        let around = states
            .chain(ends)
            .fold((low, high), |(low, high), place| (low.inf(&(place - edge)), high.sup(&(place + edge))));
        Self { low: around.0, high: around.1, scale }
    }

    fn x(&self, x: f64) -> f64 {
        (x - self.low.x) * self.scale
    }

    fn y(&self, y: f64) -> f64 {
        (self.high.y - y) * self.scale
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
        let text = animation(&SAFE, &kept, &Look::FULL, "fourteen");
        assert!(text.len() < 300_000, "{} bytes", text.len());
        assert_eq!(text.matches("attributeName=\"cx\"").count(), 14);
        let values = |attribute: &str| {
            let from = text.split(&format!("attributeName=\"{attribute}\"")).nth(1).unwrap();
            let list = from.split("values=\"").nth(1).unwrap().split('"').next().unwrap();
            list.split(';').map(String::from).collect::<Vec<_>>()
        };
        let frame = Frame::around(&kept, kept.params.model.min_separation / 2.0, Look::FULL.scale);
        let robot = &kept.scenario.robots[0];
        let (xs, ys) = (values("cx"), values("cy"));
        assert_eq!(xs.len(), kept.ticks.len() + REST);
        assert_eq!(
            [&xs[0], &ys[0]].map(|text| text.parse::<f64>().unwrap()),
            frame.at(robot.start).map(|at| (at * 10.0).round() / 10.0)
        );
        let end = [&xs, &ys].map(|list| list.last().unwrap().parse::<f64>().unwrap());
        let wanted = frame.at(robot.set_point);
        let off = (end[0] - wanted[0]).hypot(end[1] - wanted[1]) / Look::FULL.scale;
        assert!(off < kept.params.episode.arrival_tolerance + 0.01, "{off} m");
    }
}

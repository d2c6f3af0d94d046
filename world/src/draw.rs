//! A picture of a layout before anyone runs it.

use crate::Position;
use crate::shape::{Bounds, Obstacle, Obstacles, Shape};
use std::fmt::Write;

/// Longer side of a picture, pixels.
const LONG_SIDE: f64 = 1200.0;
/// Round the layout, share of its longer side.
const MARGIN: f64 = 0.04;
/// With more robots than this, names would hide the layout.
const FEW: usize = 24;
/// Golden angle, degrees: neighbours in number get colours that are far apart.
const HUE_STEP: f64 = 137.508;

/// A robot in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotMark {
    /// Written beside it where there are few.
    pub name: String,
    /// m.
    pub start: Position,
    /// m.
    pub set_point: Position,
    /// m.
    pub radius: f64,
    /// The bends of its way, the set-point last, m; empty where it has none.
    pub way: Vec<Position>,
}

/// An SVG of what stands, where robots (filled) start, where they go (rings) and on which ways, with a scale.
pub fn svg(title: &str, obstacles: &Obstacles, robots: &[RobotMark]) -> String {
    let bounds = robots.iter().fold(obstacles.bounds(), |bounds, robot| {
        let ends = Bounds::of(&[robot.start, robot.set_point]).grown(robot.radius);
        bounds.joined(&Bounds::of(&robot.way)).joined(&ends)
    });
    // Nothing at all still has a place to be drawn in.
    let bounds = if bounds.low.x <= bounds.high.x { bounds } else { Bounds::of(&[Position::zeros()]).grown(1.0) };
    let margin = (bounds.high - bounds.low).max().max(1.0) * MARGIN;
    let bounds = bounds.grown(margin);
    let size = bounds.high - bounds.low;
    let scale = LONG_SIDE / size.max();
    let mut canvas = Canvas { text: String::new(), low: bounds.low, top: bounds.high.y, scale };
    let (width, height) = (size.x * scale, size.y * scale);
    let line = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{:.0}\" viewBox=\"0 0 {width:.1} {:.1}\" \
         font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"14\">",
        height + 34.0,
        height + 34.0
    );
    canvas.line(&line);
    canvas.line(&format!("<title>{}</title>", escaped(title)));
    canvas.line("<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>");
    for obstacle in obstacles.list() {
        canvas.obstacle(obstacle);
    }
    for (number, robot) in robots.iter().enumerate() {
        canvas.way(robot, &colour(number));
    }
    for (number, robot) in robots.iter().enumerate() {
        canvas.robot(robot, &colour(number), robots.len() <= FEW);
    }
    canvas.scale_bar(title, size.x, height);
    canvas.line("</svg>");
    canvas.text
}

fn colour(number: usize) -> String {
    format!("hsl({:.0},70%,42%)", (number as f64 * HUE_STEP) % 360.0)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

struct Canvas {
    text: String,
    low: Position,
    top: f64,
    scale: f64,
}

impl Canvas {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Pixels from the left upper corner: y points down in a picture.
    fn at(&self, place: Position) -> (f64, f64) {
        ((place.x - self.low.x) * self.scale, (self.top - place.y) * self.scale)
    }

    fn path(&self, points: &[Position]) -> String {
        let mut path = String::new();
        for (i, point) in points.iter().enumerate() {
            let (x, y) = self.at(*point);
            // Writing to a string cannot fail.
            let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { "M" } else { " L" });
        }
        path
    }

    fn circle(&mut self, centre: Position, radius: f64, style: &str) {
        let (x, y) = self.at(centre);
        self.line(&format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.1}\" {style}/>", radius * self.scale));
    }

    fn obstacle(&mut self, obstacle: &Obstacle) {
        const GREY: &str = "#5c6670";
        match obstacle.shape() {
            Shape::Disc { centre, radius } => self.circle(*centre, *radius, &format!("fill=\"{GREY}\"")),
            Shape::Wall { points, thickness } => {
                let (path, width) = (self.path(points), thickness * self.scale);
                self.line(&format!(
                    "<path d=\"{path}\" fill=\"none\" stroke=\"{GREY}\" stroke-width=\"{width:.2}\" \
                     stroke-linecap=\"round\" stroke-linejoin=\"round\"/>"
                ));
            }
            Shape::Polygon(_) | Shape::Region(_) => {
                let rings: Vec<String> = obstacle.rings().iter().map(|ring| self.path(ring) + " Z").collect();
                self.line(&format!("<path d=\"{}\" fill=\"{GREY}\" fill-rule=\"evenodd\"/>", rings.join(" ")));
            }
        }
    }

    fn way(&mut self, robot: &RobotMark, colour: &str) {
        let mut points = vec![robot.start];
        points.extend(&robot.way);
        if robot.way.is_empty() {
            points.push(robot.set_point); // Dashed, as no way is known.
        }
        let (path, dashed) = (self.path(&points), if robot.way.is_empty() { " stroke-dasharray=\"3 5\"" } else { "" });
        self.line(&format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\" stroke-opacity=\"0.75\"{dashed}/>"
        ));
    }

    fn robot(&mut self, robot: &RobotMark, colour: &str, named: bool) {
        self.circle(robot.set_point, robot.radius, &format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\""));
        self.circle(robot.start, robot.radius, &format!("fill=\"{colour}\" fill-opacity=\"0.8\""));
        if named {
            let (x, y) = self.at(robot.start);
            let name = escaped(&robot.name);
            self.line(&format!(
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" stroke=\"#ffffff\" stroke-width=\"3\" \
                 paint-order=\"stroke\">{name}</text>",
                y + 5.0
            ));
        }
    }

    /// A bar of 1, 2 or 5 times a power of ten metres, at most a fifth of the picture; the title beside it.
    fn scale_bar(&mut self, title: &str, width: f64, below: f64) {
        let most = width / 5.0;
        let power = 10f64.powf(most.log10().floor());
        let length =
            [5.0, 2.0, 1.0].into_iter().map(|step| step * power).find(|length| *length <= most).unwrap_or(power);
        let (x, y) = (16.0, below + 22.0);
        let end = x + length * self.scale;
        self.line(&format!(
            "<path d=\"M{x} {:.1} V{:.1} M{x} {y:.1} H{end:.1} M{end:.1} {:.1} V{:.1}\" stroke=\"#222222\" stroke-width=\"2\"/>",
            y - 5.0,
            y + 5.0,
            y - 5.0,
            y + 5.0
        ));
        let text = y + 5.0;
        self.line(&format!("<text x=\"{:.1}\" y=\"{text:.1}\" fill=\"#222222\">{length} m</text>", end + 8.0));
        self.line(&format!(
            "<text x=\"{:.1}\" y=\"{text:.1}\" text-anchor=\"end\" fill=\"#222222\">{}</text>",
            width * self.scale - 16.0,
            escaped(title)
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robot(name: &str) -> RobotMark {
        let way = vec![Position::new(5.0, 2.0), Position::new(10.0, 0.0)];
        RobotMark { name: name.into(), start: Position::zeros(), set_point: way[1], radius: 0.75, way }
    }

    fn obstacles() -> Obstacles {
        let shapes = [
            Shape::Disc { centre: Position::new(5.0, 0.0), radius: 1.0 },
            Shape::Wall { points: vec![Position::new(0.0, 4.0), Position::new(10.0, 4.0)], thickness: 0.2 },
            Shape::Polygon(vec![Position::new(2.0, -4.0), Position::new(8.0, -4.0), Position::new(5.0, -3.0)]),
        ];
        Obstacles::new(shapes.into_iter().map(|shape| Obstacle::new("it", shape).unwrap()).collect())
    }

    #[test]
    fn a_picture_has_all_shapes_robots_names_and_a_scale() {
        let text = svg("mine & yours", &obstacles(), &[robot("<left>")]);
        assert_eq!((text.matches("<circle").count(), text.matches("<path").count()), (3, 4));
        for part in ["<svg", "</svg>", "mine &amp; yours", "&lt;left&gt;", "2 m", "evenodd", "stroke-linecap"] {
            assert!(text.contains(part), "`{part}` is not in:\n{text}");
        }
        assert!(!text.contains("NaN") && !text.contains("inf"));
    }

    #[test]
    fn many_robots_have_no_names_and_nothing_at_all_can_be_drawn() {
        let many: Vec<RobotMark> = (0..30).map(|k| robot(&format!("r{k}"))).collect();
        assert!(!svg("many", &obstacles(), &many).contains(">r7<"));
        let nothing = svg("nothing", &Obstacles::new(Vec::new()), &[]);
        assert!(nothing.contains("</svg>") && !nothing.contains("NaN") && !nothing.contains("inf"));
    }
}

//! The scenario file, version 1, and its exact copy. Documented in `scenarios/README.md`.

use super::lines;
use super::{DEFAULT_MAX_TICKS, Obstacle, Robot, Scenario, ScenarioError, Shaped};
use serde::{Deserialize, Serialize};
use std::path::Path;
use toml::Spanned;
use world::file::{LayoutError, MapEntry, ObstacleEntry, Point};
use world::map::{self, MapSettings};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    version: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(default = "default_max_ticks")]
    max_ticks: u64,
    #[serde(default)]
    seed: u64,
    #[serde(default)]
    allow_close_start: bool,
    #[serde(default)]
    robot: Vec<FileRobot>,
    #[serde(skip_serializing)]
    map: Option<Spanned<MapEntry>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    obstacle: Vec<Spanned<ObstacleEntry>>,
    #[serde(default, skip_serializing_if = "toml::Table::is_empty")]
    params: toml::Table,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRobot {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    start: Point,
    set_point: Point,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max_speed: Option<f64>,
}

fn default_max_ticks() -> u64 {
    DEFAULT_MAX_TICKS
}

/// The name of a robot that has none in the file.
pub(super) fn robot_name(index: usize) -> String {
    format!("robot-{index}")
}

/// The name of an obstacle that has none in the file.
pub(super) fn obstacle_name(index: usize) -> String {
    format!("obstacle-{index}")
}

impl File {
    /// What stands: discs, and everything else, the map's regions last. `file` is named in errors, and a map is looked
    /// for beside it.
    fn obstacles(&self, text: &str, file: &str) -> Result<(Vec<Obstacle>, Vec<Shaped>), ScenarioError> {
        let at = |span: std::ops::Range<usize>| format!("{file}, line {}", lines::line_at(text, span.start));
        let (mut discs, mut shapes) = (Vec::new(), Vec::new());
        for (number, entry) in self.obstacle.iter().enumerate() {
            let unusable = |error| ScenarioError::Standing { place: at(entry.span()), source: Box::new(error) };
            // A disc without a radius has half of the separation, which is a parameter: any radius will do for a check.
            let checked = entry.get_ref().obstacle(number, 1.0).map_err(unusable)?;
            match entry.get_ref() {
                ObstacleEntry { position: Some(position), radius, .. } => {
                    discs.push(Obstacle { name: checked.name().into(), position: position.0, radius: *radius });
                }
                _ => shapes.push(checked),
            }
        }
        if let Some(map) = &self.map {
            let MapEntry { file: path, unknown, simplify } = map.get_ref();
            let path = Path::new(file).parent().unwrap_or(Path::new("")).join(path);
            let regions = map::load(&path, MapSettings { unknown: *unknown, simplify: *simplify });
            let unusable =
                |source| ScenarioError::Standing { place: at(map.span()), source: Box::new(LayoutError::Map(source)) };
            shapes.extend(regions.map_err(unusable)?);
        }
        Ok((discs, shapes))
    }
}

impl Scenario {
    /// Reads and checks a scenario file; its name is the file's stem unless it says otherwise.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| ScenarioError::Unreadable { file: path.into(), source })?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        Self::from_toml(&text, &stem, &path.display().to_string())
    }

    /// Reads and checks the text of a scenario file. `name` is used when the text has none; `file` is
    /// named in errors.
    pub fn from_toml(text: &str, name: &str, file: &str) -> Result<Self, ScenarioError> {
        let malformed =
            |error: toml::de::Error| ScenarioError::Malformed { file: file.into(), message: error.to_string() };
        // The version first: the fields of another version would only confuse.
        let table: toml::Table = text.parse().map_err(malformed)?;
        match table.get("version") {
            None | Some(toml::Value::Integer(1)) => {}
            Some(other) => return Err(ScenarioError::Version { file: file.into(), version: other.to_string() }),
        }
        let parsed: File = toml::from_str(text).map_err(malformed)?;
        let (obstacles, shapes) = parsed.obstacles(text, file)?;
        let robots = parsed.robot.into_iter().enumerate().map(|(i, robot)| Robot {
            name: robot.name.unwrap_or_else(|| robot_name(i)),
            start: robot.start.0,
            set_point: robot.set_point.0,
            radius: robot.radius,
            max_speed: robot.max_speed,
        });
        let scenario = Self {
            name: parsed.name.unwrap_or_else(|| name.into()),
            robots: robots.collect(),
            obstacles,
            shapes,
            max_ticks: parsed.max_ticks,
            seed: parsed.seed,
            allow_close_start: parsed.allow_close_start,
            params: parsed.params,
        };
        scenario.validate().map_err(|error| error.in_file(file, text))?;
        Ok(scenario)
    }

    /// This scenario as a file that [`Scenario::from_toml`] reads back to the same bits, name included.
    pub fn to_toml(&self) -> Result<String, ScenarioError> {
        let given = |name: &str, default: String| (*name != default).then(|| name.into());
        let robot = |(i, robot): (usize, &Robot)| FileRobot {
            name: given(&robot.name, robot_name(i)),
            start: Point(robot.start),
            set_point: Point(robot.set_point),
            radius: robot.radius,
            max_speed: robot.max_speed,
        };
        let discs = self.obstacles.iter().map(|disc| ObstacleEntry {
            name: Some(disc.name.clone()),
            position: Some(Point(disc.position)),
            radius: disc.radius,
            ..ObstacleEntry::default()
        });
        let obstacle = |(i, entry): (usize, ObstacleEntry)| {
            let name = entry.name.as_deref().and_then(|name| given(name, obstacle_name(i)));
            Spanned::new(0..0, ObstacleEntry { name, ..entry })
        };
        let file = File {
            version: 1,
            name: Some(self.name.clone()),
            max_ticks: self.max_ticks,
            seed: self.seed,
            allow_close_start: self.allow_close_start,
            robot: self.robots.iter().enumerate().map(robot).collect(),
            map: None, // Its obstacles are written out: a copy needs no other file.
            obstacle: discs.chain(self.shapes.iter().map(ObstacleEntry::from)).enumerate().map(obstacle).collect(),
            params: self.params.clone(),
        };
        toml::to_string(&file)
            .map_err(|error| ScenarioError::Unwritable { scenario: self.name.clone(), message: error.to_string() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Position;
    use crate::params::{Params, Profile};
    use crate::scenario::MAX_SPEED;
    use proptest::prelude::*;

    const GOOD: &str = "version = 1\n[[robot]]\nstart = [0, 0.5]\nset_point = [5.0, 0.0]\n";

    fn message(text: &str) -> String {
        Scenario::from_toml(text, "mine", "mine.toml").unwrap_err().to_string()
    }

    #[test]
    fn what_is_left_out_has_its_default() {
        let scenario = Scenario::from_toml(GOOD, "mine", "mine.toml").unwrap();
        assert_eq!((scenario.name.as_str(), scenario.max_ticks, scenario.seed), ("mine", 350, 0));
        assert_eq!(scenario.robots[0].name, "robot-0");
        assert_eq!(scenario.robots[0].start, Position::new(0.0, 0.5));
        assert!(!scenario.allow_close_start && scenario.obstacles.is_empty() && scenario.params.is_empty());
    }

    #[test]
    fn mistakes_show_the_file_the_line_and_what_is_accepted() {
        let unknown = message(&GOOD.replace("set_point", "goal"));
        for part in ["mine.toml:", "line 4", "unknown field `goal`", "`set_point`", "^"] {
            assert!(unknown.contains(part), "{part} is not in:\n{unknown}");
        }
        assert!(message(&GOOD.replace("0.5", "abc")).contains("line 3"));
        let three = message(&GOOD.replace("[0, 0.5]", "[0, 0.5, 1]"));
        assert!(three.contains("line 3") && three.contains("expected [x, y] in metres, found 3 numbers"), "{three}");
        assert!(message(&GOOD.replace("version = 1", "")).contains("missing field `version`"));
    }

    #[test]
    fn layouts_that_cannot_be_run_name_their_file_whatever_they_are_called() {
        let text = GOOD.replace("version = 1", "version = 1\nname = \"cross\"\nmax_ticks = 0");
        assert_eq!(message(&text), "scenario mine.toml: max_ticks = 0 is not allowed; allowed: 1..=1000000");
    }

    #[test]
    fn another_version_is_refused_before_anything_else() {
        let text = GOOD.replace("version = 1", "version = 2\nnew = true");
        assert_eq!(
            message(&text),
            "mine.toml: version = 2 is not known; this program reads version = 1 (scenarios/README.md)"
        );
    }

    #[test]
    fn names_radii_and_parameters_survive_the_copy() {
        let text = format!(
            "{GOOD}name = \"left\"\nradius = 0.5\n[[obstacle]]\nname = \"pillar\"\nposition = [9, 9]\nradius = 2\n\
             [params]\nvodca.turn = 0.1\n"
        );
        let scenario = Scenario::from_toml(&text, "mine", "mine.toml").unwrap();
        let copy = Scenario::from_toml(&scenario.to_toml().unwrap(), "other", "copy.toml").unwrap();
        assert_eq!(copy, scenario);
        assert_eq!((copy.name.as_str(), copy.robots[0].name.as_str()), ("mine", "left"));
        assert_eq!(copy.params["vodca"]["turn"].as_float(), Some(0.1));
    }

    #[test]
    fn the_example_of_the_documentation_is_valid() {
        let page = include_str!("../../../scenarios/README.md");
        let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let scenario = Scenario::from_toml(example, "example", "scenarios/README.md").unwrap();
        let params = Params::resolve(Profile::Safe, &scenario.name, &scenario.params, &[]).unwrap();
        scenario.validate_distances(params.model.min_separation).unwrap();
        assert_eq!((scenario.robots[1].name.as_str(), scenario.obstacles[0].radius), ("left", Some(1.0)));
        assert_eq!(params.horizon.jitter, 2);
    }

    const SHAPES: &str = "[[obstacle]]\nname = \"shelf\"\npolygon = [[8, 2], [12, 2], [12, 3], [9, 3], [9, 6], [8, 6]]\n\
                          [[obstacle]]\nposition = [3, 3]\n[[obstacle]]\nwall = [[0, 8], [5, 8], [5, 9]]\nthickness = 0.2\n";

    #[test]
    fn polygons_walls_and_maps_survive_the_copy() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("m.pgm"), "P2\n4 3\n255\n254 254 254 254\n254 0 0 254\n254 254 0 254\n")
            .unwrap();
        let meta = "image: m.pgm\nresolution: 0.5\norigin: [20.1, -3.3, 0.3]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";
        std::fs::write(folder.path().join("m.yaml"), meta).unwrap();
        let file = folder.path().join("mine.toml");
        let map = "version = 1\nmap = { file = \"m.yaml\", unknown = \"free\" }";
        std::fs::write(&file, GOOD.replace("version = 1", map) + SHAPES).unwrap();
        let scenario = Scenario::load(&file).unwrap();
        let names: Vec<&str> = (0..scenario.obstacle_count()).map(|number| scenario.obstacle_name(number)).collect();
        assert_eq!(names, ["obstacle-1", "shelf", "obstacle-2", "m-1"]);
        let copy = Scenario::from_toml(&scenario.to_toml().unwrap(), "other", "copy.toml").unwrap();
        assert_eq!(copy, scenario);
    }

    #[test]
    fn what_cannot_stand_is_named_with_file_line_and_value() {
        let line = |text: &str| message(&format!("{GOOD}{text}"));
        let open = line("[[obstacle]]\npolygon = [[0, 0], [1, 0]]\n");
        assert!(
            open.starts_with("mine.toml, line 5: obstacle-0: a polygon needs at least 3 different points"),
            "{open}"
        );
        let crossing = line("[[obstacle]]\nname = \"bow\"\npolygon = [[0, 4], [2, 6], [2, 4], [0, 6]]\n");
        for part in ["mine.toml, line 5: bow: the side from point 1 to point 2 crosses", "[1.000, 5.000] m"] {
            assert!(crossing.contains(part), "{crossing}");
        }
        assert!(line("[[obstacle]]\nposition = [9, 9]\nradius = -1\n").contains("line 5: obstacle-0: radius = -1 m"));
        let stray =
            line("[[obstacle]]\nposition = [9, 9]\n[[obstacle]]\npolygon = [[0, 4], [2, 6], [2, 4]]\nradius = 1\n");
        assert!(stray.contains("line 7: obstacle-1: radius does not belong to a polygon"), "{stray}");
        let map = message(&GOOD.replace("version = 1", "version = 1\nmap = \"nowhere/none.yaml\""));
        assert!(map.contains("mine.toml, line 2: cannot read map file nowhere/none.yaml"), "{map}");
    }

    #[test]
    fn a_missing_file_is_named() {
        let message = Scenario::load(Path::new("no/such/file.toml")).unwrap_err().to_string();
        assert!(message.contains("no/such/file.toml"), "{message}");
    }

    proptest! {
        #[test]
        fn the_copy_reads_back_to_the_same_bits(
            points in prop::collection::vec(prop::array::uniform4(-1e6f64..1e6), 1..8),
            radius in prop::option::of(1e-12f64..1e6),
            seed in 0u64..=i64::MAX as u64,
        ) {
            let robots = points.iter().enumerate().map(|(i, p)| Robot {
                name: robot_name(i),
                start: Position::new(p[0], p[1]),
                set_point: Position::new(p[2] * 1e-9, -p[3]),
                radius,
                max_speed: radius.filter(|speed| *speed <= MAX_SPEED),
            });
            let scenario = Scenario {
                name: "ring:\"7\"".into(),
                robots: robots.collect(),
                obstacles: vec![],
                shapes: vec![],
                max_ticks: 7,
                seed,
                allow_close_start: true,
                params: toml::Table::new(),
            };
            let copy = Scenario::from_toml(&scenario.to_toml().unwrap(), "x", "x").unwrap();
            prop_assert_eq!(copy, scenario);
        }
    }
}

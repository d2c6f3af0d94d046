//! The YAML description of a map.

use super::MapError;
use crate::Position;
use std::path::{Path, PathBuf};
use yaml_rust2::{Yaml, YamlLoader};

/// How pixels say what is occupied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Darkness above one threshold is occupied, below the other free, between them unknown.
    #[default]
    Trinary,
    /// The same; what is between the thresholds has a share in being occupied, and counts as unknown here.
    Scale,
    /// The pixel's value is the occupancy in percent, above 100 unknown; `negate` does not matter.
    Raw,
}

/// What a map's description says.
#[derive(Clone, Debug, PartialEq)]
pub struct Meta {
    /// The image, relative to the description.
    pub image: PathBuf,
    /// Side of a cell, m.
    pub resolution: f64,
    /// The left lower corner of the image, m.
    pub origin: Position,
    /// By how much the image is turned about that corner, counter-clockwise, rad.
    pub yaw: f64,
    /// Whether light is occupied, not dark.
    pub negate: bool,
    /// Occupied above this, 0..1.
    pub occupied_thresh: f64,
    /// Free below this, 0..1.
    pub free_thresh: f64,
    /// How pixels say what is occupied.
    pub mode: Mode,
}

const RESOLUTION: &str = "a number of metres above 0";
const ORIGIN: &str = "[x, y, yaw], three finite numbers (m, m, rad)";
const NEGATE: &str = "0 (dark is occupied) or 1 (light is occupied)";
const OCCUPIED: &str = "a number in 0..=1, not below free_thresh";
const FREE: &str = "a number in 0..=1";

impl Meta {
    /// Reads a description. `file` is named in errors. Keys that do not matter here are passed over, as
    /// map_server does.
    ///
    /// # Errors
    /// Which key, which value and what is allowed.
    pub fn from_yaml(text: &str, file: &Path) -> Result<Self, MapError> {
        let documents = YamlLoader::load_from_str(text).map_err(|error| MapError::Yaml {
            file: file.into(),
            line: error.marker().line(),
            message: error.info().into(),
        })?;
        let reader = Reader { file, document: documents.into_iter().next().unwrap_or(Yaml::Null) };
        let image = reader.get("image", "the path of a PGM or PNG image")?;
        let image = image.as_str().filter(|path| !path.is_empty()).map(PathBuf::from);
        let image = image.ok_or_else(|| reader.value("image", "the path of a PGM or PNG image"))?;
        let resolution = reader.number("resolution", RESOLUTION, |x| x > 0.0 && x.is_finite())?;
        let origin = reader.get("origin", ORIGIN)?.as_vec().map(|list| list.iter().map(number).collect());
        let origin: Option<Vec<f64>> = origin.unwrap_or(None);
        let &[x, y, yaw] = origin.as_deref().unwrap_or_default() else { return Err(reader.value("origin", ORIGIN)) };
        if !(x.is_finite() && y.is_finite() && yaw.is_finite()) {
            return Err(reader.value("origin", ORIGIN));
        }
        let negate = match reader.get("negate", NEGATE)? {
            Yaml::Integer(0) | Yaml::Boolean(false) => false,
            Yaml::Integer(1) | Yaml::Boolean(true) => true,
            _ => return Err(reader.value("negate", NEGATE)),
        };
        let free_thresh = reader.number("free_thresh", FREE, |x| (0.0..=1.0).contains(&x))?;
        let in_order = |x| (free_thresh..=1.0).contains(&x);
        let occupied_thresh = reader.number("occupied_thresh", OCCUPIED, in_order)?;
        let mode = match &reader.document["mode"] {
            Yaml::BadValue => Mode::Trinary,
            mode => match mode.as_str() {
                Some("trinary") => Mode::Trinary,
                Some("scale") => Mode::Scale,
                Some("raw") => Mode::Raw,
                _ => return Err(reader.value("mode", "trinary, scale or raw (trinary if left out)")),
            },
        };
        let origin = Position::new(x, y);
        Ok(Self { image, resolution, origin, yaw, negate, occupied_thresh, free_thresh, mode })
    }

    /// The place of a point given in cells from the left lower corner.
    pub fn to_world(&self, cells: Position) -> Position {
        let (sin, cos) = self.yaw.sin_cos();
        let at = cells * self.resolution;
        self.origin + Position::new(cos * at.x - sin * at.y, sin * at.x + cos * at.y)
    }

    /// Whether a pixel of `grey` is occupied; none where that is unknown.
    pub fn occupied(&self, grey: u8) -> Option<bool> {
        let occupancy = match self.mode {
            Mode::Raw if grey > 100 => return None,
            Mode::Raw => f64::from(grey) / 100.0,
            _ if self.negate => f64::from(grey) / 255.0,
            _ => f64::from(255 - grey) / 255.0,
        };
        match occupancy {
            occupancy if occupancy > self.occupied_thresh => Some(true),
            occupancy if occupancy < self.free_thresh => Some(false),
            _ => None,
        }
    }
}

/// Looks up keys and makes errors of what is not allowed.
struct Reader<'a> {
    file: &'a Path,
    document: Yaml,
}

impl Reader<'_> {
    fn get(&self, key: &'static str, allowed: &'static str) -> Result<&Yaml, MapError> {
        match &self.document[key] {
            Yaml::BadValue => Err(MapError::Missing { file: self.file.into(), key, allowed }),
            found => Ok(found),
        }
    }

    fn number(&self, key: &'static str, allowed: &'static str, fits: impl Fn(f64) -> bool) -> Result<f64, MapError> {
        number(self.get(key, allowed)?).filter(|x| fits(*x)).ok_or_else(|| self.value(key, allowed))
    }

    fn value(&self, key: &'static str, allowed: &'static str) -> MapError {
        MapError::Value { file: self.file.into(), key, value: written(&self.document[key]), allowed }
    }
}

fn number(value: &Yaml) -> Option<f64> {
    value.as_f64().or(value.as_i64().map(|whole| whole as f64))
}

/// A value about as it is written.
fn written(value: &Yaml) -> String {
    match value {
        Yaml::Real(text) | Yaml::String(text) => text.clone(),
        Yaml::Integer(number) => number.to_string(),
        Yaml::Boolean(flag) => flag.to_string(),
        Yaml::Array(list) => format!("[{}]", list.iter().map(written).collect::<Vec<_>>().join(", ")),
        Yaml::Hash(_) => "{...}".into(),
        _ => "nothing".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "image: a.pgm\nresolution: 0.05\norigin: [-1, 2.5, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n\
                        free_thresh: 0.196\n";

    fn message(text: &str) -> String {
        Meta::from_yaml(text, Path::new("a.yaml")).unwrap_err().to_string()
    }

    #[test]
    fn a_description_as_map_saver_writes_it_is_read() {
        let meta = Meta::from_yaml(GOOD, Path::new("a.yaml")).unwrap();
        assert_eq!((meta.resolution, meta.origin, meta.yaw), (0.05, Position::new(-1.0, 2.5), 0.0));
        assert_eq!((meta.negate, meta.mode, meta.image), (false, Mode::Trinary, PathBuf::from("a.pgm")));
    }

    #[test]
    fn mistakes_name_the_file_the_key_the_value_and_what_is_allowed() {
        for (from, to, parts) in [
            ("resolution: 0.05", "resolution: 0", ["resolution = 0", "above 0"]),
            ("resolution: 0.05", "resolution: fine", ["resolution = fine", "above 0"]),
            ("resolution: 0.05\n", "", ["`resolution` is missing", "above 0"]),
            ("[-1, 2.5, 0.0]", "[-1, 2.5]", ["origin = [-1, 2.5]", "[x, y, yaw]"]),
            ("[-1, 2.5, 0.0]", "[-1, 2.5, .inf]", ["origin = [-1, 2.5, .inf]", "finite"]),
            ("negate: 0", "negate: 2", ["negate = 2", "0 (dark is occupied)"]),
            ("0.65", "0.1", ["occupied_thresh = 0.1", "not below free_thresh"]),
            ("free_thresh: 0.196", "free_thresh: -1", ["free_thresh = -1", "0..=1"]),
            ("image: a.pgm", "image: 7", ["image = 7", "PGM or PNG"]),
            ("negate: 0", "negate: 0\nmode: fuzzy", ["mode = fuzzy", "trinary, scale or raw"]),
            ("negate: 0", "negate: [0", ["line", "key: value"]),
        ] {
            let message = message(&GOOD.replace(from, to));
            assert!(message.starts_with("a.yaml: "), "{message}");
            for part in parts {
                assert!(message.contains(part), "`{part}` is not in: {message}");
            }
        }
        assert!(message("").contains("`image` is missing"));
    }

    #[test]
    fn pixels_are_occupied_free_or_unknown_as_map_server_says() {
        let meta = |change: &str| Meta::from_yaml(&GOOD.replace("negate: 0", change), Path::new("a.yaml")).unwrap();
        let states = |meta: &Meta, pixels: [u8; 3]| pixels.map(|grey| meta.occupied(grey));
        assert_eq!(states(&meta("negate: 0"), [0, 254, 150]), [Some(true), Some(false), None]);
        assert_eq!(meta("negate: 0").occupied(205), None, "map_saver's grey for unknown is just above 0.196");
        assert_eq!(states(&meta("negate: 1"), [0, 254, 105]), [Some(false), Some(true), None]);
        let raw = meta("negate: 1\nmode: raw");
        assert_eq!(states(&raw, [0, 100, 255]), [Some(false), Some(true), None]);
    }

    #[test]
    fn the_yaw_turns_the_map_about_its_corner() {
        let text = GOOD.replace("0.0]", &format!("{}]", std::f64::consts::FRAC_PI_2));
        let meta = Meta::from_yaml(&text, Path::new("a.yaml")).unwrap();
        assert!((meta.to_world(Position::new(20.0, 0.0)) - Position::new(-1.0, 3.5)).norm() < 1e-12);
    }
}

//! How obstacles, maps and places are written in TOML.
//!
//! ```toml
//! map = "warehouse.yaml"                  # relative to the scenario's file; or a table:
//! # map = { file = "warehouse.yaml", unknown = "free", simplify = 0.05 }
//!
//! [[obstacle]]                            # a disc
//! position = [12.0, 5.0]
//! radius = 1.0
//!
//! [[obstacle]]                            # a polygon, convex or not, either way round
//! name = "shelf"
//! polygon = [[2, 2], [6, 2], [6, 3], [3, 3], [3, 6], [2, 6]]
//!
//! [[obstacle]]                            # a wall with round ends and bends
//! wall = [[0, 0], [10, 0], [10, 4]]
//! thickness = 0.2
//! ```
//!
//! A fourth form, `region`, is what a map's obstacles become in a copy of a scenario: outlines, the rims of holes
//! among them, each with the solid on its left.

use crate::Position;
use crate::check::ShapeProblem;
use crate::map::{self, MapError, MapSettings, Unknown};
use crate::shape::{Obstacle, Obstacles, Shape};
use serde::de::{self, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};

/// `[x, y]` in metres. A list of its own type because the TOML reader drops what is too many for an array.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>", into = "[f64; 2]")]
pub struct Point(
    /// m.
    pub Position,
);

impl TryFrom<Vec<f64>> for Point {
    type Error = String;
    fn try_from(list: Vec<f64>) -> Result<Self, String> {
        let count = list.len();
        let pair: Result<[f64; 2], _> = list.try_into();
        pair.map(|pair| Self(pair.into())).map_err(|_| format!("expected [x, y] in metres, found {count} numbers"))
    }
}

impl From<Point> for [f64; 2] {
    fn from(point: Point) -> Self {
        point.0.into()
    }
}

/// One `[[obstacle]]`: exactly one of `position`, `polygon`, `wall` and `region`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObstacleEntry {
    /// For errors, pictures and records; `obstacle-0`, ... if left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Centre of a disc, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<Point>,
    /// Of a disc, m; half of the least separation if left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Corners of a polygon in order, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polygon: Option<Vec<Point>>,
    /// Points of a wall in order, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall: Option<Vec<Point>>,
    /// Of a wall, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// Outlines of a part of a map, each with the solid on its left, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<Vec<Vec<Point>>>,
}

/// The scenario's `map`: a path, or a table with `file`, `unknown` and `simplify`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MapEntry {
    /// The map's YAML file, relative to the scenario's.
    pub file: PathBuf,
    /// What unknown cells count as.
    pub unknown: Unknown,
    /// How far obstacles may grow where that saves corners, m; one cell if left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simplify: Option<f64>,
}

impl<'de> Deserialize<'de> for MapEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            file: PathBuf,
            #[serde(default)]
            unknown: Unknown,
            simplify: Option<f64>,
        }
        struct PathOrTable;
        impl<'de> Visitor<'de> for PathOrTable {
            type Value = MapEntry;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the path of a map or a table { file, unknown, simplify }")
            }
            fn visit_str<E: de::Error>(self, file: &str) -> Result<MapEntry, E> {
                Ok(MapEntry { file: file.into(), unknown: Unknown::default(), simplify: None })
            }
            fn visit_map<A: MapAccess<'de>>(self, access: A) -> Result<MapEntry, A::Error> {
                let Table { file, unknown, simplify } = Table::deserialize(MapAccessDeserializer::new(access))?;
                if simplify.is_some_and(|bound| !(bound >= 0.0 && bound.is_finite())) {
                    return Err(de::Error::custom("simplify must be a finite number of metres, at least 0"));
                }
                Ok(MapEntry { file, unknown, simplify })
            }
        }
        deserializer.deserialize_any(PathOrTable)
    }
}

/// Why an obstacle or a map of a scenario cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LayoutError {
    /// None of the keys that say what it is.
    #[error("{0}: it has no shape; allowed: position (and radius), polygon, wall and thickness, or region")]
    NoShape(String),
    /// More than one of them.
    #[error("{obstacle}: it has both {first} and {second}; write two [[obstacle]] entries")]
    TwoShapes {
        /// Its name.
        obstacle: String,
        /// A key.
        first: &'static str,
        /// Another.
        second: &'static str,
    },
    /// A size that does not belong to the shape.
    #[error("{obstacle}: {key} does not belong to a {shape}; {key} goes with {with}")]
    Stray {
        /// Its name.
        obstacle: String,
        /// The key.
        key: &'static str,
        /// What it is.
        shape: &'static str,
        /// What the key goes with.
        with: &'static str,
    },
    /// A wall without a size.
    #[error("{0}: a wall needs a thickness; add for example thickness = 0.2 (m)")]
    NoThickness(String),
    /// A shape that is wrong in itself.
    #[error("{obstacle}: {problem}")]
    Shape {
        /// Its name.
        obstacle: String,
        /// What is wrong and where.
        problem: ShapeProblem,
    },
    /// A map that cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
}

impl From<&Obstacle> for ObstacleEntry {
    /// The entry from which the same obstacle is read again, to the last bit.
    fn from(obstacle: &Obstacle) -> Self {
        let points = |places: &Vec<Position>| places.iter().copied().map(Point).collect();
        let named = Self { name: Some(obstacle.name().into()), ..Self::default() };
        match obstacle.shape() {
            Shape::Disc { centre, radius } => Self { position: Some(Point(*centre)), radius: Some(*radius), ..named },
            Shape::Polygon(corners) => Self { polygon: Some(points(corners)), ..named },
            Shape::Wall { points: chain, thickness } => {
                Self { wall: Some(points(chain)), thickness: Some(*thickness), ..named }
            }
            Shape::Region(rings) => Self { region: Some(rings.iter().map(points).collect()), ..named },
        }
    }
}

impl ObstacleEntry {
    /// The obstacle that is written here: the `number`-th of its file. `default_radius` (m) is that of a disc
    /// without one.
    ///
    /// # Errors
    /// Which obstacle, what is wrong with it and what is allowed.
    pub fn obstacle(&self, number: usize, default_radius: f64) -> Result<Obstacle, LayoutError> {
        let name = self.name.clone().unwrap_or_else(|| format!("obstacle-{number}"));
        let shape = self.shape(&name, default_radius)?;
        Obstacle::new(name.clone(), shape).map_err(|problem| LayoutError::Shape { obstacle: name, problem })
    }

    fn shape(&self, name: &str, default_radius: f64) -> Result<Shape, LayoutError> {
        let keys = [
            ("position", self.position.is_some()),
            ("polygon", self.polygon.is_some()),
            ("wall", self.wall.is_some()),
            ("region", self.region.is_some()),
        ];
        let mut given = keys.into_iter().filter(|(_, given)| *given).map(|(key, _)| key);
        if let (Some(first), Some(second)) = (given.next(), given.next()) {
            return Err(LayoutError::TwoShapes { obstacle: name.into(), first, second });
        }
        let shape = if self.position.is_some() {
            "disc"
        } else if self.wall.is_some() {
            "wall"
        } else if self.region.is_some() {
            "region"
        } else {
            "polygon"
        };
        for (key, given, owner, with) in [
            ("radius", self.radius.is_some(), "disc", "position"),
            ("thickness", self.thickness.is_some(), "wall", "wall"),
        ] {
            if given && shape != owner {
                return Err(LayoutError::Stray { obstacle: name.into(), key, shape, with });
            }
        }
        let places = |points: &Vec<Point>| points.iter().map(|point| point.0).collect();
        match (self.position, &self.polygon, &self.wall, &self.region) {
            (Some(centre), ..) => Ok(Shape::Disc { centre: centre.0, radius: self.radius.unwrap_or(default_radius) }),
            (_, Some(corners), ..) => Ok(Shape::Polygon(places(corners))),
            (.., Some(rings)) => Ok(Shape::Region(rings.iter().map(places).collect())),
            (_, _, Some(points), _) => {
                let thickness = self.thickness.ok_or_else(|| LayoutError::NoThickness(name.into()))?;
                Ok(Shape::Wall { points: places(points), thickness })
            }
            _ => Err(LayoutError::NoShape(name.into())),
        }
    }
}

/// Everything that stands in a scenario: its obstacles, then its map's. `folder` is that of its file.
///
/// # Errors
/// Which obstacle or which file, what is wrong and what is allowed.
pub fn obstacles(
    entries: &[ObstacleEntry],
    map: Option<&MapEntry>,
    folder: &Path,
    default_radius: f64,
) -> Result<Obstacles, LayoutError> {
    let mut list = Vec::with_capacity(entries.len());
    for (number, entry) in entries.iter().enumerate() {
        list.push(entry.obstacle(number, default_radius)?);
    }
    if let Some(MapEntry { file, unknown, simplify }) = map {
        list.extend(map::load(&folder.join(file), MapSettings { unknown: *unknown, simplify: *simplify })?);
    }
    Ok(Obstacles::new(list))
}

/// Places of a map at which robots may start and end, `NAME.places.toml` beside it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Places {
    /// Each far enough from the others and from walls for a robot of 1.5 m.
    pub place: Vec<Place>,
}

/// One of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// For people.
    pub name: String,
    /// m.
    pub position: Point,
}

#[cfg(test)]
mod tests;

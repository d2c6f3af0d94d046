//! Occupancy maps as ROS map_server reads them: a YAML file beside a PGM or PNG image.
//!
//! Each pixel is a cell of `resolution` metres; the left lower corner of the image lies at `origin`, the image
//! turned about it by the origin's yaw. Connected occupied cells (over their sides) become one obstacle each: a
//! region whose outlines run exactly on cell borders, and are then [simplified](MapSettings::simplify).
//!
//! Cells that are neither occupied nor free are unknown, and so is everything beyond the image. They count as
//! occupied unless [`MapSettings::unknown`] says otherwise: nobody knows what stands there.

mod error;
mod image;
mod meta;
mod outline;
mod simplify;

pub use error::MapError;
pub use image::Grey;
pub use meta::{Meta, Mode};

use crate::Position;
use crate::check::ShapeProblem;
use crate::shape::{Obstacle, Shape};
use std::path::Path;

/// What a cell that is neither occupied nor free counts as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unknown {
    /// An obstacle, and the map ends at a wall.
    #[default]
    Occupied,
    /// Open, and so is what lies beyond the image.
    Free,
}

/// How a map is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapSettings {
    /// What unknown cells count as.
    pub unknown: Unknown,
    /// How far an obstacle may grow beyond its occupied cells where that saves corners, m; one cell if none.
    /// Notches and stairs are bridged; nothing is ever taken away from an occupied cell.
    pub simplify: Option<f64>,
}

/// The cells of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    width: usize,
    height: usize,
    /// By row from the lowest, each from the left.
    occupied: Vec<bool>,
}

impl Grid {
    /// Cells in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Whether the cell in `column` (from the left) and `row` (from below) is occupied; not beyond the grid.
    pub fn is_occupied(&self, column: i64, row: i64) -> bool {
        (0..self.width as i64).contains(&column)
            && (0..self.height as i64).contains(&row)
            && self.occupied[row as usize * self.width + column as usize]
    }

    /// What counts as occupied of an image. Where unknown cells do, the grid is a cell wider on every side.
    fn new(image: &Grey, meta: &Meta, unknown: Unknown) -> Self {
        let rim = usize::from(unknown == Unknown::Occupied);
        let (width, height) = (image.width + 2 * rim, image.height + 2 * rim);
        let mut occupied = vec![unknown == Unknown::Occupied; width * height];
        for row in 0..image.height {
            for column in 0..image.width {
                // Images begin at the top.
                let pixel = image.pixels[(image.height - 1 - row) * image.width + column];
                let state = pixel.and_then(|grey| meta.occupied(grey));
                occupied[(row + rim) * width + column + rim] = state.unwrap_or(unknown == Unknown::Occupied);
            }
        }
        Self { width, height, occupied }
    }
}

/// Reads a map: its description from `file` and the image that it names, relative to that file.
///
/// # Errors
/// Which file, which key, which value and what is allowed.
pub fn load(file: &Path, settings: MapSettings) -> Result<Vec<Obstacle>, MapError> {
    let unreadable = |source| MapError::Unreadable { file: file.into(), source };
    let meta = Meta::from_yaml(&std::fs::read_to_string(file).map_err(unreadable)?, file)?;
    let image_file = file.parent().unwrap_or(Path::new("")).join(&meta.image);
    let image = Grey::load(&image_file)?;
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    obstacles(&name, &image, &meta, settings).map_err(|source| MapError::Shape { file: image_file, source })
}

/// The obstacles of a map, called `name-1`, `name-2`, ... in the order of their lowest cells.
///
/// # Errors
/// A region that cannot be cut into convex pieces.
pub fn obstacles(name: &str, image: &Grey, meta: &Meta, settings: MapSettings) -> Result<Vec<Obstacle>, ShapeProblem> {
    let grid = Grid::new(image, meta, settings.unknown);
    let bound = settings.simplify.map_or(1.0, |bound| bound / meta.resolution);
    let rim = f64::from(u8::from(settings.unknown == Unknown::Occupied));
    let to_world = |cell: &Position| meta.to_world(cell.add_scalar(-rim));
    let mut found = Vec::new();
    for (number, rings) in outline::regions(&grid).into_iter().enumerate() {
        let place = |(x, y)| to_world(&Position::new(x as f64, y as f64));
        let rings = simplify::grown(&rings, bound).into_iter().map(|ring| ring.into_iter().map(place).collect());
        found.push(Obstacle::new(format!("{name}-{}", number + 1), Shape::Region(rings.collect()))?);
    }
    Ok(found)
}

#[cfg(test)]
mod tests;

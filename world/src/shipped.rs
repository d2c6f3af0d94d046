//! The map that comes with the program, as bytes, so that a binary works from any folder.

use crate::file::{Place, Places};
use crate::map::{self, Grey, MapError, MapSettings, Meta};
use crate::shape::Obstacle;
use std::path::Path;

/// Why what is shipped cannot be used: somebody changed it.
#[derive(Debug, thiserror::Error)]
pub enum ShippedError {
    /// The map.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The list of places.
    #[error("world/maps/warehouse.places.toml: {0}; run the example make_warehouse")]
    Places(#[from] toml::de::Error),
}

/// The warehouse with aisles and stations: what stands in it and the places at which robots may start and end.
///
/// # Errors
/// Files that the example `make_warehouse` did not write.
pub fn warehouse() -> Result<(Vec<Obstacle>, Vec<Place>), ShippedError> {
    let file = Path::new("world/maps/warehouse.yaml");
    let meta = Meta::from_yaml(include_str!("../maps/warehouse.yaml"), file)?;
    let image = file.with_file_name(&meta.image);
    let grey = Grey::from_bytes(include_bytes!("../maps/warehouse.pgm"))
        .map_err(|message| MapError::Image { file: image.clone(), message })?;
    let obstacles = map::obstacles("warehouse", &grey, &meta, MapSettings::default())
        .map_err(|source| MapError::Shape { file: image, source })?;
    let places: Places = toml::from_str(include_str!("../maps/warehouse.places.toml"))?;
    Ok((obstacles, places.place))
}

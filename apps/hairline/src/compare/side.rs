//! One of the pictures that are compared.

use std::path::{Path, PathBuf};

use hairline_image::Layers;

use hairline_render::failure::Failure;

/// One of the two pictures.
pub struct Side {
    pub path: PathBuf,
    pub layers: Layers,
}

impl Side {
    pub fn read(path: &Path, only: &[hairline_image::Layer]) -> Result<Self, Failure> {
        // A picture to look at is part of the command line, as a scene is.
        let mut layers = Layers::read(path).map_err(|error| Failure::Input(error.into()))?;
        if !only.is_empty() {
            layers.held.retain(|held| only.contains(&held.layer));
        }
        Ok(Self {
            path: path.to_owned(),
            layers,
        })
    }
}

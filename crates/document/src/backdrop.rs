//! The picture behind the objects: read when a picture is written, no part of the scene that renderers read.

use hairline_image::tone_map::linear_from_srgb;
use hairline_image::{Backdrop, FilePath, Picture};
use hairline_memory::budget_bytes;
use hairline_model::texture;

use crate::description::Description;
use crate::error::Error;
use crate::gltf_scene::packed_files::with_packed;

impl Description {
    /// Reads the picture behind the objects, if there is one. A relative path starts from `base_dir`.
    ///
    /// # Errors
    /// What was found in the place of a picture, by its key.
    pub fn backdrop(&self, base_dir: impl Into<FilePath>) -> Result<Option<Backdrop>, Error> {
        let Some(file) = &self.render.behind else {
            return Ok(None);
        };
        let read = texture::read(&with_packed(base_dir).join(file), budget_bytes() as f64);
        let read = read.map_err(|found| {
            let right = "must be a .png, .jpg or .webp, relative to the scene file";
            Error::new("render.behind", found, right)
        })?;
        // What is transparent in it is black.
        let share = |code: u8| f32::from(code) / 255.0;
        let color = |[r, g, b, a]: &[u8; 4]| {
            [*r, *g, *b].map(|code| linear_from_srgb(share(code)) * share(*a))
        };
        Ok(Some(Backdrop::new(Picture {
            size_px: read.size_px,
            rgb: read.texels.iter().map(color).collect(),
        })))
    }
}

//! Pictures on lights: textures whose brightest channel is 1, and how bright that is.

use std::path::Path;

use hairline_image::Picture;

use crate::environment;
use crate::reading::{self, Kind};
use crate::scene::Texture;
use crate::text::shown;
use crate::texture::{self, Channels};

/// A picture and the factor on its values. Those of .hdr and .exr are in eight bits, relative to the brightest.
#[derive(Clone, Debug)]
pub(crate) struct LightPicture {
    pub texture: Texture,
    pub brightest: f64,
}

/// Of the memory that is free, what a file may have.
const SHARE: f64 = 0.25;

impl LightPicture {
    /// Reads a .hdr, .exr, .png, .jpg or .webp, which may take `free_bytes`.
    ///
    /// # Errors
    /// What was found in the place of a picture.
    pub(crate) fn read(path: &Path, free_bytes: f64) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default();
        if ["hdr", "exr"]
            .iter()
            .any(|own| ending.eq_ignore_ascii_case(own))
        {
            let picture = environment::read_picture(path);
            return picture.map_or_else(|error| Err(error.to_string()), Self::of_linear);
        }
        let bytes = reading::read(path, Kind::File, SHARE)
            .map_err(|why| format!("{}: {why}", shown(&path.to_string_lossy())))?;
        let texture = texture::decode(&bytes, Channels::Color, true, free_bytes)
            .map_err(|why| format!("{}: {why}", shown(&path.to_string_lossy())))?;
        Ok(Self {
            texture,
            brightest: 1.0,
        })
    }

    /// Of linear radiances.
    fn of_linear(picture: Picture) -> Result<Self, String> {
        // What is no radiance counts as none.
        let channels = || picture.rgb.iter().flatten().copied();
        let brightest = channels().filter(|c| c.is_finite()).fold(0.0, f32::max);
        if !(brightest > 0.0) {
            return Err("found a picture without light".to_owned());
        }
        let code = |c: f32| {
            let share = if c.is_nan() { 0.0 } else { c / brightest };
            texture::srgb_code(share)
        };
        let texel = |[r, g, b]: &[f32; 3]| [code(*r), code(*g), code(*b), u8::MAX];
        let texels = picture.rgb.iter().map(texel).collect();
        Ok(Self {
            texture: texture::with_mips(picture.size_px, texels, Channels::Color),
            brightest: brightest.into(),
        })
    }
}

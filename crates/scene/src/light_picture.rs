//! Pictures on lights: textures whose brightest channel is 1, and how bright that is.

use std::io;
use std::path::Path;

use hairline_image::Picture;

use crate::environment;
use crate::scene::Texture;
use crate::texture;

/// A picture and the factor on its values. Those of .hdr and .exr are in eight bits, relative to the brightest.
#[derive(Clone, Debug)]
pub(crate) struct LightPicture {
    pub texture: Texture,
    pub brightest: f64,
}

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
            let fits =
                |size_px| texture::check_memory(size_px, free_bytes).map_err(io::Error::other);
            let picture = environment::read_picture(path, &fits);
            return picture.map_or_else(|error| Err(error.to_string()), Self::of_linear);
        }
        let image = texture::read(path, free_bytes)?;
        Ok(Self {
            texture: Texture::of_colors(image.size_px, image.texels),
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
            texture: Texture::of_colors(picture.size_px, texels),
            brightest: brightest.into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::codecs::hdr::HdrEncoder;
    use image::{Rgb, RgbaImage};
    use std::fs;

    /// What is no picture, or too large for the memory, is refused in words.
    #[test]
    fn unusable_files() {
        let dir = tempfile::tempdir().unwrap();
        let file = |name: &str| dir.path().join(name);
        fs::write(file("text.png"), "not a picture").unwrap();
        RgbaImage::new(64, 64).save(file("box.png")).unwrap();
        for (name, value) in [("box.hdr", 2.0), ("dark.hdr", 0.0)] {
            let texels = vec![Rgb([value; 3]); 64 * 64];
            let encoder = HdrEncoder::new(fs::File::create(file(name)).unwrap());
            encoder.encode(&texels, 64, 64).unwrap();
        }
        for (name, free_bytes, found) in [
            ("text.png", 1e9, "The image format could not be determined"),
            ("box.png", 1e4, "64x64 pixels would take about 160.0 KiB"),
            ("box.hdr", 1e4, "64x64 pixels would take about 160.0 KiB"),
            ("dark.hdr", 1e9, "a picture without light"),
        ] {
            let refused = LightPicture::read(&file(name), free_bytes).unwrap_err();
            assert!(refused.contains(found), "{name}: {refused}");
        }
        let picture = LightPicture::read(&file("box.hdr"), 1e9).unwrap();
        assert_eq!(picture.brightest, 2.0);
        assert_eq!(picture.texture.levels[0][0], [255; 4]);
    }
}

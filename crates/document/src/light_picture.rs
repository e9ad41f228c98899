//! Pictures on lights: textures whose brightest channel is 1, and how bright that is.

use std::io;

use hairline_image::tone_map::linear_from_srgb;
use hairline_image::{FilePath, Picture};
use hairline_model::texture;

use hairline_scene::Texture;

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
    pub(crate) fn read(path: &FilePath, free_bytes: f64) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default();
        if ["hdr", "exr"]
            .iter()
            .any(|own| ending.eq_ignore_ascii_case(own))
        {
            let fits =
                |size_px| texture::check_memory(size_px, free_bytes).map_err(io::Error::other);
            let picture = hairline_sky::read_picture(path, &fits);
            return picture.map_or_else(|error| Err(error.to_string()), Self::of_linear);
        }
        let image = texture::read(path, free_bytes)?;
        // Transparent texels send less light, in proportion to alpha.
        let texels = image.texels.into_iter().map(over_black).collect();
        Ok(Self {
            texture: Texture::of_colors(image.size_px, texels),
            brightest: 1.0,
        })
    }

    /// Makes the picture of linear radiances.
    fn of_linear(picture: Picture) -> Result<Self, String> {
        // Values that are no radiance count as zero.
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

fn over_black([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    if a == u8::MAX {
        return [r, g, b, a];
    }
    let seen = |code: u8| {
        let light = linear_from_srgb(f32::from(code) / 255.0);
        texture::srgb_code(light * f32::from(a) / 255.0)
    };
    [seen(r), seen(g), seen(b), u8::MAX]
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::codecs::hdr::HdrEncoder;
    use image::{Rgb, RgbaImage};
    use std::fs;

    /// Half of a light's picture is cut out, a quarter of it half transparent; a photograph says which way up it is.
    #[test]
    fn alpha_and_the_turn_of_a_photograph_count() {
        let dir = tempfile::tempdir().unwrap();
        let path = FilePath::from(dir.path()).join("cut.png");
        let mut picture = RgbaImage::from_pixel(2, 2, image::Rgba([255; 4]));
        picture.put_pixel(0, 0, image::Rgba([255, 255, 255, 0]));
        picture.put_pixel(1, 0, image::Rgba([255, 255, 255, 0]));
        picture.put_pixel(0, 1, image::Rgba([255, 255, 255, 128]));
        picture.save(&path).unwrap();
        let read = LightPicture::read(&path, 1e9).unwrap();
        // 128 of 255 of the light is code 188.
        let expected = [
            [0, 0, 0, 255],
            [0, 0, 0, 255],
            [188, 188, 188, 255],
            [255; 4],
        ];
        assert_eq!(read.texture.levels[0], expected);

        // EXIF: TIFF's header, one entry: orientation, a short, 6. The right side of what is stored is the bottom.
        let exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
        let stored = image::RgbImage::from_fn(16, 8, |x, _| Rgb([if x < 8 { 255 } else { 0 }; 3]));
        let mut jpeg = std::io::Cursor::new(Vec::new());
        stored
            .write_to(&mut jpeg, image::ImageFormat::Jpeg)
            .unwrap();
        let jpeg = jpeg.into_inner();
        let length = (exif.len() as u16 + 2).to_be_bytes();
        let turned = [&[0xff, 0xd8, 0xff, 0xe1][..], &length, exif, &jpeg[2..]].concat();
        let path = path.folder().join("turned.jpg");
        fs::write(&path, turned).unwrap();
        let read = LightPicture::read(&path, 1e9).unwrap();
        assert_eq!(read.texture.size_px, [8, 16]);
        let texels = &read.texture.levels[0];
        assert!(texels[0][0] > 250 && texels[8 * 16 - 1][0] < 5);
    }

    /// Files that are no picture, or too large for the memory, are refused in words.
    #[test]
    fn unusable_files() {
        let dir = tempfile::tempdir().unwrap();
        let file = |name: &str| FilePath::from(dir.path()).join(name);
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

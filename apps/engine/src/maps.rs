//! The maps of an environment, as shaders look them up.

use hairline_image::Picture;
use hairline_scene::Environment;
use hairline_scene::environment::level_place;
use half::f16;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

/// An environment: maps, and the lamps that were parted from them.
#[wasm_bindgen]
pub struct Maps(Environment);

#[wasm_bindgen]
impl Maps {
    /// Reads an equirectangular map, linear Rec.709, three numbers a pixel, rows from the top, and parts suns from it.
    ///
    /// # Errors
    /// A map that is not twice as wide as high.
    #[wasm_bindgen(constructor)]
    pub fn new(rgb: &[f32], width: u32) -> Result<Self, JsError> {
        let (texels, _) = rgb.as_chunks::<3>();
        let height = texels.len() as u32 / width.max(1);
        if texels.is_empty() || width != 2 * height {
            let found = format!("environment: found a map of {width} x {height}");
            return Err(JsError::new(&format!(
                "{found}; must be twice as wide as high"
            )));
        }
        let map = Picture {
            size_px: [width, height],
            rgb: texels.to_vec(),
        };
        Ok(Self(hairline_sky::with_suns_parted(map, 0.0, 1.0, true)))
    }

    /// Width of the first mip of [`Maps::levels`], which is as high; each further one is half as wide.
    pub fn width(&self) -> u32 {
        self.0.prefiltered_levels()[0].size_px[0]
    }

    /// Mips of a texture in `rgba16float`, one after the other: the levels of the map, with the irradiance under the first. Twin:
    /// `environment_level_place` and `environment_mean_by_cosine` in environment.wgsl.
    pub fn levels(&self) -> Vec<u16> {
        mips(self.0.prefiltered_levels(), self.0.irradiance_map())
    }

    /// The radiance of a texel of value 1.
    #[wasm_bindgen(js_name = texelRadiance)]
    pub fn texel_radiance(&self) -> f64 {
        self.0.texel_radiance()
    }

    /// Number of suns, which shine on all.
    #[wasm_bindgen(js_name = sunCount)]
    pub fn sun_count(&self) -> usize {
        self.0.suns().len()
    }

    /// A sun: three numbers of its radiance, then the middle and the radius of a sphere in the map's frame, in metres.
    pub fn sun(&self, i: usize) -> Vec<f64> {
        let sun = &self.0.suns()[i];
        let (center_m, radius_m) = sun.bounding_sphere();
        let mut numbers = sun.radiance.to_vec();
        numbers.extend(center_m.to_array());
        numbers.push(radius_m);
        numbers
    }
}

fn mips(levels: &[Picture], irradiance: &Picture) -> Vec<u16> {
    let [width, height] = levels[0].size_px.map(|n| n as usize);
    let mut texels: Vec<u16> = Vec::new();
    let mut begins = Vec::new();
    for mip in 0..=level_place(levels.len() - 1).0 {
        begins.push(texels.len());
        texels.resize(texels.len() + 4 * (width >> mip) * 2 * (height >> mip), 0);
    }
    let mut put = |map: &Picture, mip: usize, first_row: usize| {
        for (row, from) in map.rgb.chunks(map.size_px[0] as usize).enumerate() {
            let begin = begins[mip] + 4 * (width >> mip) * (first_row + row);
            for (texel, rgb) in texels[begin..].chunks_mut(4).zip(from) {
                let [r, g, b] = rgb.map(|c| f16::from_f32(c).to_bits());
                texel.copy_from_slice(&[r, g, b, f16::ONE.to_bits()]);
            }
        }
    };
    for (i, map) in levels.iter().enumerate() {
        let (mip, is_below) = level_place(i);
        put(map, mip, if is_below { height >> mip } else { 0 });
    }
    put(irradiance, 0, height);
    texels
}

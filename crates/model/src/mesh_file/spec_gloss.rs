//! KHR_materials_pbrSpecularGlossiness: a body's colour and a reflectance at normal incidence, turned into base colour and metallic.
//!
//! Both models have a body and a mirror over it. What the older one says of them in two colours, the newer one says in one colour and a
//! share of metal: with the brightness of the body d and of the mirror s, b the base colour's and m the metallic, m solves
//! b (1 - m) = d (1 - s) and 0.04 (1 - m) + b m = s.

use gltf::json::Value;
use hairline_image::tone_map::{linear_from_srgb, srgb_from_linear};

use crate::texture::Texels;

pub(super) const NAME: &str = "KHR_materials_pbrSpecularGlossiness";
pub(super) const TEXTURES: [&str; 2] = ["diffuseTexture", "specularGlossinessTexture"];
/// Reflectance of a dielectric at normal incidence in glTF.
const F0: f32 = 0.04;

/// The extension's factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpecGloss {
    pub diffuse: [f32; 4],
    pub specular: [f32; 3],
    pub glossiness: f32,
}

/// Factors of the material in the newer model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Metal {
    /// Linear.
    pub base_color: [f32; 3],
    pub metallic: f32,
    pub roughness: f32,
}

impl SpecGloss {
    pub(super) fn read(extension: &Value) -> Self {
        let number = |value: Option<&Value>| {
            let number = value.and_then(Value::as_f64).unwrap_or(1.0);
            (number as f32).clamp(0.0, 1.0)
        };
        let channel = |name: &str, i: usize| number(extension.get(name).and_then(|it| it.get(i)));
        Self {
            diffuse: [0, 1, 2, 3].map(|i| channel("diffuseFactor", i)),
            specular: [0, 1, 2].map(|i| channel("specularFactor", i)),
            glossiness: number(extension.get("glossinessFactor")),
        }
    }

    pub(super) fn metal(&self) -> Metal {
        let [r, g, b, _] = self.diffuse;
        let diffuse = [r, g, b];
        let brightest = |color: [f32; 3]| color.into_iter().fold(0.0, f32::max);
        let mirror = brightest(self.specular);
        let body = brightest(diffuse) * (1.0 - mirror);
        let metallic = metallic(body, mirror);
        // The colour that either equation gives, weighed by what of it is seen.
        let of_body = diffuse.map(|c| c * (1.0 - mirror) / (1.0 - metallic).max(1e-4));
        let of_mirror = self
            .specular
            .map(|c| (c - F0 * (1.0 - metallic)) / metallic.max(1e-4));
        let share = metallic * metallic;
        let base = |i: usize| (1.0 - share) * of_body[i] + share * of_mirror[i];
        Metal {
            base_color: [0, 1, 2].map(|i| base(i).clamp(0.0, 1.0)),
            metallic,
            roughness: 1.0 - self.glossiness,
        }
    }

    /// The images of base colour and of metallic-roughness, of the size of the larger one, from those that there are.
    pub(super) fn images(
        &self,
        diffuse: Option<&Texels>,
        specular: Option<&Texels>,
    ) -> [Texels; 2] {
        let images = [diffuse, specular].into_iter().flatten();
        let largest = images.max_by_key(|it| it.texels.len());
        let size_px = largest.map_or([1, 1], |it| it.size_px);
        let [width, height] = size_px;
        let linear: Vec<f32> = (0..=255_u8)
            .map(|code| linear_from_srgb(f32::from(code) / 255.0))
            .collect();
        let of = |image: Option<&Texels>, x: u32, y: u32| {
            let [r, g, b, a] = image.map_or([255; 4], |it| nearest(it, size_px, [x, y]));
            let [r, g, b] = [r, g, b].map(|code| linear[usize::from(code)]);
            [r, g, b, f32::from(a) / 255.0]
        };
        let code = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
        let mut colors = Vec::with_capacity((width * height) as usize);
        let mut metals = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                let (diffuse, specular) = (of(diffuse, x, y), of(specular, x, y));
                let there = Self {
                    diffuse: [0, 1, 2, 3].map(|i| self.diffuse[i] * diffuse[i]),
                    specular: [0, 1, 2].map(|i| self.specular[i] * specular[i]),
                    glossiness: self.glossiness * specular[3],
                };
                let metal = there.metal();
                let [r, g, b] = metal.base_color.map(|c| code(srgb_from_linear(c)));
                colors.push([r, g, b, code(there.diffuse[3])]);
                metals.push([255, code(metal.roughness), code(metal.metallic), 255]);
            }
        }
        [colors, metals].map(|texels| Texels { size_px, texels })
    }
}

/// The root of F0 m^2 + (d + s - 2 F0) m + F0 - s = 0, with d the light of the body.
fn metallic(body: f32, mirror: f32) -> f32 {
    if mirror <= F0 {
        return 0.0;
    }
    let b = body + mirror - 2.0 * F0;
    let discriminant = (b * b - 4.0 * F0 * (F0 - mirror)).max(0.0);
    ((discriminant.sqrt() - b) / (2.0 * F0)).clamp(0.0, 1.0)
}

/// The texel of an image of another size.
fn nearest(image: &Texels, of: [u32; 2], at: [u32; 2]) -> [u8; 4] {
    let [x, y] = [0, 1].map(|i| u64::from(at[i]) * u64::from(image.size_px[i]) / u64::from(of[i]));
    image.texels[(y * u64::from(image.size_px[0]) + x) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reflectances of the body and of the mirror stay the same in both models.
    #[test]
    fn body_and_mirror_stay() {
        for (diffuse, specular) in [
            ([0.5, 0.3, 0.1], [0.04; 3]),
            ([0.0; 3], [0.9, 0.7, 0.3]),
            ([0.8; 3], [0.04; 3]),
            ([0.2; 3], [0.4; 3]),
        ] {
            let [r, g, b] = diffuse;
            let old = SpecGloss {
                diffuse: [r, g, b, 1.0],
                specular,
                glossiness: 0.75,
            };
            let Metal {
                base_color,
                metallic,
                roughness,
            } = old.metal();
            assert_eq!(roughness, 0.25);
            let largest = specular.into_iter().fold(0.0, f32::max);
            for i in 0..3 {
                let body = base_color[i] * (1.0 - metallic);
                let mirror = F0 * (1.0 - metallic) + base_color[i] * metallic;
                // Eight bits are not more exact.
                assert!(
                    (body - diffuse[i] * (1.0 - largest)).abs() < 4e-3,
                    "{old:?}"
                );
                assert!((mirror - specular[i]).abs() < 4e-3, "{old:?}: {mirror}");
            }
        }
    }

    /// Worked out from the equations above by hand.
    #[test]
    fn colours_are_those_of_the_conversion() {
        let clear = |glossiness| SpecGloss {
            diffuse: [0.0, 0.0, 0.0, 1.0],
            specular: [0.0; 3],
            glossiness,
        };
        for (diffuse, specular, base_color, metallic) in [
            // A coloured body under plastic, under less than plastic, and a coloured mirror.
            ([0.5, 0.3, 0.1], [0.04; 3], [0.48, 0.288, 0.096], 0.0),
            ([0.8, 0.4, 0.2], [0.02; 3], [0.784, 0.392, 0.196], 0.0),
            ([0.0; 3], [0.9, 0.6, 0.3], [0.9, 0.6, 0.3], 1.0),
            ([1.0; 3], [1.0; 3], [1.0; 3], 1.0),
            // Half-way: 0.04 m^2 + 0.72 m - 0.46 = 0, of brightness 0.3 and 0.5.
            (
                [0.6, 0.2, 0.1],
                [0.5; 3],
                [0.784_708, 0.461_169, 0.380_285],
                0.617_692,
            ),
            (
                [0.6, 0.2, 0.1],
                [0.2, 0.3, 0.5],
                [0.599_400, 0.337_631, 0.380_285],
                0.617_692,
            ),
        ] {
            let [r, g, b] = diffuse;
            let old = SpecGloss {
                diffuse: [r, g, b, 1.0],
                specular,
                glossiness: 0.25,
            };
            let metal = old.metal();
            let off = |a: f32, b: f32| (a - b).abs();
            assert!(off(metal.metallic, metallic) < 1e-5, "{old:?}: {metal:?}");
            for (found, right) in metal.base_color.into_iter().zip(base_color) {
                assert!(off(found, right) < 1e-5, "{old:?}: {metal:?}");
            }
            assert_eq!(metal.roughness, 0.75);
        }
        assert_eq!(clear(1.0).metal().roughness, 0.0);
        assert_eq!(clear(0.0).metal().roughness, 1.0);
    }

    #[test]
    fn images_of_two_sizes_become_two_of_one() {
        let diffuse = Texels {
            size_px: [2, 1],
            texels: vec![[255, 0, 0, 128], [0, 0, 0, 255]],
        };
        let specular = Texels {
            size_px: [1, 1],
            // sRGB 56 is 0.04.
            texels: vec![[56, 56, 56, 51]],
        };
        let old = SpecGloss {
            diffuse: [1.0; 4],
            specular: [1.0; 3],
            glossiness: 1.0,
        };
        let [colors, metals] = old.images(Some(&diffuse), Some(&specular));
        assert_eq!((colors.size_px, metals.size_px), ([2, 1], [2, 1]));
        // 0.96 of the red, encoded.
        let [r, g, b, a] = colors.texels[0];
        assert!((249..=251).contains(&r) && (g, b, a) == (0, 0, 128), "{r}");
        assert_eq!(metals.texels, [[255, 204, 0, 255]; 2]);
    }
}

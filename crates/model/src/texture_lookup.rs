//! Look-ups in textures, as all renderers do them. Twin: gpu/shaders/scene/scene.wgsl.

use glam::{DVec2, DVec3, DVec4, Vec2};
use hairline_image::tone_map::linear_from_srgb;

use crate::material::{Cutout, Material};
use crate::mesh::Mesh;
use crate::texture::Texture;

/// The standard deviation of a texel's width.
const TEXEL_STD: f64 = 0.288_675_134_594_812_9;
/// Least width of a filter: a narrower one counts as a point.
const LEAST_WIDTH: f64 = 1e-3;

impl Texture {
    /// The texels of a level about a place, row by row, in linear values, and how far the place is from the first to the others.
    /// `filter_texels` is the standard deviation of the filter that it is seen by, in texels of the first level: it softens the edges
    /// of sharp ones.
    pub fn four_texels(
        &self,
        level: usize,
        uv: DVec2,
        filter_texels: f64,
    ) -> ([DVec4; 4], [f64; 2]) {
        let size = self.size_px.map(|n| (n >> level).max(1) as i64);
        let at = uv * DVec2::new(size[0] as f64, size[1] as f64) - 0.5;
        let corner = at.floor();
        let texel = |dx: i64, dy: i64| {
            let [wrap_x, wrap_y] = self.sampling.wrap;
            let x = wrap_x.texel(corner.x as i64 + dx, size[0]);
            let y = wrap_y.texel(corner.y as i64 + dy, size[1]);
            decode(self.levels[level][(y * size[0] + x) as usize], self.srgb)
        };
        let texels = [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)];
        let mut t = (at - corner).to_array();
        if self.sampling.is_sharp && level == 0 {
            let width = (filter_texels / TEXEL_STD).clamp(LEAST_WIDTH, 1.0);
            t = t.map(|t| ((t - 0.5) / width + 0.5).clamp(0.0, 1.0));
        }
        (texels, t)
    }

    /// Trilinear look-up in linear values. `filter_side` is that of the filter in texture space: its area as a square, one standard deviation wide.
    pub fn filtered(&self, uv: DVec2, filter_side: f64, sample: TextureSampler) -> DVec4 {
        let texels = filter_side * (self.size_px[0] as f64 * self.size_px[1] as f64).sqrt();
        // A Gaussian of one texel's width is what bilinear look-up amounts to: level 0 serves down to there.
        let last = (self.levels.len() - 1) as f64;
        let lod = if texels > 0.0 {
            (2.0 * texels).log2().clamp(0.0, last)
        } else {
            0.0
        };
        let (low, share) = (lod.floor(), lod.fract());
        let near = sample(self, low as usize, uv, texels);
        if share == 0.0 {
            near
        } else {
            near.lerp(sample(self, low as usize + 1, uv, texels), share)
        }
    }

    /// A level between its texels, linear.
    pub fn at_level(&self, level: usize, uv: DVec2, filter_texels: f64) -> DVec4 {
        let (texels, t) = self.four_texels(level, uv, filter_texels);
        blend(texels, t)
    }

    /// The alpha at a place, from the first level.
    fn alpha(&self, uv: DVec2) -> f64 {
        self.at_level(0, uv, 0.0).w
    }
}

/// Bilinear look-up in a level, by a filter of so many texels of the first.
pub type TextureSampler = fn(&Texture, usize, DVec2, f64) -> DVec4;

/// Bilinear mean of four texels, with the place between them.
pub fn blend(texels: [DVec4; 4], [x, y]: [f64; 2]) -> DVec4 {
    texels[0]
        .lerp(texels[1], x)
        .lerp(texels[2].lerp(texels[3], x), y)
}

/// The area of a footprint in texture space as the side of a square, one standard deviation wide: that of two axes on a triangle of
/// these corners that spans `uv_area` twice.
pub fn texture_footprint(uv_area: f64, corners_m: &[DVec3; 3], axes_m: [DVec3; 2]) -> f64 {
    let area_m2 = (corners_m[1] - corners_m[0])
        .cross(corners_m[2] - corners_m[0])
        .length();
    (uv_area / area_m2 * axes_m[0].cross(axes_m[1]).length()).sqrt()
}

impl Mesh {
    /// Whether any triangle spans an area of a texture.
    pub fn has_uvs(&self) -> bool {
        self.triangles.iter().any(|corners| {
            let [a, b, c] = corners.map(|corner| self.uvs.get(corner as usize).copied());
            let spans = |a: Vec2, b: Vec2, c: Vec2| (b - a).perp_dot(c - a) != 0.0;
            matches!((a, b, c), (Some(a), Some(b), Some(c)) if spans(a, b, c))
        })
    }

    /// The places of a texture at the corners of a triangle.
    pub fn corner_uvs(&self, triangle: [u32; 3], texture: &Texture) -> [DVec2; 3] {
        let uvs = match texture.sampling.by_other_uvs {
            true => &self.other_uvs,
            false => &self.uvs,
        };
        // Other coordinates may be left out.
        let uv = |corner: u32| uvs.get(corner as usize).copied().unwrap_or(Vec2::ZERO);
        triangle.map(|corner| uv(corner).as_dvec2())
    }

    /// Factor of the vertices' colours at a place of a triangle, given its barycentric coordinates.
    pub fn color(&self, triangle: [u32; 3], weights: [f64; 3]) -> DVec4 {
        if self.colors.is_empty() {
            return DVec4::ONE;
        }
        let color = |i: usize| self.colors[triangle[i] as usize].as_dvec4() * weights[i];
        color(0) + color(1) + color(2)
    }
}

impl Cutout {
    /// Alpha of a surface of this material at a place of a triangle, given its barycentric coordinates.
    pub fn alpha_at(
        &self,
        material: &Material,
        textures: &[Texture],
        mesh: &Mesh,
        triangle: [u32; 3],
        weights: [f64; 3],
    ) -> f64 {
        let of_texture = material.base_color_texture.map_or(1.0, |i| {
            let texture = &textures[i];
            let [a, b, c] = mesh.corner_uvs(triangle, texture);
            texture.alpha(a * weights[0] + b * weights[1] + c * weights[2])
        });
        self.alpha * of_texture * mesh.color(triangle, weights).w
    }
}

fn decode(texel: [u8; 4], srgb: bool) -> DVec4 {
    let [r, g, b, a] = texel.map(|code| f64::from(code) / 255.0);
    let linear = |c: f64| match srgb {
        true => f64::from(linear_from_srgb(c as f32)),
        false => c,
    };
    DVec4::new(linear(r), linear(g), linear(b), a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Sampling, Wrap};

    fn row(wrap: Wrap, is_sharp: bool) -> Texture {
        Texture {
            size_px: [4, 1],
            levels: vec![[0, 50, 100, 200].map(|a| [0, 0, 0, a]).to_vec()],
            srgb: false,
            sampling: Sampling {
                wrap: [wrap, Wrap::Repeat],
                is_sharp,
                by_other_uvs: false,
            },
        }
    }

    #[test]
    fn beyond_a_border_is_what_the_sampler_says() {
        // In the middles of texels, one and two beyond either border.
        for (wrap, left, right) in [
            (Wrap::Repeat, [200, 100], [0, 50]),
            (Wrap::Mirror, [0, 50], [200, 100]),
            (Wrap::Clamp, [0, 0], [200, 200]),
        ] {
            let texture = row(wrap, false);
            let alpha = |texel: f64| 255.0 * texture.alpha(DVec2::new((texel + 0.5) / 4.0, 0.5));
            for i in 0..2 {
                let [x, y] = [-1.0 - i as f64, 4.0 + i as f64].map(alpha);
                assert!((x - f64::from(left[i])).abs() < 1e-9, "{wrap:?}: {x}");
                assert!((y - f64::from(right[i])).abs() < 1e-9, "{wrap:?}: {y}");
            }
            // Two rows of texels on, a mirror shows the same again.
            assert!((alpha(1.0 + 8.0) - alpha(1.0)).abs() < 1e-9 || wrap == Wrap::Clamp);
        }
    }

    #[test]
    fn sharp_texels_have_one_value() {
        let at = DVec2::new(1.4 / 4.0, 0.5);
        let soft = 255.0 * row(Wrap::Repeat, false).alpha(at);
        // Nine tenths of the way from the first texel's middle to the second one's.
        assert!((soft - 45.0).abs() < 1e-9, "{soft}");
        assert!((255.0 * row(Wrap::Repeat, true).alpha(at) - 50.0).abs() < 1e-9);
        // Seen by a filter as wide as a texel, both are the same.
        let wide = |is_sharp| row(Wrap::Repeat, is_sharp).four_texels(0, at, TEXEL_STD).1;
        assert!((wide(true)[0] - wide(false)[0]).abs() < 1e-9);
    }
}

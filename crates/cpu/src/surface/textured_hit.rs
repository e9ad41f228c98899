//! The mesh and the material at a hit: what is interpolated over the triangle, and what textures say there.

use glam::{DVec2, DVec3, DVec4};
use hairline_index::Hit;
use hairline_scene::texture_lookup::{TextureSampler, blend, texture_footprint};
use hairline_scene::{Material, MaterialOptics, Mesh, Scene, Texture};

/// A hit, with what textures are looked up by.
pub(super) struct TexturedHit<'a> {
    scene: &'a Scene,
    mesh: &'a Mesh,
    pub material: &'a Material,
    /// Indices of the corners, and of the triangle.
    triangle: [u32; 3],
    index: u32,
    barycentric: DVec2,
    corners_m: [DVec3; 3],
    /// Of the corners, and between them: before it is made a unit vector.
    normals: [DVec3; 3],
    interpolated: DVec3,
    /// Normal of the triangle, of any length.
    pub geometric: DVec3,
    /// 1 where the viewer is on the side of the normals, else -1: either side of a sheet is a surface of its own.
    pub side: f64,
    /// Interpolated unit normal.
    pub smooth: DVec3,
    /// Axes of the footprint about it, on the viewer's side.
    pub axes: [DVec3; 2],
}

/// A normal, as a map turns it.
pub(super) struct MappedNormal {
    pub normal: DVec3,
    /// Standard deviation of the slopes about it.
    pub slope_std: f64,
    /// Its turns over the axes of the footprint.
    pub turns: [DVec3; 2],
}

/// What a material reflects and emits.
pub(super) struct Paint {
    pub f0: DVec3,
    pub f90: f64,
    pub diffuse: DVec3,
    pub metallic: f64,
    pub roughness: f64,
    pub emission: DVec3,
}

impl<'a> TexturedHit<'a> {
    pub fn new(
        scene: &'a Scene,
        hit: &Hit,
        to_viewer: DVec3,
        footprint: impl Fn(DVec3) -> [DVec3; 2],
    ) -> Self {
        let mesh = &scene.objects[hit.object as usize].mesh;
        let triangle = mesh.triangles[hit.triangle as usize];
        let barycentric = DVec2::from(hit.barycentric);
        let corners_m = mesh.corners_m(hit.triangle as usize);
        let geometric = (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]);
        let side = if geometric.dot(to_viewer) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let normals = triangle.map(|i| mesh.normals[i as usize].as_dvec3());
        let interpolated = interpolate(barycentric, normals);
        let smooth = interpolated
            .try_normalize()
            .unwrap_or_else(|| geometric.normalize());
        Self {
            scene,
            mesh,
            material: &scene.materials[mesh.triangle_materials[hit.triangle as usize] as usize],
            triangle,
            index: hit.triangle,
            barycentric,
            corners_m,
            normals,
            interpolated,
            geometric,
            side,
            smooth,
            axes: footprint(side * smooth),
        }
    }

    /// A texture's colour at the hit.
    pub fn texture(&self, index: Option<usize>) -> Option<DVec4> {
        Some(self.look_up(index?, Texture::at_level, DVec2::ZERO))
    }

    /// A texture's colour a step of the barycentric coordinates from the hit.
    fn look_up(&self, index: usize, sample: TextureSampler, step: DVec2) -> DVec4 {
        let texture = &self.scene.textures[index];
        let [a, b, c] = self.mesh.corner_uvs(self.triangle, texture);
        let at = self.barycentric + step;
        let uv = a + (b - a) * at.x + (c - a) * at.y;
        let uv_area = (b - a).perp_dot(c - a).abs();
        let texel_scale = texture_footprint(uv_area, &self.corners_m, self.axes);
        texture.filtered(uv, texel_scale, sample)
    }

    /// Steps of the barycentric coordinates over the axes of the footprint.
    fn axis_steps(&self) -> [DVec2; 2] {
        self.axes
            .map(|axis| self.mesh.barycentric_step(self.index, axis))
    }

    fn tangents(&self) -> [DVec3; 2] {
        let tangents = self
            .triangle
            .map(|i| self.mesh.tangents[i as usize].as_dvec4());
        let tangent = interpolate(self.barycentric, tangents.map(|t| t.truncate()));
        let smooth = self.smooth;
        let tangent =
            (tangent - smooth * smooth.dot(tangent)).normalize_or(smooth.any_orthonormal_vector());
        [tangent, smooth.cross(tangent) * tangents[0].w]
    }

    /// The normal by a map and its scale. With `as_turns` bumps turn it over the footprint; else they are a spread of its slopes.
    pub fn mapped(&self, map: Option<(usize, f64)>, as_turns: bool) -> MappedNormal {
        let smooth = self.smooth;
        let Some((index, scale)) = map else {
            return MappedNormal {
                normal: smooth,
                slope_std: 0.0,
                turns: [DVec3::ZERO; 2],
            };
        };
        let sample: TextureSampler = match as_turns {
            true => Texture::at_level,
            false => sample_normals,
        };
        let [tangent, bitangent] = self.tangents();
        let normal = |texel: DVec4| {
            let n = texel.truncate() * 2.0 - DVec3::ONE;
            (tangent * (n.x * scale) + bitangent * (n.y * scale) + smooth * n.z)
                .normalize_or(smooth)
        };
        let texel = self.look_up(index, sample, DVec2::ZERO);
        let turns = match as_turns {
            true => self.axis_steps().map(|step| {
                let [after, before] =
                    [2.0 * step, -2.0 * step].map(|step| normal(self.look_up(index, sample, step)));
                0.25 * (after - before)
            }),
            false => [DVec3::ZERO; 2],
        };
        // A point has one normal.
        let is_wide = self.axes != [DVec3::ZERO; 2];
        MappedNormal {
            normal: normal(texel),
            slope_std: if is_wide { texel.w * scale.abs() } else { 0.0 },
            turns,
        }
    }

    /// Turns of the interpolated normal over the axes of the footprint.
    pub(crate) fn smooth_turns(&self) -> [DVec3; 2] {
        let [a, b, c] = self.normals;
        // Most triangles of what is flat have one normal.
        match a == b && a == c {
            true => [DVec3::ZERO; 2],
            false => self.axis_steps().map(|step| self.smooth_turn(step)),
        }
    }

    fn smooth_turn(&self, step: DVec2) -> DVec3 {
        let [a, b, c] = self.normals;
        let change = (b - a) * step.x + (c - a) * step.y;
        let interpolated = self.interpolated;
        let length2 = interpolated.length_squared();
        if length2 < 1e-12 {
            return DVec3::ZERO;
        }
        (change - interpolated * (change.dot(interpolated) / length2)) / length2.sqrt()
    }

    /// The way that facets lean further, and how much further.
    pub fn anisotropy(&self) -> Option<(DVec3, f64)> {
        let brushed = self.material.anisotropy.filter(|it| it.strength > 0.0)?;
        let texel = self.texture(self.material.anisotropy_texture);
        let own = texel.map_or(DVec2::X, |t| t.truncate().truncate() * 2.0 - DVec2::ONE);
        let turn = DVec2::from_angle(brushed.direction_deg.to_radians()).rotate(own);
        let [tangent, bitangent] = self.tangents();
        let strength = brushed.strength * texel.map_or(1.0, |t| t.z);
        Some((tangent * turn.x + bitangent * turn.y, strength))
    }

    pub fn paint(&self, optics: &MaterialOptics) -> Paint {
        let material = self.material;
        let color = self.mesh.color(self.triangle, self.weights()).truncate();
        let mut base_color = DVec3::from(optics.base_color) * color;
        let mut metallic = optics.metallic;
        let mut roughness = material.roughness;
        if let Some(texel) = self.texture(material.base_color_texture) {
            base_color *= texel.truncate();
        }
        if let Some(texel) = self.texture(material.metallic_roughness_texture) {
            roughness *= texel.y;
            metallic *= texel.z;
        }
        let emission = self.texture(material.emission_texture);
        let emission = emission.map_or(DVec3::ONE, |t| t.truncate());
        let [specular_texel, specular_color_texel] =
            material.specular_textures.map(|index| self.texture(index));
        let specular = material.specular.weight * specular_texel.map_or(1.0, |t| t.w);
        let color = DVec3::from(material.specular.color)
            * specular_color_texel.map_or(DVec3::ONE, |t| t.truncate());
        let dielectric_f0 = specular * (optics.dielectric_f0 * color).min(DVec3::ONE);
        let lit = Paint {
            f0: dielectric_f0.lerp(base_color, metallic),
            f90: specular + (1.0 - specular) * metallic,
            diffuse: base_color * (1.0 - metallic),
            metallic,
            roughness,
            emission: emission * DVec3::from(material.emission),
        };
        match material.is_unlit {
            true => Paint {
                f0: DVec3::ZERO,
                f90: 0.0,
                diffuse: DVec3::ZERO,
                emission: base_color,
                ..lit
            },
            false => lit,
        }
    }

    /// The share of the environment's light that reaches the base.
    pub fn open(&self) -> f64 {
        let occlusion = self.material.occlusion_texture;
        occlusion.map_or(1.0, |(index, strength)| {
            let red = self.texture(Some(index)).map_or(1.0, |texel| texel.x);
            1.0 + strength * (red - 1.0)
        })
    }

    fn weights(&self) -> [f64; 3] {
        let [u, v] = self.barycentric.to_array();
        [1.0 - u - v, u, v]
    }
}

fn interpolate(barycentric: DVec2, corners: [DVec3; 3]) -> DVec3 {
    let [u, v] = barycentric.to_array();
    corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v
}

/// Looks up a normal map; w is the standard deviation of the slopes, over the texels and over the part of the map that the pixel sees.
fn sample_normals(texture: &Texture, level: usize, uv: DVec2, texels_std: f64) -> DVec4 {
    let (texels, t) = texture.four_texels(level, uv, texels_std);
    let mut mean = blend(texels, t);
    let right = (texels[1] - texels[0]).lerp(texels[3] - texels[2], t[1]);
    let down = (texels[2] - texels[0]).lerp(texels[3] - texels[1], t[0]);
    let steps2 = [right, down].map(|step| 4.0 * step.truncate().truncate().length_squared());
    // Variance of the filter in texels, less that of a texel of a level that has averaged others.
    let variance = texels_std * texels_std / 4f64.powi(level as i32);
    let seen = (variance - if level > 0 { 1.0 / 12.0 } else { 0.0 }).max(0.0);
    let up = (mean.z * 2.0 - 1.0).max(0.1);
    mean.w = (mean.w * mean.w + 0.5 * seen * (steps2[0] + steps2[1]) / (up * up)).sqrt();
    mean
}

/// Origin of rays to lights: see [`super::SurfacePoint::raised_m`].
pub(super) fn raised(position_m: DVec3, hit: &Hit, mesh: &Mesh, side: f64) -> DVec3 {
    let [u, v] = hit.barycentric;
    let weights = [1.0 - u - v, u, v];
    let triangle = mesh.triangles[hit.triangle as usize];
    let normals = triangle.map(|i| mesh.normals[i as usize]);
    if normals[0] == normals[1] && normals[0] == normals[2] {
        return position_m;
    }
    let rises = (0..3).map(|i| {
        let corner_m = mesh.positions_m[triangle[i] as usize].as_dvec3();
        let normal = side * normals[i].as_dvec3();
        let below_m = (position_m - corner_m).dot(normal).min(0.0);
        normal * (-weights[i] * below_m)
    });
    position_m + rises.sum::<DVec3>()
}

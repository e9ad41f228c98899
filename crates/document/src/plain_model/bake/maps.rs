//! Maps of sums: what the surface has by itself, and its scratches.

use glam::{DMat3, DVec2, DVec3};
use hairline_model::texture::{Channels, Texels, build_texture};
use hairline_scene::{Material, Sampling, Texture};
use rayon::prelude::*;

use super::atlas::Atlas;
use super::sums::TexelSum;

/// Code of zero in normal maps, and codes from there to one.
const ZERO: f64 = 128.0;
const ONE: f64 = 127.0;
/// A code of a map whose texels say nothing.
const FULL: u8 = u8::MAX;
/// Width of the frame, in texels, by which a map goes on beyond its triangles: look-ups between texels meet it.
const FRAME_PX: usize = 4;
/// Least part of a normal across the surface: maps of 8 bits are good for no steeper one.
const LEAST_Z: f64 = 0.1;
/// Standard deviation of a texel's width.
const TEXEL_STD: f64 = 0.288_675_134_594_812_9;

/// Maps of a part.
pub(super) struct Maps {
    pub normals: Texture,
    /// Roughness over the roughest, in green; metallic as it was, in blue.
    pub roughness: Texture,
    /// Roughness where the map is 1.
    pub roughest: f64,
}

/// A texel of both maps.
#[derive(Clone, Copy)]
struct Baked {
    normal: [u8; 3],
    roughness: f64,
    metallic: u8,
}

/// What the surface is by itself at a texel.
struct SurfaceTexel {
    /// Lean of its normals, as of [`TexelSum::lean`].
    lean: DVec2,
    /// Variance of slopes that its normal map has below a texel, both directions together.
    variance: f64,
    roughness: f64,
    metallic: f64,
}

/// The textures that scratches change: those of the coat, if there is one.
struct Layer {
    normal: Option<(usize, f64)>,
    roughness: f64,
    roughness_texture: Option<usize>,
}

impl Layer {
    fn outermost(material: &Material) -> Self {
        match &material.coat {
            Some(coat) => Self {
                normal: material.coat_normal_texture,
                roughness: coat.roughness,
                roughness_texture: material.coat_textures[1],
            },
            None => Self {
                normal: material.normal_texture,
                roughness: material.base_roughness(),
                roughness_texture: material.metallic_roughness_texture,
            },
        }
    }
}

/// The maps of a part of this material.
pub(super) fn of_sums(
    atlas: &Atlas,
    sums: Vec<TexelSum>,
    material: &Material,
    textures: &[Texture],
) -> Maps {
    let layer = Layer::outermost(material);
    let texels = sums.par_iter().enumerate().map(|(texel, sum)| {
        let (triangle, weights) = atlas.surface(texel)?;
        let own = own(atlas, triangle, weights, &layer, textures);
        Some(baked(&own, sum))
    });
    let mut texels: Vec<Option<Baked>> = texels.collect();
    drop(sums);
    for _ in 0..FRAME_PX {
        texels = widened(atlas, &texels);
    }
    let roughness = texels.iter().flatten().map(|it| it.roughness);
    let roughest = roughness
        .fold(0.0, f64::max)
        .clamp(0.5 / f64::from(FULL), 1.0);
    let empty = Baked {
        normal: [ZERO as u8, ZERO as u8, FULL],
        roughness: layer.roughness,
        metallic: FULL,
    };
    let codes = |code: fn(&Baked, f64) -> [u8; 4], channels: Channels| {
        let texels = texels.iter().map(|it| code(&it.unwrap_or(empty), roughest));
        let image = Texels {
            size_px: [atlas.size as u32; 2],
            texels: texels.collect(),
        };
        Texture {
            sampling: Sampling {
                by_other_uvs: atlas.by_other_uvs,
                ..Sampling::default()
            },
            ..build_texture(image, channels, false)
        }
    };
    let normal = |texel: &Baked, _: f64| {
        let [x, y, z] = texel.normal;
        [x, y, z, FULL]
    };
    let rough = |texel: &Baked, roughest: f64| {
        let share = (texel.roughness / roughest).min(1.0);
        let code = (share * f64::from(FULL)).round() as u8;
        [FULL, code, texel.metallic, FULL]
    };
    Maps {
        normals: codes(normal, Channels::Normals),
        roughness: codes(rough, Channels::Linear),
        roughest,
    }
}

/// Scratches on a surface, (48) of docs/model.md: the normal has their mean slope. What is left of the mean square slope, and what is lost to rounding, is
/// variance, and widens the roughness: alpha squared is the mean square slope of facets.
fn baked(own: &SurfaceTexel, sum: &TexelSum) -> Baked {
    let scratches = DVec2::from(sum.lean.map(f64::from));
    let variance = f64::from(sum.square) - scratches.length_squared();
    let lean = own.lean + scratches;
    let alpha2 = own.roughness.powi(4) + own.variance + variance;
    let exact = ONE * lean.extend(1.0).normalize();
    let with_lost = |codes: DVec3| {
        let drawn = codes.truncate() / codes.z.max(1.0);
        let lost = lean.length_squared() - drawn.length_squared();
        let is_scratched = sum.square > 0.0;
        (codes, if is_scratched { alpha2 + lost } else { alpha2 })
    };
    // A slope that was rounded up takes more than there is off a smooth surface.
    let (codes, alpha2) = match with_lost(exact.round()) {
        (_, less) if less < 0.0 => with_lost(exact.truncate().trunc().extend(exact.z.round())),
        rounded => rounded,
    };
    Baked {
        normal: (ZERO + codes).to_array().map(|code| code as u8),
        roughness: alpha2.clamp(0.0, 1.0).sqrt().sqrt(),
        metallic: (own.metallic * f64::from(FULL)).round() as u8,
    }
}

/// The surface at a texel, whose middle is at these weights of a triangle's corners.
fn own(
    atlas: &Atlas,
    triangle: u32,
    weights: DVec3,
    layer: &Layer,
    textures: &[Texture],
) -> SurfaceTexel {
    let mesh = atlas.mesh;
    let corners = mesh.triangles[triangle as usize];
    let look_up = |number: usize| {
        let texture = &textures[number];
        let [a, b, c] = mesh.corner_uvs(corners, texture);
        let uv = a * weights.x + b * weights.y + c * weights.z;
        let side = TEXEL_STD / atlas.size as f64;
        texture.filtered(uv, side, Texture::at_level)
    };
    let rough = layer.roughness_texture.map(look_up);
    let bumps = layer.normal.map(|(number, scale)| (look_up(number), scale));
    SurfaceTexel {
        lean: bumps.map_or(DVec2::ZERO, |(texel, scale)| {
            let n = 2.0 * texel.truncate() - DVec3::ONE;
            let n = n * DVec3::new(scale, scale, 1.0);
            lean(atlas, triangle, weights, n)
        }),
        variance: bumps.map_or(0.0, |(texel, scale)| 2.0 * (scale * texel.w).powi(2)),
        roughness: layer.roughness * rough.map_or(1.0, |it| it.y),
        metallic: rough.map_or(1.0, |it| it.z),
    }
}

/// The lean of a normal of the surface's own map, in the axes of those that are made.
fn lean(atlas: &Atlas, triangle: u32, weights: DVec3, n: DVec3) -> DVec2 {
    let mesh = atlas.mesh;
    let corners = mesh.triangles[triangle as usize].map(|v| v as usize);
    let mean = |corners: [DVec3; 3]| DMat3::from_cols(corners[0], corners[1], corners[2]) * weights;
    let normal = mean(corners.map(|v| mesh.normals[v].as_dvec3())).normalize_or(DVec3::Z);
    let tangent = mean(corners.map(|v| mesh.tangents[v].truncate().as_dvec3()));
    let tangent = (tangent - normal * normal.dot(tangent)).normalize_or_zero();
    let side = f64::from(mesh.tangents[corners[0]].w);
    let leaning = DMat3::from_cols(tangent, normal.cross(tangent) * side, normal) * n;
    let [right, up] = atlas.placed(triangle).frame(normal);
    DVec2::new(leaning.dot(right), leaning.dot(up)) / n.z.max(LEAST_Z)
}

/// The texels, and those beside them.
fn widened(atlas: &Atlas, texels: &[Option<Baked>]) -> Vec<Option<Baked>> {
    let beside = |texel: usize| {
        let (x, y) = ((texel % atlas.size) as i64, (texel / atlas.size) as i64);
        let steps = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        steps
            .into_iter()
            .find_map(|(dx, dy)| texels[atlas.texel(x + dx, y + dy)])
    };
    let all = texels.par_iter().enumerate();
    all.map(|(texel, own)| own.or_else(|| beside(texel)))
        .collect()
}

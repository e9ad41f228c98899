//! Look-ups in an environment's maps, in the map's own frame and texel units.
//! Twin: `crates/gpu/shaders/environment.wgsl`, the same names and arguments.
//!
//! Brian Karis, "Real Shading in Unreal Engine 4", 2013 (the split sum); Ravi Ramamoorthi and Pat Hanrahan, "An Efficient
//! Representation for Irradiance Environment Maps", 2001.
//!
//! Filtering is by hand, and not by a sampler, so that every device and the CPU blend alike: maps repeat across u and
//! end at v = 0 and 1.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use hairline_image::Picture;

use super::LEVEL_ROUGHNESS;

/// Where a unit direction lies on the map: u in [0, 1] to the right, v in [0, 1] from the top.
pub fn environment_uv(dir: DVec3) -> DVec2 {
    // At the poles atan2(0, 0) is 0 here, but anything in a shader.
    let longitude = if dir.x == 0.0 && dir.z == 0.0 {
        0.0
    } else {
        dir.x.atan2(-dir.z)
    };
    // The arcus cosine as an arcus tangent, which keeps its digits near the poles in single precision too.
    let polar = dir.x.hypot(dir.z).atan2(dir.y);
    DVec2::new(0.5 + longitude / TAU, polar / PI)
}

/// The inverse of [`environment_uv`].
pub fn environment_dir(uv: DVec2) -> DVec3 {
    let (sin_longitude, cos_longitude) = ((uv.x - 0.5) * TAU).sin_cos();
    let (sin_polar, cos_polar) = (uv.y * PI).sin_cos();
    DVec3::new(
        sin_polar * sin_longitude,
        cos_polar,
        -sin_polar * cos_longitude,
    )
}

/// A map between its texels: bilinear, repeated in u, clamped in v.
pub fn environment_bilinear(map: &Picture, uv: DVec2) -> DVec3 {
    let [width, height] = map.size_px.map(|n| n as i32);
    let at = uv * DVec2::new(f64::from(width), f64::from(height)) - 0.5;
    let corner = at.floor();
    let t = at - corner;
    let x0 = (corner.x as i32).rem_euclid(width);
    let x1 = (x0 + 1) % width;
    let y0 = (corner.y as i32).clamp(0, height - 1);
    let y1 = (corner.y as i32 + 1).clamp(0, height - 1);
    let texel = |x: i32, y: i32| DVec3::from(map.rgb[(y * width + x) as usize].map(f64::from));
    // a + (b - a) t rather than a (1 - t) + b t: exact where both are equal.
    let mix = |a: DVec3, b: DVec3, t: f64| a + (b - a) * t;
    let top = mix(texel(x0, y0), texel(x1, y0), t.x);
    let bottom = mix(texel(x0, y1), texel(x1, y1), t.x);
    mix(top, bottom, t.y)
}

/// The radiance from a direction.
pub fn environment_radiance(map: &Picture, dir: DVec3) -> DVec3 {
    environment_bilinear(map, environment_uv(dir))
}

/// The level of a perceptual roughness: between levels in proportion to GGX's alpha, to which the width of the lobe is
/// proportional.
pub fn environment_lod(roughness: f64) -> f64 {
    let alpha = roughness.clamp(0.0, 1.0).powi(2);
    let mut lod = 0.0;
    for pair in LEVEL_ROUGHNESS.windows(2) {
        let (low, high) = (pair[0].powi(2), pair[1].powi(2));
        lod += ((alpha - low) / (high - low)).clamp(0.0, 1.0);
    }
    lod
}

/// The radiance blurred by the lobe of a GGX surface of perceptual `roughness` around its mirror direction `dir`.
pub fn environment_prefiltered(levels: &[Picture], dir: DVec3, roughness: f64) -> DVec3 {
    environment_prefiltered_lod(levels, dir, environment_lod(roughness))
}

/// [`environment_prefiltered`] by level.
pub fn environment_prefiltered_lod(levels: &[Picture], dir: DVec3, lod: f64) -> DVec3 {
    let uv = environment_uv(dir);
    let clamped = lod.clamp(0.0, (levels.len() - 1) as f64);
    let level = clamped.floor();
    let near = environment_bilinear(&levels[level as usize], uv);
    if level == clamped {
        return near;
    }
    let far = environment_bilinear(&levels[level as usize + 1], uv);
    near + (far - near) * (clamped - level)
}

/// The irradiance on a surface with unit `normal`, from nine coefficients of the polynomials
/// 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2, their norms and the cosine's convolution included.
pub fn environment_irradiance(sh: &[[f32; 3]; 9], normal: DVec3) -> DVec3 {
    let basis = environment_sh_basis(normal);
    let mut sum = DVec3::ZERO;
    for (coefficient, basis) in sh.iter().zip(basis) {
        sum += DVec3::from(coefficient.map(f64::from)) * basis;
    }
    // Nine terms ring below zero opposite to a very bright light.
    sum.max(DVec3::ZERO)
}

/// The real spherical harmonics up to degree two without their norms.
pub fn environment_sh_basis(n: DVec3) -> [f64; 9] {
    [
        1.0,
        n.y,
        n.z,
        n.x,
        n.x * n.y,
        n.y * n.z,
        3.0 * n.z * n.z - 1.0,
        n.x * n.z,
        n.x * n.x - n.y * n.y,
    ]
}

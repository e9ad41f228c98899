//! Look-ups in an environment's maps, in the map's own frame and texel units.
//! Twin: `crates/gpu/shaders/physics/environment.wgsl`, the same names and arguments.
//!
//! Brian Karis, "Real Shading in Unreal Engine 4", 2013 (the split sum).
//!
//! Filtering is by hand, and not by a sampler, so that every device and the CPU blend alike: maps repeat across u, and beyond a
//! pole, at v = 0 and 1, they go on with the row on its other side.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec3A};
use hairline_image::Picture;

use super::LEVEL_ROUGHNESS;

/// Position of a unit direction on the map: u in [0, 1] to the right, v in [0, 1] from the top.
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

/// `f64::atan2` with an error of 3e-8, in a third of its time: a scratch under an environment calls it some twenty times. M.
/// Abramowitz and I. Stegun, *Handbook of Mathematical Functions* (1964), 4.4.49.
#[inline(always)]
fn arctangent(y: f64, x: f64) -> f64 {
    let (low, high) = (x.abs().min(y.abs()), x.abs().max(y.abs()));
    // At the origin it is 0.
    let t = low / high.max(f64::MIN_POSITIVE);
    let s = t * t;
    let series = [
        -0.016_165_736_7,
        0.042_909_613_8,
        -0.075_289_640_0,
        0.106_562_639_3,
        -0.142_088_994_4,
        0.199_935_508_5,
        -0.333_331_452_8,
        1.0,
    ];
    let series = series.iter().fold(0.002_866_225_7, |sum, a| sum * s + a);
    let within_45 = t * series;
    let within_90 = if y.abs() > x.abs() {
        0.5 * PI - within_45
    } else {
        within_45
    };
    let angle = if x < 0.0 { PI - within_90 } else { within_90 };
    angle.copysign(y)
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

/// Column and row of texel (x, y), continued over the poles: beyond a pole lies the same row, half a turn away.
#[inline(always)]
pub fn over_the_pole([width, height]: [i32; 2], x: i32, y: i32) -> [i32; 2] {
    if y >= 0 && y < height {
        return [x, y];
    }
    let across = x + width / 2;
    let x = if across < width {
        across
    } else {
        across - width
    };
    [x, y.clamp(0, height - 1)]
}

/// A map between its texels: bilinear, repeated in u, continued over the poles in v.
pub fn environment_bilinear(map: &Picture, uv: DVec2) -> DVec3 {
    let [width, height] = map.size_px.map(|n| n as i32);
    let at = uv * DVec2::new(f64::from(width), f64::from(height)) - 0.5;
    let corner = at.floor();
    let t = at - corner;
    let x0 = (corner.x as i32).rem_euclid(width);
    let x1 = (x0 + 1) % width;
    let (y0, y1) = (corner.y as i32, corner.y as i32 + 1);
    let texel = |x: i32, y: i32| {
        let [x, y] = over_the_pole([width, height], x, y);
        DVec3::from(map.rgb[(y * width + x) as usize].map(f64::from))
    };
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
#[inline(always)]
pub fn environment_lod(roughness: f64) -> f64 {
    let alpha = roughness.clamp(0.0, 1.0).powi(2);
    let mut lod = 0.0;
    for (low, per_step) in LEVEL_STEPS {
        lod += ((alpha - low) * per_step).clamp(0.0, 1.0);
    }
    lod
}

/// Alpha of each level but the last, and the reciprocal of the step to the next.
const LEVEL_STEPS: [(f64, f64); LEVEL_ROUGHNESS.len() - 1] = {
    let mut steps = [(0.0, 0.0); LEVEL_ROUGHNESS.len() - 1];
    let mut i = 0;
    while i < steps.len() {
        let (low, high) = (LEVEL_ROUGHNESS[i], LEVEL_ROUGHNESS[i + 1]);
        steps[i] = (low * low, 1.0 / (high * high - low * low));
        i += 1;
    }
    steps
};

/// The radiance blurred by the lobe of a GGX surface of perceptual `roughness` around its mirror direction `dir`.
pub fn environment_prefiltered(levels: &[Picture], dir: DVec3, roughness: f64) -> DVec3 {
    environment_prefiltered_lod(levels, dir, environment_lod(roughness))
}

/// [`environment_prefiltered`] by level.
pub(crate) fn environment_prefiltered_lod(levels: &[Picture], dir: DVec3, lod: f64) -> DVec3 {
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

/// [`environment_prefiltered`] for several directions at once: the arithmetic is done for all in one loop, which compilers turn into
/// vector instructions.
#[inline(always)]
pub(crate) fn environment_prefiltered_all<const N: usize>(
    levels: &[Picture],
    dirs: [DVec3; N],
    roughness: [f64; N],
) -> [DVec3; N] {
    let (mut u, mut v, mut lod) = ([0.0; N], [0.0; N], [0.0; N]);
    for i in 0..N {
        let dir = dirs[i];
        let from_axis = (dir.x * dir.x + dir.z * dir.z).sqrt();
        u[i] = 0.5 + arctangent(dir.x, -dir.z) * (1.0 / TAU);
        v[i] = arctangent(from_axis, dir.y) * (1.0 / PI);
    }
    for i in 0..N {
        lod[i] = environment_lod(roughness[i]);
    }
    std::array::from_fn(|i| {
        let lod = lod[i].min((levels.len() - 1) as f64);
        let level = lod as usize;
        let near = bilinear(&levels[level], u[i], v[i]);
        let far = bilinear(&levels[(level + 1).min(levels.len() - 1)], u[i], v[i]);
        (near + (far - near) * (lod - level as f64) as f32).as_dvec3()
    })
}

/// [`environment_bilinear`] in single precision.
#[inline(always)]
fn bilinear(map: &Picture, u: f64, v: f64) -> Vec3A {
    let [width, height] = map.size_px.map(|n| n as i32);
    let (at_x, at_y) = (u * f64::from(width) - 0.5, v * f64::from(height) - 0.5);
    // The floor of a number from -1 on, without a call.
    let floor = |v: f64| (v + 1.0) as i32 - 1;
    let (x, y) = (floor(at_x), floor(at_y));
    let (tx, ty) = ((at_x - f64::from(x)) as f32, (at_y - f64::from(y)) as f32);
    let x0 = if x < 0 { width - 1 } else { x.min(width - 1) };
    let x1 = if x0 + 1 < width { x0 + 1 } else { 0 };
    let row = |y: i32| {
        let texel = |x: i32| {
            let [x, y] = over_the_pole([width, height], x, y);
            Vec3A::from(map.rgb[(y * width + x) as usize])
        };
        let (a, b) = (texel(x0), texel(x1));
        a + (b - a) * tx
    };
    let (top, bottom) = (row(y), row(y + 1));
    top + (bottom - top) * ty
}

/// The irradiance on a surface with unit `normal`, from the map that the cosine has blurred.
pub fn environment_irradiance(map: &Picture, normal: DVec3) -> DVec3 {
    environment_bilinear(map, environment_uv(normal)) * PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_look_ups_at_once_are_the_single_ones() {
        let level = |size_px: [u32; 2]| Picture {
            size_px,
            rgb: (0..size_px[0] * size_px[1])
                .map(|i| [(i * 7919 % 97) as f32, (i % 13) as f32, 1.0])
                .collect(),
        };
        let levels: Vec<Picture> = (0..LEVEL_ROUGHNESS.len())
            .map(|i| level([64 >> (i / 3), 32 >> (i / 3)]))
            .collect();
        let mut dirs = [DVec3::Y; 100];
        for (i, dir) in dirs.iter_mut().enumerate().skip(1) {
            let turn = i as f64;
            *dir = DVec3::new(turn.sin(), (1.7 * turn).sin(), turn.cos()).normalize();
        }
        dirs[1] = DVec3::NEG_Y;
        dirs[2] = DVec3::Z;
        dirs[3] = DVec3::NEG_X;
        let roughness = std::array::from_fn(|i| i as f64 / 99.0);
        let all = environment_prefiltered_all(&levels, dirs, roughness);
        for i in 2..100 {
            let one = environment_prefiltered(&levels, dirs[i], roughness[i]);
            assert!(
                (all[i] - one).abs().max_element() < 1e-3,
                "{i}: {} {one}",
                all[i]
            );
        }
        assert!(all[0].is_finite() && all[1].is_finite());
    }
}

//! The irradiance from a map: the map blurred by the cosine.

use glam::{DVec2, Vec3A};
use hairline_image::Picture;
use rayon::prelude::*;

use super::half_texels::round_to_half;
use super::lookup::environment_dir;
use super::resample::{resample, row_solid_angle};

/// Width and height of `blur`'s map: linear between texels a cosine is within 0.2 %.
pub(crate) const IRRADIANCE_SIZE_PX: [u32; 2] = [64, 32];

/// What is looked at: texels of 1.4 degrees.
const SOURCE_SIZE_PX: [u32; 2] = [256, 128];

/// For each normal the mean of radiance over the hemisphere, weighted by the cosine: irradiance over pi.
pub(super) fn blur(map: &Picture) -> Picture {
    let [width, height] = IRRADIANCE_SIZE_PX;
    if map.rgb.iter().all(|texel| *texel == map.rgb[0]) {
        let rgb = vec![map.rgb[0]; (width * height) as usize];
        return Picture {
            size_px: IRRADIANCE_SIZE_PX,
            rgb,
        };
    }
    let source = resample(map, SOURCE_SIZE_PX);
    let texels: Vec<(Vec3A, Vec3A)> = (0..SOURCE_SIZE_PX[1])
        .flat_map(|y| {
            let solid_angle = row_solid_angle(y, SOURCE_SIZE_PX[1]) as f32;
            let source = &source;
            (0..SOURCE_SIZE_PX[0]).map(move |x| {
                let direction = middle(x, y, SOURCE_SIZE_PX);
                (direction * solid_angle, Vec3A::from(source.pixel(x, y)))
            })
        })
        .collect();
    let rgb = (0..height)
        .into_par_iter()
        .flat_map_iter(|y| {
            let texels = &texels;
            (0..width).map(move |x| {
                let normal = middle(x, y, IRRADIANCE_SIZE_PX);
                let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
                for (direction, radiance) in texels {
                    let weight = normal.dot(*direction).max(0.0);
                    sum += *radiance * weight;
                    weights += weight;
                }
                (sum / weights).to_array()
            })
        })
        .collect();
    let mut map = Picture {
        size_px: IRRADIANCE_SIZE_PX,
        rgb,
    };
    round_to_half(&mut map);
    map
}

/// The direction of a texel's middle.
fn middle(x: u32, y: u32, size_px: [u32; 2]) -> Vec3A {
    let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let [width, height] = size_px.map(f64::from);
    environment_dir(at / DVec2::new(width, height))
        .as_vec3()
        .into()
}

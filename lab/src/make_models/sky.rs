//! The sky of `scenes/sunlit.toml`: a clear evening with its sun.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use glam::{DVec2, DVec3};
use hairline_scene::environment::lookup::environment_dir;
use image::Rgb;
use image::codecs::hdr::HdrEncoder;

const SIZE_PX: [usize; 2] = [1024, 512];
const SUN_ELEVATION_RAD: f64 = 38.0 / 180.0 * PI;
/// The sun as the Earth sees it.
const SUN_RADIUS_RAD: f64 = 0.00465;
const SUN: DVec3 = DVec3::new(40_000.0, 34_000.0, 26_000.0);
/// Each texel's share of the sun is that of so many places squared.
const PLACES: usize = 16;

/// A Radiance file: the map's middle column has the sun. Of sines the file keeps so few bits that platforms agree on them.
pub fn evening() -> Result<Vec<u8>> {
    let (sin, cos) = libm::sincos(SUN_ELEVATION_RAD);
    let to_sun = DVec3::new(0.0, sin, -cos);
    let [width, height] = SIZE_PX;
    let texels: Vec<Rgb<f32>> = (0..width * height)
        .map(|i| {
            let direction = |x: f64, y: f64| {
                let at = DVec2::new((i % width) as f64 + x, (i / width) as f64 + y);
                environment_dir(at / DVec2::new(width as f64, height as f64))
            };
            let middle = direction(0.5, 0.5);
            let apart_rad = |direction: DVec3| libm::acos(direction.dot(to_sun).clamp(-1.0, 1.0));
            let mut radiance = air(middle, apart_rad(middle));
            if apart_rad(middle) < 3.0 * SUN_RADIUS_RAD {
                let place = |i: usize| (i as f64 + 0.5) / PLACES as f64;
                let places = (0..PLACES * PLACES).map(|i| (place(i % PLACES), place(i / PLACES)));
                let inside = places.filter(|&(x, y)| apart_rad(direction(x, y)) < SUN_RADIUS_RAD);
                radiance += SUN * (inside.count() as f64 / (PLACES * PLACES) as f64);
            }
            Rgb(radiance.as_vec3().to_array())
        })
        .collect();
    let mut file = Vec::new();
    let encoder = HdrEncoder::new(&mut file);
    encoder
        .encode(&texels, width, height)
        .context("encode the sky")?;
    Ok(file)
}

/// Blue above, warm at the horizon and around the sun; dark ground.
fn air(direction: DVec3, from_sun_rad: f64) -> DVec3 {
    let low = (1.0 - direction.y.abs()).powi(4);
    if direction.y <= 0.0 {
        return DVec3::new(0.03, 0.026, 0.022) + DVec3::new(0.12, 0.1, 0.08) * low;
    }
    let glow = 0.5 * libm::exp(-from_sun_rad / 0.12);
    DVec3::new(0.03, 0.07, 0.2)
        + DVec3::new(0.35, 0.3, 0.22) * low
        + DVec3::new(1.0, 0.8, 0.55) * glow
}

//! Engraving of the spoon's handle: a line along the edge, flutes, a flower, and three marks on the back, with the
//! tarnish that stays in their ground.

use glam::{DVec2, DVec3};
use image::{Rgb, RgbImage};

use super::spline::smooth_step;
use super::spoon::{JOINT_MM, LENGTH_MM, Spoon, TEXTURE_HALF_WIDTH_MM};

/// Width of all three pictures.
const WIDTH_PX: u32 = 512;
const HEIGHT_PX: u32 = 256;

/// Pictures of one size.
pub struct HandleTexture {
    /// sRGB.
    pub base_color: RgbImage,
    /// Green: roughness, blue: metallic.
    pub metallic_roughness: RgbImage,
    /// Tangent space, y up.
    pub normal: RgbImage,
}

/// Paints both faces: the upper in the upper half of the picture.
pub fn paint(spoon: &Spoon) -> HandleTexture {
    let blank = || RgbImage::new(WIDTH_PX, HEIGHT_PX);
    let mut texture = HandleTexture {
        base_color: blank(),
        metallic_roughness: blank(),
        normal: blank(),
    };
    let pixel_x_mm = (LENGTH_MM - JOINT_MM) / f64::from(WIDTH_PX);
    let pixel_y_mm = 4.0 * TEXTURE_HALF_WIDTH_MM / f64::from(HEIGHT_PX);
    for (column, row, pixel) in texture.normal.enumerate_pixels_mut() {
        let is_upper = row < HEIGHT_PX / 2;
        let at = DVec2::new(
            JOINT_MM + (f64::from(column) + 0.5) * pixel_x_mm,
            // Across, upwards in the picture, from the middle of its half.
            (f64::from(HEIGHT_PX) / 4.0 - f64::from(row % (HEIGHT_PX / 2)) - 0.5) * pixel_y_mm,
        );
        let depth = |dx: f64, dy: f64| depth_mm(spoon, at + DVec2::new(dx, dy), is_upper);
        // Slopes over a pixel: what is finer than it belongs to no picture.
        let slope = DVec2::new(
            (depth(0.5 * pixel_x_mm, 0.0) - depth(-0.5 * pixel_x_mm, 0.0)) / pixel_x_mm,
            (depth(0.0, 0.5 * pixel_y_mm) - depth(0.0, -0.5 * pixel_y_mm)) / pixel_y_mm,
        );
        let normal = DVec3::new(slope.x, slope.y, 1.0).normalize();
        *pixel = Rgb((normal * 0.5 + 0.5).to_array().map(eight_bits));

        let tarnish = smooth_step(0.02, 0.14, depth(0.0, 0.0));
        let silver = DVec3::new(0.982, 0.977, 0.965);
        let sulphide = DVec3::new(0.36, 0.29, 0.21);
        let color = silver.lerp(sulphide, tarnish).to_array().map(eight_bits);
        texture.base_color.put_pixel(column, row, Rgb(color));
        let surface = [0.0, 0.12 + 0.4 * tarnish, 1.0 - 0.3 * tarnish].map(eight_bits);
        texture
            .metallic_roughness
            .put_pixel(column, row, Rgb(surface));
    }
    texture
}

fn eight_bits(value: f64) -> u8 {
    (value * 255.0).round().clamp(0.0, 255.0) as u8
}

/// Depth of the engraving at a point of a face.
fn depth_mm(spoon: &Spoon, at: DVec2, is_upper: bool) -> f64 {
    let half_width = spoon.half_width_mm(at.x);
    // A line that keeps its distance from the edge, except where the handle is too narrow for it.
    let from_edge = (half_width - at.y.abs()).min(LENGTH_MM - at.x);
    let mut depth = 0.16 * cut(from_edge - 1.35, 0.28) * smooth_step(96.0, 108.0, at.x);
    if !is_upper {
        for mark in [122.0, 127.0, 132.0] {
            let corner = (at - DVec2::new(mark, 0.0)).abs().max_element();
            depth += 0.12 * (1.0 - smooth_step(1.1, 1.5, corner));
        }
        return depth;
    }
    // Flutes that open like a fan.
    let along = smooth_step(98.0, 112.0, at.x) * (1.0 - smooth_step(136.0, 150.0, at.x));
    for flute in [-1.0, 0.0, 1.0] {
        depth += 0.13 * along * cut(at.y - flute * 0.27 * half_width, 0.26);
    }
    depth.max(flower_mm(at - DVec2::new(160.0, 0.0)))
}

/// Eight petals around a ring.
fn flower_mm(from_centre: DVec2) -> f64 {
    let radius = from_centre.length();
    let angle = libm::atan2(from_centre.y, from_centre.x);
    let petal_mm = 4.7 * libm::pow(libm::cos(4.0 * angle).abs(), 0.45);
    let petal = 0.16
        * (1.0 - smooth_step(0.55 * petal_mm, petal_mm + 0.05, radius))
        * smooth_step(1.0, 1.6, radius);
    let vein =
        0.1 * cut(libm::sin(4.0 * angle) * radius / 4.0, 0.12) * smooth_step(1.5, 2.0, radius);
    let ring = 0.12 * cut(radius - 0.75, 0.2);
    (petal - vein).max(0.0).max(ring)
}

/// A groove's section, 1 deep: a Gaussian.
fn cut(offset_mm: f64, half_width_mm: f64) -> f64 {
    let t = offset_mm / half_width_mm;
    libm::exp(-t * t)
}

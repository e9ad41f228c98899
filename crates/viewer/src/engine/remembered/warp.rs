//! Reprojection of a picture to another camera.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, Vec3};
use hairline_scene::camera::CameraFrame;
use rayon::prelude::*;

/// Largest relative difference of depths of one surface.
const SAME_DEPTH: f32 = 0.02;
/// Largest side, in pixels, of a reprojected pixel, where the camera has come nearer.
const MOST_SIDE_PX: f32 = 4.0;
/// Tolerance, in pixels, for rounding of a pixel's size.
const ROUNDING: f32 = 0.01;
/// Distance of the background, metres.
const FAR_M: f64 = 1e6;

/// Position of a pixel's surface.
#[derive(Clone, Copy)]
pub(super) struct SurfacePosition {
    /// Vector from the camera, metres.
    to_m: Vec3,
    /// Depth along the camera's axis, metres.
    depth_m: f32,
}

impl SurfacePosition {
    /// Finds the position of a pixel's surface; depth 0 is the background.
    pub fn new(camera: &CameraFrame, at_px: DVec2, depth_m: f32) -> Self {
        let ray = camera.camera_ray(at_px);
        let depth_m = match depth_m {
            0.0 => FAR_M,
            depth_m => f64::from(depth_m),
        };
        Self {
            to_m: (ray * depth_m).as_vec3(),
            depth_m: depth_m as f32,
        }
    }
}

/// Whether two depths, 0 for the background, can be of one surface.
pub(super) fn is_same_depth(a_m: f32, b_m: f32) -> bool {
    let far_m = 0.5 * FAR_M as f32;
    let is_far = |m: f32| m == 0.0 || m > far_m;
    (a_m - b_m).abs() < SAME_DEPTH * b_m || is_far(a_m) && is_far(b_m)
}

/// For each pixel of a new picture, the pixel of the old one that it shows.
pub(super) struct Warp {
    size: [usize; 2],
    /// Index of the old pixel; [`usize::MAX`] where there is none.
    pub pixels: Vec<usize>,
    /// Depth along the axis of the new camera; NaN where there is no pixel.
    pub depth_m: Vec<f32>,
}

/// Entry of an empty pixel.
const EMPTY: u64 = u64::MAX;

impl Warp {
    /// Reprojects a picture, whose pixels have these places, from one camera to another. The nearest place wins.
    pub fn new(places: &[SurfacePosition], from: &CameraFrame, to: &CameraFrame) -> Self {
        let size = [to.size_px.x as usize, to.size_px.y as usize];
        let nearest: Vec<AtomicU64> = (0..size[0] * size[1])
            .map(|_| AtomicU64::new(EMPTY))
            .collect();
        let per_px = to.per_px_x.length();
        let [right, down] = [to.per_px_x, to.per_px_y].map(|it| (it / (per_px * per_px)).as_vec3());
        let (forward, middle_px) = (to.forward.as_vec3(), to.middle_px.as_vec2());
        let moved_m = (from.position_m - to.position_m).as_vec3();
        // Ratio of the sizes of old and new pixels at one depth.
        let larger = (from.per_px_x.length() / per_px) as f32;
        places.par_iter().enumerate().for_each(|(i, place)| {
            let to_m = place.to_m + moved_m;
            let depth_m = to_m.dot(forward);
            if depth_m <= 0.0 {
                return;
            }
            let side = larger * place.depth_m / depth_m;
            let side = (side - ROUNDING).ceil().clamp(1.0, MOST_SIDE_PX);
            let [columns, rows] =
                [(right, middle_px.x), (down, middle_px.y)].map(|(axis, middle)| {
                    let first = (middle + to_m.dot(axis) / depth_m - 0.5 * side + 0.5).floor();
                    first.max(0.0) as usize..(first + side).max(0.0) as usize
                });
            // Positive floats have the order of their bits.
            let entry = u64::from(depth_m.to_bits()) << 32 | i as u64;
            for y in rows.start..rows.end.min(size[1]) {
                for x in columns.start..columns.end.min(size[0]) {
                    nearest[y * size[0] + x].fetch_min(entry, Ordering::Relaxed);
                }
            }
        });
        let entries: Vec<u64> = nearest.into_iter().map(AtomicU64::into_inner).collect();
        let closed = (0..entries.len())
            .into_par_iter()
            .map(|i| match closed(&entries, size, i) {
                EMPTY => (usize::MAX, f32::NAN),
                entry => (entry as u32 as usize, f32::from_bits((entry >> 32) as u32)),
            });
        let (pixels, depth_m) = closed.unzip();
        Self {
            size,
            pixels,
            depth_m,
        }
    }

    /// Drops pixels whose depth differs from that of the new picture.
    pub fn keep_those_at(&mut self, depth_m: &[f32]) {
        for (i, pixel) in self.pixels.iter_mut().enumerate() {
            if !is_same_depth(self.depth_m[i], depth_m[i]) {
                *pixel = usize::MAX;
            }
        }
    }

    /// Position of a pixel's middle, from 0 to 1 over the picture.
    pub fn place(&self, i: usize) -> [f32; 2] {
        let at = [i % self.size[0], i / self.size[0]];
        [0, 1].map(|c| (at[c] as f32 + 0.5) / self.size[c] as f32)
    }

    /// Index of the pixel at a position from 0 to 1.
    pub fn pixel_at(&self, at: [f32; 2]) -> usize {
        let [x, y] = [0, 1].map(|c| ((at[c] * self.size[c] as f32) as usize).min(self.size[c] - 1));
        y * self.size[0] + x
    }
}

/// Entry of a pixel, or in a gap between two opposite neighbours the farther one's: pixels move apart where the camera comes
/// nearer.
fn closed(entries: &[u64], [width, height]: [usize; 2], i: usize) -> u64 {
    let (x, y) = (i % width, i / width);
    let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
    if entries[i] != EMPTY || !is_inside {
        return entries[i];
    }
    let across = [1, width, width + 1, width - 1];
    let pairs = across.map(|step| entries[i - step].max(entries[i + step]));
    pairs.into_iter().min().unwrap_or(EMPTY)
}

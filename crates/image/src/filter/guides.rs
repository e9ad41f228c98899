//! Which pixels see the same surface.

use rayon::prelude::*;

use crate::Image;
use crate::traced::{Traced, TracedPixel};

/// Largest distance of a surface from the plane of a pixel, as a share of depth, at which both are averaged.
pub const OFF_PLANE: f32 = 0.01;
/// Distance, in pixels, over which an outline is averaged with the surfaces to both sides of it.
pub const OUTLINE_PX: i32 = 2;
/// Pixels that are less alike do not count.
pub const LEAST_ALIKE: f32 = 1e-3;

/// Guides by which pixels of one surface are found.
pub(super) struct Guides {
    pub size_px: [usize; 2],
    pub pixels: Vec<Guide>,
}

#[derive(Clone, Copy)]
pub(super) struct Guide {
    pub object: u32,
    pub normal: [f32; 3],
    /// The reciprocal of depth, which is linear over the picture of a plane, and how it changes to the right and down.
    pub per_depth: f32,
    pub slope: [f32; 2],
    pub roughness: f32,
}

impl Guides {
    pub(super) fn new(image: &Image, traced: &Traced) -> Self {
        let size_px = image.size_px.map(|n| n as usize);
        let [width, height] = size_px;
        let per_depth = |i: usize| match image.depth_m[i] {
            z if z > 0.0 => 1.0 / z,
            _ => 0.0,
        };
        // Takes the side with the smaller change: the other side may lie beyond an edge.
        let slope = |i: usize, before: Option<usize>, after: Option<usize>| {
            let object = traced.pixels[i].object;
            let step = |from: usize, to: usize, other: usize| {
                (traced.pixels[other].object == object).then(|| per_depth(to) - per_depth(from))
            };
            let before = before.and_then(|b| step(b, i, b));
            let after = after.and_then(|a| step(i, a, a));
            match (before, after) {
                (Some(a), Some(b)) => {
                    if a.abs() < b.abs() {
                        a
                    } else {
                        b
                    }
                }
                (Some(a), None) | (None, Some(a)) => a,
                (None, None) => 0.0,
            }
        };
        let pixels = (0..width * height)
            .into_par_iter()
            .map(|i| {
                let (x, y) = (i % width, i / width);
                Guide {
                    object: traced.pixels[i].object,
                    normal: image.normal[i],
                    per_depth: per_depth(i),
                    slope: [
                        slope(i, (x > 0).then(|| i - 1), (x + 1 < width).then(|| i + 1)),
                        slope(
                            i,
                            (y > 0).then(|| i - width),
                            (y + 1 < height).then(|| i + width),
                        ),
                    ],
                    roughness: traced.pixels[i].roughness,
                }
            })
            .collect();
        Self { size_px, pixels }
    }

    /// Similarity of the surfaces that two pixels see, from 0 to 1; (dx, dy) leads from one to the other.
    pub(super) fn alike(&self, normal_power: f32, p: &Guide, q: &Guide, [dx, dy]: [i32; 2]) -> f32 {
        // An outline sees what both of its sides see; its own samples are few.
        if p.object == TracedPixel::SEVERAL_OBJECTS {
            let is_near = dx.abs().max(dy.abs()) <= OUTLINE_PX;
            return f32::from(is_near && q.object != 0);
        }
        if p.object != q.object || p.object == 0 {
            return 0.0;
        }
        let cos: f32 = (0..3).map(|c| p.normal[c] * q.normal[c]).sum();
        if cos <= 0.5 {
            return 0.0;
        }
        let on_plane = p.per_depth + p.slope[0] * dx as f32 + p.slope[1] * dy as f32;
        let off = (q.per_depth - on_plane).abs() / p.per_depth;
        let off = off / OFF_PLANE;
        let bent = if cos >= 1.0 {
            1.0
        } else {
            cos.powf(normal_power)
        };
        bent / (1.0 + off * off)
    }

    pub(super) fn index(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let [width, height] = self.size_px;
        let is_in = x >= 0 && y >= 0 && (x as usize) < width && (y as usize) < height;
        is_in.then(|| y as usize * width + x as usize)
    }
}

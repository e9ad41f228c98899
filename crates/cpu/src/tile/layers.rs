//! Rows of an image, into which tiles are written side by side.

use crate::resolve::Sample;
use hairline_image::{Image, TracedPixel};

/// Some rows of an image's layers.
pub(super) struct Layers<'i> {
    base: &'i mut [[f32; 3]],
    scratches: &'i mut [[f32; 3]],
    density: &'i mut [[f32; 3]],
    depth_m: &'i mut [f32],
    normal: &'i mut [[f32; 3]],
    /// Empty without shadows.
    traced: &'i mut [TracedPixel],
}

impl<'i> Layers<'i> {
    pub fn new(image: &'i mut Image) -> Self {
        let traced = image.traced.as_mut();
        Self {
            traced: traced.map_or(&mut [], |traced| &mut traced.pixels),
            base: &mut image.base,
            scratches: &mut image.scratches,
            density: &mut image.density,
            depth_m: &mut image.depth_m,
            normal: &mut image.normal,
        }
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.depth_m.len()
    }

    /// Takes the first pixels away from it.
    pub fn split_off_first(&mut self, pixels: usize) -> Self {
        fn split<'i, T>(layer: &mut &'i mut [T], pixels: usize) -> &'i mut [T] {
            let (first, rest) = std::mem::take(layer).split_at_mut(pixels);
            *layer = rest;
            first
        }
        Self {
            base: split(&mut self.base, pixels),
            scratches: split(&mut self.scratches, pixels),
            density: split(&mut self.density, pixels),
            depth_m: split(&mut self.depth_m, pixels),
            normal: split(&mut self.normal, pixels),
            traced: match self.traced.len() {
                0 => &mut [],
                _ => split(&mut self.traced, pixels),
            },
        }
    }

    pub fn set(&mut self, pixel: usize, sample: &Sample) {
        let traced = sample.traced();
        [self.base[pixel], self.scratches[pixel]] = traced.light();
        if let Some(kept) = self.traced.get_mut(pixel) {
            *kept = traced;
        }
        self.density[pixel] = sample.density.as_vec3().to_array();
        self.depth_m[pixel] = sample.depth_m as f32;
        self.normal[pixel] = sample.normal.as_vec3().to_array();
    }
}

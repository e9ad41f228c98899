//! Stage 7, resolve: the mask, the sum of base and scratches, and the mean over a pixel's samples. Twin: resolve.wgsl.

use crate::shade_base::BaseRadiance;
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::mask::Masked;

/// What one sample adds to the film, or the sum of several.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sample {
    pub base: DVec3,
    pub scratches: DVec3,
    pub density: DVec3,
    /// Not of unit length.
    pub normal: DVec3,
    /// 0 for the background.
    pub depth_m: f64,
}

impl Sample {
    pub fn background(radiance: DVec3) -> Self {
        Self {
            base: radiance,
            ..Self::default()
        }
    }

    /// A point of a surface, at a depth along the view axis.
    pub fn surface(
        point: &SurfacePoint,
        masked: &Masked,
        light: &BaseRadiance,
        depth_m: f64,
    ) -> Self {
        let taken = DVec3::from(masked.taken);
        // A groove interrupts the reflecting surface; what shines from under it passes.
        let fresnel = point.reflectance(point.wo.z);
        Self {
            base: point.emission + light.diffuse + light.specular * (DVec3::ONE - taken),
            scratches: DVec3::from(masked.scratches) * fresnel,
            density: taken,
            normal: point.normal,
            depth_m,
        }
    }
}

/// The samples of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pixel {
    sum: Sample,
    samples: u32,
    /// Samples that see a surface.
    covered: u32,
}

impl Pixel {
    pub fn add(&mut self, sample: &Sample) {
        self.sum.base += sample.base;
        self.sum.scratches += sample.scratches;
        self.sum.density += sample.density;
        self.sum.normal += sample.normal;
        self.sum.depth_m += sample.depth_m;
        self.samples += 1;
        self.covered += u32::from(sample.depth_m > 0.0);
    }

    /// The mean, with a unit normal; none without a sample. Depths are the mean of those samples that see a surface.
    pub fn resolve(&self) -> Option<Sample> {
        if self.samples == 0 {
            return None;
        }
        let per_sample = 1.0 / f64::from(self.samples);
        Some(Sample {
            base: self.sum.base * per_sample,
            scratches: self.sum.scratches * per_sample,
            density: self.sum.density * per_sample,
            normal: self.sum.normal.normalize_or_zero(),
            depth_m: self.sum.depth_m / f64::from(self.covered.max(1)),
        })
    }
}

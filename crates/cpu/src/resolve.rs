//! Stage 7, resolve: the mask, the layers of a sample's light, and the mean over a pixel's samples. Twin: resolve.wgsl.

use crate::shade_base::BaseRadiance;
use crate::shade_gratings::ShadedGratings;
use crate::surface::SurfacePoint;
use crate::traced::{BaseLight, LayerLight};
use glam::DVec3;
use hairline_image::TracedPixel;
use hairline_optics::mask::{Masked, ScratchSums};

/// Light and guides that one sample adds to the film, or the sum of several.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sample {
    /// Radiance of the background, and of surfaces that emit.
    pub rest: DVec3,
    pub diffuse: LayerLight,
    pub specular: LayerLight,
    pub scratches: LayerLight,
    pub density: DVec3,
    /// Normal, not of unit length.
    pub normal: DVec3,
    /// 0 for the background.
    pub depth_m: f64,
    /// Number of the object, from 1; 0 for the background.
    pub object: u32,
    pub roughness: f64,
}

/// The light of a point on a surface, before scratches and gratings take theirs.
#[derive(Default)]
pub(crate) struct PointLight {
    pub base: BaseLight,
    pub scratches: LayerLight,
    pub gratings: Option<(ShadedGratings, LayerLight)>,
}

impl PointLight {
    /// Light without rays.
    pub fn open(base: BaseRadiance, sums: &ScratchSums, gratings: Option<ShadedGratings>) -> Self {
        Self {
            base: BaseLight {
                specular: LayerLight::open(base.specular),
                diffuse: LayerLight::open(base.diffuse),
            },
            scratches: LayerLight::open(sums.radiance.into()),
            gratings: gratings.map(|it| (it, LayerLight::open(it.radiance))),
        }
    }
}

impl Sample {
    pub fn background(radiance: DVec3) -> Self {
        Self {
            rest: radiance,
            ..Self::default()
        }
    }

    /// A point of a surface, at a depth along the view axis. `masked` has what is left of the light of scratches, and what they take of the base.
    pub fn surface(
        point: &SurfacePoint,
        object: u32,
        masked: &Masked,
        light: PointLight,
        depth_m: f64,
    ) -> Self {
        let mut taken = DVec3::from(masked.taken);
        let mut scratches = light.scratches.times(DVec3::splat(masked.kept));
        if let Some((gratings, of_gratings)) = light.gratings {
            // Scratches lie on top: they take of what gratings send as of what the mirror does.
            let left = DVec3::ONE - taken;
            scratches += of_gratings.times(left);
            taken = DVec3::ONE - left * (DVec3::ONE - gratings.taken);
        }
        Self {
            rest: point.emission,
            diffuse: light.base.diffuse,
            // A groove interrupts the reflecting surface; what shines from under it passes.
            specular: light.base.specular.times(DVec3::ONE - taken),
            scratches: scratches.times(point.reflectance(point.wo.z)),
            density: taken,
            normal: point.normal,
            depth_m,
            object: object + 1,
            roughness: point.roughness,
        }
    }

    /// Light that rays found in the sample.
    pub fn traced(&self) -> TracedPixel {
        TracedPixel {
            rest: self.rest.as_vec3().to_array(),
            roughness: self.roughness as f32,
            object: self.object,
            diffuse: self.diffuse.in_picture(),
            specular: self.specular.in_picture(),
            scratches: self.scratches.in_picture(),
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
        let sum = &mut self.sum;
        sum.rest += sample.rest;
        sum.diffuse += sample.diffuse;
        sum.specular += sample.specular;
        sum.scratches += sample.scratches;
        sum.density += sample.density;
        sum.normal += sample.normal;
        sum.depth_m += sample.depth_m;
        sum.roughness += sample.roughness;
        sum.object = match (self.samples, sum.object) {
            (0, _) => sample.object,
            (_, object) if object == sample.object => object,
            _ => TracedPixel::SEVERAL_OBJECTS,
        };
        self.samples += 1;
        self.covered += u32::from(sample.depth_m > 0.0);
    }

    /// The mean, with a unit normal; none without a sample. Depths are the mean of those samples that see a surface.
    pub fn resolve(&self) -> Option<Sample> {
        if self.samples == 0 {
            return None;
        }
        let per_sample = 1.0 / f64::from(self.samples);
        let covered = f64::from(self.covered.max(1));
        Some(Sample {
            rest: self.sum.rest * per_sample,
            diffuse: self.sum.diffuse.for_samples(per_sample),
            specular: self.sum.specular.for_samples(per_sample),
            scratches: self.sum.scratches.for_samples(per_sample),
            density: self.sum.density * per_sample,
            normal: self.sum.normal.normalize_or_zero(),
            depth_m: self.sum.depth_m / covered,
            object: self.sum.object,
            roughness: self.sum.roughness / covered,
        })
    }
}

//! The coat over a metal: a GGX lobe of its own (docs/model.md, (29a)).

use glam::{DVec2, DVec3};

use super::nodes::place;
use crate::coat::{COAT_F0, COAT_IOR, CoatPart};
use crate::fresnel::dielectric;
use crate::ggx::{ggx_alpha, ggx_eval, ggx_mean, ggx_pdf, ggx_sample};

/// Nodes of the lobe's albedos over the square root of the cosine, and steps of their quadrature.
const NODES: usize = 65;
const STEPS: usize = 64;
/// Probability of drawing a coat that covers all, of all that is drawn from it and from the base: faint as it is, its highlights are the strongest.
const PICK: f64 = 0.3;

/// A coat.
#[derive(Clone, Debug)]
pub struct CoatLobe {
    weight: f64,
    alpha: f64,
    /// Albedo of the lobe with F = 1, and with the coat's reflectance.
    albedos: Vec<[f64; 2]>,
}

/// A coat for one viewer.
pub(super) struct CoatView {
    pub part: CoatPart,
    /// Probability of drawing from it in the place of the base.
    pub pick: f64,
    wo: DVec3,
    alpha: f64,
    /// Factor of multiple scattering, (27).
    factor: f64,
}

impl CoatLobe {
    /// A coat of a perceptual roughness on the share `weight` of the surface.
    pub fn new(weight: f64, roughness: f64) -> Self {
        let alpha = ggx_alpha(roughness);
        let albedo = |i: usize| {
            let root = i as f64 / (NODES - 1) as f64;
            ggx_mean(root * root, alpha, STEPS, |cos_h| {
                [1.0, dielectric(cos_h, COAT_IOR)]
            })
        };
        Self {
            weight,
            alpha,
            albedos: (0..NODES).map(albedo).collect(),
        }
    }

    pub(super) fn view(&self, wo: DVec3) -> CoatView {
        let (i, share) = place(wo.z, NODES);
        let [white, own] = [0, 1].map(|k| {
            let [low, high] = [i, i + 1].map(|i| self.albedos[i][k]);
            low + share * (high - low)
        });
        let factor = 1.0 + COAT_F0 * (1.0 / white.clamp(1e-3, 1.0) - 1.0);
        CoatView {
            part: CoatPart::new(self.weight, DVec3::splat(own * factor)),
            pick: PICK * self.weight,
            wo,
            alpha: self.alpha,
            factor,
        }
    }
}

impl CoatView {
    /// Its own light, the cosine of `wi` inside.
    pub(super) fn eval(&self, wi: DVec3) -> DVec3 {
        let h = (wi + self.wo).normalize_or(DVec3::Z);
        let facet = dielectric(wi.dot(h), COAT_IOR) * self.factor;
        DVec3::splat(facet * ggx_eval(wi, self.wo, self.alpha))
    }

    /// Reflectance of a flat surface, `base` being that of the metal where there is no coat.
    pub(super) fn reflectance(&self, base: DVec3) -> DVec3 {
        let own = DVec3::splat(dielectric(self.wo.z, COAT_IOR));
        self.part.reflected(own, base)
    }

    pub(super) fn pdf(&self, wi: DVec3) -> f64 {
        ggx_pdf(wi, self.wo, self.alpha)
    }

    pub(super) fn sample(&self, u: DVec2) -> DVec3 {
        ggx_sample(self.wo, self.alpha, u)
    }
}

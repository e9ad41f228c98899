//! The base of docs/model.md, section 8, as a BRDF to evaluate and to sample: GGX (25) with its Fresnel (26) and the factor for
//! multiple scattering of (27), over the diffuse body of (29), and the coat of (29a) over both.
//!
//! Nothing fitted or tabulated for the closed form enters: reflectances are those of [`Reflectance`].

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use hairline_optics::facets::Facets;
use hairline_optics::ggx::ggx_alpha;

use crate::reflectance::{Albedo, Ends, Reflectance};
use hairline_cpu::surface::SurfacePoint;

/// The base at a point for its viewer. Directions are unit vectors in the point's local frame.
#[derive(Clone, Copy)]
pub(crate) struct BaseLobes<'a> {
    wo: DVec3,
    facets: Facets,
    reflectance: &'a Reflectance,
    ends: Ends,
    /// What multiple scattering adds to a white surface's light: the bracket of (27) less one, over F0.
    gain: f64,
    /// What reaches the body, times its albedo.
    body: DVec3,
    /// How often the specular lobe is sampled.
    specular_share: f64,
    coat: Option<CoatLobe<'a>>,
}

/// A clear layer over the base (29a).
#[derive(Clone, Copy)]
struct CoatLobe<'a> {
    /// The share of the surface that it covers.
    weight: f64,
    facets: Facets,
    reflectance: &'a Reflectance,
    gain: f64,
    /// What goes through it.
    passed: DVec3,
    /// How often its lobe is sampled.
    share: f64,
}

impl<'a> BaseLobes<'a> {
    /// `coat` is the reflectance of a coat.
    pub(crate) fn new(
        point: &SurfacePoint,
        reflectance: &'a Reflectance,
        coat: Option<&'a Reflectance>,
    ) -> Self {
        let ends = Ends::of(point);
        let bare = match point.facets.map(Facets::new) {
            Some(facets) => {
                let of_lobe = reflectance.albedo_of(&facets, point.wo);
                Self::from_lobe(point.wo, reflectance, ends, point.diffuse, facets, of_lobe)
            }
            None => Self::from_parts(point.wo, reflectance, ends, point.diffuse, point.roughness),
        };
        match point.coat.zip(coat) {
            Some((it, of)) => bare.coated(it.weight, it.roughness, of),
            None => bare,
        }
    }

    fn coated(self, weight: f64, roughness: f64, reflectance: &'a Reflectance) -> Self {
        let of_lobe = reflectance.albedo(roughness, self.wo.z);
        let albedo = of_lobe.reflected(Ends::COAT);
        let coat = CoatLobe {
            weight,
            facets: Facets::round(ggx_alpha(roughness)),
            reflectance,
            gain: of_lobe.gain(),
            passed: (DVec3::ONE - albedo).max(DVec3::ZERO),
            // Faint as it is, its highlights are the strongest.
            share: 0.3 * weight,
        };
        Self {
            coat: Some(coat),
            ..self
        }
    }

    fn from_parts(
        wo: DVec3,
        reflectance: &'a Reflectance,
        ends: Ends,
        diffuse: DVec3,
        roughness: f64,
    ) -> Self {
        let of_lobe = reflectance.albedo(roughness, wo.z);
        let facets = Facets::round(ggx_alpha(roughness));
        Self::from_lobe(wo, reflectance, ends, diffuse, facets, of_lobe)
    }

    fn from_lobe(
        wo: DVec3,
        reflectance: &'a Reflectance,
        ends: Ends,
        diffuse: DVec3,
        facets: Facets,
        of_lobe: Albedo,
    ) -> Self {
        let albedo = of_lobe.reflected(ends);
        let body = diffuse * (DVec3::ONE - albedo).max(DVec3::ZERO);
        let (specular, below) = (albedo.element_sum().max(0.0), body.element_sum());
        // A faint lobe still needs samples: a narrow one is found by nothing else.
        let specular_share = if below > 0.0 {
            (specular / (specular + below)).clamp(0.1, 0.9)
        } else {
            1.0
        };
        Self {
            wo,
            facets,
            reflectance,
            ends,
            gain: of_lobe.gain(),
            body,
            specular_share,
            coat: None,
        }
    }

    /// BRDF times the cosine of `wi`: (specular, diffuse). Zero at and below the horizon.
    pub(crate) fn eval(&self, wi: DVec3) -> (DVec3, DVec3) {
        if wi.z <= 0.0 {
            return (DVec3::ZERO, DVec3::ZERO);
        }
        let h = (wi + self.wo).normalize_or(DVec3::Z);
        let reflected = |reflectance: &Reflectance, ends, gain: f64, facets: &Facets| {
            let facet = reflectance.eval(wi.dot(h), ends);
            (facet.once + facet.twice * gain) * facets.eval(wi, self.wo)
        };
        let specular = reflected(self.reflectance, self.ends, self.gain, &self.facets);
        let diffuse = self.body * (wi.z / PI);
        let Some(coat) = &self.coat else {
            return (specular, diffuse);
        };
        let by_coat = reflected(coat.reflectance, Ends::COAT, coat.gain, &coat.facets);
        let bare = 1.0 - coat.weight;
        (
            bare * specular + coat.weight * by_coat,
            bare * diffuse + coat.weight * coat.passed * (specular + diffuse),
        )
    }

    /// A direction above the horizon; `pick` and `u` are in [0, 1). None where the specular lobe was picked and its direction
    /// lies below: such a sample counts as zero.
    pub(crate) fn sample(&self, pick: f64, u: DVec2) -> Option<DVec3> {
        let coat_share = self.coat.map_or(0.0, |coat| coat.share);
        let wi = if let Some(coat) = self.coat.filter(|_| pick >= 1.0 - coat_share) {
            coat.facets.sample(self.wo, u)
        } else if pick < self.specular_share * (1.0 - coat_share) || self.specular_share == 1.0 {
            self.facets.sample(self.wo, u)
        } else {
            cosine_sample(u)
        };
        (wi.z > 0.0).then_some(wi)
    }

    /// The density of [`BaseLobes::sample`], per steradian. Over the upper hemisphere it integrates to how often a sample is
    /// not None.
    pub(crate) fn pdf(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let specular = self.facets.pdf(wi, self.wo);
        let bare = specular * self.specular_share + wi.z / PI * (1.0 - self.specular_share);
        match &self.coat {
            Some(coat) => bare + (coat.facets.pdf(wi, self.wo) - bare) * coat.share,
            None => bare,
        }
    }
}

/// A direction in proportion to its cosine.
fn cosine_sample(u: DVec2) -> DVec3 {
    let (sin_phi, cos_phi) = (2.0 * PI * u.x).sin_cos();
    let r = u.y.sqrt();
    DVec3::new(r * cos_phi, r * sin_phi, (1.0 - u.y).sqrt())
}

#[cfg(test)]
mod tests;

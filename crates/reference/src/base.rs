//! The base of docs/model.md, section 8, as a BRDF to evaluate and to sample: GGX (25) with its Fresnel (26) and the factor for
//! multiple scattering of (27), over the diffuse body of (29), and the coat of (29a) over both.
//!
//! Nothing fitted or tabulated for the closed form enters: reflectances are those of [`Reflectance`].

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};
use hairline_optics::coat::CoatPart;
use hairline_optics::facets::Facets;
use hairline_optics::ggx::ggx_alpha;

use crate::reflectance::{Albedo, MixedEnds, Reflectance, ReflectanceEnds};
use hairline_cpu::surface::SurfacePoint;

/// The base at a point for its viewer. Directions are unit vectors in the point's local frame.
#[derive(Clone, Copy)]
pub(crate) struct BaseLobes<'a> {
    /// Viewer's direction in the frame of the base under the coat.
    wo: DVec3,
    /// Rotation from the coat's frame to that of the base, where they differ.
    under_coat: Option<DMat3>,
    facets: Facets,
    reflectance: &'a Reflectance,
    ends: MixedEnds,
    /// Relative light that multiple scattering adds to a white surface: the bracket of (27) less one, over F0.
    gain: f64,
    /// Share of the light that reaches the body, times the body's albedo.
    body: DVec3,
    /// Probability of sampling the specular lobe.
    specular_share: f64,
    coat: Option<CoatLobe<'a>>,
}

/// A clear layer over the base (29a).
#[derive(Clone, Copy)]
struct CoatLobe<'a> {
    part: CoatPart,
    /// Viewer's direction in the coat's own frame.
    wo: DVec3,
    facets: Facets,
    reflectance: &'a Reflectance,
    gain: f64,
    /// Probability of sampling the coat's lobe.
    share: f64,
}

impl<'a> BaseLobes<'a> {
    /// `coat` is the reflectance of a coat.
    pub(crate) fn new(
        point: &SurfacePoint,
        reflectance: &'a Reflectance,
        coat: Option<&'a Reflectance>,
    ) -> Self {
        let ends = MixedEnds::from_point(point);
        let under_coat = point.under_coat();
        let wo = under_coat.map_or(point.wo, |it| it.wo);
        let bare = match point.facets.map(Facets::new) {
            Some(facets) => {
                let of_lobe = reflectance.albedo_of(&facets, wo);
                Self::from_lobe(wo, reflectance, ends, point.diffuse, facets, of_lobe)
            }
            None => Self::from_parts(wo, reflectance, ends, point.diffuse, point.roughness),
        };
        let turned = Self {
            under_coat: under_coat.map(|it| point.turn_to(&it)),
            ..bare
        };
        match point.coat.zip(coat) {
            Some((it, of)) => turned.coated(it.weight, it.roughness, point.wo, of),
            None => turned,
        }
    }

    fn coated(self, weight: f64, roughness: f64, wo: DVec3, reflectance: &'a Reflectance) -> Self {
        let of_lobe = reflectance.albedo(roughness, wo.z);
        let albedo = of_lobe.reflected(ReflectanceEnds::COAT);
        let coat = CoatLobe {
            part: CoatPart::new(weight, albedo),
            wo,
            facets: Facets::round(ggx_alpha(roughness)),
            reflectance,
            gain: of_lobe.gain(),
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
        ends: MixedEnds,
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
        ends: MixedEnds,
        diffuse: DVec3,
        facets: Facets,
        of_lobe: Albedo,
    ) -> Self {
        let albedo = ends.mix(|ends| of_lobe.reflected(ends));
        // A body lies under the dielectric alone.
        let body = diffuse * (DVec3::ONE - of_lobe.reflected(ends.dielectric)).max(DVec3::ZERO);
        let (specular, below) = (albedo.element_sum().max(0.0), body.element_sum());
        // A faint lobe still needs samples: a narrow one is found by nothing else.
        let specular_share = if below > 0.0 {
            (specular / (specular + below)).clamp(0.1, 0.9)
        } else {
            1.0
        };
        Self {
            wo,
            under_coat: None,
            facets,
            reflectance,
            ends,
            gain: of_lobe.gain(),
            body,
            specular_share,
            coat: None,
        }
    }

    fn under_coat(&self, wi: DVec3) -> DVec3 {
        self.under_coat.map_or(wi, |turn| turn * wi)
    }

    /// Whether light from a direction falls on the coat or on the surface under it.
    pub(crate) fn are_above(&self, wi: DVec3) -> bool {
        wi.z > 0.0 || self.under_coat(wi).z > 0.0
    }

    /// BRDF times the cosine of `wi`: (specular, diffuse). Each layer has none at and below its horizon.
    pub(crate) fn eval(&self, wi: DVec3) -> (DVec3, DVec3) {
        let reflected =
            |reflectance: &Reflectance, ends, gain: f64, facets: &Facets, wi: DVec3, wo: DVec3| {
                let h = (wi + wo).normalize_or(DVec3::Z);
                let facet = reflectance.eval(wi.dot(h), ends);
                (facet.once + facet.twice * gain) * facets.eval(wi, wo)
            };
        let under_coat = self.under_coat(wi);
        let (facets, wo) = (&self.facets, self.wo);
        let specular = (self.ends)
            .mix(|ends| reflected(self.reflectance, ends, self.gain, facets, under_coat, wo));
        let diffuse = self.body * (under_coat.z.max(0.0) / PI);
        let Some(coat) = &self.coat else {
            return (specular, diffuse);
        };
        let (ends, facets) = (ReflectanceEnds::COAT, &coat.facets);
        let by_coat = reflected(coat.reflectance, ends, coat.gain, facets, wi, coat.wo);
        let below = coat.part.transmitted(specular, diffuse);
        (coat.part.reflected(by_coat, specular), below)
    }

    /// A direction above the horizon of the lobe that was picked; `pick` and `u` are in [0, 1). None where that of facets lies below: such a sample
    /// counts as zero.
    pub(crate) fn sample(&self, pick: f64, u: DVec2) -> Option<DVec3> {
        let coat_share = self.coat.map_or(0.0, |coat| coat.share);
        if let Some(coat) = self.coat.filter(|_| pick >= 1.0 - coat_share) {
            let wi = coat.facets.sample(coat.wo, u);
            return (wi.z > 0.0).then_some(wi);
        }
        let wi = if pick < self.specular_share * (1.0 - coat_share) || self.specular_share == 1.0 {
            self.facets.sample(self.wo, u)
        } else {
            cosine_sample(u)
        };
        let on_top = self.under_coat.map_or(wi, |turn| turn.transpose() * wi);
        (wi.z > 0.0).then_some(on_top)
    }

    /// The density of [`BaseLobes::sample`], per steradian. Over all directions it integrates to how often a sample is not None.
    pub(crate) fn pdf(&self, wi: DVec3) -> f64 {
        let of = |facets: &Facets, wi: DVec3, wo| {
            if wi.z > 0.0 { facets.pdf(wi, wo) } else { 0.0 }
        };
        let under_coat = self.under_coat(wi);
        let specular = of(&self.facets, under_coat, self.wo);
        let diffuse = under_coat.z.max(0.0) / PI;
        let bare = specular * self.specular_share + diffuse * (1.0 - self.specular_share);
        match &self.coat {
            Some(coat) => bare + (of(&coat.facets, wi, coat.wo) - bare) * coat.share,
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

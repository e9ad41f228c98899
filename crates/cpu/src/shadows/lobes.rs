//! The lobes of the base, to draw directions from.

use crate::light_view::{LightView, LightViews};
use crate::sampling::luminance;
use crate::shade_base::{Base, BaseRadiance};
use crate::surface::SurfacePoint;
use glam::{DMat3, DVec2, DVec3};
use hairline_optics::band::Cap;
use hairline_optics::facets::{FacetAxes, Facets};
use hairline_optics::fresnel::{FresnelRgb, half_vector_cos};
use hairline_optics::ggx::ggx_alpha;
use std::f64::consts::PI;

/// Amount for each steradian that is added to the estimate by which a source is drawn, so that no light far above its estimate makes a bright dot.
const LEAST_LIKELY: f64 = 0.01;

/// The lobes of the base, simple enough to be drawn from. They only shape shadows: the closed form says how much light there is. Directions are in
/// the frame of the point.
pub(super) struct Lobes<'l, 'a> {
    base: &'l Base<'l, 'a>,
    lobe: DrawnLobe<'a>,
    coat: Option<DrawnLobe<'a>>,
    /// Probability of drawing from the body's lobe.
    body_share: f64,
    /// Rotation to the frame of the lobe and the body, where that is not the coat's.
    under_coat: Option<DMat3>,
}

/// A lobe, widened by the pixel's normals. Directions are in its own frame.
struct DrawnLobe<'a> {
    wo: DVec3,
    facets: Facets,
    fresnel: FresnelRgb<'a>,
    /// Probability of drawing from the lobe.
    share: f64,
}

impl<'a> DrawnLobe<'a> {
    fn new(
        point: &SurfacePoint,
        own: FacetAxes,
        slope_std: f64,
        fresnel: FresnelRgb<'a>,
        share: f64,
    ) -> Self {
        // By turns of the normal and not by the footprint: a wider GGX has higher tails, which would find more of bright walls than the sharp lobe.
        let turns = point
            .normal_turns
            .map(|turn| turn.truncate().length_squared());
        let added = 2.0 * (turns[0] + turns[1] + 2.0 * slope_std * slope_std);
        Self {
            wo: point.wo,
            facets: Facets::new(own.spread_by(added)),
            fresnel,
            share,
        }
    }

    fn single(&self, wi: DVec3) -> DVec3 {
        let facet = self.fresnel.eval(half_vector_cos(wi, self.wo));
        DVec3::from(facet) * self.facets.eval(wi, self.wo)
    }

    fn pdf(&self, wi: DVec3) -> f64 {
        if wi.z > 0.0 {
            self.share * self.facets.pdf(wi, self.wo)
        } else {
            0.0
        }
    }
}

impl<'l, 'a> Lobes<'l, 'a> {
    pub fn new(base: &'l Base<'l, 'a>, point: &SurfacePoint<'a>) -> Self {
        let round = |roughness: f64| FacetAxes {
            along: DVec2::X,
            alphas: DVec2::splat(ggx_alpha(roughness)),
        };
        let (specular, below) = (luminance(base.lobe.albedo), luminance(base.body));
        let share = if below > 0.0 {
            (specular / (specular + below)).clamp(0.1, 0.9)
        } else {
            1.0
        };
        let coat = point.coat.zip(base.coat.as_ref());
        let coat = coat.map(|(here, (part, layer))| {
            let weight = part.weight;
            // Faint as it is, its highlights are the strongest.
            let share = (weight * luminance(layer.albedo)).max(0.3 * weight);
            DrawnLobe::new(
                point,
                round(here.roughness),
                here.slope_std,
                here.fresnel,
                share,
            )
        });
        let left = 1.0 - coat.as_ref().map_or(0.0, |coat| coat.share);
        let under_coat = base.under_coat();
        let own = under_coat.facets.unwrap_or(round(point.roughness));
        let (slope_std, fresnel) = (point.slope_std, point.fresnel);
        Self {
            base,
            lobe: DrawnLobe::new(under_coat, own, slope_std, fresnel, left * share),
            coat,
            body_share: left * (1.0 - share),
            under_coat: point.normal_under_coat.map(|_| point.turn_to(under_coat)),
        }
    }

    /// A direction in the frame of the lobe and the body.
    fn under_coat(&self, wi: DVec3) -> DVec3 {
        self.under_coat.map_or(wi, |turn| turn * wi)
    }

    /// Whether light from a direction falls on the coat or on the surface under it.
    pub fn are_above(&self, wi: DVec3) -> bool {
        wi.z > 0.0 || self.under_coat(wi).z > 0.0
    }

    pub fn sample(&self, pick: f64, u: DVec2) -> Option<DVec3> {
        if let Some(coat) = self.coat.as_ref().filter(|coat| pick >= 1.0 - coat.share) {
            let wi = coat.facets.sample(coat.wo, u);
            return (wi.z > 0.0).then_some(wi);
        }
        let wi = if pick < self.lobe.share || self.body_share == 0.0 {
            self.lobe.facets.sample(self.lobe.wo, u)
        } else {
            let (sin, cos) = (2.0 * PI * u.x).sin_cos();
            let r = u.y.sqrt();
            DVec3::new(r * cos, r * sin, (1.0 - u.y).sqrt())
        };
        let on_top = self.under_coat.map_or(wi, |turn| turn.transpose() * wi);
        (wi.z > 0.0).then_some(on_top)
    }

    pub fn pdf(&self, wi: DVec3) -> f64 {
        let under_coat = self.under_coat(wi);
        let by_coat = self.coat.as_ref().map_or(0.0, |coat| coat.pdf(wi));
        by_coat + self.lobe.pdf(under_coat) + under_coat.z.max(0.0) / PI * self.body_share
    }

    /// About how much light of a source is sent; 0 where it surely is none. Cheap: to draw one of many by.
    pub fn likely(&self, light: &LightView, views: &LightViews) -> f64 {
        let cap = light.bound();
        let solid_angle_sr = light.solid_angle_sr(views);
        // The direction of the cap that is nearest to the mirror's, and the highest.
        let wo = self.lobe.wo;
        let mirrored = DVec3::new(-wo.x, -wo.y, wo.z);
        let towards = |to: DVec3| {
            let aside = (to - cap.axis * to.dot(cap.axis)).normalize_or_zero();
            if to.dot(cap.axis) >= cap.cos_radius {
                to
            } else {
                cap.axis * cap.cos_radius + aside * cap.sin_radius
            }
        };
        let highest = towards(DVec3::Z).z;
        if highest <= 0.0 {
            return 0.0;
        }
        let nearest = towards(mirrored);
        let sent = if nearest.z > 0.0 {
            luminance(self.eval(nearest).specular)
        } else {
            0.0
        };
        // No lobe sends more than its albedo, and all of it only to a light far larger than the lobe is wide.
        let (small, albedo) = (
            sent * solid_angle_sr,
            luminance(self.base.albedo().specular),
        );
        let specular = small * albedo / (small + albedo).max(f64::MIN_POSITIVE);
        let diffuse = luminance(self.base.body) * (solid_angle_sr / PI).min(1.0) * mean_cos(cap);
        luminance(light.radiance()) * (specular + diffuse + LEAST_LIKELY * solid_angle_sr)
    }

    /// The BRDF times the cosine.
    pub fn eval(&self, wi: DVec3) -> BaseRadiance {
        let under_coat = self.under_coat(wi);
        let bare = BaseRadiance {
            specular: self.base.lobe.of_single(self.lobe.single(under_coat)),
            diffuse: self.base.body * (under_coat.z.max(0.0) / PI),
        };
        match &self.coat {
            Some(drawn) => self
                .base
                .coated(bare, |coat| coat.of_single(drawn.single(wi))),
            None => bare,
        }
    }
}

/// About the mean over a cap of the cosines above the horizon.
fn mean_cos(cap: &Cap) -> f64 {
    let (middle, radius) = (cap.axis.z, cap.sin_radius);
    if cap.cos_radius <= 0.0 {
        0.5
    } else if middle >= radius {
        middle
    } else {
        (middle + radius).max(0.0).powi(2) / (4.0 * radius)
    }
}

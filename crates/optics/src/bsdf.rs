//! The reflection of a scratched metal by itself, for two directions and without a scene: to evaluate, to sample, to plug in elsewhere
//! (docs/model.md, section 13).
//!
//! Directions are unit vectors in the local frame, z = normal. All values hold the cosine of `wi`; densities are per steradian.

mod coat;
mod conductor;
mod directions;
mod grating;
mod layer;
mod nodes;
mod point;
mod profile;
mod spectral_mode;

pub use coat::CoatLobe;
pub use conductor::{Conductor, Overlay};
pub use directions::GrooveDirections;
pub use grating::{FineGrating, GratingLobe};
pub use layer::{Groove, LayerLobe};
pub use point::PointScratch;
pub use profile::Profile;
pub use spectral_mode::SpectralMode;

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::footprint::ScratchShare;
use crate::ggx::{ggx_alpha, ggx_eval, ggx_pdf, ggx_sample};
use crate::mask::{Mask, Masked, ScratchSums};
use crate::scratch::oblique_depth_nm;
use coat::CoatView;

/// Reflection, in parts that add up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reflected {
    /// Light off the base.
    pub base: DVec3,
    /// Light off scratches and gratings.
    pub scratches: DVec3,
}

/// A scratched metal.
#[derive(Clone, Debug)]
pub struct ScratchedBsdf {
    /// The metal, with what lies over it.
    pub conductor: Arc<Conductor>,
    /// Perceptual roughness of its base, as in glTF.
    pub roughness: f64,
    /// Standard deviation of the coherence window's amplitude.
    pub coherence_um: f64,
    /// Layers of scratches, each by its mean.
    pub layers: Vec<LayerLobe>,
    /// Scratches around one point, each by itself.
    pub points: Vec<PointScratch>,
    /// Gratings. Their shares add up to 1 at most.
    pub gratings: Vec<GratingLobe>,
    /// Coherence of the phase steps of all scratches, (8).
    pub depth_coherence: f64,
}

/// Least probability of either side, base or scratches, in a sample.
const LEAST_PICK: f64 = 0.1;

/// The material for one viewer: what does not depend on the light.
struct View<'a> {
    of: &'a ScratchedBsdf,
    mode: SpectralMode,
    wo: DVec3,
    alpha: f64,
    /// Factor on each scratch, and what the base loses.
    kept: f64,
    left: DVec3,
    left_by_gratings: DVec3,
    /// Reflectance of the layer in which scratches lie.
    fresnel: DVec3,
    coat: Option<CoatView>,
}

impl ScratchedBsdf {
    fn view(&self, wo: DVec3, mode: SpectralMode) -> View<'_> {
        let mut sums = ScratchSums::default();
        let energy = |depth: &dyn Fn() -> DVec3, share: ScratchShare, sums: &mut ScratchSums| {
            sums.add(share, depth().into(), [0.0; 3]);
        };
        for layer in &self.layers {
            let share = ScratchShare {
                segment: layer.share(),
                line: 0.0,
                cover: 1.0,
            };
            energy(&|| layer.energy(wo.z, mode), share, &mut sums);
        }
        for scratch in &self.points {
            let at = || match mode {
                SpectralMode::Rgb => scratch.energy_rgb(&self.conductor, wo.z),
                SpectralMode::Wavelength(nm) => {
                    let depth_nm = oblique_depth_nm(scratch.depth_nm, wo.z, wo.z);
                    DVec3::splat(scratch.profile.energy(depth_nm, nm))
                }
            };
            energy(&at, scratch.share, &mut sums);
        }
        let Masked { kept, taken, .. } = sums.resolve(Mask::Energy, self.depth_coherence);
        let left = DVec3::ONE - DVec3::from(taken);
        let of_grating = |it: &GratingLobe| it.taken(&self.conductor, wo, mode);
        let taken_by_gratings: DVec3 = self.gratings.iter().map(of_grating).sum();
        let left_by_gratings = (DVec3::ONE - taken_by_gratings).max(DVec3::ZERO);
        let coat = self.conductor.coat().map(|coat| coat.view(wo));
        let bare = self.conductor.reflectance(wo.z, mode);
        let fresnel = coat.as_ref().map_or(bare, |coat| coat.reflectance(bare));
        View {
            of: self,
            mode,
            wo,
            alpha: ggx_alpha(self.roughness),
            kept,
            left,
            left_by_gratings,
            fresnel,
            coat,
        }
    }

    /// The reflection from `wi` to `wo`, the cosine of `wi` inside; nothing where either is at or below the horizon.
    pub fn eval(&self, wi: DVec3, wo: DVec3, mode: SpectralMode) -> Reflected {
        match wi.z > 0.0 && wo.z > 0.0 {
            true => self.view(wo, mode).eval(wi),
            false => Reflected::default(),
        }
    }

    /// The part of [`Self::eval`] that scratches and gratings send.
    pub fn eval_scratches(&self, wi: DVec3, wo: DVec3, mode: SpectralMode) -> DVec3 {
        match wi.z > 0.0 && wo.z > 0.0 {
            true => self.view(wo, mode).scratches(wi),
            false => DVec3::ZERO,
        }
    }

    /// The density of [`Self::sample`] at `wi`. Over the hemisphere it integrates to how often a sample is not None.
    pub fn pdf(&self, wi: DVec3, wo: DVec3, mode: SpectralMode) -> f64 {
        match wi.z > 0.0 && wo.z > 0.0 {
            true => self.view(wo, mode).pdf(wi),
            false => 0.0,
        }
    }

    /// A direction with its density and its reflection. None where the one that was drawn lies below the horizon: such a sample counts as zero.
    /// `pick`, and both of `u`, are in [0, 1).
    pub fn sample(
        &self,
        wo: DVec3,
        pick: f64,
        u: DVec2,
        mode: SpectralMode,
    ) -> Option<(DVec3, f64, Reflected)> {
        if !(wo.z > 0.0) {
            return None;
        }
        let view = self.view(wo, mode);
        let wi = view.sample(pick, u).filter(|wi| wi.z > 0.0)?;
        let pdf = view.pdf(wi);
        (pdf > 0.0).then(|| (wi, pdf, view.eval(wi)))
    }
}

impl View<'_> {
    fn eval(&self, wi: DVec3) -> Reflected {
        let h = (wi + self.wo).normalize_or(DVec3::Z);
        let facet = self.of.conductor.facet(wi.dot(h), self.gain(), self.mode);
        let metal = facet * ggx_eval(wi, self.wo, self.alpha);
        // What shines from under a coat passes the scratches in it.
        let (reflected, below) = match &self.coat {
            Some(coat) => {
                let reflected = coat.part.reflected(coat.eval(wi), metal);
                (reflected, coat.part.transmitted(metal, DVec3::ZERO))
            }
            None => (metal, DVec3::ZERO),
        };
        Reflected {
            base: reflected * self.left * self.left_by_gratings + below,
            scratches: self.scratches(wi),
        }
    }

    /// Probability of drawing from the base or its coat: about their part of all light.
    fn base_pick(&self) -> f64 {
        let of = self.of;
        if of.layers.is_empty() && of.points.is_empty() && of.gratings.is_empty() {
            return 1.0;
        }
        let below = self.coat.as_ref().map_or(DVec3::ZERO, |coat| {
            let bare = of.conductor.reflectance(self.wo.z, self.mode);
            coat.part.transmitted(bare, DVec3::ZERO)
        });
        let base = self.fresnel * self.left * self.left_by_gratings + below;
        let all = (self.fresnel + below).max(DVec3::splat(1e-30));
        let bright = (base / all).element_sum() / 3.0;
        bright.clamp(LEAST_PICK, 1.0 - LEAST_PICK)
    }

    /// Relative light that multiple scattering adds to a white base, over F0.
    fn gain(&self) -> f64 {
        self.of.conductor.gain(self.of.roughness, self.wo.z)
    }

    fn scratches(&self, wi: DVec3) -> DVec3 {
        let (of, wo, mode) = (self.of, self.wo, self.mode);
        let xi = (wi + wo).truncate();
        let depth_share = 0.5 * (wi.z + wo.z);
        let mut scratches = DVec3::ZERO;
        for layer in &of.layers {
            scratches += layer.density(xi, depth_share, mode);
        }
        for scratch in &of.points {
            scratches += scratch.density(&of.conductor, xi, depth_share, of.coherence_um, mode);
        }
        let mut rows = DVec3::ZERO;
        for row in &of.gratings {
            rows += row.density(&of.conductor, wi, wo, mode);
        }
        // Densities are per d xi, which is the cosine of `wi` times the solid angle.
        self.fresnel * (scratches * self.kept + rows * self.left) * wi.z
    }

    /// Shares by which layers, scratches and gratings are drawn, in this order.
    fn shares(&self) -> impl Iterator<Item = f64> + Clone {
        let of = self.of;
        let layers = of.layers.iter().map(LayerLobe::share);
        let points = of.points.iter().map(|it| it.share.segment);
        layers
            .chain(points)
            .chain(of.gratings.iter().map(|it| it.share))
    }

    fn pdf(&self, wi: DVec3) -> f64 {
        let metal = ggx_pdf(wi, self.wo, self.alpha);
        let base = self
            .coat
            .as_ref()
            .map_or(metal, |coat| metal + coat.pick * (coat.pdf(wi) - metal));
        let base_pick = self.base_pick();
        let base = base_pick * base;
        let all: f64 = self.shares().sum();
        if base_pick == 1.0 || all <= 0.0 {
            return base;
        }
        let (of, wo, xi) = (self.of, self.wo, (wi + self.wo).truncate());
        let layers = of.layers.iter().map(|it| it.share() * it.pdf(xi, wo));
        let points = of.points.iter();
        let points = points.map(|it| it.share.segment * it.pdf(xi, of.coherence_um));
        let rows = of
            .gratings
            .iter()
            .map(|it| it.share * it.pdf(xi, self.mode));
        let drawn: f64 = layers.sum::<f64>() + points.sum::<f64>() + rows.sum::<f64>();
        base + (1.0 - base_pick) * drawn / all * wi.z
    }

    fn sample(&self, pick: f64, u: DVec2) -> Option<DVec3> {
        let (of, wo) = (self.of, self.wo);
        let base_pick = self.base_pick();
        if pick < base_pick {
            return Some(match &self.coat {
                Some(coat) if pick < coat.pick * base_pick => coat.sample(u),
                _ => ggx_sample(wo, self.alpha, u),
            });
        }
        let rest = ((pick - base_pick) / (1.0 - base_pick)).min(1.0 - f64::EPSILON);
        let all: f64 = self.shares().sum();
        let mut left = rest * all;
        for (i, share) in self.shares().enumerate() {
            if left >= share {
                left -= share;
                continue;
            }
            let again = (left / share).clamp(0.0, 1.0 - f64::EPSILON);
            let (layers, points) = (of.layers.len(), of.points.len());
            let xi = if i < layers {
                of.layers[i].sample(wo, again, u)
            } else if i < layers + points {
                of.points[i - layers].sample(of.coherence_um, u)
            } else {
                of.gratings[i - layers - points].sample(again, u, self.mode)
            };
            let at = xi - wo.truncate();
            let z2 = 1.0 - at.length_squared();
            return (z2 > 0.0).then(|| at.extend(z2.sqrt()));
        }
        None
    }
}

#[cfg(test)]
mod tests;

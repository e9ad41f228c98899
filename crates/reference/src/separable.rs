//! Light by way of grooves, each for itself: the separable |S|^2 of docs/model.md, (3) to (7), at a point.

use super::grooves::GrooveView;
use super::interval::{CutCauchy, CutNormal, normal};
use super::wavelengths::{Spectrum, WIDEST_NM, Wavelengths};
use glam::DVec3;
use hairline_cpu::surface::SurfacePoint;
use hairline_optics::diffraction::sinc;
use hairline_optics::scratch::{band_std, phase_step_energy};
use std::f64::consts::PI;

/// Half width of the distribution over u = W q that directions across a groove are drawn by: about that of sinc^2 at green.
const DRAWN_HALF_WIDTH_UM: f64 = 0.2;

/// One groove's response, made ready for many directions.
pub(super) struct Lobe<'a> {
    pub groove: &'a GrooveView,
    /// rho W/lambda times the weight of each wavelength: all but the angles and the phase.
    strength: Spectrum<DVec3>,
    nm: Spectrum<f64>,
    half_k_width: Spectrum<f64>,
    band_std: Spectrum<f64>,
    drawn_std: f64,
}

impl<'a> Lobe<'a> {
    /// `weight` holds the material's reflectance; `coherence_um` is sigma.
    pub(crate) fn new(
        groove: &'a GrooveView,
        wavelengths: &Wavelengths,
        weight: &Spectrum<DVec3>,
        coherence_um: f64,
    ) -> Self {
        let piece = &groove.piece;
        let at = |j: usize| wavelengths.nm[j];
        let strength = std::array::from_fn(|j| {
            weight[j] * (groove.share.segment * piece.width_um / (at(j) * 1e-3))
        });
        Self {
            groove,
            strength,
            nm: wavelengths.nm,
            half_k_width: wavelengths.nm.map(|nm| PI * piece.width_um / (nm * 1e-3)),
            band_std: wavelengths.nm.map(|nm| band_std(coherence_um, nm)),
            drawn_std: band_std(coherence_um, WIDEST_NM),
        }
    }

    /// The BRDF times the light's cosine, per d xi, for a direction that [`LobeDirections`] drew.
    pub(crate) fn eval(&self, to: &LobeDirection) -> DVec3 {
        // The path into the groove and out is longer the steeper both are.
        let depth_nm = self.groove.piece.depth_nm * 0.5 * (to.wi.z + self.groove.wo.z);
        (0..self.strength.len())
            .map(|j| {
                let energy = phase_step_energy(depth_nm, self.nm[j]);
                let across = sinc(self.half_k_width[j] * to.q);
                let along = normal(to.xi_t, self.band_std[j]);
                self.strength[j] * (energy * across * across * along)
            })
            .sum()
    }

    /// A way to draw directions whose components along and across the groove lie in intervals. None where the band does not
    /// reach them.
    pub(crate) fn directions(
        &self,
        along: (f64, f64),
        across: (f64, f64),
    ) -> Option<LobeDirections> {
        let wo = self.groove.wo;
        let scale = DRAWN_HALF_WIDTH_UM / self.groove.piece.width_um;
        Some(LobeDirections {
            wo,
            xi_t: CutNormal::new(self.drawn_std, wo.x + along.0, wo.x + along.1)?,
            q: CutCauchy::new(scale, wo.y + across.0, wo.y + across.1)?,
        })
    }
}

/// Directions in the band of a groove.
pub(super) struct LobeDirections {
    wo: DVec3,
    xi_t: CutNormal,
    q: CutCauchy,
}

/// One of them.
pub(super) struct LobeDirection {
    pub xi_t: f64,
    pub q: f64,
    /// Unit, in the frame of the groove.
    pub wi: DVec3,
    /// Per d xi.
    pub pdf: f64,
}

impl LobeDirections {
    /// None where no direction above the horizon has these components.
    pub(crate) fn sample(&self, u: f64, v: f64) -> Option<LobeDirection> {
        let (xi_t, q) = (self.xi_t.sample(u), self.q.sample(v));
        let wi = direction_from_cosines(xi_t - self.wo.x, q - self.wo.y)?;
        Some(LobeDirection {
            xi_t,
            q,
            wi,
            pdf: self.xi_t.pdf(xi_t) * self.q.pdf(q),
        })
    }
}

/// The unit direction above the horizon with two given components.
pub(super) fn direction_from_cosines(x: f64, y: f64) -> Option<DVec3> {
    let z2 = 1.0 - x * x - y * y;
    (z2 > 0.0).then(|| DVec3::new(x, y, z2.sqrt()))
}

/// The components along world axes that a groove's frame has.
pub(super) fn world_axes(groove: &GrooveView, point: &SurfacePoint) -> [DVec3; 2] {
    [DVec3::X, DVec3::Y].map(|axis| point.world_from_surface(groove.frame.surface_from_band(axis)))
}

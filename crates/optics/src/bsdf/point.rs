//! A scratch near one point, by itself.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;

use super::conductor::Conductor;
use super::profile::Profile;
use super::spectral_mode::SpectralMode;
use crate::footprint::ScratchShare;
use crate::scratch::band_std;
use crate::spectrum::{self, CHANNEL_MEAN_NM, WAVELENGTH_MEAN_NM};

/// Half width over which q is drawn times the width, um: about that of sinc^2 at green.
const DRAWN_UM: f64 = 0.2;

/// A scratch.
#[derive(Clone, Debug)]
pub struct PointScratch {
    /// Unit vector along it.
    pub tangent: DVec2,
    /// Width of the groove.
    pub width_um: f64,
    /// Depth of the groove.
    pub depth_nm: f64,
    /// Its cross section.
    pub profile: Profile,
    /// Share of the coherence window, or of its mean over a footprint, (20).
    pub share: ScratchShare,
}

impl PointScratch {
    /// Mean of |D|^2 in colour where both cosines are this.
    pub(super) fn energy_rgb(&self, conductor: &Conductor, cos: f64) -> DVec3 {
        let samples = spectrum::samples().iter();
        let of = samples.map(|s| {
            let energy = (self.profile).energy(self.depth_nm * cos, s.wavelength_nm);
            DVec3::from(s.weight) * conductor.shape(s.wavelength_nm) * energy
        });
        of.sum()
    }

    /// Light for each unit of xi, before the metal's own colour.
    pub(super) fn density(
        &self,
        conductor: &Conductor,
        xi: DVec2,
        depth_share: f64,
        coherence_um: f64,
        mode: SpectralMode,
    ) -> DVec3 {
        let (t, q) = (xi.dot(self.tangent), self.tangent.perp_dot(xi));
        let depth_nm = self.depth_nm * depth_share;
        let across = |nm: f64| self.profile.density(self.width_um, depth_nm, nm, q);
        let band = |nm: f64| {
            let s = band_std(coherence_um, nm);
            (-0.5 * t * t / (s * s)).exp() / ((2.0 * PI).sqrt() * s)
        };
        match mode {
            SpectralMode::Wavelength(nm) => {
                DVec3::splat(self.share.segment * across(nm) * band(nm))
            }
            SpectralMode::Rgb => {
                let bands = DVec3::from_array(CHANNEL_MEAN_NM.map(band));
                if bands.max_element() <= 0.0 {
                    return DVec3::ZERO;
                }
                let colour: DVec3 = spectrum::samples()
                    .iter()
                    .map(|s| {
                        let shape = DVec3::from(s.weight) * conductor.shape(s.wavelength_nm);
                        shape * across(s.wavelength_nm)
                    })
                    .sum();
                self.share.segment * colour * bands
            }
        }
    }

    /// The density of [`Self::sample`] for each unit of xi.
    pub(super) fn pdf(&self, xi: DVec2, coherence_um: f64) -> f64 {
        let (t, q) = (xi.dot(self.tangent), self.tangent.perp_dot(xi));
        let (s, half) = (
            band_std(coherence_um, WAVELENGTH_MEAN_NM),
            DRAWN_UM / self.width_um,
        );
        let along = s / (PI * (s * s + t * t));
        along * half / (PI * (half * half + q * q))
    }

    /// Draws xi, along the scratch by a Cauchy distribution, which is nowhere much below the bands of all colours.
    pub(super) fn sample(&self, coherence_um: f64, u: DVec2) -> DVec2 {
        let (s, half) = (
            band_std(coherence_um, WAVELENGTH_MEAN_NM),
            DRAWN_UM / self.width_um,
        );
        let cauchy = |half: f64, u: f64| half * (PI * (u - 0.5)).tan();
        cauchy(s, u.x) * self.tangent + cauchy(half, u.y) * self.tangent.perp()
    }
}

//! Light off grooves, each by itself: the separable |S|^2 of docs/model.md, (3) to (7), at a point.

use super::gratings::RowView;
use super::grooves::GrooveView;
use super::interval::{CutCauchy, CutNormal, normal};
use super::orders::Orders;
use super::wavelengths::{Spectrum, WIDEST_NM, Wavelengths};
use glam::DVec3;
use hairline_cpu::surface::SurfacePoint;
use hairline_optics::band::BandFrame;
use hairline_optics::diffraction::sinc;
use hairline_optics::grating::{Grating as Row, RigorousGrating};
use hairline_optics::groove_spectrum::GrooveSpectrum;
use hairline_optics::scratch::{band_std, phase_step_energy};
use std::f64::consts::PI;

/// Weight by which rigorous orders are drawn at least, of all light.
const LEAST_RIGOROUS: f64 = 0.01;

/// The response of a groove, or of all grooves of a grating, made ready for many directions.
pub(super) struct Lobe<'a> {
    pub frame: BandFrame,
    /// `wo` in its frame.
    wo: DVec3,
    /// Share of the window, rho; for a grating its density over the mean.
    pub share: f64,
    /// The share times the weight of each wavelength.
    strength: Spectrum<DVec3>,
    nm: Spectrum<f64>,
    band_std: Spectrum<f64>,
    drawn_std: f64,
    of: LobeSource<'a>,
}

/// Source of a lobe.
enum LobeSource<'a> {
    Groove {
        width_um: f64,
        depth_nm: f64,
        /// Half width of the distribution over u = W q that directions are drawn by.
        drawn_um: f64,
        /// Width over the width of the share.
        lit_per_share: f64,
        /// None for a narrow rectangle.
        spectrum: Option<&'a GrooveSpectrum>,
    },
    Row(Row, Option<RigorousGrating<'a>>),
}

impl<'a> Lobe<'a> {
    /// `weight` holds the material's reflectance; `coherence_um` is sigma.
    pub(crate) fn new(
        groove: &GrooveView,
        spectrum: Option<&'a GrooveSpectrum>,
        wavelengths: &Wavelengths,
        weight: &Spectrum<DVec3>,
        coherence_um: f64,
    ) -> Self {
        let of = LobeSource::Groove {
            width_um: groove.lit_um,
            lit_per_share: groove.lit_per_share,
            depth_nm: groove.piece.depth_nm,
            drawn_um: groove.drawn_um(coherence_um),
            spectrum,
        };
        Self::with_source(
            (groove.frame, groove.wo, groove.share.segment),
            of,
            wavelengths,
            weight,
            coherence_um,
        )
    }

    /// The response of a grating.
    pub(crate) fn of_row(
        view: &RowView<'a>,
        wavelengths: &Wavelengths,
        weight: &Spectrum<DVec3>,
        coherence_um: f64,
    ) -> Self {
        let of = LobeSource::Row(view.row, view.rigorous);
        let place = (view.frame, view.wo, view.density);
        let by_grooves = view
            .rigorous
            .map_or([1.0; 3], |it| it.by_grooves(view.wo.z));
        let weight = weight.map(|weight| weight * DVec3::from(by_grooves));
        Self::with_source(place, of, wavelengths, &weight, coherence_um)
    }

    fn with_source(
        (frame, wo, share): (BandFrame, DVec3, f64),
        of: LobeSource<'a>,
        wavelengths: &Wavelengths,
        weight: &Spectrum<DVec3>,
        coherence_um: f64,
    ) -> Self {
        Self {
            frame,
            wo,
            share,
            strength: weight.map(|weight| weight * share),
            nm: wavelengths.nm,
            band_std: wavelengths.nm.map(|nm| band_std(coherence_um, nm)),
            drawn_std: band_std(coherence_um, WIDEST_NM),
            of,
        }
    }

    /// The BRDF times the light's cosine, per d xi, for a direction that [`LobeDirections`] drew.
    pub(crate) fn eval(&self, to: &LobeDirection) -> DVec3 {
        // The path into the groove and out is longer the steeper both are.
        let depth_share = 0.5 * (to.wi.z + self.wo.z);
        let passed = match &self.of {
            LobeSource::Row(_, Some(rigorous)) => rigorous.passed(to.wi.z, self.wo.z).into(),
            _ => DVec3::ONE,
        };
        let sum: DVec3 = (0..self.strength.len())
            .map(|j| {
                let nm = self.nm[j];
                let across = match &self.of {
                    LobeSource::Groove {
                        width_um,
                        depth_nm,
                        lit_per_share,
                        spectrum: Some(spectrum),
                        ..
                    } => {
                        let per_um = width_um / (nm * 1e-3);
                        let row = spectrum.at_depth(depth_nm * depth_share / nm);
                        lit_per_share * per_um * row.look_up(per_um * to.q.abs())[0]
                    }
                    LobeSource::Groove {
                        width_um, depth_nm, ..
                    } => {
                        let slit = sinc(PI * width_um / (nm * 1e-3) * to.q);
                        let energy = phase_step_energy(depth_nm * depth_share, nm);
                        energy * width_um / (nm * 1e-3) * slit * slit
                    }
                    LobeSource::Row(row, None) => {
                        row.density(to.q, depth_share, nm, self.band_std[j])
                    }
                    LobeSource::Row(_, Some(rigorous)) => {
                        let viewer = [self.wo.y, self.wo.x];
                        rigorous.density(to.q, viewer, depth_share, nm, self.band_std[j])
                    }
                };
                self.strength[j] * (across * normal(to.xi_t, self.band_std[j]))
            })
            .sum();
        passed * sum
    }

    /// Distribution of directions whose components along and across the groove lie in intervals. None if the band does not
    /// reach them.
    pub(crate) fn directions(
        &self,
        along: (f64, f64),
        across: (f64, f64),
    ) -> Option<LobeDirections> {
        let (low, high) = (self.wo.y + across.0, self.wo.y + across.1);
        let q = match &self.of {
            LobeSource::Groove {
                width_um, drawn_um, ..
            } => Across::Slit(CutCauchy::new(drawn_um / width_um, low, high)?),
            LobeSource::Row(row, rigorous) => {
                // Orders that a rectangle does not send may have light.
                let least = if rigorous.is_some() {
                    LEAST_RIGOROUS
                } else {
                    0.0
                };
                let weight = |order| row.order_weight(order).max(least);
                Across::Orders(Orders::new(
                    row,
                    weight,
                    &self.nm,
                    &self.band_std,
                    low,
                    high,
                )?)
            }
        };
        Some(LobeDirections {
            wo: self.wo,
            xi_t: CutNormal::new(self.drawn_std, self.wo.x + along.0, self.wo.x + along.1)?,
            q,
        })
    }
}

/// Distribution from which q is drawn.
enum Across {
    /// About the mirror's direction.
    Slit(CutCauchy),
    /// About the orders of a grating, and a part as about the mirror's direction.
    Orders(Orders),
}

impl Across {
    fn sample(&self, v: f64) -> f64 {
        match self {
            Self::Slit(slit) => slit.sample(v),
            Self::Orders(orders) => orders.sample(v),
        }
    }

    fn pdf(&self, q: f64) -> f64 {
        match self {
            Self::Slit(slit) => slit.pdf(q),
            Self::Orders(orders) => orders.pdf(q),
        }
    }
}

/// Directions in the band of a groove.
pub(super) struct LobeDirections {
    wo: DVec3,
    xi_t: CutNormal,
    q: Across,
}

/// A direction of [`LobeDirections`].
pub(super) struct LobeDirection {
    pub xi_t: f64,
    pub q: f64,
    /// Unit, in the frame of the groove.
    pub wi: DVec3,
    /// Per d xi.
    pub pdf: f64,
}

impl LobeDirections {
    /// Draws a direction; none where no direction above the horizon has these components.
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

/// The axes of a groove's frame in world space.
pub(super) fn world_axes(frame: BandFrame, point: &SurfacePoint) -> [DVec3; 2] {
    [DVec3::X, DVec3::Y].map(|axis| point.world_from_surface(frame.surface_from_band(axis)))
}

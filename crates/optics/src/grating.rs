//! Rows of parallel grooves finer than a pixel: compact discs, foils, brushed and turned metal (docs/model.md, section 12).
//!
//! The grooves of a row interfere. Averaged over where the row lies under the pixel, what it sends falls into orders of diffraction, weakened
//! by how far the grooves are off their places as X-rays are by the warmth of a crystal (P. Debye, 1913; I. Waller, 1923), and a rest
//! that grooves send each for itself. Both depend on q alone, for a given row: [`Grating::table`] holds their integral, so that the chords
//! that a light cuts out of a scratch's band serve a row as they are.

mod incidence;
mod rigorous;
mod single;
mod table;

use num_complex::Complex64;
use std::f64::consts::PI;

use crate::cover::Cover;
use crate::diffraction::sinc;
use crate::spectrum::WAVELENGTH_MIN_NM;

pub use incidence::IncidenceRow;
pub use rigorous::RigorousGrating;
pub use single::GroovesAt;
pub use table::{GRATING_DEPTH_NM, GRATING_WIDTH_UM};

/// Number of phases at which the largest share that a row takes is sought.
const PHASES: u32 = 16;

/// A row of parallel grooves of rectangular profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grating {
    /// Mean distance from one groove to the next.
    pub pitch_um: f64,
    /// Width of each groove, at most the pitch.
    pub width_um: f64,
    /// Mean depth.
    pub depth_nm: f64,
    /// Standard deviation of a groove's depth, a share of the mean.
    pub depth_spread: f64,
    /// Standard deviation of how far a groove is off its place.
    pub jitter_um: f64,
}

impl Grating {
    /// W / pitch: the share of the surface that lies in grooves.
    pub fn fill(&self) -> f64 {
        self.width_um / self.pitch_um
    }

    /// The same row as waves see it in a plate, in which they are shorter: for the scalar step of its floors.
    #[must_use]
    pub fn in_cover(self, cover: &Cover) -> Self {
        Self {
            depth_nm: self.depth_nm * cover.ior,
            ..self
        }
    }

    /// E D: the mean over the grooves of the change of the reflection coefficient by a floor, (3). `depth_share` is the factor on depths by which
    /// an oblique path is shorter: half the sum of the cosines.
    pub(crate) fn mean_phase_step(&self, depth_share: f64, wavelength_nm: f64) -> Complex64 {
        let phase = 4.0 * PI * self.depth_nm * depth_share / wavelength_nm;
        1.0 - Complex64::from_polar(self.kept_by_spread(depth_share, wavelength_nm), -phase)
    }

    /// Magnitude of the mean over the grooves of the phase factor of a floor: 1 where all are as deep.
    fn kept_by_spread(&self, depth_share: f64, wavelength_nm: f64) -> f64 {
        let std = 4.0 * PI * self.depth_nm * depth_share / wavelength_nm * self.depth_spread;
        (-0.5 * std * std).exp()
    }

    /// E |D|^2, which is twice the real part of E D.
    pub(crate) fn mean_phase_step_energy(&self, depth_share: f64, wavelength_nm: f64) -> f64 {
        2.0 * self.mean_phase_step(depth_share, wavelength_nm).re
    }

    /// xi_n of the directions that an order sends a wavelength to: the grating equation.
    pub fn order_q(&self, order: i32, wavelength_nm: f64) -> f64 {
        f64::from(order) * wavelength_nm * 1e-3 / self.pitch_um
    }

    /// Energy that an order other than 0 sends of any wavelength, over |E D|^2; it is the same for all wavelengths.
    pub fn order_weight(&self, order: i32) -> f64 {
        self.envelope(f64::from(order) / self.pitch_um)[0] * self.order_kept(order)
    }

    /// J: the share of an order that the displacements of the grooves leave. It belongs to the order as a whole, and not to places within it.
    pub(crate) fn order_kept(&self, order: i32) -> f64 {
        let displaced = 2.0 * PI * self.jitter_um * f64::from(order) / self.pitch_um;
        (-displaced * displaced).exp()
    }

    /// Envelope of the orders from a groove's width, where the phase makes `turns_per_um` turns for each um across, and its derivative.
    fn envelope(&self, turns_per_um: f64) -> [f64; 2] {
        let x = PI * self.width_um * turns_per_um;
        let slit = sinc(x);
        let slope = if x.abs() < 1e-4 {
            -x / 3.0
        } else {
            (x.cos() - slit) / x
        };
        let fill2 = self.fill() * self.fill();
        let rise = 2.0 * slit * slope * PI * self.width_um;
        [fill2 * slit * slit, fill2 * rise]
    }

    /// (42), integrated over xi_t: the light that the row sends to q, order 0 aside, for each unit of q and of the surface that it covers.
    /// `band_std` is (5) of the wavelength.
    pub fn density(&self, q: f64, depth_share: f64, wavelength_nm: f64, band_std: f64) -> f64 {
        let kept = self.orders_about(q, wavelength_nm, band_std);
        let peaks: f64 = kept
            .map(|(order, peak)| self.order_kept(order) * peak)
            .sum();
        let together = self.envelope(1e3 / wavelength_nm * q)[0] * peaks;
        let of_mean = self.mean_phase_step(depth_share, wavelength_nm).norm_sqr();
        of_mean * together + self.rest_density(q, depth_share, wavelength_nm)
    }

    /// Orders but 0 whose peaks reach q, each with its density there.
    fn orders_about(
        &self,
        q: f64,
        wavelength_nm: f64,
        band_std: f64,
    ) -> impl Iterator<Item = (i32, f64)> {
        let spacing = self.order_q(1, wavelength_nm);
        let (nearest, reach) = ((q / spacing).round(), (6.0 * band_std / spacing).ceil());
        let orders = (nearest - reach) as i32..=(nearest + reach) as i32;
        orders.filter(|order| *order != 0).map(move |order| {
            let off = (q - f64::from(order) * spacing) / band_std;
            let peak = (-0.5 * off * off).exp() / ((2.0 * PI).sqrt() * band_std);
            (order, peak)
        })
    }

    /// The light that grooves send each for itself, as [`Self::density`].
    pub(crate) fn rest_density(&self, q: f64, depth_share: f64, wavelength_nm: f64) -> f64 {
        let per_um = 1e3 / wavelength_nm;
        let slit = sinc(PI * self.width_um * per_um * q);
        let displaced = 2.0 * PI * self.jitter_um * per_um * q;
        let alone = self.fill() * self.width_um * per_um * slit * slit;
        let step = self.mean_phase_step(depth_share, wavelength_nm);
        (2.0 * step.re - step.norm_sqr() * (-displaced * displaced).exp()) * alone
    }

    /// The share of the light that goes to an order. That of order 0 leaves in the mirror's direction.
    pub fn order_energy(&self, order: i32, depth_share: f64, wavelength_nm: f64) -> f64 {
        let step = self.mean_phase_step(depth_share, wavelength_nm);
        if order == 0 {
            (1.0 - self.fill() * step).norm_sqr()
        } else {
            self.order_weight(order) * step.norm_sqr()
        }
    }

    /// Upper bound of the share that the row takes from the mirror's direction, 1 - eta_0 of (43), over all wavelengths and angles.
    pub fn most_taken(&self) -> f64 {
        let fill = self.fill();
        // Spread depths take the most within the first turn of the phase.
        let last = (4.0 * PI * self.depth_nm / WAVELENGTH_MIN_NM).min(2.0 * PI);
        let taken = (0..=PHASES).map(|i| {
            let phase = last * f64::from(i) / f64::from(PHASES);
            let std = phase * self.depth_spread;
            let kept = (-0.5 * std * std).exp();
            let real = 1.0 - kept * phase.cos();
            2.0 * fill * real - fill * fill * (2.0 * real - 1.0 + kept * kept)
        });
        taken.fold(0.0, f64::max).clamp(1e-3, 1.0)
    }
}

#[cfg(test)]
mod tests;

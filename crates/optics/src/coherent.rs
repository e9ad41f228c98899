//! The full-wave field at one point and one wavelength: |B - S|^2 with every phase (docs/model.md, sections 2 and 9;
//! Werner, Velinov, Jakob, Hullin, *Scratch Iridescence: Wave-Optical Rendering of Diffractive Surface Structure*, 2017).
//!
//! Straight rectangular grooves under a Gaussian coherence window, by scalar diffraction: nothing is separated, averaged
//! or dropped. [`coherent_response`] sums grooves, 1 - sum of D, also where they cross; [`GrooveField`] has one floor
//! there, the deeper one.

mod cell;
mod crossings;
mod ends;
mod field;
mod lanes;
mod legendre;
mod polygon;
mod window;

pub use field::GrooveField;
pub use window::window_fourier;

use glam::DVec2;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Largest part of a term of [`GrooveField::responses`] that may be left out, relative to the window's whole integral.
const TOLERANCE: f64 = 5e-10;

/// One straight piece of a groove as seen from the point that the window is centred on, in the surface's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroovePiece {
    /// The direction t along the groove; a unit vector.
    pub tangent: DVec2,
    /// p: where the groove's middle line lies along n = N x t, from the point.
    pub offset_um: f64,
    /// Start of the piece along t, from the point; may be -infinity.
    pub start_um: f64,
    /// End of the piece along t, from the point; at or after its start, may be infinity.
    pub end_um: f64,
    /// Width W, 0 or more.
    pub width_um: f64,
    /// Depth d of the floor.
    pub depth_nm: f64,
}

impl GroovePiece {
    /// Edges of the piece along n = N x t, from the point.
    pub(crate) fn across_um(&self) -> [f64; 2] {
        let half = 0.5 * self.width_um;
        [self.offset_um - half, self.offset_um + half]
    }

    /// [`phase_step`] at its floor.
    pub fn phase_step(&self, cos_sum: f64, wavelength_nm: f64) -> Complex64 {
        phase_step(self.depth_nm, cos_sum, wavelength_nm)
    }

    /// Whether the cross sections are equal.
    pub(crate) fn has_profile_of(&self, other: &Self) -> bool {
        self.width_um == other.width_um && self.depth_nm == other.depth_nm
    }
}

/// f = |B - S|^2 / (pi sigma^2), per unit of xi's area, in the three parts that it has. Its integral over xi is 1 for
/// a mirror; as d(xi) = cos(theta_i) d(omega_i), f is a BRDF with the cosine inside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoherentResponse {
    /// |B|^2: the response of the base alone.
    pub base: f64,
    /// -2 Re(B S*): interference of base and grooves, mostly negative.
    pub cross: f64,
    /// |S|^2: the grooves, their interference with one another included.
    pub scratches: f64,
}

impl CoherentResponse {
    /// Computes the response from the amplitudes B and S in um.
    pub fn from_amplitudes(base_um: f64, scratches_um: Complex64, coherence_um: f64) -> Self {
        let per_area = 1.0 / (PI * coherence_um * coherence_um);
        Self {
            base: per_area * base_um * base_um,
            cross: -2.0 * per_area * base_um * scratches_um.re,
            scratches: per_area * scratches_um.norm_sqr(),
        }
    }

    /// f itself, never negative but by rounding.
    pub fn total(&self) -> f64 {
        self.base + self.cross + self.scratches
    }
}

/// B of (2) in um: the amplitude that a mirror sends to `xi`, the tangential part of wi + wo. Real.
pub fn base_amplitude(xi: DVec2, coherence_um: f64, wavelength_nm: f64) -> f64 {
    let wavelength_um = wavelength_nm * 1e-3;
    let a = 2.0 * PI / wavelength_um * coherence_um;
    2.0 * PI * coherence_um * coherence_um / wavelength_um
        * (-0.5 * a * a * xi.length_squared()).exp()
}

/// One piece's term of S in (33) in um, without D: the Fourier integral of the window over the piece's rectangle. The
/// window's fall across the groove counts too, so it holds for any width.
pub fn groove_amplitude(
    piece: &GroovePiece,
    xi: DVec2,
    coherence_um: f64,
    wavelength_nm: f64,
) -> Complex64 {
    let wavelength_um = wavelength_nm * 1e-3;
    let k = 2.0 * PI / wavelength_um;
    let [near, far] = piece.across_um();
    // Along first: off its band a groove without an end in sight is 0 there, at the cost of one exponential.
    let along = window_fourier(
        piece.start_um,
        piece.end_um,
        coherence_um,
        k * xi.dot(piece.tangent),
    );
    if along == Complex64::ZERO {
        return along;
    }
    let across = window_fourier(near, far, coherence_um, k * xi.dot(piece.tangent.perp()));
    2.0 * PI * coherence_um * coherence_um / wavelength_um * along * across
}

/// D = 1 - exp(-i k d (cos theta_i + cos theta_o)): the change of the reflection coefficient by a groove's floor, (3).
/// `cos_sum` is the sum of the cosines, 2 at normal incidence, where this is (3).
pub fn phase_step(depth_nm: f64, cos_sum: f64, wavelength_nm: f64) -> Complex64 {
    let half_phase = PI * depth_nm * cos_sum / wavelength_nm;
    // 1 - exp(-2ih) = 2i sin(h) exp(-ih), which does not cancel for shallow grooves.
    let (sin, cos) = half_phase.sin_cos();
    2.0 * sin * Complex64::new(sin, cos)
}

/// S of (33) in um: all grooves in the window with their phases.
pub fn scratch_amplitude<'a>(
    pieces: impl IntoIterator<Item = &'a GroovePiece>,
    xi: DVec2,
    cos_sum: f64,
    coherence_um: f64,
    wavelength_nm: f64,
) -> Complex64 {
    pieces
        .into_iter()
        .map(|piece| {
            let amplitude = groove_amplitude(piece, xi, coherence_um, wavelength_nm);
            if amplitude == Complex64::ZERO {
                amplitude
            } else {
                piece.phase_step(cos_sum, wavelength_nm) * amplitude
            }
        })
        .sum()
}

/// f of (1), exact, from the pieces in the window. `with_base` false leaves B out: the grooves alone.
pub fn coherent_response<'a>(
    pieces: impl IntoIterator<Item = &'a GroovePiece>,
    xi: DVec2,
    cos_sum: f64,
    coherence_um: f64,
    wavelength_nm: f64,
    with_base: bool,
) -> CoherentResponse {
    let s = scratch_amplitude(pieces, xi, cos_sum, coherence_um, wavelength_nm);
    let b = if with_base {
        base_amplitude(xi, coherence_um, wavelength_nm)
    } else {
        0.0
    };
    CoherentResponse::from_amplitudes(b, s, coherence_um)
}

/// The share of the window's energy exp(-|x|^2/sigma^2) that lies on the piece, (34). Grooves lower the mean reflection
/// coefficient about the point from 1 to 1 - sum of D times this share.
pub fn groove_overlap(piece: &GroovePiece, coherence_um: f64) -> f64 {
    let [near, far] = piece.across_um();
    window::energy_share(near, far, coherence_um)
        * window::energy_share(piece.start_um, piece.end_um, coherence_um)
}

//! The grooves in a window, prepared once for all directions and wavelengths.

use super::cell::{Cell, Span};
use super::crossings::{Hidden, hidden_parts};
use super::ends::IntervalEnds;
use super::lanes::{Complexes, Lanes};
use super::{CoherentResponse, GroovePiece, TOLERANCE};
use super::{base_amplitude, groove_amplitude, groove_overlap, phase_step};
use crate::vectors::with_widest;
use glam::DVec2;
use num_complex::Complex64;
use std::f64::consts::{PI, SQRT_2};

/// Number of wavelengths that [`GrooveField::responses`] computes at once.
const LANES: usize = 8;
/// Pieces up to this many sigma long are one span along.
const SHORT: f64 = 1.0;

/// The grooves in a window with one floor everywhere. [`super::coherent_response`] is the same for grooves that do not
/// cross, and else counts the area of crossings twice, which adds about the square of the share that they cover to the
/// energy.
#[derive(Clone, Debug)]
pub struct GrooveField {
    pieces: Vec<GroovePiece>,
    strips: Vec<Strip>,
    hidden: Vec<Hidden>,
    coherence_um: f64,
}

/// A piece, prepared.
#[derive(Clone, Debug)]
struct Strip {
    tangent: DVec2,
    depth_nm: f64,
    along: Along,
    across: Vec<Span>,
    /// Share of the window's integral that the piece covers, across.
    share: f64,
}

#[derive(Clone, Debug)]
enum Along {
    Short(Span),
    Long(IntervalEnds),
}

impl GrooveField {
    /// Finds the crossings: the square of the number of pieces in cheap tests, so leave out pieces that the window does
    /// not reach.
    pub fn new(pieces: Vec<GroovePiece>, coherence_um: f64) -> Self {
        let strips = pieces
            .iter()
            .filter_map(|piece| Strip::new(piece, coherence_um))
            .collect();
        let hidden = hidden_parts(&pieces, coherence_um);
        Self {
            pieces,
            strips,
            hidden,
            coherence_um,
        }
    }

    /// The grooves that it was made of.
    pub fn pieces(&self) -> &[GroovePiece] {
        &self.pieces
    }

    /// S in um, as [`super::scratch_amplitude`], less the hidden parts: (35).
    pub fn amplitude(&self, xi: DVec2, cos_sum: f64, wavelength_nm: f64) -> Complex64 {
        let wavelength_um = wavelength_nm * 1e-3;
        let k = Lanes([2.0 * PI / wavelength_um]);
        let all: Complex64 = self
            .pieces
            .iter()
            .map(|piece| {
                let amplitude = groove_amplitude(piece, xi, self.coherence_um, wavelength_nm);
                piece.phase_step(cos_sum, wavelength_nm) * amplitude
            })
            .sum();
        let hidden: Complex64 = self
            .hidden
            .iter()
            .map(|floor| {
                let sum = sum_of_cells(&floor.cells, k, xi);
                phase_step(floor.depth_nm, cos_sum, wavelength_nm)
                    * Complex64::new(sum.re.0[0], sum.im.0[0])
            })
            .sum();
        all - 2.0 * PI * self.coherence_um * self.coherence_um / wavelength_um * hidden
    }

    /// f of (1) in its three parts, as [`super::coherent_response`].
    pub fn response(
        &self,
        xi: DVec2,
        cos_sum: f64,
        wavelength_nm: f64,
        with_base: bool,
    ) -> CoherentResponse {
        let base = if with_base {
            base_amplitude(xi, self.coherence_um, wavelength_nm)
        } else {
            0.0
        };
        let scratches = self.amplitude(xi, cos_sum, wavelength_nm);
        CoherentResponse::from_amplitudes(base, scratches, self.coherence_um)
    }

    /// [`Self::amplitude`] at many wavelengths, into as many places of `out`, by series instead of error functions: off by
    /// less than 1e-8 of the base's peak amplitude.
    pub fn amplitudes(
        &self,
        xi: DVec2,
        cos_sum: f64,
        wavelengths_nm: &[f64],
        out: &mut [Complex64],
    ) {
        for (nm, out) in wavelengths_nm.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let lanes: Lanes<LANES> = Lanes(std::array::from_fn(|i| nm[i.min(nm.len() - 1)]));
            // All called functions must be inlined, or they are not compiled for each kind of vectors.
            let sums = with_widest(
                #[inline(always)]
                || self.lanes(xi, cos_sum, lanes),
            );
            for (i, out) in out.iter_mut().enumerate().take(nm.len()) {
                *out = Complex64::new(sums.re.0[i], sums.im.0[i]);
            }
        }
    }

    /// [`Self::response`] at many wavelengths, one for each element of `out`, from [`Self::amplitudes`].
    pub fn responses(
        &self,
        xi: DVec2,
        cos_sum: f64,
        wavelengths_nm: &[f64],
        with_base: bool,
        out: &mut [CoherentResponse],
    ) {
        for (nm, out) in wavelengths_nm.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let mut scratches = [Complex64::ZERO; LANES];
            self.amplitudes(xi, cos_sum, nm, &mut scratches);
            for ((&nm, scratches), out) in nm.iter().zip(scratches).zip(out) {
                let base = if with_base {
                    base_amplitude(xi, self.coherence_um, nm)
                } else {
                    0.0
                };
                *out = CoherentResponse::from_amplitudes(base, scratches, self.coherence_um);
            }
        }
    }

    /// S in um.
    #[inline(always)]
    fn lanes<const N: usize>(
        &self,
        xi: DVec2,
        cos_sum: f64,
        wavelengths_nm: Lanes<N>,
    ) -> Complexes<N> {
        let k_per_um = wavelengths_nm.map(|nm| 2e3 * PI / nm);
        let mut steps = PhaseSteps {
            half_phase_per_nm: k_per_um * (0.5e-3 * cos_sum),
            last: None,
        };
        let mut sum = Complexes::ZERO;
        for strip in &self.strips {
            if let Some(amplitude) = strip.fourier(k_per_um, xi) {
                sum = sum + steps.step(strip.depth_nm) * amplitude;
            }
        }
        for floor in &self.hidden {
            let amplitude = sum_of_cells(&floor.cells, k_per_um, xi);
            sum = sum - steps.step(floor.depth_nm) * amplitude;
        }
        let scale = k_per_um * (self.coherence_um * self.coherence_um);
        Complexes {
            re: sum.re * scale,
            im: sum.im * scale,
        }
    }

    /// The mean of the reflection coefficient, weighted by the window's energy: 1 - sum of D times share, (34).
    pub fn mean_reflection(&self, cos_sum: f64, wavelength_nm: f64) -> Complex64 {
        let taken: Complex64 = self
            .pieces
            .iter()
            .map(|piece| {
                piece.phase_step(cos_sum, wavelength_nm) * groove_overlap(piece, self.coherence_um)
            })
            .sum();
        // The window's square is a window itself.
        let hidden: Complex64 = hidden_parts(&self.pieces, self.coherence_um / SQRT_2)
            .iter()
            .map(|floor| {
                let share = sum_of_cells(&floor.cells, Lanes([0.0]), DVec2::ZERO);
                phase_step(floor.depth_nm, cos_sum, wavelength_nm) * share.re.0[0]
            })
            .sum();
        1.0 - taken + hidden
    }
}

/// The window's Fourier integral over the cells, relative to its whole integral.
#[inline(always)]
fn sum_of_cells<const N: usize>(cells: &[Cell], k_per_um: Lanes<N>, xi: DVec2) -> Complexes<N> {
    let mut sum = Complexes::ZERO;
    for cell in cells {
        sum = sum + cell.fourier(k_per_um, xi);
    }
    sum
}

impl Strip {
    /// Prepares a piece; none where the window does not reach it.
    fn new(piece: &GroovePiece, coherence_um: f64) -> Option<Self> {
        let [near, far] = piece.across_um();
        let across = Span::cover(near, far, coherence_um);
        let share: f64 = across.iter().map(Span::share).sum();
        if !(share > TOLERANCE) {
            return None;
        }
        let along = if piece.end_um - piece.start_um < SHORT * coherence_um {
            let span = Span::cover(piece.start_um, piece.end_um, coherence_um).pop()?;
            if !(share * span.share() > TOLERANCE) {
                return None;
            }
            Along::Short(span)
        } else {
            Along::Long(IntervalEnds::new(
                piece.start_um,
                piece.end_um,
                coherence_um,
            ))
        };
        Some(Self {
            tangent: piece.tangent,
            depth_nm: piece.depth_nm,
            along,
            across,
            share,
        })
    }

    /// The window's Fourier integral over the piece, relative to its whole integral; None where it is negligible.
    #[inline(always)]
    fn fourier<const N: usize>(&self, k_per_um: Lanes<N>, xi: DVec2) -> Option<Complexes<N>> {
        let kappa = k_per_um * xi.dot(self.tangent);
        // Along first: off its band a groove without an end in sight is nothing.
        let along = match &self.along {
            Along::Short(span) => span.fourier(kappa),
            Along::Long(ends) => ends.fourier(kappa, self.share)?,
        };
        let kappa = k_per_um * xi.dot(self.tangent.perp());
        let mut across = Complexes::ZERO;
        for span in &self.across {
            across = across + span.fourier(kappa);
        }
        Some(along * across)
    }
}

/// D of grooves one after another: the pieces of one groove share theirs.
struct PhaseSteps<const N: usize> {
    half_phase_per_nm: Lanes<N>,
    last: Option<(f64, Complexes<N>)>,
}

impl<const N: usize> PhaseSteps<N> {
    /// [`phase_step`] at each wavelength; the last depth's is kept.
    #[inline(always)]
    fn step(&mut self, depth_nm: f64) -> Complexes<N> {
        match self.last {
            Some((depth, step)) if depth == depth_nm => step,
            _ => {
                let (sin, cos) = (self.half_phase_per_nm * depth_nm).sin_cos();
                let step = Complexes {
                    re: sin * sin * 2.0,
                    im: sin * cos * 2.0,
                };
                self.last = Some((depth_nm, step));
                step
            }
        }
    }
}

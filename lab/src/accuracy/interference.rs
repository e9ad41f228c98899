//! Error of the incoherent sum: parallel grooves, as a row and at random, with their phases and without.
//!
//! No Monte Carlo: the field of endless parallel grooves depends on one place and one direction, which are integrated over.

use anyhow::Result;
use glam::DVec2;
use hairline_optics::coherent::{CoherentResponse, GroovePiece, scratch_amplitude};
use hairline_optics::spectrum;
use num_complex::Complex64;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

const COHERENCE_UM: f64 = 20.0;
const WIDTH_UM: f64 = 1.0;
const DEPTH_NM: f64 = 150.0;
/// Radius of the window, where its amplitude has fallen to 1e-3.
const REACH_UM: f64 = 3.7 * COHERENCE_UM;
/// Directions across the grooves, in direction cosines from the mirror direction: beside the specular peak, within the main
/// lobe of a groove.
const Q_START: f64 = 0.05;
const Q_STEP: f64 = 0.001;
const Q_COUNT: usize = 301;
/// A light's middle keeps its whole chord within these directions.
const LIGHTS: [f64; 3] = [0.002, 0.01, 0.05];
/// A pixel's Gaussian, as renders have it: half of its side.
const FILTER_STD_PX: f64 = 0.5;
const PIXEL_UM: f64 = 30.0;
const SPACINGS_UM: [f64; 11] = [
    2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 70.0, 100.0,
];
const PIXELS_UM: [f64; 6] = [10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0];
/// Spacing of the row in the figure over angle, and of the random grooves in the figure over pixels.
const SHOWN_UM: f64 = 10.0;
/// Length of the stretch of random grooves, which has at least WAY_GROOVES grooves; places on it are STEP_UM apart.
const WAY_UM: f64 = 1000.0;
const WAY_GROOVES: f64 = 60.0;
const STEP_UM: f64 = 5.0;
const SEED: u64 = 1;

/// Results of the measurement.
#[derive(Serialize, Deserialize)]
pub struct Interference {
    width_um: f64,
    depth_nm: f64,
    pub pixel_um: f64,
    pub shown_um: f64,
    /// One row and one stretch of random grooves under a small light: response over direction, in green.
    pub profiles: Vec<Profile>,
    /// Errors by spacing, for grooves in a row and at random.
    pub by_spacing: Vec<Errors>,
    /// Random grooves, by the pixel's side.
    pub by_pixel: Vec<Errors>,
}

/// Relative response of grooves over direction.
#[derive(Serialize, Deserialize)]
pub struct Profile {
    pub random: bool,
    /// q in direction cosines, the response with all phases, and that without phases between grooves.
    pub points: Vec<[f64; 3]>,
}

/// The incoherent sum's relative rms error over directions, channels and places.
#[derive(Clone, Serialize, Deserialize)]
pub struct Errors {
    pub spacing_um: f64,
    pub pixel_um: f64,
    pub random: bool,
    /// The light's angular radius with the rms.
    pub by_light: Vec<[f64; 2]>,
    /// Mean of the incoherent sum over mean of the full response.
    pub mean_ratio: f64,
}

/// Integrates it all; `quick` in larger steps.
pub fn measure(quick: bool) -> Result<Interference> {
    let shorter = if quick { 0.2 } else { 1.0 };
    let nm_step = if quick { 4 } else { 1 };
    let mut by_spacing = Vec::new();
    let mut profiles = Vec::new();
    for random in [false, true] {
        for spacing_um in SPACINGS_UM {
            let way_um = shorter * f64::max(WAY_UM, WAY_GROOVES * spacing_um);
            let seen = SeenResponses::new(&GrooveRow::new(spacing_um, random, way_um), nm_step);
            by_spacing.push(seen.errors(spacing_um, PIXEL_UM, random));
            if spacing_um == SHOWN_UM {
                profiles.push(seen.profile(random));
            }
        }
        println!("interference: spacings, random {random}");
    }
    let long_um = if quick { 1000.0 } else { 12_000.0 };
    let seen = SeenResponses::new(&GrooveRow::new(SHOWN_UM, true, long_um), 4 * nm_step);
    let by_pixel = PIXELS_UM
        .iter()
        .filter(|pixel_um| **pixel_um * 3.0 < long_um)
        .map(|pixel_um| seen.errors(SHOWN_UM, *pixel_um, true))
        .collect();
    println!("interference: pixels");
    Ok(Interference {
        width_um: WIDTH_UM,
        depth_nm: DEPTH_NM,
        pixel_um: PIXEL_UM,
        shown_um: SHOWN_UM,
        profiles,
        by_spacing,
        by_pixel,
    })
}

/// Parallel grooves, and the places that they are seen from.
struct GrooveRow {
    grooves_um: Vec<f64>,
    places_um: Vec<f64>,
    /// Whether places repeat, so that their average is any pixel's.
    periodic: bool,
}

impl GrooveRow {
    fn new(spacing_um: f64, random: bool, way_um: f64) -> Self {
        if !random {
            // One period stands for all.
            let count = (spacing_um / STEP_UM).ceil().max(4.0);
            let reach = (REACH_UM / spacing_um).ceil() as i32 + 2;
            return Self {
                grooves_um: (-reach..=reach)
                    .map(|i| f64::from(i) * spacing_um)
                    .collect(),
                places_um: (0..count as i32)
                    .map(|i| f64::from(i) / count * spacing_um)
                    .collect(),
                periodic: true,
            };
        }
        // Grooves that do not overlap, at random otherwise: gaps with an exponential distribution.
        let mut draw = Pcg64::seed_from_u64(SEED);
        let mut grooves_um = Vec::new();
        let mut at = -2.0 * REACH_UM;
        while at < way_um + 2.0 * REACH_UM {
            let gap = -(1.0 - draw.random::<f64>()).ln() * (spacing_um - WIDTH_UM);
            at += WIDTH_UM + gap;
            grooves_um.push(at);
        }
        Self {
            grooves_um,
            places_um: (0..(way_um / STEP_UM) as i32)
                .map(|i| f64::from(i) * STEP_UM)
                .collect(),
            periodic: false,
        }
    }
}

/// Responses by place and direction.
struct SeenResponses {
    /// See [`GrooveRow`].
    periodic: bool,
    places: Vec<Vec<Response>>,
}

/// Responses in linear Rec.709.
#[derive(Clone, Copy, Default)]
struct Response {
    full: [f64; 3],
    incoherent: [f64; 3],
}

impl Response {
    fn add(&mut self, other: &Self, weight: f64) {
        for c in 0..3 {
            self.full[c] += weight * other.full[c];
            self.incoherent[c] += weight * other.incoherent[c];
        }
    }
}

impl SeenResponses {
    fn new(row: &GrooveRow, nm_step: usize) -> Self {
        let places: Vec<Vec<Response>> = row
            .places_um
            .par_iter()
            .map(|place| from_place(&row.grooves_um, *place, nm_step))
            .collect();
        Self {
            periodic: row.periodic,
            places,
        }
    }

    /// Responses seen by pixels of this size: one for all places in a period, else one at each place that is far enough
    /// from the ends.
    fn pixels(&self, pixel_um: f64) -> Vec<Vec<Response>> {
        let average = |weights: &dyn Fn(usize) -> f64| {
            let mut sum = vec![Response::default(); Q_COUNT];
            let total: f64 = (0..self.places.len()).map(weights).sum();
            for (i, place) in self.places.iter().enumerate() {
                let weight = weights(i) / total;
                if weight > 1e-6 {
                    for (sum, response) in sum.iter_mut().zip(place) {
                        sum.add(response, weight);
                    }
                }
            }
            sum
        };
        if self.periodic {
            return vec![average(&|_| 1.0)];
        }
        let std = FILTER_STD_PX * pixel_um / STEP_UM;
        let margin = (2.5 * std).ceil() as usize;
        let count = self.places.len();
        let middles: Vec<usize> = (margin..count.saturating_sub(margin))
            .step_by((0.5 * std).ceil().max(1.0) as usize)
            .collect();
        middles
            .par_iter()
            .map(|middle| average(&|i| (-0.5 * ((i as f64 - *middle as f64) / std).powi(2)).exp()))
            .collect()
    }

    fn errors(&self, spacing_um: f64, pixel_um: f64, random: bool) -> Errors {
        let pixels = self.pixels(pixel_um);
        let by_light = LIGHTS.map(|light| {
            let (mut squares, mut reference) = (0.0, 0.0);
            for responses in &pixels {
                for response in lit(responses, light) {
                    for c in 0..3 {
                        squares += (response.incoherent[c] - response.full[c]).powi(2);
                        reference += response.full[c].powi(2);
                    }
                }
            }
            [light, (squares / reference).sqrt()]
        });
        let sum = |of: fn(&Response) -> f64| pixels.iter().flatten().map(of).sum::<f64>();
        Errors {
            spacing_um,
            pixel_um,
            random,
            by_light: by_light.into(),
            mean_ratio: sum(|r| r.incoherent.iter().sum()) / sum(|r| r.full.iter().sum()),
        }
    }

    /// Profile of one pixel, in green, over the response's mean.
    fn profile(&self, random: bool) -> Profile {
        let pixels = self.pixels(PIXEL_UM);
        let responses = lit(&pixels[pixels.len() / 2], LIGHTS[0]);
        let mean = responses.iter().map(|r| r.incoherent[1]).sum::<f64>() / responses.len() as f64;
        let first = Q_START + LIGHTS[0];
        let points = responses.iter().enumerate().map(|(i, r)| {
            let q = first + i as f64 * Q_STEP;
            [q, r.full[1] / mean, r.incoherent[1] / mean]
        });
        Profile {
            random,
            points: points.collect(),
        }
    }
}

/// Averages over the chord of a light, for each place of the light.
fn lit(responses: &[Response], light_rad: f64) -> Vec<Response> {
    let half = (light_rad / Q_STEP).round() as usize;
    responses
        .windows(2 * half + 1)
        .map(|window| {
            let mut sum = Response::default();
            for response in window {
                sum.add(response, 1.0 / window.len() as f64);
            }
            sum
        })
        .collect()
}

/// Responses over directions, at one place.
fn from_place(grooves_um: &[f64], place_um: f64, nm_step: usize) -> Vec<Response> {
    let pieces: Vec<GroovePiece> = grooves_um
        .iter()
        .map(|groove| groove - place_um)
        .filter(|offset| offset.abs() < REACH_UM)
        .map(|offset_um| GroovePiece {
            tangent: DVec2::X,
            offset_um,
            start_um: f64::NEG_INFINITY,
            end_um: f64::INFINITY,
            width_um: WIDTH_UM,
            depth_nm: DEPTH_NM,
        })
        .collect();
    (0..Q_COUNT)
        .map(|i| {
            let xi = DVec2::new(0.0, Q_START + i as f64 * Q_STEP);
            let mut response = Response::default();
            for sample in spectrum::samples().iter().step_by(nm_step) {
                let (mut sum, mut incoherent) = (Complex64::ZERO, 0.0);
                for piece in &pieces {
                    let alone =
                        scratch_amplitude([piece], xi, 2.0, COHERENCE_UM, sample.wavelength_nm);
                    sum += alone;
                    incoherent += CoherentResponse::of(0.0, alone, COHERENCE_UM).scratches;
                }
                let full = CoherentResponse::of(0.0, sum, COHERENCE_UM).scratches;
                // The band is narrower for shorter waves: what a light that covers it sees goes with the wavelength.
                let weight = sample.wavelength_nm * nm_step as f64;
                response.add(
                    &Response {
                        full: sample.weight.map(|w| w * full),
                        incoherent: sample.weight.map(|w| w * incoherent),
                    },
                    weight,
                );
            }
            response
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_groove_has_nothing_to_interfere_with() {
        let responses = from_place(&[3.0], 0.0, 16);
        for r in &responses {
            for c in 0..3 {
                assert!((r.full[c] - r.incoherent[c]).abs() <= 1e-12 * r.full[c].abs());
            }
        }
    }

    #[test]
    fn a_row_is_a_grating_that_a_large_light_hides() {
        let row = GrooveRow::new(10.0, false, 100.0);
        let errors = SeenResponses::new(&row, 8).errors(10.0, 30.0, false);
        let [small, .., large] = errors.by_light[..] else {
            panic!("three lights")
        };
        assert!(small[1] > 0.3, "{small:?}");
        // An order every 0.055: a light of 0.1 across holds about two.
        assert!(large[1] < 0.5 * small[1], "{large:?}");
    }
}

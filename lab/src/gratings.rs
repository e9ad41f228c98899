//! `cargo lab gratings`: the table of a grating against rows of grooves with all their phases. Writes docs/accuracy/gratings.md.
//!
//! A row of endless parallel grooves, each at a place and of a depth of its own, is summed as amplitudes over one coherence window; many rows
//! are averaged. [`Grating`] is asked for its numbers there, and for its table on the other side. The same is done of grooves at places that do not depend on
//! one another, as those of brushed metal: there the incoherent sum is all that pair statistics could tell.

use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use hairline_image::output::write_atomically;
use hairline_optics::grating::{GRATING_DEPTH_NM, GRATING_WIDTH_UM, Grating};
use hairline_optics::spectrum;
use hairline_optics::table::ScratchTable;
use num_complex::Complex64;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;

/// Options of `gratings`.
#[derive(clap::Args)]
pub struct Gratings {
    /// Rows of grooves that are averaged for each line.
    #[arg(long, default_value_t = 400)]
    rows: u32,
}

const COHERENCE_UM: f64 = 20.0;
/// Pitch and width of the grooves, in um.
const ROWS_UM: [[f64; 2]; 4] = [[0.74, 0.35], [1.6, 0.6], [10.0, 3.0], [30.0, 5.0]];
const DEPTH_NM: f64 = 110.0;
/// Mean distances from one groove at an independent place to the next.
const SPACINGS_UM: [f64; 3] = [3.0, 10.0, 30.0];
/// Standard deviations of the grooves' displacements, in pitches.
const JITTERS: [f64; 4] = [0.0, 0.05, 0.1, 0.2];
/// Angular radii of the lights.
const LIGHTS: [f64; 4] = [0.002, 0.01, 0.05, 0.3];
/// Directions across the grooves, in direction cosines from the mirror's: beyond order 0.
const Q_START: f64 = 0.02;
const Q_STEP: f64 = 0.001;
const Q_COUNT: usize = 1300;
/// Number of blocks of rows, by whose scatter noise is estimated.
const BLOCKS: u32 = 8;
const SEED: u64 = 1000;
/// The window's amplitude has fallen to 4e-5 here.
const REACH_SIGMA: f64 = 4.5;

type Rgb = [f64; 3];

/// Light that is sent to each step of q, times the step.
type SentLight = Vec<Rgb>;

impl Gratings {
    /// Measures and writes.
    pub fn run(self) -> Result<()> {
        let mut text = head(self.rows);
        let scratches = ScratchTable::new(|_| 1.0);
        let as_scratches = |row: &Grating| {
            sent(|q| {
                table_value(&scratches, row.width_um * q, row.depth_nm).map(|v| row.fill() * v)
            })
        };
        for [pitch_um, width_um] in ROWS_UM {
            for jitter in JITTERS {
                let start = Instant::now();
                let row = Grating {
                    pitch_um,
                    width_um,
                    depth_nm: DEPTH_NM,
                    depth_spread: 0.0,
                    jitter_um: jitter * pitch_um,
                };
                // Rows without jitter differ in their place alone.
                let rows = if jitter == 0.0 { 48 } else { self.rows };
                let blocks = blocks(&row, row_places_um, rows);
                let table = row.table(COHERENCE_UM, |_| 1.0);
                let by_table =
                    sent(|q| table_value(&table, GRATING_WIDTH_UM * q, GRATING_DEPTH_NM));
                let alone = as_scratches(&row);
                let _ = write!(text, "| {pitch_um} | {jitter} |");
                for light in LIGHTS {
                    let [error, noise] = relative_rms(&by_table, &blocks, light);
                    let _ = write!(text, " {:.1} ± {:.1} |", 100.0 * error, 100.0 * noise);
                }
                for light in LIGHTS {
                    let _ = write!(
                        text,
                        " {:.0} |",
                        100.0 * relative_rms(&alone, &blocks, light)[0]
                    );
                }
                text.push('\n');
                println!(
                    "{pitch_um} um, jitter {jitter}: {:.0} s",
                    start.elapsed().as_secs_f64()
                );
            }
        }
        text += INDEPENDENT;
        for pitch_um in SPACINGS_UM {
            let row = Grating {
                pitch_um,
                width_um: 1.0,
                depth_nm: DEPTH_NM,
                depth_spread: 0.0,
                jitter_um: 0.0,
            };
            let blocks = blocks(&row, independent_places_um, self.rows);
            let found = LIGHTS.map(|light| relative_rms(&as_scratches(&row), &blocks, light));
            let _ = write!(text, "| {pitch_um} |");
            for [error, noise] in found {
                let _ = write!(text, " {:.1} ± {:.1} |", 100.0 * error, 100.0 * noise);
            }
            for [_, noise] in found {
                let alone = noise * f64::from(self.rows).sqrt();
                let _ = write!(text, " {:.0} |", 100.0 * alone);
            }
            text.push('\n');
            println!("at independent places, {pitch_um} um");
        }
        text += &crate::fine_gratings::measured();
        text += IN_PICTURES;
        let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/accuracy/gratings.md");
        write_atomically(&document, text.as_bytes())?;
        println!("{}", document.display());
        Ok(())
    }
}

/// T from above.
fn table_value(table: &ScratchTable, u_um: f64, depth_nm: f64) -> Rgb {
    table.scratch_table(u_um, depth_nm)
}

/// Light that is sent, by an antiderivative over q.
fn sent(rise: impl Fn(f64) -> Rgb) -> SentLight {
    let edge = |i: usize| rise(Q_START + i as f64 * Q_STEP);
    (0..Q_COUNT)
        .map(|i| {
            let (low, high) = (edge(i), edge(i + 1));
            std::array::from_fn(|c| high[c] - low[c])
        })
        .collect()
}

/// Function that places the grooves of a row under the window: `phase` is the shift of the row, in pitches.
type Places = fn(row: &Grating, phase: f64, random: &mut Pcg64) -> Vec<f64>;

fn row_places_um(row: &Grating, phase: f64, random: &mut Pcg64) -> Vec<f64> {
    let reach = (REACH_SIGMA * COHERENCE_UM / row.pitch_um).ceil() as i32 + 2;
    (-reach..=reach)
        .map(|j| (f64::from(j) + phase) * row.pitch_um + row.jitter_um * normal(random))
        .collect()
}

/// One to a pitch in the mean.
fn independent_places_um(row: &Grating, _: f64, random: &mut Pcg64) -> Vec<f64> {
    let reach_um = REACH_SIGMA * COHERENCE_UM;
    let mut at_um = -reach_um;
    let gaps = std::iter::from_fn(|| {
        at_um -= (1.0 - random.random::<f64>()).ln() * row.pitch_um;
        (at_um < reach_um).then_some(at_um)
    });
    gaps.collect()
}

/// The mean of each of some blocks of random rows: how far they are apart is the noise.
fn blocks(row: &Grating, places_um: Places, rows: u32) -> Vec<SentLight> {
    let block = |number| full(row, places_um, rows / BLOCKS, number);
    (0..BLOCKS).map(block).collect()
}

/// The mean of random rows.
fn full(row: &Grating, places_um: Places, rows: u32, block: u32) -> SentLight {
    let all = (0..rows).into_par_iter().map(|number| {
        let mut random = Pcg64::seed_from_u64(u64::from(BLOCKS * number + block) + SEED);
        // Place of the row: evenly over the rows.
        let phase = (f64::from(number) + random.random::<f64>()) / f64::from(rows);
        let places_um = places_um(row, phase, &mut random);
        one_row(row, &places_um, &mut random)
    });
    let none = || vec![[0.0; 3]; Q_COUNT];
    let sum = all.reduce(none, |mut a, b| {
        for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
            *a += b;
        }
        a
    });
    let mean = |v: Rgb| v.map(|v| v / f64::from(rows));
    sum.into_iter().map(mean).collect()
}

/// Light of all grooves under the window, with their phases, at a wavelength of each step of the spectrum.
fn one_row(row: &Grating, places_um: &[f64], random: &mut Pcg64) -> SentLight {
    let mut sent = vec![[0.0; 3]; Q_COUNT];
    let samples = spectrum::samples();
    for pair in samples.windows(2) {
        let part = random.random::<f64>();
        let nm = (1.0 - part) * pair[0].wavelength_nm + part * pair[1].wavelength_nm;
        let weight: Rgb =
            std::array::from_fn(|c| (1.0 - part) * pair[0].weight[c] + part * pair[1].weight[c]);
        let um = nm * 1e-3;
        let k = 2.0 * PI / um;
        let floor = 1.0 - Complex64::from_polar(1.0, -4.0 * PI * row.depth_nm / nm);
        let q = |i: usize| Q_START + (i as f64 + 0.5) * Q_STEP;
        let mut fields = vec![Complex64::ZERO; Q_COUNT];
        for place_um in places_um {
            let window = (-place_um * place_um / (2.0 * COHERENCE_UM * COHERENCE_UM)).exp();
            let mut wave = Complex64::from_polar(window, -k * q(0) * place_um);
            let turn = Complex64::from_polar(1.0, -k * Q_STEP * place_um);
            for field in &mut fields {
                *field += wave;
                wave *= turn;
            }
        }
        // |S|^2/(pi sigma^2), integrated over xi_t.
        let per_area = 2.0 * PI.sqrt() / (k * COHERENCE_UM);
        for (i, (sent, field)) in sent.iter_mut().zip(&fields).enumerate() {
            let x = 0.5 * k * row.width_um * q(i);
            let slit = row.width_um / um * x.sin() / x;
            let value = per_area * slit * slit * (floor * field).norm_sqr() * Q_STEP;
            for (sent, weight) in sent.iter_mut().zip(weight) {
                *sent += weight * value;
            }
        }
    }
    sent
}

fn normal(random: &mut Pcg64) -> f64 {
    let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt();
    radius * (2.0 * PI * random.random::<f64>()).cos()
}

/// Relative rms over lights of a radius at all places and over channels, without the noise of the rows; and that noise.
fn relative_rms(found: &SentLight, blocks: &[SentLight], light: f64) -> [f64; 2] {
    let width = ((2.0 * light / Q_STEP).round() as usize).min(Q_COUNT);
    let count = blocks.len() as f64;
    let [mut errors, mut noise, mut values] = [0.0; 3];
    for first in (0..=Q_COUNT - width).step_by((width / 8).max(1)) {
        for c in 0..3 {
            let lit =
                |sent: &SentLight| -> f64 { sent[first..first + width].iter().map(|v| v[c]).sum() };
            let mean = blocks.iter().map(lit).sum::<f64>() / count;
            let spread = |block: &SentLight| (lit(block) - mean).powi(2);
            errors += (lit(found) - mean).powi(2);
            noise += blocks.iter().map(spread).sum::<f64>() / (count * (count - 1.0));
            values += mean * mean;
        }
    }
    [
        ((errors - noise).max(0.0) / values).sqrt(),
        (noise / values).sqrt(),
    ]
}

fn head(rows: u32) -> String {
    format!(
        "# Gratings against the full wave\n\n\
         Made by\n\n    cargo lab gratings\n\n\
         Endless parallel grooves {DEPTH_NM} nm deep under a window of {COHERENCE_UM} µm, in white light; 0.35, 0.6, 3 and 5 µm wide. On the one side the table of a \
         grating (model.md, section 12), on the other the field of all grooves with their phases, |S|², averaged over {rows} rows of grooves at random places about theirs. \
         Lights stand at all places across the grooves from {Q_START} to {:.2} off the mirror's direction, in direction cosines. *Jitter* is how far grooves are off their places, in \
         pitches. The first four columns are the error of the grating by the light's angular radius: relative rms over places and channels in percent, without the noise of the rows, \
         which stands behind ± and is found from {BLOCKS} blocks of them. The last four are the error of as many single scratches.\n\n\
         | pitch, µm | jitter | 0.002 rad | 0.01 | 0.05 | 0.3 | scratches, 0.002 rad | 0.01 | 0.05 | 0.3 |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
        Q_START + Q_STEP * Q_COUNT as f64
    )
}

const INDEPENDENT: &str = "\n## Dense scratches\n\n\
    The same of grooves 1 µm wide at places that do not depend on one another, as brushes and wear leave them. The first four columns are the error of the incoherent sum, that of \
    single scratches: it is the mean over such rows. So their pairs have no statistics that could lower it. The last four tell by how much one row differs from that \
    mean where a pixel is far below the window: speckles, which no statistics of a layer know.\n\n\
    | spacing, µm | 0.002 rad | 0.01 | 0.05 | 0.3 | one row, 0.002 rad | 0.01 | 0.05 | 0.3 |\n\
    |---|---|---|---|---|---|---|---|---|\n";

const IN_PICTURES: &str = "\n## In pictures\n\n\
    The angles of a compact disc's first order and what the frames of a zoom differ by are measured by the tests `orders_lie_where_the_grating_equation_says`, \
    `a_zoom_neither_steps_nor_flickers` and `frames_of_a_zoom_do_not_flicker`; [model.md](../model.md#12-gratings) has the figures.\n";

#[cfg(test)]
mod tests {
    use super::*;

    /// For a few rows, the grating is near and single scratches are far.
    #[test]
    fn a_row_is_its_table_and_not_its_scratches() {
        let row = Grating {
            pitch_um: 30.0,
            width_um: 5.0,
            depth_nm: DEPTH_NM,
            depth_spread: 0.0,
            jitter_um: 0.0,
        };
        let blocks = blocks(&row, row_places_um, 32);
        let table = row.table(COHERENCE_UM, |_| 1.0);
        let by_table = sent(|q| table_value(&table, GRATING_WIDTH_UM * q, GRATING_DEPTH_NM));
        let [error, _] = relative_rms(&by_table, &blocks, 0.01);
        assert!(error < 0.03, "{error}");
        let deeper = Grating {
            depth_nm: 1.1 * DEPTH_NM,
            ..row
        }
        .table(COHERENCE_UM, |_| 1.0);
        let wrong = sent(|q| table_value(&deeper, GRATING_WIDTH_UM * q, GRATING_DEPTH_NM));
        assert!(relative_rms(&wrong, &blocks, 0.01)[0] > 0.05);
    }
}

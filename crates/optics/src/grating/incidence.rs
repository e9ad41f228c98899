//! Table of the light that a fine row of grooves sends, by rigorous efficiencies: between the mirror's direction and q, in each colour channel, for
//! each direction to the viewer. With a viewer all angles of the light on the band's middle line are given by q, so that one row of the table serves
//! whole chords.

use super::rigorous::{RigorousGrating, cos_of};
use super::table::{Columns, Rise};
use crate::spectrum::SpectralSample;
use crate::table::{COLUMNS, ROWS, ScratchTable, TableRow};
use std::f64::consts::FRAC_PI_2;

/// Rows of a table by the component of the direction to the viewer across the grooves, over what the one along them leaves, from -1 to 1; and by the
/// angle to the plane across them, from 0 to 90 degrees.
const INCIDENCES: [usize; 2] = [64, 8];

const _: () = assert!(INCIDENCES[0] * INCIDENCES[1] == ROWS);

/// The components of a direction to a viewer across and along the grooves, at an incidence of the table or between some.
fn components(across: f64, along: f64) -> [f64; 2] {
    let (along, cos) = (along / (INCIDENCES[1] - 1) as f64 * FRAC_PI_2).sin_cos();
    let across = 2.0 * across / (INCIDENCES[0] - 1) as f64 - 1.0;
    [across * cos, along]
}

/// Place of a direction among the incidences: [`components`] backwards.
fn place([across, along]: [f64; 2]) -> [f64; 2] {
    let along = along.abs().min(1.0);
    let left = (1.0 - along * along).sqrt().max(1e-9);
    let across = (across / left).clamp(-1.0, 1.0);
    [
        0.5 * (across + 1.0) * (INCIDENCES[0] - 1) as f64,
        along.asin() / FRAC_PI_2 * (INCIDENCES[1] - 1) as f64,
    ]
}

/// An order that sends a wavelength of its own, with its light over q.
struct Sent {
    order: i32,
    nm: f64,
    /// Weight in each channel.
    weight: [f64; 3],
    first: usize,
    rises: Vec<Rise>,
}

/// A direction to the viewer, with what a flat surface sends there.
struct Viewer {
    /// Components across and along the grooves.
    direction: [f64; 2],
    cos_o: f64,
    /// The material's own spectrum at the observer's wavelengths.
    own_nm: Vec<f64>,
    /// The part in each channel that the outer face of a cover does not send.
    by_grooves: [f64; 3],
    /// What all of the spectrum weighs, without what the outer face of a cover adds.
    own: [f64; 3],
}

impl Viewer {
    /// Cosine of light at q.
    fn cos_i(&self, q: f64) -> f64 {
        let [across, along] = self.direction;
        cos_of([q - across, along])
    }
}

impl RigorousGrating<'_> {
    /// As [`Grating::table`](super::Grating::table), of which it has the columns; a row is an [incidence](IncidenceRow). The last column has half of what is missing in the
    /// mirror's direction, over the light that a flat surface sends there.
    pub fn table(&self, coherence_um: f64) -> ScratchTable {
        let samples = self.observer.samples();
        let columns = Columns::new();
        let nodes: Vec<f64> = samples.iter().map(|s| s.wavelength_nm).collect();
        let count = columns.q.len();
        let mut sent = Vec::new();
        self.row
            .for_edges(&columns, &nodes, coherence_um, |order, nm, edge, nodes| {
                let mut rises = vec![[0.0; 2]; count];
                let mut whole = vec![0.0; count + 1];
                edge.add(&columns, [1.0, 0.0], &mut rises, &mut whole);
                let first = rises.iter().position(|rise| rise[1] != 0.0);
                let risen = whole.iter().position(|whole| *whole > 0.0);
                if let (Some(first), Some(risen)) = (first, risen) {
                    sent.push(Sent {
                        order,
                        nm,
                        weight: std::array::from_fn(|c| {
                            let of = |(node, share): (usize, f64)| share * samples[node].weight[c];
                            nodes.map(of).iter().sum()
                        }),
                        first,
                        rises: rises[first..risen.min(count)].to_vec(),
                    });
                }
            });
        let rests: Vec<_> = match self.row.jitter_um > 0.0 || self.row.depth_spread > 0.0 {
            true => nodes
                .iter()
                .map(|nm| self.row.rest(&columns, *nm))
                .collect(),
            false => Vec::new(),
        };
        let mut table = ScratchTable::from_rows(ROWS, |row, sums| {
            let viewer = components((row % INCIDENCES[0]) as f64, (row / INCIDENCES[0]) as f64);
            self.fill(viewer, &columns, &sent, &rests, sums);
        });
        table.by_incidence = true;
        table
    }

    /// Adds to zeros the columns of a viewer's direction.
    fn fill(
        &self,
        direction: [f64; 2],
        columns: &Columns,
        sent: &[Sent],
        rests: &[[Vec<Rise>; 2]],
        sums: &mut [[f64; 6]],
    ) {
        let count = columns.q.len();
        let viewer = self.viewer(direction);
        self.add_orders(&viewer, sent, &mut sums[..count]);
        for (i, rest) in rests.iter().enumerate() {
            self.add_rest(&viewer, columns, i, rest, sums);
        }
        // Slopes are by the column.
        for (sum, step) in sums.iter_mut().zip(&columns.step) {
            (3..6).for_each(|c| sum[c] *= step);
        }
        let [r, g, b, ..] = sums[count - 1];
        sums[count..].fill([r, g, b, 0.0, 0.0, 0.0]);
        let missing = self.missing(&viewer);
        (0..3).for_each(|c| sums[COLUMNS - 1][c] = 0.5 * missing[c]);
    }

    fn viewer(&self, direction: [f64; 2]) -> Viewer {
        let samples = self.observer.samples();
        let cos_o = cos_of(direction);
        let own_at = |s: &SpectralSample| self.own_spectrum(cos_o, s.wavelength_nm);
        let own_nm: Vec<f64> = samples.iter().map(own_at).collect();
        let by_grooves = self.by_grooves(cos_o);
        let own = std::array::from_fn(|c| {
            let weighed = samples
                .iter()
                .zip(&own_nm)
                .map(|(s, own)| s.weight[c] * own);
            weighed.sum::<f64>() / by_grooves[c]
        });
        Viewer {
            direction,
            cos_o,
            own_nm,
            by_grooves,
            own,
        }
    }

    /// The material's own spectrum.
    fn own_spectrum(&self, cos_o: f64, nm: f64) -> f64 {
        match self.is_colored {
            true => 1.0,
            false => self.flat(cos_o, nm),
        }
    }

    /// Adds the light of the orders, each over the columns that its window spans and whole from there on.
    fn add_orders(&self, viewer: &Viewer, sent: &[Sent], sums: &mut [[f64; 6]]) {
        let mut whole = vec![[0.0; 3]; sums.len() + 1];
        for sent in sent {
            let cos_i = viewer.cos_i(self.row.order_q(sent.order, sent.nm));
            if cos_i == 0.0 {
                continue;
            }
            let depth_share = 0.5 * (cos_i + viewer.cos_o);
            let energy = self.energy(sent.order, sent.nm, viewer.direction, depth_share);
            let energy = energy * self.own_spectrum(viewer.cos_o, sent.nm);
            let passed = self.passed(cos_i, viewer.cos_o);
            let weight: [f64; 3] =
                std::array::from_fn(|c| sent.weight[c] * energy * passed[c] / viewer.own[c]);
            for (at, rise) in sent.rises.iter().enumerate() {
                let sum = &mut sums[sent.first + at];
                for c in 0..3 {
                    sum[c] += weight[c] * rise[0];
                    sum[3 + c] += weight[c] * rise[1];
                }
            }
            for c in 0..3 {
                whole[sent.first + sent.rises.len()][c] += weight[c];
            }
        }
        let mut risen = [0.0; 3];
        for (sum, whole) in sums.iter_mut().zip(&whole) {
            for c in 0..3 {
                risen[c] += whole[c];
                sum[c] += risen[c];
            }
        }
    }

    /// Adds the light that grooves send each for itself, of one of the observer's wavelengths.
    fn add_rest(
        &self,
        viewer: &Viewer,
        columns: &Columns,
        wavelength: usize,
        [alone, less]: &[Vec<Rise>; 2],
        sums: &mut [[f64; 6]],
    ) {
        let sample = &self.observer.samples()[wavelength];
        let nm = sample.wavelength_nm;
        let scale = self.rest_scale(nm, viewer.direction);
        let weight: [f64; 3] = std::array::from_fn(|c| {
            sample.weight[c] * scale * viewer.own_nm[wavelength] / viewer.own[c]
        });
        let mut value = 0.0;
        for at in 1..columns.q.len() {
            let cos_i = viewer.cos_i(columns.q[at]);
            if cos_i == 0.0 {
                if columns.q[at] > viewer.direction[0] {
                    (0..3).for_each(|c| sums[at][c] += weight[c] * value);
                }
                continue;
            }
            let step = self.row.mean_phase_step(0.5 * (cos_i + viewer.cos_o), nm);
            let (all, together) = (2.0 * step.re, step.norm_sqr());
            let of = |i: usize| all * (alone[at][i]) - together * less[at][i];
            let before = all * alone[at - 1][0] - together * less[at - 1][0];
            value += of(0) - before;
            for c in 0..3 {
                sums[at][c] += weight[c] * value;
                sums[at][3 + c] += weight[c] * of(1);
            }
        }
    }

    /// What the grooves take from the mirror's direction, over the light that a flat surface sends there.
    fn missing(&self, viewer: &Viewer) -> [f64; 3] {
        let samples = self.observer.samples();
        std::array::from_fn(|c| {
            let of = |i: usize| {
                let energy =
                    self.energy(0, samples[i].wavelength_nm, viewer.direction, viewer.cos_o);
                samples[i].weight[c] * viewer.own_nm[i] * energy
            };
            let kept = (0..samples.len()).map(of).sum::<f64>() / viewer.own[c];
            (viewer.by_grooves[c] - kept).max(0.0)
        })
    }
}

/// The part of a table that a viewer's direction sees.
#[derive(Clone, Copy, Debug)]
pub struct IncidenceRow<'a> {
    /// For q from 0 on, and below: between two components across the grooves each, at the two nearest angles along them.
    ahead: [TableRow<'a>; 2],
    behind: [TableRow<'a>; 2],
    /// Weight of the second angle.
    share: f64,
}

impl<'a> IncidenceRow<'a> {
    /// `across` and `along` are the components of the direction to the viewer, to the grooves.
    pub fn new(table: &'a ScratchTable, [across, along]: [f64; 2]) -> Self {
        let along_at = place([0.0, along])[1];
        let first = (along_at as usize).min(INCIDENCES[1] - 2);
        let rows = |across: f64| {
            let at = place([across, along])[0];
            let low = (at as usize).min(INCIDENCES[0] - 2);
            [first, first + 1]
                .map(|row| table.between_rows(row * INCIDENCES[0] + low, at - low as f64))
        };
        Self {
            ahead: rows(across),
            behind: rows(-across),
            share: along_at - first as f64,
        }
    }

    /// T at u = [`GRATING_WIDTH_UM`](super::GRATING_WIDTH_UM) q.
    #[inline]
    pub fn look_up(&self, u_um: f64) -> [f64; 3] {
        let [near, far] = if u_um < 0.0 { self.behind } else { self.ahead };
        let (near, far) = (near.look_up(u_um), far.look_up(u_um));
        std::array::from_fn(|c| near[c] + self.share * (far[c] - near[c]))
    }

    /// The energy that is missing in the mirror's direction.
    pub fn taken(&self) -> [f64; 3] {
        let (low, high) = (self.look_up(f64::NEG_INFINITY), self.look_up(f64::INFINITY));
        std::array::from_fn(|c| high[c] - low[c])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grating::Grating;
    use crate::metal::Metal;
    use crate::rigorous::{Efficiencies, FineGrooves, Medium};
    use crate::spectrum::{self, Observer};

    /// Sums over its efficiencies are what a row of a table sends to all places of an order, and what it takes; between rows nearly.
    #[test]
    fn a_table_has_the_light_of_its_efficiencies() {
        let row = Grating {
            pitch_um: 0.5,
            width_um: 0.2,
            depth_nm: 80.0,
            depth_spread: 0.0,
            jitter_um: 0.0,
        };
        let medium = Medium::Metal(Metal::Gold.into());
        let grooves = FineGrooves {
            pitch_um: row.pitch_um,
            width_um: row.width_um,
            depth_nm: row.depth_nm,
            above: 1.0,
            medium: medium.clone(),
        };
        let efficiencies = Efficiencies::new(&grooves, &|| false).unwrap();
        let rigorous = RigorousGrating {
            row,
            efficiencies: &efficiencies,
            medium: &medium,
            observer: Observer::eye(),
            is_colored: false,
            cover: None,
        };
        let table = rigorous.table(20.0);
        let green = |of: [f64; 3]| of[1];
        // Halfway between two of the eight angles along the grooves an order leaves along the surface, where light changes at once: the table is linear
        // there, which is what is left of its errors.
        for (at, most) in [
            ([40.0, 0.0], 0.01),
            ([50.0, 3.0], 0.01),
            ([40.5, 0.0], 0.03),
            ([45.3, 2.5], 0.25),
        ] {
            let viewer = components(at[0], at[1]);
            let [across, along] = viewer;
            let back = place(viewer);
            assert!((back[0] - at[0]).abs() + (back[1] - at[1]).abs() < 1e-9);
            let cos_of = |across: f64| (1.0 - along * along - across * across).max(0.0).sqrt();
            let cos_o = cos_of(across);
            let f0 = spectrum::rgb_from_reflectance(|nm| medium.reflectance(1.0, cos_o, nm));
            let of_order = |order: i32| {
                green(spectrum::rgb_from_reflectance(|nm| {
                    let cos_i = cos_of(row.order_q(order, nm) - across);
                    let is_sent = order == 0 || cos_i > 0.0;
                    let energy = rigorous.energy(order, nm, viewer, 0.5 * (cos_i + cos_o));
                    f64::from(u8::from(is_sent)) * energy * medium.reflectance(1.0, cos_o, nm)
                })) / f0[1]
            };
            let seen = IncidenceRow::new(&table, viewer);
            let first = green(seen.look_up(2.0 * 2.04)) - green(seen.look_up(0.02));
            let taken = green(seen.taken());
            println!(
                "{at:?}: sent {first:.4} of {:.4}, taken {taken:.4}, kept {:.4}",
                of_order(1),
                of_order(0)
            );
            assert!((first / of_order(1) - 1.0).abs() < most, "{at:?}");
            assert!((taken + of_order(0) - 1.0).abs() < most, "{at:?}");
            // There is no other light; the rest is absorbed.
            assert!(taken > first - 0.01);
        }
    }
}

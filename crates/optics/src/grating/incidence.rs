//! Table of the light that a fine row of grooves sends, by rigorous efficiencies: between the mirror's direction and q, in each colour channel, for
//! each direction to the viewer. With a viewer all angles of the light on the band's middle line are given by q, so that one row of the table serves
//! whole chords.

use super::Grating;
use super::table::{Columns, Rise};
use crate::cover::Cover;
use crate::rigorous::{Efficiencies, Medium};
use crate::spectrum::Observer;
use crate::table::{COLUMNS, ROWS, ScratchTable, TableRow};
use std::f64::consts::FRAC_PI_2;

/// Rows of a table by the component of the direction to the viewer across the grooves, over what the one along them leaves, from -1 to 1; and by the
/// angle to the plane across them, from 0 to 90 degrees.
const INCIDENCES: [usize; 2] = [64, 8];

const _: () = assert!(INCIDENCES[0] * INCIDENCES[1] == ROWS);

/// A row of grooves with its rigorous efficiencies, in a material.
#[derive(Clone, Copy, Debug)]
pub struct RigorousGrating<'a> {
    /// The grooves.
    pub row: Grating,
    /// Their efficiencies, without what displaces them or spreads their depths.
    pub efficiencies: &'a Efficiencies,
    /// What the channels are.
    pub observer: &'a Observer,
    /// Material whose efficiencies they are.
    pub medium: &'a Medium,
    /// Whether the grooves are in a material of another colour, which its shading brings.
    pub is_colored: bool,
    /// A plate over the grooves, of the index that the efficiencies have above them.
    pub cover: Option<Cover>,
}

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

impl RigorousGrating<'_> {
    /// As [`Grating::table`], of which it has the columns; a row is an [incidence](IncidenceRow). The last column has half of what is missing in the
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
        [across, along]: [f64; 2],
        columns: &Columns,
        sent: &[Sent],
        rests: &[[Vec<Rise>; 2]],
        sums: &mut [[f64; 6]],
    ) {
        let count = columns.q.len();
        let samples = self.observer.samples();
        let left = 1.0 - along * along;
        let cos_of = |across: f64| (left - across * across).max(0.0).sqrt();
        let cos_o = cos_of(across);
        // The material's own spectrum.
        let own_at = |nm: f64| match self.is_colored {
            true => 1.0,
            false => self.flat(cos_o, nm),
        };
        let own_nm: Vec<f64> = samples.iter().map(|s| own_at(s.wavelength_nm)).collect();
        let by_grooves = self.by_grooves(cos_o);
        // What all of it weighs, without what the outer face of a cover adds.
        let own: [f64; 3] = std::array::from_fn(|c| {
            let weighed = samples
                .iter()
                .zip(&own_nm)
                .map(|(s, own)| s.weight[c] * own);
            weighed.sum::<f64>() / by_grooves[c]
        });
        let mut whole = vec![[0.0; 3]; count + 1];
        for sent in sent {
            let q = self.row.order_q(sent.order, sent.nm);
            let cos_i = cos_of(q - across);
            if cos_i == 0.0 {
                continue;
            }
            let energy = self.energy(sent.order, sent.nm, [across, along], 0.5 * (cos_i + cos_o));
            let energy = energy * own_at(sent.nm);
            let passed = self.passed(cos_i, cos_o);
            let weight: [f64; 3] =
                std::array::from_fn(|c| sent.weight[c] * energy * passed[c] / own[c]);
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
        for (sum, whole) in sums.iter_mut().zip(&whole).take(count) {
            for c in 0..3 {
                risen[c] += whole[c];
                sum[c] += risen[c];
            }
        }
        for (i, rest) in rests.iter().enumerate() {
            let nm = samples[i].wavelength_nm;
            let scale = self.rest_scale(nm, [across, along]);
            let weight: [f64; 3] =
                std::array::from_fn(|c| samples[i].weight[c] * scale * own_nm[i] / own[c]);
            let [alone, less] = rest;
            let mut value = 0.0;
            for at in 1..count {
                let cos_i = cos_of(columns.q[at] - across);
                if cos_i == 0.0 {
                    if columns.q[at] > across {
                        (0..3).for_each(|c| sums[at][c] += weight[c] * value);
                    }
                    continue;
                }
                let step = self.row.mean_phase_step(0.5 * (cos_i + cos_o), nm);
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
        // Slopes are by the column.
        for (sum, step) in sums.iter_mut().zip(&columns.step) {
            (3..6).for_each(|c| sum[c] *= step);
        }
        let [r, g, b, ..] = sums[count - 1];
        sums[count..].fill([r, g, b, 0.0, 0.0, 0.0]);
        let kept: [f64; 3] = std::array::from_fn(|c| {
            let of = |i: usize| {
                let nm = samples[i].wavelength_nm;
                samples[i].weight[c] * own_nm[i] * self.energy(0, nm, [across, along], cos_o)
            };
            (0..samples.len()).map(of).sum::<f64>() / own[c]
        });
        (0..3).for_each(|c| sums[COLUMNS - 1][c] = 0.5 * (by_grooves[c] - kept[c]).max(0.0));
    }

    fn index_above(&self) -> f64 {
        self.cover.map_or(1.0, |cover| cover.ior)
    }

    fn flat(&self, cos_o: f64, nm: f64) -> f64 {
        self.medium.reflectance(self.index_above(), cos_o, nm)
    }

    /// The part of the light in the mirror's direction of a flat surface that its outer face does not send.
    pub fn by_grooves(&self, cos_o: f64) -> [f64; 3] {
        match (self.cover, self.medium) {
            (Some(cover), Medium::Metal(metal)) => {
                let all = cover.reflectance_seen_by(self.observer, metal, cos_o);
                cover.part_below(all, cos_o)
            }
            _ => [1.0; 3],
        }
    }

    /// Light from one angle that gets through a cover, over light from the viewer's.
    pub fn passed(&self, cos_i: f64, cos_o: f64) -> [f64; 3] {
        self.cover.map_or([1.0; 3], |cover| {
            let (to, from) = (cover.passed(cos_o), cover.passed(cos_i));
            std::array::from_fn(|c| if to[c] > 0.0 { from[c] / to[c] } else { 0.0 })
        })
    }

    /// The light that an order sends to a viewer, over that of a flat surface of the same material. Spread depths weaken the orders as in (43).
    pub fn energy(&self, order: i32, nm: f64, [across, along]: [f64; 2], depth_share: f64) -> f64 {
        let cos_o = (1.0 - across * across - along * along).max(0.0).sqrt();
        let flat = self.flat(cos_o, nm);
        let sent = self.efficiencies.efficiency(order, nm, -across, along) / flat;
        // Waves are shorter in a cover.
        let spread = self
            .row
            .kept_by_spread(self.index_above() * depth_share, nm);
        let fill = self.row.fill();
        let lost = 1.0 - spread;
        if order == 0 {
            let floor = 1.0 - fill;
            return spread * sent + lost * (floor * floor - fill * fill * spread);
        }
        spread * self.row.order_kept(order) * sent + lost * lost * self.row.order_weight(order)
    }

    /// As [`Grating::density`], to a viewer; what a cover takes of it is left out.
    pub fn density(
        &self,
        q: f64,
        viewer: [f64; 2],
        depth_share: f64,
        nm: f64,
        band_std: f64,
    ) -> f64 {
        let orders = self.row.orders_about(q, nm, band_std);
        let peaks = orders.map(|(order, peak)| self.energy(order, nm, viewer, depth_share) * peak);
        peaks.sum::<f64>() + self.rest_density(q, viewer, depth_share, nm)
    }

    /// The light that grooves send each for itself, as [`Self::density`].
    pub(crate) fn rest_density(&self, q: f64, viewer: [f64; 2], depth_share: f64, nm: f64) -> f64 {
        match self.row.rest_density(q, depth_share, nm) {
            0.0 => 0.0,
            rest => self.rest_scale(nm, viewer) * rest,
        }
    }

    /// Ratio of the light of rigorous orders to that of scalar ones: what displaced grooves take of them, they send elsewhere.
    fn rest_scale(&self, nm: f64, [across, along]: [f64; 2]) -> f64 {
        let left = 1.0 - along * along;
        let cos_of = |across: f64| (left - across * across).max(0.0).sqrt();
        let cos_o = cos_of(across);
        let flat = self.flat(cos_o, nm);
        let most = (2.0 / self.row.order_q(1, nm)) as i32;
        let (mut rigorous, mut scalar) = (0.0, 0.0);
        for order in (-most..=most).filter(|order| *order != 0) {
            let cos_i = cos_of(self.row.order_q(order, nm) - across);
            if cos_i > 0.0 {
                rigorous += self.efficiencies.efficiency(order, nm, -across, along) / flat;
                let bare = Grating {
                    jitter_um: 0.0,
                    depth_spread: 0.0,
                    ..self.row
                };
                scalar += bare.order_energy(order, 0.5 * (cos_i + cos_o), nm);
            }
        }
        if scalar > 0.0 {
            (rigorous / scalar).min(4.0)
        } else {
            0.0
        }
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
    use crate::metal::Metal;
    use crate::rigorous::FineGrooves;
    use crate::spectrum;

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

//! Table of the light that a row of grooves sends between the mirror's direction and q, in each colour channel; it is looked up as a scratch's table
//! is.

use super::Grating;
use crate::diffraction::{sinc, sinc_squared_integral};
use crate::gaussian::gaussian;
use crate::scratch::DEPTH_MAX_NM;
use crate::scratch::band_std;
use crate::spectrum::{Observer, WAVELENGTH_MIN_NM, WAVELENGTH_STEP_NM};
use crate::table::{COLUMNS, ROWS, ScratchTable, U_HALF_UM, column_u_um};
use std::f64::consts::PI;

/// Width of the scratch whose table layout a row uses: u = 2 um q. Columns are then 0.001 apart in q about the mirror's direction, 0.004 at q = 1.
pub const GRATING_WIDTH_UM: f64 = 2.0;

/// Depth of that scratch, which an oblique path scales. The row's own depths are in the table.
pub const GRATING_DEPTH_NM: f64 = DEPTH_MAX_NM;

/// There are no directions beyond |q| = 2. The table holds its value from here on.
const Q_MAX: f64 = 2.05;

/// Edges of orders are summed to this many standard deviations.
const EDGE_STD: f64 = 6.0;

/// Largest distance of the edges of neighbouring wavelengths, in standard deviations of an edge, at which their sum is smooth.
const EDGE_STEP_STD: f64 = 0.7;

/// Standard deviation of the sharpest edge that the table holds, in columns: value and slope of the nearest one tell no more.
const FINEST_COLUMNS: f64 = 0.5;

/// Orders of less than this share of the light are left out.
const LEAST_WEIGHT: f64 = 1e-8;

/// A value and its derivative by q.
pub(super) type Rise = [f64; 2];

/// One number for each column up to [`Q_MAX`].
pub(super) struct Columns {
    pub(super) q: Vec<f64>,
    /// dq for one column, there.
    pub(super) step: Vec<f64>,
}

impl Columns {
    pub(super) fn new() -> Self {
        let q: Vec<f64> = (0..COLUMNS - 1)
            .map(|column| column_u_um(column as f64) / GRATING_WIDTH_UM)
            .take_while(|q| *q < Q_MAX)
            .collect();
        let columns = (COLUMNS - 1) as f64;
        let half = U_HALF_UM / GRATING_WIDTH_UM;
        let step = q
            .iter()
            .map(|q| (q + half) * (q + half) / (half * columns))
            .collect();
        Self { q, step }
    }

    /// The first column at or beyond q.
    fn from(&self, q: f64) -> usize {
        self.q.partition_point(|at| *at < q)
    }
}

impl Grating {
    /// T_c(q, d): the light that the row sends between the mirror's direction and q, per unit of the surface that it covers, (44). `reflectance` is
    /// spectral at normal incidence, and its colour is divided out, as in [`ScratchTable::new`]. `coherence_um` is sigma: orders are as wide as the
    /// band of a scratch, across it too.
    ///
    /// A look-up at `u_um` = [`GRATING_WIDTH_UM`] q and at the depth to which [`GRATING_DEPTH_NM`] shrinks on the oblique path gives T.
    pub fn table(
        &self,
        coherence_um: f64,
        reflectance: impl Fn(f64) -> f64 + Sync,
    ) -> ScratchTable {
        self.table_seen_by(Observer::eye(), coherence_um, reflectance)
    }

    /// [`Self::table`] for the channels of an observer.
    pub fn table_seen_by(
        &self,
        observer: &Observer,
        coherence_um: f64,
        reflectance: impl Fn(f64) -> f64 + Sync,
    ) -> ScratchTable {
        let samples = observer.samples();
        let f0 = observer.channels(&reflectance);
        let columns = Columns::new();
        let count = columns.q.len();
        let nodes: Vec<f64> = samples.iter().map(|s| s.wavelength_nm).collect();
        let orders = self.orders(&columns, &nodes, coherence_um);
        // Parts in proportion to |E D|^2, and to E |D|^2, for each wavelength.
        let parts: Vec<(Vec<Rise>, Vec<Rise>)> = nodes
            .iter()
            .zip(orders)
            .map(|(nm, mut together)| {
                let [alone, less] = self.rest(&columns, *nm);
                for (sum, less) in together.iter_mut().zip(less) {
                    *sum = [sum[0] - less[0], sum[1] - less[1]];
                }
                (together, alone)
            })
            .collect();
        ScratchTable::from_rows(ROWS, |row, sums| {
            let depth_share = row as f64 / (ROWS - 1) as f64;
            for (sample, (together, alone)) in samples.iter().zip(&parts) {
                let nm = sample.wavelength_nm;
                let of_mean = self.mean_phase_step(depth_share, nm).norm_sqr();
                let mean = self.mean_phase_step_energy(depth_share, nm);
                let weight: [f64; 3] =
                    std::array::from_fn(|c| sample.weight[c] * reflectance(nm) / f0[c]);
                for ((sum, together), alone) in sums.iter_mut().zip(together).zip(alone) {
                    let value = of_mean * together[0] + mean * alone[0];
                    let slope = of_mean * together[1] + mean * alone[1];
                    for c in 0..3 {
                        sum[c] += weight[c] * value;
                        sum[3 + c] += weight[c] * slope;
                    }
                }
            }
            // Slopes are by the column.
            for (sum, step) in sums.iter_mut().zip(&columns.step) {
                (3..6).for_each(|c| sum[c] *= step);
            }
            let [r, g, b, ..] = sums[count - 1];
            sums[count..].fill([r, g, b, 0.0, 0.0, 0.0]);
        })
    }

    /// The integral over q of all orders but 0, over |E D|^2, for the wavelengths about each node: those between two nodes count for both, as a
    /// linear blend does.
    fn orders(&self, columns: &Columns, nodes: &[f64], coherence_um: f64) -> Vec<Vec<Rise>> {
        let count = columns.q.len();
        let mut sums = vec![vec![[0.0; 2]; count]; nodes.len()];
        // Weight of the orders that have risen fully before each column, for each node.
        let mut whole = vec![vec![0.0; count + 1]; nodes.len()];
        self.for_edges(columns, nodes, coherence_um, |order, nm, edge, nodes| {
            let kept = self.order_kept(order);
            let envelope = self.envelope(f64::from(order) / self.pitch_um);
            let [weight, rise_per_turn] = envelope.map(|value| kept * value);
            if weight + rise_per_turn.abs() < LEAST_WEIGHT {
                return;
            }
            for (node, share) in nodes {
                // Derivative over q.
                let rise = share * rise_per_turn / (nm * 1e-3);
                let envelope = [share * weight, rise];
                edge.add(columns, envelope, &mut sums[node], &mut whole[node]);
            }
        });
        for (sums, whole) in sums.iter_mut().zip(whole) {
            let mut risen = 0.0;
            for (sum, more) in sums.iter_mut().zip(whole) {
                risen += more;
                sum[0] += risen;
            }
        }
        sums
    }

    /// Visits the edges at which orders from 1 on begin to send a wavelength: the order, the wavelength, the edge, and the shares that it has of the
    /// nodes beside it. Edges are as near to one another as their sum needs to be smooth.
    pub(super) fn for_edges(
        &self,
        columns: &Columns,
        nodes: &[f64],
        coherence_um: f64,
        mut each: impl FnMut(i32, f64, Edge, [(usize, f64); 2]),
    ) {
        let last = (Q_MAX * self.pitch_um / (WAVELENGTH_MIN_NM * 1e-3)).ceil() as i32;
        for order in 1..=last {
            for (low, &low_nm) in nodes.iter().enumerate().take(nodes.len() - 1) {
                let q_low = self.order_q(order, low_nm);
                if q_low > Q_MAX + 0.1 {
                    break;
                }
                let at = columns.from(q_low).min(columns.q.len() - 1);
                // No finer than columns can tell.
                let finest = FINEST_COLUMNS * columns.step[at];
                let width = band_std(coherence_um, low_nm).max(finest);
                let between = self.order_q(order, WAVELENGTH_STEP_NM);
                let parts = (between / (EDGE_STEP_STD * width)).ceil().max(1.0) as usize;
                for part in 0..parts {
                    let f = (part as f64 + 0.5) / parts as f64;
                    let nm = low_nm + WAVELENGTH_STEP_NM * f;
                    let edge = Edge {
                        q: self.order_q(order, nm),
                        std: band_std(coherence_um, nm).max(finest),
                    };
                    let share = |f: f64| f / parts as f64;
                    each(
                        order,
                        nm,
                        edge,
                        [(low, share(1.0 - f)), (low + 1, share(f))],
                    );
                }
            }
        }
    }

    /// Integral over q of the light of single grooves, over E |D|^2, and of the part that is sent together instead, over |E D|^2.
    pub(super) fn rest(&self, columns: &Columns, wavelength_nm: f64) -> [Vec<Rise>; 2] {
        let wavelength_um = wavelength_nm * 1e-3;
        let (width, k) = (self.width_um, 2.0 * PI / wavelength_um);
        let scale = self.fill() * width / wavelength_um;
        let slope = |q: f64| scale * sinc(0.5 * k * width * q).powi(2);
        let alone: Vec<Rise> = columns
            .q
            .iter()
            .map(|q| {
                let integral = sinc_squared_integral(width * q, wavelength_um) / width;
                [scale * integral, slope(*q)]
            })
            .collect();
        if self.jitter_um == 0.0 {
            return [alone.clone(), alone];
        }
        let together = |q: f64| {
            let displaced = k * q * self.jitter_um;
            slope(q) * (-displaced * displaced).exp()
        };
        // Simpson's rule between columns, as fine as the integrand is.
        let finest_um = wavelength_um / (8.0 * (width + 3.0 * self.jitter_um));
        let (mut sum, mut from) = (0.0, 0.0);
        let less = columns.q.iter().map(|&q| {
            let parts = ((q - from) / finest_um).ceil().max(1.0) as usize;
            let h = (q - from) / parts as f64;
            for part in 0..parts {
                let at = from + h * part as f64;
                let sides = together(at) + together(at + h);
                sum += h / 6.0 * (sides + 4.0 * together(at + 0.5 * h));
            }
            from = q;
            [sum, together(q)]
        });
        [alone, less.collect()]
    }
}

/// The q at which an order begins to send a wavelength.
pub(super) struct Edge {
    q: f64,
    std: f64,
}

impl Edge {
    /// Adds an order and its opposite: the sum is odd in q. Each is a peak times the envelope, which is given by its value and its slope at the peak's
    /// middle.
    pub(super) fn add(
        &self,
        columns: &Columns,
        envelope: [f64; 2],
        sums: &mut [Rise],
        whole: &mut [f64],
    ) {
        let [weight, rise] = envelope;
        let reach = EDGE_STD * self.std;
        let (first, end) = (columns.from(self.q - reach), columns.from(self.q + reach));
        for (q, sum) in columns.q[first..end].iter().zip(&mut sums[first..end]) {
            let [near, far] = [(q - self.q) / self.std, (q + self.q) / self.std];
            let [near_density, far_density] = [density(near), density(far)];
            sum[0] += weight * (gaussian().cdf(near) + gaussian().cdf(far) - 1.0)
                + rise * self.std * (far_density - near_density);
            sum[1] += (weight / self.std + rise * near) * near_density
                + (weight / self.std - rise * far) * far_density;
        }
        whole[end] += weight;
    }
}

fn density(x: f64) -> f64 {
    (-0.5 * x * x).exp() / (2.0 * PI).sqrt()
}

//! A row of parallel grooves: its orders in closed form, one wavelength at each place.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

use super::conductor::Conductor;
use super::directions::GrooveDirections;
use super::spectral_mode::SpectralMode;
use crate::cover::Cover;
use crate::grating::{Grating, RigorousGrating};
use crate::rigorous::{Efficiencies, Medium};
use crate::scratch::band_std;
use crate::spectrum::{
    self, CHANNEL_MEAN_NM, Observer, WAVELENGTH_MAX_NM, WAVELENGTH_MEAN_NM, WAVELENGTH_MIN_NM,
};

/// Orders beyond this are not drawn by themselves.
const MOST_ORDERS: i32 = 64;
/// Probability of drawing about the mirror's direction, for what grooves send each for itself.
const REST_PICK: f64 = 0.1;
/// Half width over which that is drawn times the groove's width, um.
const DRAWN_UM: f64 = 0.2;
/// Nodes of what a row takes, over either component of the viewer, from -1 to 1.
const TAKEN_NODES: usize = 33;
/// Nodes of rigorous ones, which change at once where an order sets.
const FINE_TAKEN_NODES: usize = 129;
/// Probability of drawing any of the orders alike; of rigorous ones, whose energies change over the angle.
const EVENLY: f64 = 0.02;
const FINE_EVENLY: f64 = 0.2;
/// Wavelength at which energies of rigorous orders are those that they are drawn by.
const DRAWN_NM: f64 = 550.0;
/// Steps of the sum over what grooves send each for themselves.
const REST_STEPS: usize = 64;

/// Rigorous efficiencies of a fine grating, with what they depend on besides the grooves.
#[derive(Clone, Debug)]
pub struct FineGrating {
    /// The efficiencies.
    pub efficiencies: Arc<Efficiencies>,
    /// Metal of the grooves.
    pub medium: Medium,
    /// A plate over the grooves.
    pub cover: Option<Cover>,
}

/// A grating by its scalar theory, (42), or by rigorous efficiencies.
#[derive(Clone, Debug)]
pub struct GratingLobe {
    row: Grating,
    fine: Option<FineGrating>,
    /// Share of the surface that it covers.
    pub share: f64,
    /// Unit vector along the grooves.
    along: DVec2,
    /// Standard deviation of their directions at any place.
    angle_std_rad: f64,
    coherence_um: f64,
    conductor_shape: Vec<DVec3>,
    /// Probability of each order that is drawn, and the sum up to it.
    orders: Vec<(i32, f64, f64)>,
    /// What it takes of the mirror's direction in colour, over the light that comes from below the outer face of a cover; by the viewer's components
    /// along and across the grooves.
    taken: Vec<DVec3>,
}

impl GratingLobe {
    /// A grating on a metal, scalar where it is not `fine`. The row of a scalar one under a cover is that [in the cover](Grating::in_cover).
    pub fn new(
        conductor: &Conductor,
        row: Grating,
        fine: Option<FineGrating>,
        share: f64,
        directions: GrooveDirections,
        coherence_um: f64,
    ) -> Self {
        let farthest = (2e3 * row.pitch_um / WAVELENGTH_MIN_NM).floor() as i32;
        let most = farthest.clamp(1, MOST_ORDERS);
        let rigorous = fine.as_ref().map(|fine| fine.rigorous(row));
        let drawn = |m| match &rigorous {
            Some(rigorous) => rigorous.energy(m, DRAWN_NM, [0.0; 2], 1.0),
            None => row.order_weight(m),
        };
        let weights = (1..=most).flat_map(|m| [m, -m]);
        let weights: Vec<_> = weights.map(|m| (m, drawn(m))).collect();
        let evenly = if fine.is_some() { FINE_EVENLY } else { EVENLY };
        let all: f64 = weights.iter().map(|(_, w)| w).sum();
        // Rows whose light goes nowhere in orders draw all of them alike.
        let (by_weight, evenly) = match all > 1e-30 {
            true => ((1.0 - evenly) / all, evenly),
            false => (0.0, 1.0),
        };
        let least = evenly / weights.len() as f64;
        let mut sum = 0.0;
        let orders = weights.into_iter().map(|(m, weight)| {
            let probability = by_weight * weight + least;
            sum += probability;
            (m, probability, sum)
        });
        let orders: Vec<_> = orders.collect();
        let samples = spectrum::samples();
        let shape = samples.iter().map(|s| conductor.shape(s.wavelength_nm));
        let mut made = Self {
            row,
            fine,
            share,
            along: DVec2::from_angle(directions.mean_rad),
            angle_std_rad: directions.std_rad,
            coherence_um,
            conductor_shape: shape.collect(),
            orders,
            taken: Vec::new(),
        };
        let per_side = made.taken_nodes();
        let component = |i: usize| 2.0 * i as f64 / (per_side - 1) as f64 - 1.0;
        let nodes = (0..per_side * per_side).into_par_iter().map(|i| {
            let wo = DVec2::new(component(i / per_side), component(i % per_side));
            let colours = samples.iter().zip(&made.conductor_shape);
            colours
                .map(|(s, shape)| {
                    DVec3::from(s.weight) * shape * made.taken_of(wo, s.wavelength_nm)
                })
                .sum()
        });
        made.taken = nodes.collect();
        made
    }

    fn rigorous(&self) -> Option<RigorousGrating<'_>> {
        self.fine.as_ref().map(|fine| fine.rigorous(self.row))
    }

    fn taken_nodes(&self) -> usize {
        match self.fine {
            Some(_) => FINE_TAKEN_NODES,
            None => TAKEN_NODES,
        }
    }

    /// What is missing in the mirror's direction at one wavelength, for a viewer by its components along and across the grooves: the light of all
    /// other orders whose directions lie above the horizon, and what grooves send each for itself; of a rigorous one also what they absorb.
    fn taken_of(&self, wo: DVec2, nm: f64) -> f64 {
        let cos_o = (1.0 - wo.length_squared()).max(0.0).sqrt();
        if let Some(rigorous) = self.rigorous() {
            return (1.0 - rigorous.energy(0, nm, [wo.y, wo.x], cos_o)).max(0.0);
        }
        let farthest = (2e3 * self.row.pitch_um / nm).floor() as i32;
        let together: f64 = (-farthest..=farthest)
            .filter(|order| *order != 0)
            .map(|order| {
                let y = self.row.order_q(order, nm) - wo.y;
                let z2 = 1.0 - wo.x * wo.x - y * y;
                if z2 <= 0.0 {
                    return 0.0;
                }
                let step = self.row.mean_phase_step(0.5 * (cos_o + z2.sqrt()), nm);
                self.row.order_weight(order) * step.norm_sqr()
            })
            .sum();
        let rest = match self.has_rest() {
            true => self.rest_taken(wo, nm),
            false => 0.0,
        };
        together + rest
    }

    /// What grooves send each for itself to all directions above the horizon: a sum over even steps of the angle along the middle of the band.
    fn rest_taken(&self, wo: DVec2, nm: f64) -> f64 {
        let radius = (1.0 - wo.x * wo.x).max(0.0).sqrt();
        let cos_o = (1.0 - wo.length_squared()).max(0.0).sqrt();
        let step = PI / REST_STEPS as f64;
        let each = (0..REST_STEPS).map(|i| {
            let (sine, cosine) = ((i as f64 + 0.5) * step).sin_cos();
            let (q, z) = (wo.y + radius * cosine, radius * sine);
            self.row.rest_density(q, 0.5 * (cos_o + z), nm) * radius * sine * step
        });
        each.sum()
    }

    fn in_frame(&self, v: DVec2) -> DVec2 {
        DVec2::new(v.dot(self.along), self.along.perp_dot(v))
    }

    /// Share of the base's light that the grating takes for a viewer.
    pub(super) fn taken(&self, conductor: &Conductor, wo: DVec3, mode: SpectralMode) -> DVec3 {
        let share = self.share * self.by_grooves(conductor, wo.z, mode);
        let wo = self.in_frame(wo.truncate());
        match mode {
            SpectralMode::Wavelength(nm) => share * self.taken_of(wo, nm),
            SpectralMode::Rgb => {
                let per_side = self.taken_nodes();
                let at = (wo + 1.0) * (0.5 * (per_side - 1) as f64);
                let low = at
                    .floor()
                    .clamp(DVec2::ZERO, DVec2::splat((per_side - 2) as f64));
                let f = (at - low).clamp(DVec2::ZERO, DVec2::ONE);
                let first = low.x as usize * per_side + low.y as usize;
                let pair = |i: usize| self.taken[i].lerp(self.taken[i + 1], f.y);
                share * pair(first).lerp(pair(first + per_side), f.x)
            }
        }
    }

    /// The part of the metal's reflection that a cover's outer face does not send; all of it for scalar rows, as in pictures.
    fn by_grooves(&self, conductor: &Conductor, cos_o: f64, mode: SpectralMode) -> DVec3 {
        match self.fine {
            Some(_) => conductor.part_below(cos_o, mode),
            None => DVec3::ONE,
        }
    }

    /// Standard deviation along the grooves, (45), at a wavelength.
    fn along_std(&self, q: f64, nm: f64) -> f64 {
        band_std(self.coherence_um, nm).hypot(self.angle_std_rad * q)
    }

    /// Light for each unit of xi, before the metal's own colour.
    pub(super) fn density(
        &self,
        conductor: &Conductor,
        wi: DVec3,
        wo: DVec3,
        mode: SpectralMode,
    ) -> DVec3 {
        let at = self.in_frame((wi + wo).truncate());
        let (t, q) = (at.x, at.y);
        let depth_share = 0.5 * (wi.z + wo.z);
        let band = |nm: f64| normal(t, self.along_std(q, nm));
        let rigorous = self.rigorous();
        let to_viewer = self.in_frame(wo.truncate());
        let viewer = [to_viewer.y, to_viewer.x];
        // Light goes through a cover twice.
        let share = match &rigorous {
            Some(rigorous) => {
                let passed = DVec3::from(rigorous.passed(wi.z, wo.z));
                self.share * passed * self.by_grooves(conductor, wo.z, mode)
            }
            None => DVec3::splat(self.share),
        };
        match mode {
            SpectralMode::Wavelength(nm) => {
                let s = band_std(self.coherence_um, nm);
                let across = match &rigorous {
                    Some(rigorous) => rigorous.density(q, viewer, depth_share, nm, s),
                    None => self.row.density(q, depth_share, nm, s),
                };
                share * across * band(nm)
            }
            SpectralMode::Rgb => {
                let orders: DVec3 = self
                    .at_place(q)
                    .map(|(order, nm)| {
                        // One wavelength of the order leaves here; its spectrum is wider than the order.
                        let weight = DVec3::from(spectrum::weight_per_nm(nm)) * conductor.shape(nm);
                        let energy = match &rigorous {
                            Some(rigorous) => rigorous.energy(order, nm, viewer, depth_share),
                            None => self.row.order_energy(order, depth_share, nm),
                        };
                        let per_q = 1e3 * self.row.pitch_um / f64::from(order.abs());
                        weight * (energy * per_q * band(nm))
                    })
                    .sum();
                let bands = DVec3::from_array(CHANNEL_MEAN_NM.map(band));
                let rest = match self.has_rest() && bands.max_element() > 0.0 {
                    true => self.rest(q, viewer, depth_share),
                    false => DVec3::ZERO,
                };
                share * (orders + rest * bands)
            }
        }
    }

    /// Orders that send a visible wavelength to q, with it.
    fn at_place(&self, q: f64) -> impl Iterator<Item = (i32, f64)> + '_ {
        let path_nm = 1e3 * q.abs() * self.row.pitch_um;
        let (first, last) = (path_nm / WAVELENGTH_MAX_NM, path_nm / WAVELENGTH_MIN_NM);
        let sign = if q < 0.0 { -1 } else { 1 };
        let orders = (first.ceil() as i32).max(1)..=(last.floor() as i32);
        orders.map(move |m| (sign * m, path_nm / f64::from(m)))
    }

    fn has_rest(&self) -> bool {
        self.row.jitter_um > 0.0 || self.row.depth_spread > 0.0
    }

    /// What grooves send each for itself, in colour.
    fn rest(&self, q: f64, viewer: [f64; 2], depth_share: f64) -> DVec3 {
        let rigorous = self.rigorous();
        let at = |nm: f64| match &rigorous {
            Some(rigorous) => rigorous.rest_density(q, viewer, depth_share, nm),
            None => self.row.rest_density(q, depth_share, nm),
        };
        let colours = spectrum::samples().iter().zip(&self.conductor_shape);
        let each = colours.map(|(s, shape)| DVec3::from(s.weight) * shape * at(s.wavelength_nm));
        each.sum()
    }

    fn rest_pick(&self) -> f64 {
        if self.has_rest() { REST_PICK } else { 0.0 }
    }

    /// Standard deviation along the grooves that xi is drawn by.
    fn drawn_std(&self, q: f64, mode: SpectralMode) -> f64 {
        match mode {
            SpectralMode::Wavelength(nm) => self.along_std(q, nm),
            SpectralMode::Rgb => self.along_std(q, WAVELENGTH_MEAN_NM),
        }
    }

    /// The density of [`Self::sample`] for each unit of xi.
    pub(super) fn pdf(&self, xi: DVec2, mode: SpectralMode) -> f64 {
        let at = self.in_frame(xi);
        let (t, q) = (at.x, at.y);
        let rest_pick = self.rest_pick();
        let half = DRAWN_UM / self.row.width_um;
        let rest = rest_pick * half / (PI * (half * half + q * q));
        let orders: f64 = match mode {
            SpectralMode::Wavelength(nm) => {
                let s = band_std(self.coherence_um, nm);
                let each = self
                    .orders
                    .iter()
                    .map(|(m, p, _)| p * normal(q - self.row.order_q(*m, nm), s));
                each.sum()
            }
            SpectralMode::Rgb => {
                let each = self.orders.iter().map(|(m, p, _)| {
                    let [low, high] =
                        [WAVELENGTH_MIN_NM, WAVELENGTH_MAX_NM].map(|nm| self.row.order_q(*m, nm));
                    let inside = (q - low) * (q - high) <= 0.0;
                    if inside { p / (high - low).abs() } else { 0.0 }
                });
                each.sum()
            }
        };
        (rest + (1.0 - rest_pick) * orders) * cauchy(t, self.drawn_std(q, mode))
    }

    /// Draws xi.
    pub(super) fn sample(&self, pick: f64, u: DVec2, mode: SpectralMode) -> DVec2 {
        let rest_pick = self.rest_pick();
        let quantile = |half: f64, u: f64| half * (PI * (u - 0.5)).tan();
        let q = if pick < rest_pick {
            quantile(DRAWN_UM / self.row.width_um, u.x)
        } else {
            let all = self.orders.last().map_or(1.0, |it| it.2);
            let place = (pick - rest_pick) / (1.0 - rest_pick) * all;
            let i = self
                .orders
                .partition_point(|it| it.2 <= place)
                .min(self.orders.len() - 1);
            let order = self.orders[i].0;
            match mode {
                SpectralMode::Wavelength(nm) => {
                    let s = band_std(self.coherence_um, nm);
                    self.row.order_q(order, nm)
                        + s * spec_math::cephes64::ndtri(u.x.clamp(1e-12, 1.0 - 1e-12))
                }
                SpectralMode::Rgb => self.row.order_q(
                    order,
                    WAVELENGTH_MIN_NM + u.x * (WAVELENGTH_MAX_NM - WAVELENGTH_MIN_NM),
                ),
            }
        };
        let t = quantile(self.drawn_std(q, mode), u.y);
        t * self.along + q * self.along.perp()
    }
}

impl FineGrating {
    fn rigorous(&self, row: Grating) -> RigorousGrating<'_> {
        RigorousGrating {
            row,
            efficiencies: &self.efficiencies,
            observer: Observer::eye(),
            medium: &self.medium,
            is_colored: false,
            cover: self.cover,
        }
    }
}

fn normal(x: f64, std: f64) -> f64 {
    let z = x / std;
    (-0.5 * z * z).exp() / ((2.0 * PI).sqrt() * std)
}

fn cauchy(x: f64, half: f64) -> f64 {
    half / (PI * (half * half + x * x))
}

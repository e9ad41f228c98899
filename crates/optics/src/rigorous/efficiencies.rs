//! Table of the efficiencies of a fine grating: order by wavelength by incidence across the grooves and along them.
//!
//! Incidence is sampled where one set of coupled waves serves all orders: at fixed components across the grooves in wavelengths over the pitch.
//! Along the grooves a perfect conductor knows no incidence of its own: it sends light as at the wavelength and the angle that are left across them,
//! both divided by the cosine to that plane. A table follows that rule from one sampled cosine to the next, and holds what a metal does otherwise.

#[cfg(not(target_arch = "wasm32"))]
use super::coupled_waves::{CoupledWaves, Relief};
use crate::fresnel;
use crate::metal::MetalIndex;
use num_complex::Complex64;
use rayon::prelude::*;

/// Material of grooves.
#[derive(Clone, Debug, PartialEq)]
pub enum Medium {
    /// A metal of measured index.
    Metal(MetalIndex),
    /// A clear material of a refractive index.
    Dielectric(f64),
}

impl Medium {
    /// Unpolarised reflectance of a flat surface under a medium of the index `above`, by the cosine in air.
    pub fn reflectance(&self, above: f64, cos_theta: f64, wavelength_nm: f64) -> f64 {
        let index = self.index(wavelength_nm) / above;
        fresnel::conductor(fresnel::inner_cos(cos_theta, above), index.re, index.im)
    }

    pub(crate) fn index(&self, wavelength_nm: f64) -> Complex64 {
        match self {
            Self::Metal(metal) => {
                let (n, k) = metal.n_k(wavelength_nm);
                Complex64::new(n, k)
            }
            Self::Dielectric(ior) => Complex64::from(*ior),
        }
    }
}

/// Rectangular grooves, which are symmetric.
#[derive(Clone, Debug, PartialEq)]
pub struct FineGrooves {
    /// Distance from one groove to the next.
    pub pitch_um: f64,
    /// Width of each, at most the pitch.
    pub width_um: f64,
    /// Depth.
    pub depth_nm: f64,
    /// Refractive index above them.
    pub above: f64,
    /// Material that they are in.
    pub medium: Medium,
}

/// Cosines to the plane across the grooves that are sampled: powers of this one. Between two of them wavelengths are shifted by up to a step, and a
/// metal's index with them: steps are so small that
/// resonances of silver stay where they are.
const COS_STEP: f64 = 0.94;
const COS_COUNT: usize = 19;
/// Sampled wavelengths: those of the visible, and as far beyond as one step of the cosine shifts them.
const FIRST_NM: f64 = 350.0;
const STEP_NM: f64 = 10.0;
const NM_COUNT: usize = 49;
/// Largest distance of sampled incidences, in components across the grooves.
const INCIDENCE_STEP: f64 = 0.03;
/// A component across the grooves is this much off where two orders are each other's mirror images, in wavelengths over the pitch.
#[cfg(not(target_arch = "wasm32"))]
const OFF_MIRROR: f64 = 1e-6;

/// Efficiencies at one wavelength.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Incidences to one order.
    per_order: i32,
    /// The highest order that may leave.
    most: i32,
    /// Ordered by cosine, by incidence from 0 on, by order from the lowest on; NaN where light comes from below the horizon.
    pub(super) values: Vec<f32>,
}

/// The table.
#[derive(Clone, Debug, PartialEq)]
pub struct Efficiencies {
    pitch_um: f64,
    /// Reflectance of a flat surface, straight from above, at each sampled wavelength.
    flat: Vec<f64>,
    pub(super) columns: Vec<Column>,
}

fn sampled_nm(column: usize) -> f64 {
    FIRST_NM + STEP_NM * column as f64
}

fn sampled_cos(i: usize) -> f64 {
    COS_STEP.powi(i as i32)
}

impl Column {
    /// Nothing but its sizes.
    fn new(grooves: &FineGrooves, wavelength_nm: f64) -> Self {
        let pitch = grooves.pitch_um * 1e3 / wavelength_nm;
        // From one order's mirror image to the next.
        let per_half = (0.5 / pitch / INCIDENCE_STEP).ceil().max(1.0) as i32;
        let mut column = Self {
            per_order: 2 * per_half,
            most: (2.0 * pitch).floor() as i32,
            values: Vec::new(),
        };
        let samples = column.incidences(grooves.pitch_um, wavelength_nm) * column.orders();
        column.values = vec![f32::NAN; COS_COUNT * samples];
        column
    }

    #[cfg(target_arch = "wasm32")]
    fn fill(&mut self, _: &FineGrooves, _: f64) {
        unreachable!("gratings of pages keep scalar orders")
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn fill(&mut self, grooves: &FineGrooves, wavelength_nm: f64) {
        let incidences = self.incidences(grooves.pitch_um, wavelength_nm);
        let orders = self.orders();
        let relief = Relief::lamellar(
            grooves.pitch_um,
            grooves.width_um,
            grooves.depth_nm,
            grooves.above,
            grooves.medium.index(wavelength_nm),
        );
        let kept = kept_orders(grooves);
        for part in 0..=self.per_order / 2 {
            let bloch = f64::from(part) / f64::from(self.per_order) + OFF_MIRROR;
            let waves = CoupledWaves::new(&relief, wavelength_nm, bloch, kept);
            for cos in 0..COS_COUNT {
                let cosine = sampled_cos(cos);
                for from in waves.reflected((1.0 - cosine * cosine).sqrt()) {
                    let at = part + from.order * self.per_order;
                    // A row of symmetric grooves is its own mirror image.
                    for sign in [1, -1] {
                        if sign * at < 0 || sign * at >= incidences as i32 {
                            continue;
                        }
                        let first = (cos * incidences + (sign * at) as usize) * orders;
                        for order in -self.most..=self.most {
                            let to = from.order + sign * order + kept;
                            let sent = from.efficiencies.get(to.max(0) as usize);
                            let sent = sent.map_or(0.0, |[s, p]| 0.5 * (s + p));
                            self.values[first + (order + self.most) as usize] = sent as f32;
                        }
                    }
                }
            }
        }
    }

    fn incidences(&self, pitch_um: f64, wavelength_nm: f64) -> usize {
        (pitch_um * 1e3 / wavelength_nm * f64::from(self.per_order)).ceil() as usize + 1
    }

    fn orders(&self) -> usize {
        2 * self.most as usize + 1
    }

    /// Efficiency at a sampled cosine, for a component across the grooves from 0 to that cosine.
    fn efficiency(
        &self,
        pitch_um: f64,
        wavelength_nm: f64,
        cos: usize,
        across: f64,
        order: i32,
    ) -> f64 {
        let per_component = pitch_um * 1e3 / wavelength_nm * f64::from(self.per_order);
        let incidences = self.incidences(pitch_um, wavelength_nm);
        let mirror = if order == 0 { 1.0 } else { 0.0 };
        if order.abs() > self.most {
            return mirror;
        }
        let place = across * per_component;
        let low = (place as usize).min(incidences - 2);
        let value = |i: usize| {
            let first = (cos * incidences + i) * self.orders();
            f64::from(self.values[first + (order + self.most) as usize])
        };
        let (near, mut far, mut end) = (value(low), value(low + 1), (low + 1) as f64);
        if near.is_nan() {
            return mirror;
        }
        if far.is_nan() {
            // At the horizon a surface is a mirror.
            (far, end) = (mirror, sampled_cos(cos) * per_component);
        }
        let share = (place - low as f64) / (end - low as f64).max(1e-9);
        near + share.clamp(0.0, 1.0) * (far - near)
    }
}

/// Orders of the coupled waves to each side, for errors of the efficiencies of about 1 %.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn kept_orders(grooves: &FineGrooves) -> i32 {
    (12.0 + 9.0 * grooves.pitch_um * grooves.above) as i32
}

impl Efficiencies {
    /// Computes them all: seconds, on all cores. None where `cancelled` says so, which is asked from any thread.
    pub fn new(grooves: &FineGrooves, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let mut all = Self::empty(grooves);
        let columns = all.columns.par_iter_mut().enumerate();
        let filled = columns.try_for_each(|(i, column)| {
            column.fill(grooves, sampled_nm(i));
            (!cancelled()).then_some(())
        });
        filled.map(|()| all)
    }

    fn empty(grooves: &FineGrooves) -> Self {
        let flat = |i| {
            grooves
                .medium
                .reflectance(grooves.above, 1.0, sampled_nm(i))
        };
        Self {
            pitch_um: grooves.pitch_um,
            // A medium of the index above has none, and sends nothing.
            flat: (0..NM_COUNT).map(|i| flat(i).max(1e-9)).collect(),
            columns: (0..NM_COUNT)
                .map(|i| Column::new(grooves, sampled_nm(i)))
                .collect(),
        }
    }

    /// All numbers, to be kept in a file.
    pub fn values(&self) -> impl Iterator<Item = f32> {
        self.columns
            .iter()
            .flat_map(|column| column.values.iter().copied())
    }

    /// [`Self::values`] backwards; none if they are more or fewer than those of the grooves.
    pub fn from_values(
        grooves: &FineGrooves,
        values: impl IntoIterator<Item = f32>,
    ) -> Option<Self> {
        let mut all = Self::empty(grooves);
        let mut values = values.into_iter();
        for value in all.columns.iter_mut().flat_map(|column| &mut column.values) {
            *value = values.next()?;
        }
        values.next().is_none().then_some(all)
    }

    /// The share of unpolarised light that an order sends back. It comes from a direction with the components `across` and `along` the
    /// grooves; the one that it leaves in has `across` - order times wavelength over pitch with the same sign, as seen from the surface on the other side.
    pub(crate) fn efficiency(
        &self,
        order: i32,
        wavelength_nm: f64,
        across: f64,
        along: f64,
    ) -> f64 {
        let cos = (1.0 - along * along).max(0.0).sqrt();
        let order = if across < 0.0 { -order } else { order };
        let across = across.abs().min(cos);
        let place = (cos.max(1e-3).ln() / COS_STEP.ln()).min((COS_COUNT - 1) as f64);
        let low = (place as usize).min(COS_COUNT - 2);
        let [from, to] = [low, low + 1].map(sampled_cos);
        let share = ((from - cos.max(to)) / (from - to)).clamp(0.0, 1.0);
        let own = self.flat_at(wavelength_nm);
        let sampled = |i: usize| {
            let scale = sampled_cos(i) / cos.max(1e-9);
            own * self.over_flat(i, order, wavelength_nm * scale, across * scale)
        };
        if share == 0.0 {
            return sampled(low);
        }
        (1.0 - share) * sampled(low) + share * sampled(low + 1)
    }

    /// Efficiency over the reflectance of a flat surface, at a sampled cosine: a metal's colour is that of its own wavelength, and not of the one to
    /// which the cosine shifts it.
    fn over_flat(&self, cos: usize, order: i32, wavelength_nm: f64, across: f64) -> f64 {
        let (low, share) = wavelength_step(wavelength_nm);
        let at = |i: usize| {
            self.columns[i].efficiency(self.pitch_um, sampled_nm(i), cos, across, order)
                / self.flat[i]
        };
        (1.0 - share) * at(low) + share * at(low + 1)
    }

    fn flat_at(&self, wavelength_nm: f64) -> f64 {
        let (low, share) = wavelength_step(wavelength_nm);
        (1.0 - share) * self.flat[low] + share * self.flat[low + 1]
    }
}

/// The sampled wavelength below one, and how far it is from there to the next.
fn wavelength_step(wavelength_nm: f64) -> (usize, f64) {
    let place = ((wavelength_nm - FIRST_NM) / STEP_NM).clamp(0.0, (NM_COUNT - 1) as f64);
    let low = (place as usize).min(NM_COUNT - 2);
    (low, place - low as f64)
}

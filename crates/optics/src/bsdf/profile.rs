//! What a groove of any cross section sends across itself.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;

use crate::diffraction::sinc;
use crate::groove_spectrum::GrooveSpectrum;
use crate::scratch::phase_step_energy;
use crate::section::{GrooveShape, Section};

/// The cross section of narrow grooves: rectangles, or a grid over depth and angle.
#[derive(Clone, Default)]
pub struct Profile {
    grid: Option<Arc<GrooveSpectrum>>,
}

/// Columns of a table for a width and a wavelength: what does not depend on depth.
pub(super) struct Across {
    widths: f64,
    columns: Vec<f64>,
}

impl Profile {
    /// Computes the grid of a section.
    pub fn new(section: &Section) -> Self {
        let shape = GrooveShape {
            section: section.clone(),
            width_class: 0,
        };
        let is_rectangle = shape == GrooveShape::default();
        Self {
            grid: (!is_rectangle).then(|| GrooveSpectrum::new(&shape).into()),
        }
    }

    /// Light for each unit of q: the mean of |D|^2 over the groove is its integral.
    pub(super) fn density(&self, width_um: f64, depth_nm: f64, nm: f64, q: f64) -> f64 {
        let widths = width_um * 1e3 / nm;
        match &self.grid {
            Some(grid) => widths * grid.at_depth(depth_nm / nm).look_up((widths * q).abs())[0],
            None => {
                let slit = sinc(PI * widths * q);
                phase_step_energy(depth_nm, nm) * widths * slit * slit
            }
        }
    }

    /// Values of q of a table's columns, as [`Self::add`] takes them.
    pub(super) fn column_places(&self, width_um: f64, nm: f64, columns: &[f64]) -> Across {
        let widths = width_um * 1e3 / nm;
        let at = |q: &f64| match &self.grid {
            Some(_) => widths * q,
            None => widths * sinc(PI * widths * q).powi(2),
        };
        Across {
            widths,
            columns: columns.iter().map(at).collect(),
        }
    }

    /// Adds the densities at columns, for a depth, times a weight.
    pub(super) fn add(
        &self,
        across: &Across,
        depth_nm: f64,
        nm: f64,
        weight: DVec3,
        sums: &mut [DVec3],
    ) {
        match &self.grid {
            Some(grid) => {
                let row = grid.at_depth(depth_nm / nm);
                for (sum, u) in sums.iter_mut().zip(&across.columns) {
                    *sum += weight * (across.widths * row.look_up(*u)[0]);
                }
            }
            None => {
                let weight = weight * phase_step_energy(depth_nm, nm);
                for (sum, slit) in sums.iter_mut().zip(&across.columns) {
                    *sum += weight * *slit;
                }
            }
        }
    }

    /// Mean of |D|^2 over the groove.
    pub(super) fn energy(&self, depth_nm: f64, nm: f64) -> f64 {
        match &self.grid {
            Some(grid) => 2.0 * grid.at_depth(depth_nm / nm).limit,
            None => phase_step_energy(depth_nm, nm),
        }
    }
}

impl std::fmt::Debug for Profile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = if self.grid.is_some() {
            "grid"
        } else {
            "rectangle"
        };
        f.write_str(name)
    }
}

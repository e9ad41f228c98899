//! A metal by its n and k: reflectances over the angle, in colour and at a wavelength.

use glam::DVec3;

use super::spectral_mode::{SpectralMode, rgb};
use crate::fresnel;
use crate::ggx::{ggx_albedo, ggx_alpha, unit_clamp};
use crate::metal::Metal;
use crate::spectrum::{WAVELENGTH_COUNT, WAVELENGTH_MIN_NM, WAVELENGTH_STEP_NM};

/// Nodes over the square root of the cosine.
const NODES: usize = 513;
/// Nodes and steps of the albedo of the base's lobe.
const ALBEDO_NODES: usize = 65;
const ALBEDO_STEPS: usize = 64;

/// A metal.
#[derive(Clone, Debug)]
pub struct Conductor {
    /// n and k every 5 nm from 380 to 780 nm.
    n_k: Vec<[f64; 2]>,
    /// Reflectance in colour, and that times the reflectance at normal incidence.
    nodes: Vec<[DVec3; 2]>,
    /// Reflectance at normal incidence in colour.
    f0: DVec3,
    /// Albedo of the lobe of F = 1 at one roughness, and that roughness.
    albedo: (f64, Vec<f64>),
}

impl Conductor {
    /// A metal of n and k every 5 nm from 380 to 780 nm, under a base of this roughness. None where their number is another.
    pub fn new(n_k: Vec<[f64; 2]>, roughness: f64) -> Option<Self> {
        if n_k.len() != WAVELENGTH_COUNT {
            return None;
        }
        let at = |cos: f64, nm: f64| reflectance(&n_k, cos, nm);
        let nodes = (0..NODES).map(|i| {
            let root = i as f64 / (NODES - 1) as f64;
            let once = rgb(|nm| at(root * root, nm));
            [once, rgb(|nm| at(root * root, nm) * at(1.0, nm))]
        });
        let nodes: Vec<_> = nodes.collect();
        let f0 = rgb(|nm| at(1.0, nm));
        let albedos = (0..ALBEDO_NODES).map(|i| {
            let root = i as f64 / (ALBEDO_NODES - 1) as f64;
            ggx_albedo(root * root, ggx_alpha(roughness), ALBEDO_STEPS)
        });
        let albedo = (roughness, albedos.collect());
        Some(Self {
            n_k,
            nodes,
            f0,
            albedo,
        })
    }

    /// A measured metal.
    pub fn of_metal(metal: Metal, roughness: f64) -> Self {
        let nm = |i: usize| WAVELENGTH_MIN_NM + i as f64 * WAVELENGTH_STEP_NM;
        let n_k = (0..WAVELENGTH_COUNT).map(|i| metal.n_k(nm(i)).into());
        Self::new(n_k.collect(), roughness).expect("as many as there are wavelengths")
    }

    /// Reflectance of a flat surface.
    pub(super) fn reflectance(&self, cos: f64, mode: SpectralMode) -> DVec3 {
        match mode {
            SpectralMode::Rgb => self.node(cos)[0],
            SpectralMode::Wavelength(nm) => DVec3::splat(reflectance(&self.n_k, cos, nm)),
        }
    }

    /// Reflectance of a facet with what is scattered more than once, `gain` times as much on a white surface.
    pub(super) fn facet(&self, cos: f64, gain: f64, mode: SpectralMode) -> DVec3 {
        match mode {
            SpectralMode::Rgb => {
                let [once, twice] = self.node(cos);
                once + twice * gain
            }
            SpectralMode::Wavelength(nm) => {
                let straight = reflectance(&self.n_k, 1.0, nm);
                DVec3::splat(reflectance(&self.n_k, cos, nm) * (1.0 + straight * gain))
            }
        }
    }

    /// Reflectance at normal incidence at a wavelength, over that in each channel: the shape of the spectrum.
    pub(super) fn shape(&self, nm: f64) -> DVec3 {
        reflectance(&self.n_k, 1.0, nm) / self.f0
    }

    /// Light of multiple scattering over that of single scattering where F = 1, at the roughness that it was made for.
    pub(super) fn gain(&self, roughness: f64, cos_o: f64) -> f64 {
        debug_assert_eq!(roughness, self.albedo.0);
        let (i, share) = place(cos_o, ALBEDO_NODES);
        let e0 = self.albedo.1[i] + share * (self.albedo.1[i + 1] - self.albedo.1[i]);
        1.0 / e0.clamp(1e-3, 1.0) - 1.0
    }

    fn node(&self, cos: f64) -> [DVec3; 2] {
        let (i, share) = place(cos, NODES);
        [0, 1].map(|k| self.nodes[i][k].lerp(self.nodes[i + 1][k], share))
    }
}

fn place(cos: f64, nodes: usize) -> (usize, f64) {
    let at = unit_clamp(cos).sqrt() * (nodes - 1) as f64;
    let i = (at as usize).min(nodes - 2);
    (i, at - i as f64)
}

fn reflectance(n_k: &[[f64; 2]], cos: f64, nm: f64) -> f64 {
    let last = (n_k.len() - 1) as f64;
    let at = ((nm - WAVELENGTH_MIN_NM) / WAVELENGTH_STEP_NM).clamp(0.0, last);
    let i = (at as usize).min(n_k.len() - 2);
    let share = at - i as f64;
    let [n, k] = [0, 1].map(|j| n_k[i][j] + share * (n_k[i + 1][j] - n_k[i][j]));
    fresnel::conductor(cos, n, k)
}

//! A metal by its n and k: reflectances over the angle, in colour and at a wavelength.

use glam::DVec3;

use super::coat::CoatLobe;
use super::nodes::place;
use super::spectral_mode::{SpectralMode, rgb};
use crate::cover::Cover;
use crate::fresnel;
use crate::ggx::{ggx_albedo, ggx_alpha};
use crate::metal::MetalIndex;
use crate::spectrum::{WAVELENGTH_COUNT, WAVELENGTH_MIN_NM, WAVELENGTH_STEP_NM};

/// Nodes over the square root of the cosine.
const NODES: usize = 513;
/// Nodes and steps of the albedo of the base's lobe.
const ALBEDO_NODES: usize = 65;
const ALBEDO_STEPS: usize = 64;

/// The clear layer over a metal.
#[derive(Clone, Debug)]
pub enum Overlay {
    /// None.
    Bare,
    /// A coat. Scratches and gratings lie in it, and send white's spectrum.
    Coat(CoatLobe),
    /// A plate, which light passes to and fro. At wavelengths it has to be grey.
    Cover(Cover),
}

/// A metal.
#[derive(Clone, Debug)]
pub struct Conductor {
    /// n and k every 5 nm from 380 to 780 nm.
    n_k: Vec<[f64; 2]>,
    overlay: Overlay,
    /// Reflectance in colour, and that times the reflectance at normal incidence.
    nodes: Vec<[DVec3; 2]>,
    /// Reflectance of the bare metal at normal incidence in colour.
    f0: DVec3,
    /// Albedo of the lobe of F = 1 at one roughness, and that roughness.
    albedo: (f64, Vec<f64>),
}

impl Conductor {
    /// A metal under a layer, as a base of this roughness.
    pub fn new(metal: impl Into<MetalIndex>, overlay: Overlay, roughness: f64) -> Self {
        let metal = metal.into();
        let nm = |i: usize| WAVELENGTH_MIN_NM + i as f64 * WAVELENGTH_STEP_NM;
        let n_k: Vec<_> = (0..WAVELENGTH_COUNT)
            .map(|i| metal.n_k(nm(i)).into())
            .collect();
        let bare = |cos: f64, nm: f64| bare(&n_k, cos, nm);
        let nodes = (0..NODES).map(|i| {
            let root = i as f64 / (NODES - 1) as f64;
            let cos = root * root;
            if let Overlay::Cover(cover) = &overlay {
                // Light that facets scatter once more meets the plate once more.
                let [once, straight] =
                    [cos, 1.0].map(|cos| cover.reflectance_rgb(&metal, cos).into());
                return [once, once * straight];
            }
            let once = rgb(|nm| bare(cos, nm));
            [once, rgb(|nm| bare(cos, nm) * bare(1.0, nm))]
        });
        let nodes: Vec<[DVec3; 2]> = nodes.collect();
        let f0 = rgb(|nm| bare(1.0, nm));
        let albedos = (0..ALBEDO_NODES).map(|i| {
            let root = i as f64 / (ALBEDO_NODES - 1) as f64;
            ggx_albedo(root * root, ggx_alpha(roughness), ALBEDO_STEPS)
        });
        let albedo = (roughness, albedos.collect());
        Self {
            n_k,
            overlay,
            nodes,
            f0,
            albedo,
        }
    }

    /// A bare metal.
    pub fn of_metal(metal: impl Into<MetalIndex>, roughness: f64) -> Self {
        Self::new(metal, Overlay::Bare, roughness)
    }

    /// The coat over it.
    pub(super) fn coat(&self) -> Option<&CoatLobe> {
        match &self.overlay {
            Overlay::Coat(coat) => Some(coat),
            _ => None,
        }
    }

    /// Reflectance of a flat surface.
    pub(super) fn reflectance(&self, cos: f64, mode: SpectralMode) -> DVec3 {
        match mode {
            SpectralMode::Rgb => self.node(cos)[0],
            SpectralMode::Wavelength(nm) => DVec3::splat(self.at_wavelength(cos, nm)),
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
                let straight = self.at_wavelength(1.0, nm);
                DVec3::splat(self.at_wavelength(cos, nm) * (1.0 + straight * gain))
            }
        }
    }

    /// The spectrum of scratches and gratings, over its mean in each channel: that of the metal's reflectance at normal incidence, or white's in a
    /// coat.
    pub(super) fn shape(&self, nm: f64) -> DVec3 {
        match &self.overlay {
            Overlay::Coat(_) => DVec3::ONE,
            _ => bare(&self.n_k, 1.0, nm) / self.f0,
        }
    }

    /// Light of multiple scattering over that of single scattering where F = 1, at the roughness that it was made for.
    pub(super) fn gain(&self, roughness: f64, cos_o: f64) -> f64 {
        debug_assert_eq!(roughness, self.albedo.0);
        let (i, share) = place(cos_o, ALBEDO_NODES);
        let e0 = self.albedo.1[i] + share * (self.albedo.1[i + 1] - self.albedo.1[i]);
        1.0 / e0.clamp(1e-3, 1.0) - 1.0
    }

    /// The part of a flat surface's reflection that comes from below the outer face of a cover.
    pub(super) fn part_below(&self, cos: f64, mode: SpectralMode) -> DVec3 {
        match &self.overlay {
            Overlay::Cover(cover) => {
                let all = self.reflectance(cos, mode);
                cover.part_below(all.into(), cos).into()
            }
            _ => DVec3::ONE,
        }
    }

    fn node(&self, cos: f64) -> [DVec3; 2] {
        let (i, share) = place(cos, NODES);
        [0, 1].map(|k| self.nodes[i][k].lerp(self.nodes[i + 1][k], share))
    }

    fn at_wavelength(&self, cos: f64, nm: f64) -> f64 {
        match &self.overlay {
            Overlay::Cover(cover) => cover.reflectance(n_k_at(&self.n_k, nm), cos),
            _ => bare(&self.n_k, cos, nm),
        }
    }
}

fn bare(n_k: &[[f64; 2]], cos: f64, nm: f64) -> f64 {
    let [n, k] = n_k_at(n_k, nm);
    fresnel::conductor(cos, n, k)
}

fn n_k_at(n_k: &[[f64; 2]], nm: f64) -> [f64; 2] {
    let last = (n_k.len() - 1) as f64;
    let at = ((nm - WAVELENGTH_MIN_NM) / WAVELENGTH_STEP_NM).clamp(0.0, last);
    let i = (at as usize).min(n_k.len() - 2);
    let share = at - i as f64;
    [0, 1].map(|j| n_k[i][j] + share * (n_k[i + 1][j] - n_k[i][j]))
}

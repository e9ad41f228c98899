//! The wavelengths of one sample, spread evenly over the visible, and the spectra of a material at them.

use super::reflectance::{Reflectance, ReflectanceEnds};
use glam::DVec3;
use hairline_cpu::surface::SurfacePoint;
use hairline_optics::metal::MetalIndex;
use hairline_optics::spectrum::{Observer, WAVELENGTH_MAX_NM};
use hairline_scene::{Base, MaterialOptics};

/// Wavelengths in a sample: all of them see the same directions, which costs little and keeps colour noise low.
pub(super) const WAVELENGTHS: usize = 8;

/// One number for each wavelength of a sample.
pub(super) type Spectrum<T> = [T; WAVELENGTHS];

/// The wavelengths of a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wavelengths {
    pub nm: Spectrum<f64>,
    /// Weight in linear Rec.709 over the probability of the wavelength: sums over the sample are estimates of integrals.
    pub weight: Spectrum<DVec3>,
}

impl Wavelengths {
    /// One in each eighth of what an observer sees; `u` in [0, 1) moves them all.
    pub(crate) fn new(observer: &Observer, u: f64) -> Self {
        let [first_nm, last_nm] = observer.range_nm();
        let step = (last_nm - first_nm) / WAVELENGTHS as f64;
        let nm = std::array::from_fn(|j| first_nm + step * (j as f64 + u));
        let weight = nm.map(|nm| step * DVec3::from(observer.weight_per_nm(nm)));
        Self { nm, weight }
    }
}

/// Wavelength by whose band, the widest one, directions are drawn.
pub(super) const WIDEST_NM: f64 = WAVELENGTH_MAX_NM;

/// Reflection off the floor of a groove and off the smooth base.
#[derive(Clone, Copy)]
pub(super) struct SpectralFresnel<'a> {
    /// The metal of the floors, with its colour before textures. None in a coat, and of what has no spectrum.
    spectrum: Option<(&'a MetalIndex, DVec3)>,
    /// Whether nothing lies over the metal.
    is_bare: bool,
    reflectance: &'a Reflectance,
    ends: ReflectanceEnds,
    cos_o: f64,
    /// Reflectance of a coat, and its share of the surface.
    coat: Option<(f64, &'a Reflectance)>,
}

impl<'a> SpectralFresnel<'a> {
    pub(crate) fn new(
        base: &'a Base,
        optics: &MaterialOptics,
        point: &SurfacePoint,
        reflectance: &'a Reflectance,
        coat: Option<&'a Reflectance>,
    ) -> Self {
        let coat = point.coat.map(|it| it.weight).zip(coat);
        let spectrum = match base {
            Base::Metal(metal) if coat.is_none() => Some((metal, optics.base_color.into())),
            Base::Covered { metal, .. } => {
                let f0 = point.observer.channels(|nm| metal.reflectance(1.0, nm));
                Some((metal, f0.into()))
            }
            _ => None,
        };
        Self {
            spectrum,
            is_bare: matches!(base, Base::Metal(_)),
            reflectance,
            ends: ReflectanceEnds::from_point(point),
            cos_o: point.wo.z,
            coat,
        }
    }

    fn reflectance_at(&self, cos_theta: f64) -> DVec3 {
        let base = self.reflectance.eval(cos_theta, self.ends).once;
        self.coat.map_or(base, |(weight, reflectance)| {
            let coat = reflectance.eval(cos_theta, ReflectanceEnds::COAT).once;
            base.lerp(coat, weight)
        })
    }

    /// Weights with the model's reflectance, (7) and (17): the spectrum's shape at normal incidence, the colour by the
    /// viewer's angle.
    pub(crate) fn separable(&self, wavelengths: &Wavelengths) -> Spectrum<DVec3> {
        let fresnel = self.reflectance_at(self.cos_o);
        self.shape(wavelengths).map(|weight| weight * fresnel)
    }

    /// Weights with the shape of the reflectance's spectrum alone: they add up to white.
    pub(crate) fn shape(&self, wavelengths: &Wavelengths) -> Spectrum<DVec3> {
        std::array::from_fn(|j| match self.spectrum {
            Some((metal, f0)) => {
                let reflectance = metal.reflectance(1.0, wavelengths.nm[j]);
                wavelengths.weight[j] * reflectance / f0
            }
            None => wavelengths.weight[j],
        })
    }

    /// Weights with the reflectance by both angles: the geometric mean of those at the light's and at the viewer's cosine. It is
    /// reciprocal, and equal to Fresnel's in the mirror's direction.
    pub(crate) fn coherent(&self, wavelengths: &Wavelengths, cos_i: f64) -> Spectrum<DVec3> {
        let cos_o = self.cos_o;
        match self.spectrum {
            Some((metal, f0)) if self.is_bare => {
                let tint = self.ends.f0 / f0;
                std::array::from_fn(|j| {
                    let nm = wavelengths.nm[j];
                    let r = metal.reflectance(cos_i, nm) * metal.reflectance(cos_o, nm);
                    wavelengths.weight[j] * tint * r.sqrt()
                })
            }
            _ => {
                let both = self.reflectance_at(cos_i) * self.reflectance_at(cos_o);
                let mean = both.max(DVec3::ZERO).map(f64::sqrt);
                self.shape(wavelengths).map(|weight| weight * mean)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_add_up_to_white() {
        let count = 1000;
        let sum: DVec3 = (0..count)
            .map(|i| Wavelengths::new(Observer::eye(), (i as f64 + 0.5) / count as f64))
            .map(|w| w.weight.iter().sum::<DVec3>())
            .sum();
        // Same tolerance as for the weights themselves: spectrum.rs, `weights_as_a_density_integrate_to_one`.
        assert!((sum / count as f64 - DVec3::ONE).abs().max_element() < 3e-4);
    }
}

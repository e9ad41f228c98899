//! A clear plate over a metal: the polycarbonate of discs, the glass of dials (docs/model.md, section 12).
//!
//! Its faces are parallel. So a direction in air stays what it is by its components along them, and light that goes back and forth in the plate
//! leaves in the same directions.

use crate::fresnel;
use crate::metal::MetalIndex;
use crate::spectrum::Observer;

/// A clear plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// Refractive index.
    pub ior: f64,
    /// How thick it is.
    pub thickness_mm: f64,
    /// The light that a millimetre lets through, linear Rec.709.
    pub color: [f64; 3],
}

impl Cover {
    /// Reflectance of its outer face.
    pub fn outer(&self, cos_theta: f64) -> f64 {
        fresnel::dielectric(cos_theta, self.ior)
    }

    /// The share of light in each channel that gets through the outer face and once through the plate.
    pub fn passed(&self, cos_theta: f64) -> [f64; 3] {
        let face = 1.0 - self.outer(cos_theta);
        self.crossed(cos_theta).map(|crossed| face * crossed)
    }

    fn crossed(&self, cos_theta: f64) -> [f64; 3] {
        let way_mm = self.thickness_mm / fresnel::inner_cos(cos_theta, self.ior);
        self.color.map(|color| color.powf(way_mm))
    }

    /// The part of `reflected`, which a metal under it sends with its outer face, that comes from below that face.
    pub(crate) fn part_below(&self, reflected: [f64; 3], cos_theta: f64) -> [f64; 3] {
        let outer = self.outer(cos_theta);
        // A black plate of the index of air sends nothing.
        reflected.map(|all| if all > 0.0 { 1.0 - outer / all } else { 0.0 })
    }

    /// Whether its colour is the same in all channels, and so at all wavelengths.
    pub fn is_grey(&self) -> bool {
        let [r, g, b] = self.color;
        r == g && g == b
    }

    /// Reflectance of a metal of the index n + i k under it at a wavelength. The plate [is grey](Self::is_grey).
    pub fn reflectance(&self, n_k: [f64; 2], cos_theta: f64) -> f64 {
        let ([passed, ..], [crossed, ..]) = (self.passed(cos_theta), self.crossed(cos_theta));
        let under = self.metal_under(n_k, cos_theta).seen_through(crossed);
        self.outer(cos_theta) + passed * passed * under
    }

    /// A metal under it.
    fn metal_under(&self, [n, k]: [f64; 2], cos_theta: f64) -> UnderCover {
        let inner_cos = fresnel::inner_cos(cos_theta, self.ior);
        UnderCover {
            metal: fresnel::conductor(inner_cos, n / self.ior, k / self.ior),
            outer: self.outer(cos_theta),
        }
    }

    /// Reflectance of a metal under it in linear Rec.709, with the outer face, and with all that goes back and forth in the plate.
    pub fn reflectance_rgb(&self, metal: &MetalIndex, cos_theta: f64) -> [f64; 3] {
        self.reflectance_seen_by(Observer::eye(), metal, cos_theta)
    }

    /// [`Self::reflectance_rgb`] in the channels of an observer.
    pub fn reflectance_seen_by(
        &self,
        observer: &Observer,
        metal: &MetalIndex,
        cos_theta: f64,
    ) -> [f64; 3] {
        let (outer, passed) = (self.outer(cos_theta), self.passed(cos_theta));
        let crossed = self.crossed(cos_theta);
        let under = observer.channels_of(|nm| {
            let under = self.metal_under(metal.n_k(nm).into(), cos_theta);
            crossed.map(|crossed| under.seen_through(crossed))
        });
        std::array::from_fn(|c| outer + passed[c] * passed[c] * under[c])
    }
}

/// Reflectances that light meets in a plate: of the metal below, and of the outer face.
struct UnderCover {
    metal: f64,
    outer: f64,
}

impl UnderCover {
    /// Light that comes up to the outer face for the first time and after each way back, where a crossing leaves the share `crossed`.
    fn seen_through(&self, crossed: f64) -> f64 {
        self.metal / (1.0 - self.outer * self.metal * crossed * crossed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metal::Metal;

    #[test]
    fn a_plate_of_air_is_no_cover_and_a_dark_one_shows_its_face_alone() {
        let cover = |ior, color| Cover {
            ior,
            thickness_mm: 1.2,
            color: [color; 3],
        };
        for cos in [1.0, 0.6, 0.2] {
            let bare = Metal::Gold.reflectance_rgb(cos);
            let air = cover(1.0, 1.0).reflectance_rgb(&Metal::Gold.into(), cos);
            let dark = cover(1.58, 1e-9).reflectance_rgb(&Metal::Gold.into(), cos);
            let clear = cover(1.58, 1.0).reflectance_rgb(&Metal::Silver.into(), cos);
            let face = fresnel::dielectric(cos, 1.58);
            for c in 0..3 {
                assert!((air[c] - bare[c]).abs() < 1e-9 && (dark[c] - face).abs() < 1e-9);
                // A clear plate takes little of a good mirror, whatever its face sends back.
                assert!((0.85..1.0).contains(&clear[c]), "{clear:?}");
            }
        }
    }

    /// Half of each channel in a millimetre: a quarter there and back at 1 mm, straight on.
    #[test]
    fn light_crosses_it_twice() {
        let cover = Cover {
            ior: 1.0,
            thickness_mm: 1.0,
            color: [0.5; 3],
        };
        let [bare, dimmed] = [
            Metal::Silver.reflectance_rgb(1.0),
            cover.reflectance_rgb(&Metal::Silver.into(), 1.0),
        ];
        assert!((dimmed[1] / bare[1] - 0.25).abs() < 1e-9);
    }
}

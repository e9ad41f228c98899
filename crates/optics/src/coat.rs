//! A clear coat over a part of a surface (docs/model.md, (29a)), in the manner of glTF's KHR_materials_clearcoat.

use glam::DVec3;

/// The refractive index of a coat.
pub const COAT_IOR: f64 = 1.5;
/// Reflectance of a coat at normal incidence.
pub const COAT_F0: f64 = 0.04;

/// The part of a coat in the light that a surface sends to a viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoatPart {
    /// The share of the surface that the coat covers.
    pub weight: f64,
    /// That times the share of the light that goes through the coat.
    passed: DVec3,
}

impl CoatPart {
    /// A coat on the share `weight` of a surface. `albedo` is the light that its lobe reflects of radiance 1 from all around: the rest goes through.
    pub fn new(weight: f64, albedo: DVec3) -> Self {
        Self {
            weight,
            passed: weight * (DVec3::ONE - albedo).max(DVec3::ZERO),
        }
    }

    /// Light that is reflected at the surface: by the coat, and by the base where there is none. Scratches take from it.
    pub fn reflected(&self, by_coat: DVec3, by_base: DVec3) -> DVec3 {
        by_base * (1.0 - self.weight) + self.weight * by_coat
    }

    /// Light from below the surface: that of base and body through the coat, and that of the body where there is none.
    pub fn transmitted(&self, by_base: DVec3, by_body: DVec3) -> DVec3 {
        by_body * (self.passed + (1.0 - self.weight)) + by_base * self.passed
    }
}

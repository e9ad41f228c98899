//! Colour, or one wavelength.

use glam::DVec3;

use crate::spectrum;

/// Colour, or one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectralMode {
    /// Linear Rec.709 under D65.
    Rgb,
    /// Reflection at one wavelength, nm; the three numbers are equal.
    Wavelength(f64),
}

/// Sum over the tabulated wavelengths of their weights times a value.
pub(super) fn rgb(value: impl Fn(f64) -> f64) -> DVec3 {
    spectrum::rgb_from_reflectance(value).into()
}

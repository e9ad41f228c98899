//! The switches of the method.

use crate::sine_integral::SineIntegral;

/// The switches of the talk's table. The rest of the method is fixed: eight wavelengths
/// ([`crate::spectrum::PUBLISHED_WAVELENGTHS`]), the steps that find a light's chords on the
/// middle line of the band, and the pivot transform for spheres on the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PublishedMethod {
    /// Structure that finds the scratches under a pixel.
    pub structure: Structure,
    /// Whether a pixel averages over its footprint; otherwise it is the point in its middle.
    pub anti_aliasing: bool,
    /// Sine integral that is evaluated.
    pub si: SineIntegral,
}

impl PublishedMethod {
    pub(crate) const DEFAULT: Self = Self {
        structure: Structure::Bvh,
        anti_aliasing: true,
        si: SineIntegral::Fast,
    };
}

impl Default for PublishedMethod {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Structure by which the published method finds the scratches under a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Structure {
    /// A bounding volume hierarchy.
    #[default]
    Bvh,
    /// A list for each triangle, of all scratches within the coherence window's reach of it. A footprint reaches further, so this is
    /// only for pictures without anti-aliasing.
    TriangleLists,
}

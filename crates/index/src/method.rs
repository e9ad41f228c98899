//! The method by which scratches are rendered: Hairline's own, or the method of 2018 with its switches ([`hairline_published`]).

use hairline_optics::mask::Mask;
use hairline_published::sine_integral::SineIntegral;

/// The method by which scratches are rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Method {
    /// The method of 2018 with its switches; `None` is Hairline's own.
    pub published: Option<PublishedMethod>,
    /// Energy that the base loses to the scratches.
    pub mask: Mask,
}

impl Method {
    /// The published method: BVH, anti-aliasing, the fast sine integral, the density mask.
    pub const PUBLISHED: Self = Self {
        published: Some(PublishedMethod::DEFAULT),
        mask: Mask::Density,
    };
}

/// The switches of the talk's table. The rest of the method is fixed: eight wavelengths
/// ([`PUBLISHED_WAVELENGTHS`](hairline_published::spectrum::PUBLISHED_WAVELENGTHS)), the steps that find a light's chords on the
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
    const DEFAULT: Self = Self {
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

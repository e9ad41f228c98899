//! By which method scratches are rendered: Hairline's own, or the method of 2018 with its switches ([`hairline_optics::published`]).

use hairline_optics::mask::Mask;
use hairline_optics::published::sine_integral::SineIntegral;

/// By which method scratches are rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Method {
    /// The method of 2018 with its switches; `None` is Hairline's own.
    pub published: Option<PublishedMethod>,
    /// What the base pays.
    pub mask: Mask,
}

impl Method {
    /// As published: BVH, anti-aliasing, the fast sine integral, the density mask.
    pub const PUBLISHED: Self = Self {
        published: Some(PublishedMethod::DEFAULT),
        mask: Mask::Density,
    };
}

/// The switches of the talk's table. The rest of the method is fixed: eight wavelengths
/// ([`PUBLISHED_WAVELENGTHS`](hairline_optics::published::spectrum::PUBLISHED_WAVELENGTHS)), the steps that find a light's chords on the
/// middle line of the band, and the pivot transform for spheres on the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PublishedMethod {
    /// How the scratches under a pixel are found.
    pub structure: Structure,
    /// Whether a pixel averages over its footprint; otherwise it is the point in its middle.
    pub anti_aliasing: bool,
    /// Which sine integral.
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

/// How the published method finds the scratches under a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Structure {
    /// By a traversal of the bounding volume hierarchy.
    #[default]
    Bvh,
    /// By a list for each triangle, of all scratches within the coherence window's reach of it. A footprint reaches further, so
    /// this is only for pictures without anti-aliasing.
    TriangleLists,
}

//! By which of the known ways scratches are computed: the default, the method of 2018 ([`crate::published`]), or any mixture
//! of their parts, so that each part's error and cost can be told apart (docs/model.md, sections 4 to 9).

use crate::mask::Mask;
use crate::published::sine_integral::SineIntegral;
use crate::published::spectrum::PUBLISHED_WAVELENGTHS;

/// A way to compute scratches, part by part. [`Default`] is Hairline's own, [`Method::PUBLISHED`] that of 2018.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Method {
    /// How the visible is integrated.
    pub spectrum: Spectrum,
    /// How a light's chords on a line of the band are found.
    pub chords: Chords,
    /// What of the band is evaluated.
    pub band: Band,
    /// How a pixel averages a scratch.
    pub footprint: PixelFilter,
    /// What the base pays.
    pub mask: Mask,
    /// How the base reflects spheres; polygons are reflected by [`crate::ltc`] either way.
    pub sphere_base: SphereBase,
    /// How the scratches under a pixel are found.
    pub lookup: Lookup,
    /// Whether many scratches may be taken as one.
    pub gather: Gather,
    /// At which places a scratch's light is worked out.
    pub light_at: LightAt,
}

impl Method {
    /// The method of 2018, with its approximated sine integral and its hierarchy.
    pub const PUBLISHED: Self = Self {
        spectrum: Spectrum::Wavelengths {
            count: PUBLISHED_WAVELENGTHS,
            si: SineIntegral::Fast,
        },
        chords: Chords::Steps,
        band: Band::MiddleLine,
        footprint: PixelFilter::Published,
        mask: Mask::Density,
        sphere_base: SphereBase::Pivot,
        lookup: Lookup::Bvh,
        gather: Gather::Exact,
        light_at: LightAt::Pixels,
    };

    /// The default as users want it: what is the same to about a percent of the scratches' light is done the faster way.
    pub fn fastest() -> Self {
        Self {
            light_at: LightAt::Fastest,
            ..Self::default()
        }
    }

    /// Whether the default path can compute this: it has every footprint but the blend, every mask and every look-up, and
    /// nothing of the rest of the method of 2018.
    pub fn is_default_path(&self) -> bool {
        let refined = Self::default();
        self.spectrum == refined.spectrum
            && self.chords == refined.chords
            && self.band == refined.band
            && self.sphere_base == refined.sphere_base
            && self.footprint != PixelFilter::Published
    }
}

/// How the visible is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Spectrum {
    /// Beforehand, into a table over u = W q and depth: [`crate::table`].
    #[default]
    Table,
    /// At a few wavelengths for each chord: [`crate::published::spectrum`].
    Wavelengths {
        /// How many; 3, 8 or 16 are what was looked into.
        count: usize,
        /// By which sine integral.
        si: SineIntegral,
    },
}

/// How a light's chords on a line of the band are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Chords {
    /// A signed sum over roots, each alone: [`crate::band`].
    #[default]
    Roots,
    /// The talk's six steps, polygons in triangles: [`crate::published::sphere`], [`crate::published::polygon`].
    Steps,
}

/// What of the band is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Band {
    /// One to five lines with a width for each channel, moved and widened by the pixel's perspective and curvature, depths
    /// along oblique paths.
    #[default]
    Lines,
    /// The middle line alone, as if the whole band met the light there; depths along the normal.
    MiddleLine,
}

/// How a pixel averages a scratch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PixelFilter {
    /// The exact mean over a Gaussian: [`crate::footprint`].
    #[default]
    Gaussian,
    /// The talk's blend of two limits, for the box that has the Gaussian's variance: [`crate::published::footprint`].
    Published,
    /// None: the pixel is the point in its middle.
    Off,
}

/// How the base reflects spheres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SphereBase {
    /// Linearly transformed cosines: [`crate::ltc`].
    #[default]
    Cosines,
    /// The pivot transform of 2017: [`crate::sptd`].
    Pivot,
}

/// How the scratches under a pixel are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lookup {
    /// One walk of the hierarchy for a tile of pixels, where the renderer has tiles; else as [`Lookup::Bvh`].
    #[default]
    Tiles,
    /// Each pixel walks the hierarchy by its skip pointers.
    Bvh,
    /// A list for each triangle, of all scratches within the coherence window's reach of it. Larger footprints reach
    /// further: only for [`PixelFilter::Off`].
    Triangles,
}

/// Whether many scratches may be taken together (docs/model.md, section 7). On the default path; elsewhere every scratch is taken
/// for itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gather {
    /// Every scratch under the pixel for itself.
    #[default]
    Exact,
    /// Where a footprint covers many, what they add up to on a grid that is fine against it.
    Clusters,
    /// The same, and where no grid is fine enough what hundreds of scratches under the footprint add up to, found one by one.
    /// Takes less than lighting each on processors, and more than the lists of tiles on a software driver.
    Tally,
}

impl Gather {
    /// Whether it reads grids.
    pub fn has_grids(self) -> bool {
        self != Self::Exact
    }
}

/// At which places the light of a single scratch is worked out. On the default path with [`Lookup::Tiles`]; elsewhere at pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightAt {
    /// For each pixel that it lies under.
    #[default]
    Pixels,
    /// At places along it, as many as its light changes, and interpolated between them: pixels take their shares of that.
    Scratches,
    /// Along scratches on processors, where that is several times as fast; for each pixel on graphics adapters, where it is not.
    Fastest,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_path_is_the_default_and_not_the_published_method() {
        assert!(Method::default().is_default_path());
        assert!(!Method::PUBLISHED.is_default_path());
        for lookup in [Lookup::Tiles, Lookup::Bvh, Lookup::Triangles] {
            let off = Method {
                lookup,
                footprint: PixelFilter::Off,
                mask: Mask::Density,
                ..Method::default()
            };
            assert!(off.is_default_path());
        }
        let blended = Method {
            footprint: PixelFilter::Published,
            ..Method::default()
        };
        assert!(!blended.is_default_path());
    }
}

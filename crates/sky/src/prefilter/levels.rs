//! Which maps each level of a prefiltered map is made from.

/// Width and height of level 0; powers of two.
pub(crate) const LEVEL_0_SIZE_PX: [u32; 2] = [2048, 1024];

/// Finest map of a level, by the level's halvings, and reach in texels of that and of each coarser map: smooth levels have many texels, and dim
/// tails. Texels of the finest map are a quarter of the level's, if there are such.
pub(super) const FINEST: [usize; 7] = [0, 0, 0, 1, 2, 3, 4];
pub(super) const REACH_TEXELS: [f64; 7] = [0.0, 5.0, 6.0, 12.0, 16.0, 16.0, 16.0];
/// Ratio of the distances at which a map's weight has fallen to zero and begins to fall; the next map takes over in between.
pub(super) const FADE: f64 = 1.5;
/// The coarsest map.
pub(super) const COARSEST: usize = 5;

//! The levels of a prefiltered map, and which maps each is made from.

/// The perceptual roughness of each level. A lobe between two levels is a blend of theirs, so that these are close together: one is
/// less than twice as wide as the one before.
pub const LEVEL_ROUGHNESS: [f64; LEVELS] = [
    0.0, 0.06, 0.081, 0.11, 0.148, 0.2, 0.265, 0.35, 0.458, 0.6, 0.775, 1.0,
];
pub(super) const LEVELS: usize = 12;

/// Number of times that a level's width and height are halved from the first one's: texels are about as wide as their level's lobe, or narrower.
pub const LEVEL_HALVINGS: [usize; LEVELS] = [0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6];

/// The mip of a texture that holds a level of the maps, and whether the level lies below another one there. Twin: `environment_level_place` in
/// environment.wgsl.
pub fn level_place(level: usize) -> (usize, bool) {
    let mip = LEVEL_HALVINGS[level];
    (mip, level > 0 && LEVEL_HALVINGS[level - 1] == mip)
}

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

//! The levels of a prefiltered map, and which maps each is made from.

/// The perceptual roughness of each level. A lobe between two levels is a blend of theirs, so that these are close together: one is
/// less than twice as wide as the one before.
pub const LEVEL_ROUGHNESS: [f64; LEVELS] = [
    0.0, 0.06, 0.081, 0.11, 0.148, 0.2, 0.265, 0.35, 0.458, 0.6, 0.775, 1.0,
];
pub(super) const LEVELS: usize = 12;

/// Number of times that a level's width and height are halved from the first one's: texels are about as wide as their level's lobe, or narrower.
pub const LEVEL_HALVINGS: [usize; LEVELS] = [0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6];

/// Width and height of level 0; powers of two.
pub(crate) const LEVEL_0_SIZE_PX: [u32; 2] = [2048, 1024];

/// The finest map that a level is made from, and up to how many of its texels away that and each coarser map is looked at, by a level's
/// halvings: smooth levels have many texels, and tails that are dim. Texels of the finest map are a quarter of the level's, where there are any.
pub(super) const FINEST: [usize; 7] = [0, 0, 0, 1, 2, 3, 4];
pub(super) const REACH_TEXELS: [f64; 7] = [0.0, 5.0, 6.0, 12.0, 16.0, 16.0, 16.0];
/// Factor on the reach of a map over which it fades, and the next map takes over.
pub(super) const FADE: f64 = 1.5;
/// The coarsest map.
pub(super) const COARSEST: usize = 5;

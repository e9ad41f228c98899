//! The levels of a prefiltered map.

/// The perceptual roughness of each level. A lobe between two levels is a blend of theirs, so that these are close together: one is
/// less than twice as wide as the one before.
pub const LEVEL_ROUGHNESS: [f64; LEVELS] = [
    0.0, 0.06, 0.081, 0.11, 0.148, 0.2, 0.265, 0.35, 0.458, 0.6, 0.775, 1.0,
];
const LEVELS: usize = 12;

/// Number of times that a level's width and height are halved from the first one's: texels are about as wide as their level's lobe, or narrower.
pub const LEVEL_HALVINGS: [usize; LEVELS] = [0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6];

/// The mip of a texture that holds a level of the maps, and whether the level lies below another one there. Twin: `environment_level_place` in
/// environment.wgsl.
pub fn level_place(level: usize) -> (usize, bool) {
    let mip = LEVEL_HALVINGS[level];
    (mip, level > 0 && LEVEL_HALVINGS[level - 1] == mip)
}

//! What a file brings besides its triangles.

use std::path::PathBuf;

use crate::scene::{Material, Part, Texture};

/// Of the free memory, what one file may take.
pub(super) const FILE_SHARE: f64 = 1.0 / 4.0;

/// Where a file's parts and its own materials go.
pub(crate) struct Stock<'a> {
    pub parts: &'a mut Vec<Part>,
    pub materials: &'a mut Vec<Material>,
    pub textures: &'a mut Vec<Texture>,
    /// The files that it refers to and that were read.
    pub files: &'a mut Vec<PathBuf>,
    /// What textures may still take of the memory.
    pub free_bytes: f64,
    /// Whether textures get their mip chains, which take longer than the rest.
    pub with_mips: bool,
}

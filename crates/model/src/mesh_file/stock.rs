//! Materials, textures and notes that a file brings besides its triangles.

use glam::DVec3;
use hairline_image::FilePath;

use crate::material::Material;
use crate::mesh::NodeTriangles;
use crate::texture::Texture;

/// Largest share of the free memory that one file may take.
pub(super) const FILE_SHARE: f64 = 1.0 / 4.0;

/// Destination of a file's parts and its own materials.
pub struct FileContents<'a> {
    /// Triangles of each node.
    pub parts: &'a mut Vec<NodeTriangles>,
    /// Materials, to which those of the file are added.
    pub materials: &'a mut Vec<Material>,
    /// Textures, to which those of the file are added.
    pub textures: &'a mut Vec<Texture>,
    /// The files that it refers to and that were read.
    pub files: &'a mut Vec<FilePath>,
    /// The middle of a file that stood too far off, in its own frame: it was put at the origin.
    pub moved_from: &'a mut Option<DVec3>,
    /// Notes on the file for its author.
    pub notes: &'a mut Vec<String>,
    /// Memory that is left for textures.
    pub free_bytes: f64,
    /// Whether textures get their mip chains, which take longer than the rest.
    pub with_mips: bool,
}

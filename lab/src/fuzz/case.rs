//! An input and its kind.

use std::path::Path;

use anyhow::{Context, Result};
use clap::ValueEnum;

/// A kind of input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum InputKind {
    /// Scene files.
    Toml,
    /// Lists of scratches.
    Csv,
    /// Binary glTF.
    Glb,
    /// glTF as text.
    Gltf,
    /// Radiance maps.
    Hdr,
    /// OpenEXR maps.
    Exr,
    /// Textures.
    Png,
    /// Textures of Basis Universal.
    Ktx2,
    /// Textures of WebP.
    Webp,
    /// Textures of JPEG.
    Jpeg,
    /// Meshes that Draco packs.
    Draco,
    /// Meshes whose views meshoptimizer packs.
    Meshopt,
}

/// One input: files in a folder, of which `scene.toml` is rendered.
pub struct Case {
    /// Name of the case in failures.
    pub name: String,
    /// Names and contents.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Case {
    /// Writes its files.
    pub fn write(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        for (name, bytes) in &self.files {
            let path = folder.join(name);
            std::fs::write(&path, bytes).with_context(|| path.display().to_string())?;
        }
        Ok(())
    }
}

//! A scene as one file for other programs.

use std::ops::RangeInclusive;
use std::path::Path;

use hairline_image::FilePath;

use crate::description::Description;
use crate::error::Error;
use crate::gltf_scene::Exported;
use crate::loader::Loader;
use crate::plain_model::PlainModel;

/// A kind of file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// The whole scene as a binary glTF file.
    #[default]
    Glb,
    /// The model alone as a package of Universal Scene Description, for phones.
    Usdz,
}

impl Format {
    /// The endings of files.
    pub const ENDINGS: [&str; 2] = ["glb", "usdz"];
    /// Says which names are right.
    pub const RIGHT: &str = "must end in .glb or .usdz";

    /// The kind of a file by its ending.
    pub fn from_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        let [glb, usdz] = Self::ENDINGS.map(|it| ending.eq_ignore_ascii_case(it));
        if usdz {
            return Some(Self::Usdz);
        }
        glb.then_some(Self::Glb)
    }
}

/// Contents of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Export {
    /// Kind of the file.
    pub format: Format,
    /// Whether a glTF file has scratches as they lie too, for programs that lay none: 44 bytes a straight piece; and the tables of all gratings, 0.2 to
    /// 2 MiB each. Those of fine gratings, 4 MiB each, always are: no other program solves Maxwell's equations.
    pub laid: bool,
    /// Texels of a side of the maps into which scratches are drawn, in [`BAKE_PX`]: the file then has the model alone, for programs that know no scratches.
    pub bake_px: Option<u32>,
}

/// Least and greatest [`Export::bake_px`].
pub const BAKE_PX: RangeInclusive<u32> = 16..=4096;

impl Loader<'_> {
    /// Makes one file of a scene and all that it names. Files are looked for in `base_dir`.
    ///
    /// # Errors
    /// What is wrong with the scene, or what of it a file cannot hold, by its key.
    pub fn export(
        &self,
        description: &Description,
        base_dir: impl Into<FilePath>,
        export: Export,
    ) -> Result<Exported, Error> {
        if export.format == Format::Glb && export.bake_px.is_none() {
            return self.export_scene(description, base_dir, export.laid);
        }
        if export.laid {
            let found = "found scratches as they lie";
            let right = "must be off in a file for programs that know no scratches";
            return Err(Error::new("laid", found, right));
        }
        let mut model = PlainModel::new(self, description, base_dir)?;
        if let Some(size_px) = export.bake_px {
            model.bake(self, size_px)?;
        }
        match export.format {
            Format::Glb => model.to_glb(),
            Format::Usdz => model.to_usdz(),
        }
    }
}

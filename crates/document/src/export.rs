//! A scene as one file for other programs.

use std::path::Path;

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
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        let formats = [Self::Glb, Self::Usdz];
        let mut known = Self::ENDINGS.into_iter().zip(formats);
        let found = known.find(|(it, _)| ending.eq_ignore_ascii_case(it));
        found.map(|(_, format)| format)
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
}

impl Loader<'_> {
    /// Makes one file of a scene and all that it names. Files are looked for in `base_dir`.
    ///
    /// # Errors
    /// What is wrong with the scene, or what of it a file cannot hold, by its key.
    pub fn export(
        &self,
        description: &Description,
        base_dir: &Path,
        export: Export,
    ) -> Result<Exported, Error> {
        if export.laid && export.format == Format::Usdz {
            let found = "found scratches as they lie";
            let right = "must be off in a file for programs that know no scratches";
            return Err(Error::new("laid", found, right));
        }
        match export.format {
            Format::Glb => self.export_scene(description, base_dir, export.laid),
            Format::Usdz => PlainModel::new(self, description, base_dir)?.to_usdz(),
        }
    }
}

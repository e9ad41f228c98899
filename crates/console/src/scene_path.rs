//! Which files are scenes, by their names.

use std::path::Path;

use anyhow::anyhow;
use hairline_render::failure::Failure;

/// Refuses pictures and lists with a hint at their use. Files of other names are read, or refused there.
///
/// # Errors
/// [`Failure::Input`] that says what the file is for.
pub fn refuse_other_files(path: &Path) -> Result<(), Failure> {
    let ending = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    let what = match ending.as_str() {
        "hdr" | "exr" => "an environment map; name it in a scene as `file` of [environment]",
        "png" | "jpg" | "jpeg" | "webp" | "apng" | "tif" | "tiff" => "a picture",
        "csv" => "a list of scratches; name it in a scene as `file` of a [[scratches]]",
        _ => return Ok(()),
    };
    Err(Failure::Input(anyhow!(
        "{}: it is {what}; give a scene (.toml) or a model (.glb, .gltf, .obj, .stl)",
        path.display()
    )))
}

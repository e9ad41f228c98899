//! A short name for all that a picture depends on, so that samples of two scenes are never mixed.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use hairline_document::description::{Description, FileUse};
use hairline_document::{Arrays, inputs};

/// Hexadecimal digits of a fingerprint: 128 bits, beyond any accident.
const DIGITS: usize = 32;

/// A digest of everything that a scene's linear picture depends on: the description, with the contents of files in the place of their names; arrays in memory
/// have a name that tells their contents. Exposure and tone map act on the display alone and are left out, and looks that the scene could have; so is the picture's size, which a picture tells by
/// itself.
///
/// # Errors
/// Files that cannot be read.
pub fn fingerprint(description: &Description, folder: &Path, arrays: &Arrays) -> Result<String> {
    let mut described = description.clone();
    described.camera.exposure_ev = 0.0;
    described.render.tone_map = hairline_image::ToneMap::default();
    described.render.size_px = [0, 0];
    described.looks.clear();
    for (used_for, file) in described.files_mut() {
        if !arrays.has(file) {
            let path = folder.join(&*file);
            let digest = match used_for {
                FileUse::Mesh(_) => digest_of_mesh(&path)?,
                _ => digest_of_file(&path)?,
            };
            *file = digest.into();
        }
    }
    // Not TOML, which does not have the upper half of the seeds.
    let text = serde_json::to_vec(&described).context("the scene cannot be described")?;
    Ok(shortened(&blake3::hash(&text)))
}

fn shortened(hash: &blake3::Hash) -> String {
    let mut digits = hash.to_hex().to_string();
    digits.truncate(DIGITS);
    digits
}

fn read(path: &Path) -> Result<Vec<u8>> {
    inputs::bytes(path).with_context(|| format!("{}: cannot be read", path.display()))
}

fn digest_of_file(path: &Path) -> Result<String> {
    Ok(shortened(&blake3::hash(&read(path)?)))
}

/// A glTF file and the files that it names in turn.
fn digest_of_mesh(path: &Path) -> Result<String> {
    let bytes = read(path)?;
    let mut hasher = blake3::Hasher::new();
    hasher.update(&bytes);
    if inputs::file_of(path) != path {
        // One of several in the file.
        let name = path.file_name().unwrap_or_default();
        hasher.update(name.as_encoded_bytes());
    }
    for file in inputs::of_model(path) {
        // A texture that the scene had no use for may be absent.
        match fs::read(file) {
            Ok(bytes) => hasher.update(blake3::hash(&bytes).as_bytes()),
            Err(_) => hasher.update(b"absent"),
        };
    }
    Ok(shortened(&hasher.finalize()))
}

#[cfg(test)]
mod tests {
    use hairline_document::description::Layer;

    use super::*;

    const SCENE: &str = r#"
[camera]
position_m = [0.0, -0.22, 0.30]
target_m = [0.0, 0.0, 0.0]

[environment]
file = "sky.hdr"

[[material]]
name = "steel"
kind = "metal"
metal = "iron"

[[object]]
name = "plate"
shape = { disk = { radius_m = 0.08 } }
material = "steel"

[[object]]
name = "cup"
mesh = "cup.gltf"

[[scratches]]
object = "plate"
pattern = "random"
count = 5
seed = 18446744073709551

[[scratches]]
object = "plate"
pattern = "file"
file = "lines.csv"
where = { mask = "worn.png", density = "dense.png" }

[[grating]]
object = "cup"
pattern = "uv"
pitch_um = 2.0
mask = "label.png"
directions = "ways.png"

[[light]]
kind = "rectangle"
center_m = [0.0, 0.0, 1.0]
width_m = 0.1
height_m = 0.1
target_m = [0.0, 0.0, 0.0]
radiance = 1.0
picture = "lamp.png"
"#;

    /// All files that it names, each for another use.
    const NAMED: [&str; 8] = [
        "sky.hdr",
        "cup.gltf",
        "lines.csv",
        "worn.png",
        "dense.png",
        "label.png",
        "ways.png",
        "lamp.png",
    ];

    const CUP: &str = r#"{"asset": {"version": "2.0"},
        "buffers": [{"byteLength": 3, "uri": "its%20data.bin"}], "images": [{"uri": "rust.png"}]}"#;

    /// Makes the files that `fingerprint` reads: their bytes, and of glTF the names within.
    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in NAMED {
            fs::write(folder.path().join(name), name).unwrap();
        }
        for (name, contents) in [
            ("cup.gltf", CUP),
            ("its data.bin", "123"),
            ("rust.png", "rust"),
        ] {
            fs::write(folder.path().join(name), contents).unwrap();
        }
        folder
    }

    fn described(text: &str) -> Description {
        Description::from_toml(text, Path::new("scene.toml")).unwrap()
    }

    #[test]
    fn what_the_picture_depends_on_is_in_it() {
        let folder = folder();
        let of =
            |text: &str| fingerprint(&described(text), folder.path(), &Arrays::default()).unwrap();
        let first = of(SCENE);
        assert_eq!(first.len(), DIGITS);
        for (from, to) in [
            ("0.30", "0.31"),
            ("count = 5", "count = 6"),
            ("seed = 1", "seed = 2"),
            ("\"iron\"", "\"gold\""),
            ("[camera]", "[render]\nfilter_std_px = 0.4\n[camera]"),
        ] {
            assert_ne!(of(&SCENE.replacen(from, to, 1)), first, "{from}");
        }
        for (from, to) in [
            ("[camera]", "[camera]\nexposure_ev = 2.0"),
            ("[camera]", "[render]\ntone_map = \"aces\"\n[camera]"),
            ("[camera]", "[render]\nsize_px = [10, 10]\n[camera]"),
            ("[camera]", "[render]\ngather = \"clusters\"\n[camera]"),
            ("[camera]", "# A comment.\n[camera]"),
            // A default, written out.
            ("[camera]", "[camera]\nfov_y_deg = 30"),
        ] {
            assert_eq!(of(&SCENE.replacen(from, to, 1)), first, "{to}");
        }
    }

    #[test]
    fn so_are_the_bytes_of_files_and_not_their_names() {
        let folder = folder();
        let of =
            |text: &str| fingerprint(&described(text), folder.path(), &Arrays::default()).unwrap();
        let first = of(SCENE);
        for name in NAMED {
            let other = format!("other-{name}");
            fs::copy(folder.path().join(name), folder.path().join(&other)).unwrap();
            assert_eq!(of(&SCENE.replace(name, &other)), first, "{other}");
        }
        for name in [&NAMED[..], &["its data.bin", "rust.png"]].concat() {
            let path = folder.path().join(name);
            let before = fs::read(&path).unwrap();
            fs::write(&path, [&before[..], b" "].concat()).unwrap();
            assert_ne!(of(SCENE), first, "{name}");
            fs::write(&path, before).unwrap();
            assert_eq!(of(SCENE), first, "{name}");
        }
    }

    /// A flag may give a seed outside of the range of scene files.
    #[test]
    fn all_seeds_have_one() {
        let folder = folder();
        let mut description = described(SCENE);
        if let Layer::Laid(laid) = &mut description.scratches[0].layer {
            laid.seed = u64::MAX;
        }
        assert!(fingerprint(&description, folder.path(), &Arrays::default()).is_ok());
    }

    #[test]
    fn a_file_that_is_gone_is_named() {
        let folder = folder();
        fs::remove_file(folder.path().join("sky.hdr")).unwrap();
        let error = fingerprint(&described(SCENE), folder.path(), &Arrays::default()).unwrap_err();
        assert!(error.to_string().contains("sky.hdr"), "{error}");
    }
}

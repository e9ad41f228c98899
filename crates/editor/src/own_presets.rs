//! The user's own presets: layers of scratches, materials and lights, kept from run to run. Each is a file of its name, of the tables
//! that scene files have.

use std::fs;
use std::path::{Path, PathBuf};

use hairline_document::{Description, Error};
use hairline_image::output::write_atomically;

/// Reason why a preset was not saved or deleted.
#[derive(Debug, thiserror::Error)]
pub enum PresetError {
    /// A name that is no name of a file on every system.
    #[error(
        "\"{0}\" is no name for a preset: it may have letters, digits, spaces, - and _, and must not be empty"
    )]
    Name(String),
    /// A file of that name is there, and cannot be read: it is not written over.
    #[error("{0}; delete that file, or choose another name")]
    Broken(String),
    /// The file cannot be written or deleted.
    #[error("{}: {reason}", path.display())]
    File {
        /// The preset's file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
}

/// A preset of the user's.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnPreset {
    /// Name in menus, and of its file.
    pub name: String,
    /// A scene with the preset's materials, layers and lights, and nothing else. Files in it are relative to
    /// [`OwnPresets::folder`].
    pub parts: Description,
}

/// The presets in a folder, by name.
#[derive(Clone, Debug, Default)]
pub struct OwnPresets {
    list: Vec<OwnPreset>,
    folder: Option<PathBuf>,
}

impl OwnPresets {
    /// Reads the presets of a folder; without one they last for this run. Also what is wrong with files that cannot be read.
    pub fn load(folder: Option<PathBuf>) -> (Self, Vec<String>) {
        let entries = folder.as_ref().and_then(|folder| fs::read_dir(folder).ok());
        let paths = entries
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path());
        let is_preset = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "toml");
        let mut list = Vec::new();
        let mut wrong = Vec::new();
        for path in paths.filter(is_preset) {
            match read(&path) {
                Ok(parts) => list.push(OwnPreset {
                    name: path
                        .file_stem()
                        .unwrap_or_default()
                        .to_string_lossy()
                        .into_owned(),
                    parts,
                }),
                Err(why) => wrong.push(why),
            }
        }
        list.sort_by(|a, b| a.name.cmp(&b.name));
        wrong.sort();
        (Self { list, folder }, wrong)
    }

    /// All of them, by name.
    pub fn list(&self) -> &[OwnPreset] {
        &self.list
    }

    /// Folder of the files; none if they last for this run.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Keeps the materials, layers and lights of a scene under a name, in the place of a preset of that name.
    ///
    /// # Errors
    /// [`PresetError`]; then nothing has changed.
    pub fn save(&mut self, name: &str, parts: Description) -> Result<(), PresetError> {
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
        let name = name.trim();
        if name.is_empty() || !name.chars().all(is_plain) {
            return Err(PresetError::Name(name.to_owned()));
        }
        if let Some(path) = self.path(name) {
            if path.exists() {
                read(&path).map_err(PresetError::Broken)?;
            }
            let failed = |reason: String| PresetError::File {
                path: path.clone(),
                reason,
            };
            let text = parts
                .parts_to_toml()
                .map_err(|error| failed(error.to_string()))?;
            if let Some(folder) = &self.folder {
                fs::create_dir_all(folder).map_err(|error| failed(error.to_string()))?;
            }
            write_atomically(&path, text.as_bytes()).map_err(|error| failed(error.to_string()))?;
        }
        self.list.retain(|other| other.name != name);
        let preset = OwnPreset {
            name: name.to_owned(),
            parts,
        };
        let place = self.list.partition_point(|other| other.name < preset.name);
        self.list.insert(place, preset);
        Ok(())
    }

    /// Deletes a preset with its file.
    ///
    /// # Errors
    /// [`PresetError::File`].
    pub fn delete(&mut self, name: &str) -> Result<(), PresetError> {
        if let Some(path) = self.path(name)
            && let Err(error) = fs::remove_file(&path)
            && error.kind() != std::io::ErrorKind::NotFound
        {
            let reason = error.to_string();
            return Err(PresetError::File { path, reason });
        }
        self.list.retain(|other| other.name != name);
        Ok(())
    }

    fn path(&self, name: &str) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(format!("{name}.toml")))
    }
}

/// Reads a preset's file, or tells by its name what is wrong with it.
fn read(path: &Path) -> Result<Description, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let parts = Description::parts_from_toml(&text, path).map_err(|error| error.to_string())?;
    if parts.materials.is_empty() && parts.scratches.is_empty() && parts.lights.is_empty() {
        let right = "must have at least one `[[material]]`, `[[scratches]]` or `[[light]]`";
        let error = Error::new("", "found none of the tables of a preset", right);
        return Err(error.with_position(path, None).to_string());
    }
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets::{LayerPreset, LightPreset, MaterialPreset};
    use glam::DVec3;

    fn parts() -> Description {
        Description {
            materials: vec![MaterialPreset::FlakePaint.material()],
            scratches: vec![LayerPreset::SpunDisk.layer("pan", 0.2)],
            lights: vec![LightPreset::Tube.light(DVec3::ZERO, DVec3::Z, 0.2)],
            ..Description::parts_from_toml("", Path::new("nothing")).unwrap()
        }
    }

    #[test]
    fn presets_last_and_are_deleted() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("presets");
        let (mut own, wrong) = OwnPresets::load(Some(folder.clone()));
        assert!(own.list().is_empty() && wrong.is_empty());
        own.save(" my pan ", parts()).unwrap();
        own.save("Dial", parts()).unwrap();
        let text = fs::read_to_string(folder.join("my pan.toml")).unwrap();
        assert!(text.contains("[[scratches]]\nobject = \"pan\"\n"), "{text}");
        assert!(
            !text.contains("[camera]") && !text.contains("[ground]"),
            "{text}"
        );
        let (mut again, wrong) = OwnPresets::load(Some(folder.clone()));
        assert_eq!((again.list(), wrong.len()), (own.list(), 0));
        let names: Vec<_> = again
            .list()
            .iter()
            .map(|preset| preset.name.as_str())
            .collect();
        assert_eq!(names, ["Dial", "my pan"]);
        assert_eq!(again.list()[1].parts, parts());
        again.delete("my pan").unwrap();
        assert!(!folder.join("my pan.toml").exists());
        assert_eq!(OwnPresets::load(Some(folder)).0.list().len(), 1);
        for name in ["", "../evil", "a/b", "a.b"] {
            assert!(
                matches!(again.save(name, parts()), Err(PresetError::Name(_))),
                "{name}"
            );
        }
    }

    #[test]
    fn a_broken_file_is_named_and_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let text = "[[material]]\nname = \"steel\"\nkind = \"metal\"\nmetal = \"stele\"\n";
        let path = folder.path().join("mine.toml");
        fs::write(&path, text).unwrap();
        fs::write(folder.path().join("empty.toml"), "").unwrap();
        let (mut own, wrong) = OwnPresets::load(Some(folder.path().to_owned()));
        assert!(own.list().is_empty());
        assert!(
            wrong[0].contains("empty.toml: found none of the tables"),
            "{wrong:?}"
        );
        assert!(
            wrong[1].contains("mine.toml:4: material[0].metal"),
            "{wrong:?}"
        );
        let refused = own.save("mine", parts()).unwrap_err().to_string();
        assert!(refused.starts_with(&wrong[1]), "{refused}");
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
}

//! Notes for a scene's author on its models: contents of their files that the picture does not have.

use std::path::{Path, PathBuf};

use hairline_image::FilePath;
use hairline_model::mesh_file::{self, LeftOut, UsedContents};
use hairline_model::text::shown;

use crate::description::{Description, Object, Surface};

impl Description {
    /// Lists, file by file and each once, the contents of the models that are not in the picture. Files are looked for in
    /// `base_dir`; what cannot be read has nothing.
    pub fn left_out(&self, base_dir: impl Into<FilePath>) -> Vec<(PathBuf, Vec<LeftOut>)> {
        let base_dir = base_dir.into();
        let mut models: Vec<(&PathBuf, UsedContents)> = Vec::new();
        for object in &self.objects {
            let Surface::Mesh(file) = &object.surface else {
                continue;
            };
            let wanted = object.used_contents(self.lights_of.as_deref());
            match models.iter_mut().find(|(known, _)| *known == file) {
                Some((_, known)) => {
                    known.own_materials |= wanted.own_materials;
                    known.animation |= wanted.animation;
                }
                None => models.push((file, wanted)),
            }
        }
        let of_file = |(file, wanted): (&PathBuf, UsedContents)| {
            let left_out = mesh_file::left_out(&base_dir.join(file), wanted);
            (file.clone(), left_out)
        };
        models.into_iter().map(of_file).collect()
    }

    /// The entries of [`Self::left_out`] that change the picture, as notes, a line each.
    pub fn model_notes(&self, base_dir: impl Into<FilePath>) -> Vec<String> {
        let left_out = self.left_out(base_dir).into_iter();
        left_out
            .flat_map(|(file, left_out)| notes(&file, &left_out))
            .collect()
    }
}

impl Object {
    /// Parts of its file that are in the picture; `lights_of` as in [`Description::lights_of`].
    pub(crate) fn used_contents(&self, lights_of: Option<&Path>) -> UsedContents {
        UsedContents {
            lights: matches!(&self.surface, Surface::Mesh(file) if Some(&**file) == lights_of),
            own_materials: self.material.is_none(),
            animation: self.time_s.is_some(),
        }
    }
}

/// Notes on the contents whose absence changes the picture, a line each.
pub(crate) fn notes(file: &Path, left_out: &[LeftOut]) -> Vec<String> {
    let line = |content: &LeftOut| {
        let what = format!(
            "{} ({}) left out; {}",
            content.what, content.count, content.meaning
        );
        note(file, &what)
    };
    left_out.iter().filter(|it| it.matters).map(line).collect()
}

/// A line about a model.
pub(crate) fn note(file: &Path, what: &str) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str());
    format!("{}: {what}", shown(&name.to_string_lossy()))
}

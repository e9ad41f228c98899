//! Notes for a scene's author on its models: contents of their files that the picture does not have.

use std::path::{Path, PathBuf};

use crate::description::{Description, Object, Surface};
use crate::mesh_file::{self, LeftOut, UsedContents};
use crate::text::shown;

impl Description {
    /// Lists, file by file and each once, the contents of the models that are not in the picture. Files are looked for in
    /// `base_dir`; what cannot be read has nothing.
    pub fn left_out(&self, base_dir: &Path) -> Vec<(PathBuf, Vec<LeftOut>)> {
        let mut models: Vec<(&PathBuf, UsedContents)> = Vec::new();
        for object in &self.objects {
            let Surface::Mesh(file) = &object.surface else {
                continue;
            };
            let wanted = UsedContents::of(object, self.lights_of.as_deref());
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
    pub fn model_notes(&self, base_dir: &Path) -> Vec<String> {
        let left_out = self.left_out(base_dir).into_iter();
        left_out
            .flat_map(|(file, left_out)| notes(&file, &left_out))
            .collect()
    }
}

impl UsedContents {
    /// `lights_of` as in [`Description::lights_of`].
    pub(crate) fn of(object: &Object, lights_of: Option<&Path>) -> Self {
        Self {
            lights: matches!(&object.surface, Surface::Mesh(file) if Some(&**file) == lights_of),
            own_materials: object.material.is_none(),
            animation: object.time_s.is_some(),
        }
    }
}

/// Notes on the contents whose absence changes the picture, a line each.
pub(crate) fn notes(file: &Path, left_out: &[LeftOut]) -> Vec<String> {
    let line = |it: &LeftOut| {
        let what = format!("{} ({}) left out; {}", it.what, it.count, it.meaning);
        note(file, &what)
    };
    left_out.iter().filter(|it| it.matters).map(line).collect()
}

/// A line about a model.
pub(crate) fn note(file: &Path, what: &str) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str());
    format!("{}: {what}", shown(&name.to_string_lossy()))
}

//! Scene files: opened, and saved whole or not at all.

use std::path::Path;
use std::sync::Arc;

use hairline_image::output::write_atomically;
use hairline_scene::{Description, Error};

use super::{Document, layout, next_revision};
use crate::paths;

/// Why a document was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// It has no file yet; ask for one.
    #[error("the scene has no file yet; choose a name for it")]
    NoPath,
    /// It holds what a scene file cannot, such as a path that is not Unicode.
    #[error("the scene cannot be written as a scene file: {0}")]
    Form(String),
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] hairline_image::Error),
}

impl Document {
    /// Opens a scene file. Its form, ranges and references are checked; the files that it names are not read.
    ///
    /// # Errors
    /// What is wrong in the file, with its line.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|error| {
            let found = format!("cannot be read ({error})");
            Error::new("", found, "give the path of a scene file (TOML)").at(path, None)
        })?;
        let description = Self::read(&text, path)?;
        Ok(Self {
            path: Some(path.to_owned()),
            text: Some(text.into()),
            ..Self::untitled(description, path.parent().unwrap_or(Path::new("")))
        })
    }

    /// Reads a scene file's text as [`Self::open`] does; `name` is what errors call it.
    ///
    /// # Errors
    /// What is wrong in the text, with its line.
    pub fn read(text: &str, name: &Path) -> Result<Description, Error> {
        let description = Description::from_toml(text, name)?;
        description
            .check()
            .and_then(|()| description.check_references())
            .map_err(|error| error.in_scene_file(text, name))?;
        Ok(description)
    }

    /// Writes the scene to its file. Comments and layout of what was not edited stay as they are.
    ///
    /// # Errors
    /// [`SaveError`]; then the file is as it was.
    pub fn save(&mut self) -> Result<(), SaveError> {
        let path = self.path.clone().ok_or(SaveError::NoPath)?;
        self.text = Some(self.write(&path)?);
        self.was_saved();
        Ok(())
    }

    /// Writes the scene to another file, which is its own from now on. What it names keeps its place: paths in the
    /// description, and in every step of its history, are made relative to the new folder.
    ///
    /// # Errors
    /// [`SaveError`]; then neither the file nor the document has changed.
    pub fn save_as(&mut self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        let from = paths::absolute(&self.base_dir);
        let to = paths::absolute(folder);
        let mut rebased = self.clone();
        if from != to {
            rebased.rebase(&from, &to);
        }
        rebased.text = Some(rebased.write(path)?);
        rebased.path = Some(path.to_owned());
        rebased.base_dir = folder.to_owned();
        rebased.was_saved();
        *self = rebased;
        Ok(())
    }

    /// Returns the text that the file has now.
    fn write(&self, path: &Path) -> Result<Arc<str>, SaveError> {
        let description = &self.state.description;
        let mut text = description
            .to_toml()
            .map_err(|error| SaveError::Form(error.to_string()))?;
        if let Some(original) = &self.text {
            text = layout::kept(original, description, text);
        }
        write_atomically(path, text.as_bytes())?;
        Ok(text.into())
    }

    fn was_saved(&mut self) {
        self.end_drag();
        self.saved = Some(self.state.description.clone());
        self.is_modified = false;
    }

    fn rebase(&mut self, from: &Path, to: &Path) {
        let mut done: Vec<(Arc<Description>, Arc<Description>)> = Vec::new();
        let mut change = |old: &Arc<Description>| {
            if let Some((_, new)) = done.iter().find(|(known, _)| Arc::ptr_eq(known, old)) {
                return new.clone();
            }
            let mut description = (**old).clone();
            paths::each_path(&mut description, &mut |path| {
                *path = paths::rebase(path, from, to);
            });
            let new = match description == **old {
                true => old.clone(),
                false => Arc::new(description),
            };
            done.push((old.clone(), new.clone()));
            new
        };
        let description = change(&self.state.description);
        if !Arc::ptr_eq(&description, &self.state.description) {
            self.revision = next_revision();
        }
        self.state.description = description;
        self.history.rewrite(&mut change);
        self.end_drag();
    }
}

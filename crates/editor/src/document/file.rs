//! Scene files: opened, and saved whole or not at all.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use hairline_document::description::FileUse;
use hairline_document::{Description, Error, inputs, reading};
use hairline_image::FilePath;
use hairline_image::output::write_atomically;

use super::{Document, layout};
use crate::paths;

/// Reason why a document was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The document has no file yet; ask for one.
    #[error("the scene has no file yet; choose a name for it")]
    NoPath,
    /// The file has changed since it was opened or saved here; see [`Document::save_over`].
    #[error("{} has changed on disk since it was opened or saved here", .0.display())]
    ChangedOnDisk(PathBuf),
    /// The document holds a value that a scene file cannot, such as a path that is not Unicode.
    #[error("the scene cannot be written as a scene file: {0}")]
    Form(String),
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] hairline_image::Error),
}

/// State of a document's file since it was opened or saved here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnDisk {
    /// The file's text is the same.
    Same,
    /// The file's text is another.
    Changed,
    /// There is no such file, or it cannot be read; or the document has none.
    Gone,
}

impl Document {
    /// Opens a scene file. Its form, ranges and references are checked; the files that it names are not read.
    ///
    /// # Errors
    /// What is wrong in the file, with its line.
    pub fn open(path: impl Into<FilePath>) -> Result<Self, Error> {
        let path = &path.into();
        let text = reading::scene_text(path)?;
        let description = Self::read(&text, path)?;
        let folder = path.folder();
        // The camera of a file becomes the scene's own here, so that it can be moved.
        let seen = description
            .with_its_camera(&folder)
            .map_err(|error| error.in_scene_file(&text, path))?
            .into_owned();
        Ok(Self {
            path: Some(path.to_path_buf()),
            text: Some(text.into()),
            ..Self::untitled(seen, folder)
        })
    }

    /// Reads a scene file's text as [`Self::open`] does; `name` is the file's name in errors.
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

    /// Compares its file with the text that was opened or saved here. Reads the file: what a clock says of it may be wrong.
    pub fn on_disk(&self) -> OnDisk {
        let text = self.path.as_ref().map(std::fs::read_to_string);
        match text {
            Some(Ok(text)) if self.text.as_deref() == Some(&text) => OnDisk::Same,
            Some(Ok(text)) if self.passed_over.as_deref() == Some(&text) => OnDisk::Same,
            Some(Ok(_)) => OnDisk::Changed,
            Some(Err(_)) | None => OnDisk::Gone,
        }
    }

    /// The document goes on, and the file's text of now may be written over: somebody has chosen between the two.
    pub fn pass_over_disk(&mut self) {
        let text = self.path.as_ref().map(std::fs::read_to_string);
        self.passed_over = text.and_then(Result::ok).map(Into::into);
    }

    /// Reads the scene from its file again, as one step that undo reverts.
    ///
    /// # Errors
    /// What is wrong in the file, with its line; then nothing has changed.
    pub fn reload(&mut self) -> Result<(), Error> {
        let Some(path) = self.path.clone() else {
            return Ok(());
        };
        let text = reading::scene_text(self.base_dir.with_path(&path))?;
        let description = Self::read(&text, &path)?;
        self.edit("Reload", |d| *d = description);
        self.text = Some(text.into());
        self.was_saved();
        Ok(())
    }

    /// Whether [`Self::revert`] would change something.
    pub fn can_revert(&self) -> bool {
        self.is_modified && self.saved.is_some()
    }

    /// Restores the description that was opened or saved last, as one step that undo reverts.
    pub fn revert(&mut self) {
        if let Some(saved) = self.saved.clone() {
            self.edit("Revert", |d| d.clone_from(&saved));
        }
    }

    /// Files that the scene names, with their full paths as far as the document knows its folder.
    pub fn files(&self) -> Vec<PathBuf> {
        let named = self.state.description.files().into_iter();
        named
            .map(|(_, path)| inputs::file_of(self.base_dir.join(path)))
            .collect()
    }

    /// Returns the files that are not there, as the scene names them, each once, with the use of the first place that names
    /// it.
    pub fn missing_files(&self) -> Vec<(FileUse, PathBuf)> {
        let mut missing: Vec<(FileUse, PathBuf)> = Vec::new();
        for (of, path) in self.state.description.files() {
            let is_known = missing.iter().any(|(_, known)| known == path);
            if !is_known && !inputs::is_there(self.base_dir.join(path)) {
                missing.push((of, path.clone()));
            }
        }
        missing
    }

    /// Takes the file's text as the one that the document began with, unless it was written after `since`.
    pub(crate) fn adopt_text(&mut self, since: Option<SystemTime>) {
        let Some(path) = &self.path else { return };
        let written = std::fs::metadata(path).and_then(|data| data.modified());
        if let (Ok(written), Some(since)) = (written, since)
            && written <= since
        {
            self.text = reading::scene_text(self.base_dir.with_path(path))
                .ok()
                .map(Into::into);
        }
    }

    /// Writes the scene to its file. Comments and layout of what was not edited stay as they are.
    ///
    /// # Errors
    /// [`SaveError`]; then the file is as it was.
    pub fn save(&mut self) -> Result<(), SaveError> {
        match (&self.path, self.on_disk()) {
            (Some(path), OnDisk::Changed) => Err(SaveError::ChangedOnDisk(path.clone())),
            _ => self.save_over(),
        }
    }

    /// Saves the document, whatever the file holds by now.
    ///
    /// # Errors
    /// [`SaveError`] but [`SaveError::ChangedOnDisk`]; then the file is as it was.
    pub fn save_over(&mut self) -> Result<(), SaveError> {
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
        rebased.base_dir = self.base_dir.with_path(folder);
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
        write_atomically(self.base_dir.with_path(path), text.as_bytes())?;
        Ok(text.into())
    }

    fn was_saved(&mut self) {
        self.end_drag();
        self.passed_over = None;
        self.saved = Some(self.state.description.clone());
        self.is_modified = false;
    }

    /// Rewrites a description whose relative paths start from `base_dir`, so that they start from this document's folder.
    pub fn brought_here(&self, description: &Description, base_dir: &Path) -> Description {
        rebased(description, base_dir, &self.base_dir)
    }

    fn rebase(&mut self, from: &Path, to: &Path) {
        let mut done: Vec<(Arc<Description>, Arc<Description>)> = Vec::new();
        let mut change = |old: &Arc<Description>| {
            if let Some((_, new)) = done.iter().find(|(known, _)| Arc::ptr_eq(known, old)) {
                return new.clone();
            }
            let mut description = (**old).clone();
            for (_, path) in description.files_mut() {
                *path = paths::rebase(path, from, to);
            }
            let new = match description == **old {
                true => old.clone(),
                false => Arc::new(description),
            };
            done.push((old.clone(), new.clone()));
            new
        };
        let description = change(&self.state.description);
        if !Arc::ptr_eq(&description, &self.state.description) {
            self.revision += 1;
        }
        self.state.description = description;
        self.history.rewrite(&mut change);
        self.end_drag();
    }
}

/// A description whose relative paths start from `from`, rewritten so that they start from `to`.
pub fn rebased(description: &Description, from: &Path, to: &Path) -> Description {
    let mut description = description.clone();
    if from != to {
        let (from, to) = (paths::absolute(from), paths::absolute(to));
        for (_, path) in description.files_mut() {
            *path = paths::rebase(path, &from, &to);
        }
    }
    description
}

//! Loads a scene file to a [`Scene`].

use std::path::Path;

use hairline_image::FilePath;

use crate::builder::SceneBuilder;
use crate::description::Description;
use crate::error::Error;
use crate::loader::Loader;
use crate::reading;
use hairline_scene::Scene;

/// Reads a scene file and all that it names, within the limits of [`Loader::default`].
pub fn load(path: impl AsRef<Path>) -> Result<Scene, Error> {
    Loader::default().load(path.as_ref())
}

/// Reads a scene from text. `name` is what errors call it; files are looked for in `base_dir`.
pub fn from_toml(
    text: &str,
    name: impl AsRef<Path>,
    base_dir: impl AsRef<Path>,
) -> Result<Scene, Error> {
    Loader::default().from_toml(text, name, base_dir.as_ref())
}

/// Builds the scene of a description. Files are looked for in `base_dir`.
pub fn build(description: &Description, base_dir: impl AsRef<Path>) -> Result<Scene, Error> {
    Loader::default().build(description, base_dir.as_ref())
}

impl Loader<'_> {
    /// See [`load()`].
    pub fn load(&self, path: impl Into<FilePath>) -> Result<Scene, Error> {
        let path = path.into();
        let text = reading::scene_text(&path)?;
        self.from_toml(&text, &path, path.folder())
    }

    /// See [`from_toml`].
    pub fn from_toml(
        &self,
        text: &str,
        name: impl AsRef<Path>,
        base_dir: impl Into<FilePath>,
    ) -> Result<Scene, Error> {
        let name = name.as_ref();
        let description = Description::from_toml(text, name)?;
        self.build(&description, base_dir)
            .map_err(|error| error.in_scene_file(text, name))
    }

    /// See [`build()`]. An error names the key; [`Error::in_scene_file`] adds the line, if there is a file.
    pub fn build(
        &self,
        description: &Description,
        base_dir: impl Into<FilePath>,
    ) -> Result<Scene, Error> {
        SceneBuilder::new().build(self, description, base_dir)
    }
}

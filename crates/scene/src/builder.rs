//! Builds scenes one after the other and keeps what has not changed: what an editor needs.

use std::path::Path;

use crate::description::Description;
use crate::error::Error;
use crate::load::Loader;
use crate::scene::Scene;

/// Builds scenes one after the other; see [`SceneBuilder::build`].
#[derive(Debug, Default)]
pub struct SceneBuilder {}

impl SceneBuilder {
    /// A builder that has built nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Builds what is described.
    ///
    /// # Errors
    /// What is wrong with the scene, or that the work was cancelled.
    pub fn build(
        &mut self,
        loader: &Loader,
        description: &Description,
        base_dir: &Path,
    ) -> Result<Scene, Error> {
        loader.build(description, base_dir)
    }
}

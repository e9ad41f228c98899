//! Textures of a scene that is being built, file by file.

use std::sync::Arc;

use hairline_scene::Texture;

/// Textures of a scene that is being built.
pub(super) struct NewTextures {
    pub parts: Vec<Arc<Vec<Texture>>>,
    pub count: usize,
    pub free_bytes: f64,
}

impl NewTextures {
    /// Adds the textures of one file, and returns the number of the first.
    pub(super) fn add(&mut self, textures: Arc<Vec<Texture>>) -> usize {
        let first = self.count;
        self.count += textures.len();
        if !textures.is_empty() {
            self.parts.push(textures);
        }
        first
    }
}

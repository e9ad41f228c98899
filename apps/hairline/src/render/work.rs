//! What is to be done with a scene, whether it becomes one picture or many.

use hairline_render::failure::Failure;
use hairline_render::{Painter, Task, Writer};
use hairline_scene::Scene;

use crate::cli;
use crate::progress::Terminal;

/// What is to be done with the scene, and what files have of its pictures.
pub(super) struct Work<'a> {
    pub arguments: &'a cli::Render,
    pub task: Task,
    pub writer: Writer,
    pub terminal: Terminal,
}

impl Work<'_> {
    /// Chooses the renderer and reports it.
    ///
    /// # Errors
    /// As [`Painter::choose`].
    pub fn painter(&self, scene: &Scene) -> Result<Painter<'_>, Failure> {
        let backend = self.arguments.backend.into();
        Painter::choose(scene, backend, self.task.clone(), &self.terminal)
    }
}

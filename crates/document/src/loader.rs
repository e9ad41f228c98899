//! The limits and the listener of a load.

use hairline_memory::budget_bytes;

use crate::arrays::Arrays;
use crate::error::Error;

/// Progress of long work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Current stage.
    pub stage: Stage,
    /// Number of units of the work that are done, out of `total`.
    pub done: u64,
    /// Number of units of the stage: objects for [`Stage::Meshes`], scratches for [`Stage::Scratches`].
    pub total: u64,
}

/// The slow stages of loading a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading and building the objects' surfaces.
    Meshes,
    /// Reading and prefiltering the environment.
    Environment,
    /// Laying scratches on the surfaces.
    Scratches,
}

/// Loads scenes within limits.
#[derive(Clone, Copy)]
pub struct Loader<'a> {
    /// Largest memory of a scene, here and in renderers; larger ones are refused before they are built.
    pub memory_budget_bytes: u64,
    /// Arrays in memory, where a scene names no file.
    pub arrays: &'a Arrays,
    /// Callback for the progress of long work, on the calling thread.
    pub progress: &'a dyn Fn(Progress),
    /// Callback on the calling thread that returns whether to give up. Then the work ends with an error for
    /// which
    /// [`Error::is_cancelled`] holds.
    pub cancelled: &'a dyn Fn() -> bool,
}

impl Default for Loader<'_> {
    /// Silent, and with [`budget_bytes`].
    fn default() -> Self {
        Self {
            memory_budget_bytes: budget_bytes(),
            arrays: Arrays::none(),
            progress: &|_| {},
            cancelled: &|| false,
        }
    }
}

impl Loader<'_> {
    /// An error if the caller gave up.
    pub(crate) fn go_on(&self) -> Result<(), Error> {
        match (self.cancelled)() {
            true => Err(Error::cancelled()),
            false => Ok(()),
        }
    }

    pub(crate) fn report(&self, stage: Stage, done: u64, total: u64) {
        (self.progress)(Progress { stage, done, total });
    }
}

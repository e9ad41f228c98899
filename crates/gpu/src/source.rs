//! A scene with its trees and tables, ready to be uploaded.

use std::sync::Arc;

use hairline_index::ScratchIndex;
use hairline_scene::{Scene, ScratchTables};

use crate::method::Method;

/// A scene, its index, its tables, and the method that they are to be rendered by.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub scene: &'a Scene,
    pub index: &'a Arc<ScratchIndex>,
    pub tables: &'a ScratchTables,
    pub method: &'a Method,
}

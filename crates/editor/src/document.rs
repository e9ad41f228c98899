//! A scene that is being edited: its description, its file, and the history of its edits.

mod file;
mod layout;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use hairline_document::Description;
use hairline_image::FilePath;

use crate::history::{DragKey, History, State};
use crate::{ActionError, Selection};

pub use file::{OnDisk, SaveError, rebased};

/// A scene file in the making, with undo.
#[derive(Clone, Debug)]
pub struct Document {
    state: State,
    history: History,
    drag: Option<Drag>,
    /// Contents of the file; none if no file holds the scene with which this document began.
    saved: Option<Arc<Description>>,
    is_modified: bool,
    path: Option<PathBuf>,
    base_dir: FilePath,
    revision: u64,
    /// The file's text as it was opened or saved last; none where there is no file.
    text: Option<Arc<str>>,
    /// Other text of the file that was seen, and may be written over.
    passed_over: Option<Arc<str>>,
}

/// A drag that goes on.
#[derive(Clone, Debug)]
struct Drag {
    label: String,
    key: DragKey,
    before: State,
    /// Whether the newest step of the history is this drag's.
    is_step: bool,
}

impl Document {
    /// A scene that has no file yet, such as the built-in one. Paths in it are relative to `base_dir`. It counts as
    /// unmodified: closing it loses nothing.
    pub fn untitled(description: Description, base_dir: impl Into<FilePath>) -> Self {
        let description = Arc::new(description);
        Self {
            saved: Some(description.clone()),
            state: State {
                description,
                selection: Selection::None,
            },
            history: History::default(),
            drag: None,
            is_modified: false,
            path: None,
            base_dir: base_dir.into(),
            revision: 1,
            text: None,
            passed_over: None,
        }
    }

    /// Makes a document of an autosave: a scene that no file holds as it is, though it belongs to one at `path`, if it
    /// has one. It counts as modified until it is saved.
    pub(crate) fn recovered(
        description: Description,
        path: Option<PathBuf>,
        base_dir: impl Into<FilePath>,
    ) -> Self {
        Self {
            path,
            saved: None,
            is_modified: true,
            ..Self::untitled(description, base_dir)
        }
    }

    /// Puts another document in the place of this one. Its revisions follow those of this one.
    pub fn replace(&mut self, by: Self) {
        let revision = self.revision + 1;
        *self = Self { revision, ..by };
    }

    /// The current description of the scene.
    pub fn description(&self) -> &Arc<Description> {
        &self.state.description
    }

    /// The scene file, once there is one.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The folder that paths in the description are relative to.
    pub fn base_dir(&self) -> &FilePath {
        &self.base_dir
    }

    /// Title of the window: the file's name, without a mark for unsaved changes.
    pub fn title(&self) -> String {
        match self.path.as_deref().and_then(Path::file_name) {
            Some(name) => name.to_string_lossy().into_owned(),
            None => "untitled".to_owned(),
        }
    }

    /// Number that grows with every change of the description, undo and redo among them.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether the description differs from the one that was last saved or opened.
    pub fn is_modified(&self) -> bool {
        self.is_modified
    }

    /// Part that the panel shows; always in the description.
    pub fn selection(&self) -> Selection {
        self.state.selection
    }

    /// Selects. That is no step of its own, but steps restore what was selected when they were made.
    pub fn select(&mut self, selection: Selection) {
        self.state.selection = selection.held_by(&self.state.description);
    }

    /// Changes the description as one step. A change that changes nothing makes no step.
    pub fn edit(&mut self, label: &str, change: impl FnOnce(&mut Description)) {
        let selection = self.state.selection;
        let done = self.apply(label, |description, _| {
            change(description);
            Ok(selection)
        });
        debug_assert!(done.is_ok());
    }

    /// Applies an action of [`actions`](crate::actions) as one step: it is given the description and the selection, and
    /// returns the selection after it.
    ///
    /// # Errors
    /// The action's; then nothing has changed.
    pub fn apply(
        &mut self,
        label: &str,
        action: impl FnOnce(&mut Description, Selection) -> Result<Selection, ActionError>,
    ) -> Result<(), ActionError> {
        self.end_drag();
        let before = self.state.clone();
        let mut description = (*before.description).clone();
        let selection = action(&mut description, before.selection)?;
        if description != *before.description {
            self.state.description = Arc::new(description);
        }
        self.state.selection = selection.held_by(&self.state.description);
        if !Arc::ptr_eq(&self.state.description, &before.description) {
            self.history.push(label, before, self.state.selection);
            self.changed();
        }
        Ok(())
    }

    /// Changes the description as part of a drag: while the same label and key come, all of it is one step. `change` gets
    /// the description as the drag has left it so far; see also [`Self::before_drag`].
    pub fn drag(&mut self, label: &str, key: DragKey, change: impl FnOnce(&mut Description)) {
        let mut drag = match self.drag.take() {
            Some(drag) if drag.key == key && drag.label == label => drag,
            _ => Drag {
                label: label.to_owned(),
                key,
                before: self.state.clone(),
                is_step: false,
            },
        };
        let last = self.state.description.clone();
        let mut description = (*last).clone();
        change(&mut description);
        if description != *last {
            let back = description == *drag.before.description;
            self.state.description = match back {
                true => drag.before.description.clone(),
                false => Arc::new(description),
            };
            self.state.selection = self.state.selection.held_by(&self.state.description);
            match (back, drag.is_step) {
                (true, true) => self.history.pop(),
                (false, false) => {
                    let before = drag.before.clone();
                    self.history.push(label, before, self.state.selection);
                }
                _ => self.history.set_newest_selection(self.state.selection),
            }
            drag.is_step = !back;
            self.changed();
        }
        self.drag = Some(drag);
    }

    /// Description at the beginning of the current drag, to which a gizmo applies its whole motion.
    pub fn before_drag(&self) -> Option<&Arc<Description>> {
        self.drag.as_ref().map(|drag| &drag.before.description)
    }

    /// Ends a drag, so that the next [`Self::drag`] is a step of its own.
    pub fn end_drag(&mut self) {
        self.drag = None;
    }

    /// Takes back the changes of the current drag, as for the Escape key.
    pub fn cancel_drag(&mut self) {
        if let Some(drag) = self.drag.take()
            && drag.is_step
        {
            self.history.pop();
            self.state = drag.before;
            self.changed();
        }
    }

    /// One step back; its label.
    pub fn undo(&mut self) -> Option<String> {
        self.end_drag();
        let (state, label) = self.history.undo(self.state.clone())?;
        self.state = state;
        self.changed();
        Some(label)
    }

    /// The description before the newest step; none where steps were undone.
    pub fn before_step(&self) -> Option<&Arc<Description>> {
        self.history.previous()
    }

    /// Takes the newest step back for good, as if it had been refused; its label.
    pub fn refuse_step(&mut self) -> Option<String> {
        let label = self.undo()?;
        self.history.drop_redo();
        Some(label)
    }

    /// One step forward again; its label.
    pub fn redo(&mut self) -> Option<String> {
        self.end_drag();
        let (state, label) = self.history.redo(self.state.clone())?;
        self.state = state;
        self.changed();
        Some(label)
    }

    /// Label of the step that [`Self::undo`] would take back.
    pub fn undo_label(&self) -> Option<&str> {
        self.history.undo_label()
    }

    /// Label of the step that [`Self::redo`] would do again.
    pub fn redo_label(&self) -> Option<&str> {
        self.history.redo_label()
    }

    fn changed(&mut self) {
        self.revision += 1;
        self.is_modified = match &self.saved {
            Some(saved) => {
                !Arc::ptr_eq(saved, &self.state.description) && **saved != *self.state.description
            }
            None => true,
        };
    }
}

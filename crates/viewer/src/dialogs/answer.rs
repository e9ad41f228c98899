//! Actions after an answer.

use std::path::PathBuf;

use hairline_editor::autosave::Pending;

use crate::files::Purpose;

/// Action that waits for an answer about unsaved changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PendingAction {
    New,
    /// An example, by its index.
    Example(usize),
    Open(PathBuf),
    Quit,
}

/// Answer to a question.
pub(crate) enum Answer {
    /// Nothing changes.
    Cancel,
    /// Nothing is done, and the scene is not saved.
    CancelSaving,
    /// The scene is saved before the action.
    SaveBefore(PendingAction),
    Perform(PendingAction),
    /// An action, before which unsaved changes are asked about.
    Request(PendingAction),
    SaveOver,
    SaveAs,
    /// A file that is there is written over.
    Replace(Purpose, PathBuf),
    /// The file gets another name than this.
    Rename(Purpose, PathBuf),
    /// A path was typed.
    Path(Purpose, PathBuf),
    /// What is selected becomes a preset of this name; of a light, if it is true, all lights do.
    SavePreset(String, bool),
    Reload,
    /// The text that another program has written is ignored.
    PassOver,
    /// The model is added as large as in its file, or fitted to a size.
    AddModel(PathBuf, Option<f64>),
    Recover(Pending),
}

//! Errors of lists of pieces.

/// An error of a list of pieces: its key, what was found there, and what would be right.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key}: {found}; {right}")]
pub struct Error {
    /// Key of the list.
    pub key: &'static str,
    /// What was found.
    pub found: String,
    /// What would be right.
    pub right: String,
}

impl Error {
    pub(crate) fn new(key: &'static str, found: String, right: impl Into<String>) -> Self {
        Self {
            key,
            found,
            right: right.into(),
        }
    }
}

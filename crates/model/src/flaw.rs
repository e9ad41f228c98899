//! Errors of a model's file.

/// Description of a valid file.
pub(crate) const RIGHT: &str = "must be a whole glTF 2.0 file, text (.gltf) or binary (.glb)";

/// An error of a file: what was found, and what would be right.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{found}")]
pub struct Flaw {
    /// What was found there.
    pub found: String,
    /// What would be right.
    pub right: String,
}

impl Flaw {
    /// Both are halves of a sentence.
    pub fn new(found: impl Into<String>, right: impl Into<String>) -> Self {
        Self {
            found: found.into(),
            right: right.into(),
        }
    }
}

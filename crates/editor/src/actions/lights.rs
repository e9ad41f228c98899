//! Lights.

use hairline_document::Description;
use hairline_document::description::Light;

use super::list;
use crate::Selection;

/// Adds a light, under another name if its own is taken.
pub fn add(description: &mut Description, light: Light) -> Selection {
    list::insert(description, description.lights.len(), light)
}

/// Title of a light in a list: its name, else its kind.
pub fn title(light: &Light) -> &str {
    let kind = light.kind.title();
    light.name.as_deref().unwrap_or(kind)
}

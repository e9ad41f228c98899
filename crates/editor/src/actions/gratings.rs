//! Gratings.

use hairline_document::Description;
use hairline_document::description::Grating;

use super::{ActionError, list};
use crate::Selection;

/// Adds a grating behind the last one of its object.
///
/// # Errors
/// [`ActionError::Missing`]: no object of that name.
pub fn add(description: &mut Description, grating: Grating) -> Result<Selection, ActionError> {
    if !description.objects.iter().any(|o| o.name == grating.object) {
        return Err(ActionError::Missing("object"));
    }
    let place = description.gratings.len();
    Ok(list::insert(description, place, grating))
}

/// Title of a grating in a list: its name and its pitch.
pub fn title(grating: &Grating) -> String {
    let name = grating.name.as_deref().unwrap_or("grating");
    format!("{name}, {} µm", grating.pitch_um)
}

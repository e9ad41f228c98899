//! Gratings.

use hairline_scene::Description;
use hairline_scene::description::Grating;

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

/// Adds a copy behind the original.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let copy: Grating = list::get(description, index).cloned()?;
    Ok(list::insert(description, index + 1, copy))
}

/// Removes a grating. Where it was selected, the next one on the same object is, else the object.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn delete(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    list::remove_from_object::<Grating>(description, index, selection)
}

/// Changes places with the next grating of the same object up (`by` -1) or down (1); at the end nothing happens.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn shift(
    description: &mut Description,
    index: usize,
    by: isize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    list::shift::<Grating>(description, index, by, selection)
}

/// Hides a grating or shows it again.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn toggle_hidden(
    description: &mut Description,
    index: usize,
) -> Result<Selection, ActionError> {
    let grating: &mut Grating = list::get_mut(description, index)?;
    grating.hidden = !grating.hidden;
    Ok(Selection::Grating(index))
}

/// Title of a grating in a list: its name and its pitch.
pub fn title(grating: &Grating) -> String {
    let name = grating.name.as_deref().unwrap_or("grating");
    format!("{name}, {} µm", grating.pitch_um)
}

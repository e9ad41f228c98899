//! Lights.

use hairline_scene::Description;
use hairline_scene::description::Light;

use super::{ActionError, list};
use crate::Selection;

/// Adds a light, under another name if its own is taken.
pub fn add(description: &mut Description, light: Light) -> Selection {
    list::insert(description, description.lights.len(), light)
}

/// Adds a copy in the same place, behind the original.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let copy: Light = list::get(description, index).cloned()?;
    Ok(list::insert(description, index + 1, copy))
}

/// Sets the name of a light; an empty one removes it.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn rename(
    description: &mut Description,
    index: usize,
    name: &str,
) -> Result<Selection, ActionError> {
    list::rename_freely::<Light>(description, index, name)
}

/// Puts a light out or on again.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn toggle_hidden(
    description: &mut Description,
    index: usize,
) -> Result<Selection, ActionError> {
    let light: &mut Light = list::get_mut(description, index)?;
    light.hidden = !light.hidden;
    Ok(Selection::Light(index))
}

/// Title of a light in a list: its name, else its kind.
pub fn title(light: &Light) -> &str {
    let kind = light.kind.title();
    light.name.as_deref().unwrap_or(kind)
}

/// Removes a light.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn delete(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    list::remove::<Light>(description, index, selection)
}

/// Changes places with the next one up (`by` -1) or down (1); at the end nothing happens.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn shift(
    description: &mut Description,
    index: usize,
    by: isize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    list::shift::<Light>(description, index, by, selection)
}

//! Lights.

use hairline_scene::Description;
use hairline_scene::description::Light;

use super::ActionError;
use crate::Selection;
use crate::selection::{after_removal, after_swap};

/// Adds a light.
pub fn add(description: &mut Description, light: Light) -> Selection {
    description.lights.push(light);
    Selection::Light(description.lights.len() - 1)
}

/// Adds a copy in the same place, behind the original.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let copy = get(description, index)?.clone();
    description.lights.insert(index + 1, copy);
    Ok(Selection::Light(index + 1))
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
    get(description, index)?;
    description.lights.remove(index);
    Ok(match selection {
        Selection::Light(i) => after_removal(i, index, description.lights.len())
            .map_or(Selection::None, Selection::Light),
        other => other,
    })
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
    get(description, index)?;
    let Some(other) = index
        .checked_add_signed(by.signum())
        .filter(|&other| other < description.lights.len())
    else {
        return Ok(selection);
    };
    description.lights.swap(index, other);
    Ok(match selection {
        Selection::Light(i) => Selection::Light(after_swap(i, index, other)),
        held => held,
    })
}

fn get(description: &Description, index: usize) -> Result<&Light, ActionError> {
    let light = description.lights.get(index);
    light.ok_or(ActionError::Missing("light"))
}

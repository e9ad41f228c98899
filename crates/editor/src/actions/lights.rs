//! Lights.

use hairline_scene::Description;
use hairline_scene::description::{Light, LightKind};

use super::{ActionError, unique_name};
use crate::Selection;
use crate::selection::{after_removal, after_swap};

/// Adds a light, under another name if its own is taken.
pub fn add(description: &mut Description, light: Light) -> Selection {
    insert(description, description.lights.len(), light)
}

/// Adds a copy in the same place, behind the original.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let copy = get(description, index)?.clone();
    Ok(insert(description, index + 1, copy))
}

/// Gives a light a name; an empty one takes it away.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn rename(
    description: &mut Description,
    index: usize,
    name: &str,
) -> Result<Selection, ActionError> {
    let name = Some(name.trim()).filter(|name| !name.is_empty());
    get_mut(description, index)?.name = name.map(str::to_owned);
    Ok(Selection::Light(index))
}

/// Puts a light out or on again.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn toggle_hidden(
    description: &mut Description,
    index: usize,
) -> Result<Selection, ActionError> {
    let light = get_mut(description, index)?;
    light.hidden = !light.hidden;
    Ok(Selection::Light(index))
}

/// What a list calls a light: its name, else its kind.
pub fn title(light: &Light) -> &str {
    match (&light.name, &light.kind) {
        (Some(name), _) => name,
        (None, LightKind::Sphere { .. }) => "sphere light",
        (None, LightKind::Polygon { .. }) => "polygon light",
    }
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

fn get_mut(description: &mut Description, index: usize) -> Result<&mut Light, ActionError> {
    let light = description.lights.get_mut(index);
    light.ok_or(ActionError::Missing("light"))
}

fn insert(description: &mut Description, place: usize, mut light: Light) -> Selection {
    if let Some(name) = &mut light.name {
        let others = description.lights.iter();
        *name = unique_name(name, others.filter_map(|other| other.name.as_deref()));
    }
    description.lights.insert(place, light);
    Selection::Light(place)
}

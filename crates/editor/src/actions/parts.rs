//! Actions on any part of a scene that can be selected. Those that a kind of part has for itself are in the module of that kind.

use hairline_document::Description;
use hairline_document::description::{Grating, Light, Look, Material, Object, Scratches};

use super::list::{self, ListedPart};
use super::{ActionError, layers, materials, objects, studio};
use crate::Selection;

/// Adds a copy behind the original, of an object with all that lies on it. Parts that are there once have none.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, part: Selection) -> Result<Selection, ActionError> {
    match part {
        Selection::Object(i) => objects::duplicate(description, i),
        Selection::Layer(i) => layers::duplicate(description, i),
        Selection::Grating(i) => copy::<Grating>(description, i),
        Selection::Light(i) => copy::<Light>(description, i),
        Selection::Material(i) => copy::<Material>(description, i),
        Selection::Look(i) => copy::<Look>(description, i),
        other => Ok(other),
    }
}

fn copy<P: ListedPart>(
    description: &mut Description,
    index: usize,
) -> Result<Selection, ActionError> {
    let copy: P = list::get(description, index).cloned()?;
    Ok(list::insert(description, index + 1, copy))
}

/// Removes a part. Where it was selected, the next one is: of a layer or a grating on the same object, else the object. Parts that are there
/// once stay.
///
/// # Errors
/// [`ActionError::Missing`], [`ActionError::LastObject`], [`ActionError::MaterialInUse`].
pub fn delete(
    description: &mut Description,
    part: Selection,
    selection: Selection,
) -> Result<Selection, ActionError> {
    match part {
        Selection::Object(i) => objects::delete(description, i, selection),
        Selection::Layer(i) => list::remove_from_object::<Scratches>(description, i, selection),
        Selection::Grating(i) => list::remove_from_object::<Grating>(description, i, selection),
        Selection::Light(i) => list::remove::<Light>(description, i, selection),
        Selection::Material(i) => materials::delete(description, i, selection),
        Selection::Look(i) => list::remove::<Look>(description, i, selection),
        _ => Ok(selection),
    }
}

/// Changes places with the next part up (`by` -1) or down (1), of a layer or a grating on the same object; at the end nothing happens.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn shift(
    description: &mut Description,
    part: Selection,
    by: isize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    match part {
        Selection::Object(i) => list::shift::<Object>(description, i, by, selection),
        Selection::Layer(i) => list::shift::<Scratches>(description, i, by, selection),
        Selection::Grating(i) => list::shift::<Grating>(description, i, by, selection),
        Selection::Light(i) => list::shift::<Light>(description, i, by, selection),
        Selection::Material(i) => list::shift::<Material>(description, i, by, selection),
        Selection::Look(i) => list::shift::<Look>(description, i, by, selection),
        _ => Ok(selection),
    }
}

/// Hides a part or shows it again, of an object with all that lies on it. Parts that cannot be hidden stay.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn toggle_hidden(
    description: &mut Description,
    part: Selection,
) -> Result<Selection, ActionError> {
    let hidden = match part {
        Selection::Object(i) => &mut list::get_mut::<Object>(description, i)?.hidden,
        Selection::Layer(i) => &mut list::get_mut::<Scratches>(description, i)?.hidden,
        Selection::Grating(i) => &mut list::get_mut::<Grating>(description, i)?.hidden,
        Selection::Light(i) => &mut list::get_mut::<Light>(description, i)?.hidden,
        Selection::Studio => &mut description.studio.hidden,
        Selection::Ground => return Ok(studio::toggle_ground(description)),
        other => return Ok(other),
    };
    *hidden = !*hidden;
    Ok(part)
}

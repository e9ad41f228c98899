//! Looks: cameras, exposures and lights by name.

use hairline_document::Description;
use hairline_document::description::{Camera, Look};

use super::{ActionError, list};
use crate::Selection;

/// Keeps how the scene looks from `camera`, as a new look.
pub fn keep(description: &mut Description, camera: Camera) -> Selection {
    let look = new_look("Look 1".to_owned(), description, camera);
    list::insert(description, description.looks.len(), look)
}

/// Sets a look to how the scene looks from `camera`.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn set(
    description: &mut Description,
    index: usize,
    camera: Camera,
) -> Result<Selection, ActionError> {
    let name = list::get::<Look>(description, index)?.name.clone();
    description.looks[index] = new_look(name, description, camera);
    Ok(Selection::Look(index))
}

fn new_look(name: String, description: &Description, camera: Camera) -> Look {
    Look {
        camera: Some(camera),
        ..Look::from_description(name, description)
    }
}

/// Gives the scene a look. Its camera and light of before are kept as a look of their own, unless one has them, and looks that leave some of them
/// out take what they had of them: no light is lost, and no look depends on which was taken before.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn take(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    list::get::<Look>(description, index)?;
    keep_whole(description);
    description.looks[index].clone().apply(description);
    Ok(Selection::Look(index))
}

fn keep_whole(description: &mut Description) {
    let gives = |look: &Look| {
        let mut scene = description.clone();
        look.apply(&mut scene);
        scene == *description
    };
    let is_kept = (description.looks.iter()).any(|look| look.is_whole() && gives(look));
    let scene = Look::from_description("Scene".to_owned(), description);
    for look in &mut description.looks {
        look.complete(&scene);
    }
    if !is_kept {
        list::insert(description, description.looks.len(), scene);
    }
}

/// Renames a look.
///
/// # Errors
/// [`ActionError::EmptyName`], [`ActionError::NameTaken`], [`ActionError::Missing`].
pub fn rename(
    description: &mut Description,
    index: usize,
    name: &str,
) -> Result<Selection, ActionError> {
    list::rename_known::<Look>(description, index, name)?;
    Ok(Selection::Look(index))
}

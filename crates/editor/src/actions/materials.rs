//! Materials.

use hairline_scene::Description;
use hairline_scene::description::Material;

use super::{ActionError, unique_name};
use crate::Selection;
use crate::selection::{after_removal, after_swap};

/// Adds a material, under another name if its own is taken.
pub fn add(description: &mut Description, material: Material) -> Selection {
    let name = unique(description, &material.name);
    description.materials.push(Material { name, ..material });
    Selection::Material(description.materials.len() - 1)
}

/// Adds a copy, behind the original.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let mut copy = get(description, index)?.clone();
    copy.name = unique(description, &copy.name);
    description.materials.insert(index + 1, copy);
    Ok(Selection::Material(index + 1))
}

/// Removes a material that no object has.
///
/// # Errors
/// [`ActionError::MaterialInUse`], [`ActionError::Missing`].
pub fn delete(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    let material = get(description, index)?.name.clone();
    let users = users(description, index);
    if !users.is_empty() {
        let users = users
            .into_iter()
            .map(|i| description.objects[i].name.clone())
            .collect();
        return Err(ActionError::MaterialInUse { material, users });
    }
    description.materials.remove(index);
    Ok(match selection {
        Selection::Material(i) => after_removal(i, index, description.materials.len())
            .map_or(Selection::None, Selection::Material),
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
        .filter(|&other| other < description.materials.len())
    else {
        return Ok(selection);
    };
    description.materials.swap(index, other);
    Ok(match selection {
        Selection::Material(i) => Selection::Material(after_swap(i, index, other)),
        held => held,
    })
}

/// Renames a material; objects that have it keep it.
///
/// # Errors
/// [`ActionError::EmptyName`], [`ActionError::NameTaken`], [`ActionError::Missing`].
pub fn rename(
    description: &mut Description,
    index: usize,
    name: &str,
) -> Result<Selection, ActionError> {
    let old = get(description, index)?.name.clone();
    let name = name.trim();
    let mut others = description.materials.iter().enumerate();
    match name {
        "" => return Err(ActionError::EmptyName),
        _ if others.any(|(i, m)| i != index && m.name == name) => {
            return Err(ActionError::NameTaken {
                what: "a material",
                name: name.to_owned(),
            });
        }
        _ => {}
    }
    description.materials[index].name = name.to_owned();
    for object in &mut description.objects {
        if object.material.as_ref() == Some(&old) {
            object.material = Some(name.to_owned());
        }
    }
    Ok(Selection::Material(index))
}

/// The places of the objects that have a material.
pub fn users(description: &Description, index: usize) -> Vec<usize> {
    let Some(material) = description.materials.get(index) else {
        return Vec::new();
    };
    let objects = description.objects.iter().enumerate();
    objects
        .filter(|(_, object)| object.material.as_ref() == Some(&material.name))
        .map(|(i, _)| i)
        .collect()
}

fn get(description: &Description, index: usize) -> Result<&Material, ActionError> {
    let material = description.materials.get(index);
    material.ok_or(ActionError::Missing("material"))
}

fn unique(description: &Description, name: &str) -> String {
    unique_name(name, description.materials.iter().map(|m| m.name.as_str()))
}

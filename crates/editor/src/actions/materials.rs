//! Materials.

use hairline_document::Description;
use hairline_document::description::{Material, Object, Override};
use hairline_optics::metal::Metal;

use super::{ActionError, list};
use crate::Selection;

/// Adds a material, under another name if its own is taken.
pub fn add(description: &mut Description, material: Material) -> Selection {
    list::insert(description, description.materials.len(), material)
}

/// Gives an object a material: one of the scene that is equal, else a new one. All of a model is of it then.
///
/// # Errors
/// [`ActionError::Missing`]: no such object.
pub fn give(
    description: &mut Description,
    object: usize,
    material: Material,
) -> Result<Selection, ActionError> {
    list::get::<Object>(description, object)?;
    if !description.materials.contains(&material) {
        add(description, material.clone());
    }
    let equal = description.materials.iter().find(|it| **it == material);
    // The material's own name may have been taken.
    let given = equal.or(description.materials.last());
    let given = given.map(|it| it.name.clone());
    let own = list::get_mut::<Object>(description, object)?;
    own.material = given;
    // Those of a file's materials.
    own.overrides.clear();
    Ok(Selection::Object(object))
}

/// Makes a material of a model's file a metal; its roughness and its maps stay.
///
/// # Errors
/// [`ActionError::Missing`]: no such object.
pub fn make_metal(
    description: &mut Description,
    object: usize,
    material: &str,
    metal: Metal,
) -> Result<Selection, ActionError> {
    let overrides = &mut list::get_mut::<Object>(description, object)?.overrides;
    let known = overrides.iter().find(|it| it.material == material).cloned();
    overrides.retain(|it| it.material != material);
    overrides.push(Override {
        metal: Some(metal),
        base_color: None,
        metallic: None,
        ..known.unwrap_or_else(|| Override::new(material))
    });
    Ok(Selection::Object(object))
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
    let material = list::get::<Material>(description, index)?.name.clone();
    let users = users(description, index);
    if !users.is_empty() {
        let users = users
            .into_iter()
            .map(|i| description.objects[i].name.clone())
            .collect();
        return Err(ActionError::MaterialInUse { material, users });
    }
    list::remove::<Material>(description, index, selection)
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
    let [old, name] = list::rename_known::<Material>(description, index, name)?;
    for object in &mut description.objects {
        if object.material.as_ref() == Some(&old) {
            object.material = Some(name.clone());
        }
    }
    Ok(Selection::Material(index))
}

/// The places of the objects that have a material.
pub fn users(description: &Description, index: usize) -> Vec<usize> {
    let Some(material) = description.materials.get(index) else {
        return Vec::new();
    };
    list::places(description, |object: &Object| {
        object.material.as_ref() == Some(&material.name)
    })
}

//! Objects.

use std::path::Path;

use hairline_scene::Description;
use hairline_scene::description::{Object, Shape, Surface};

use super::{ActionError, materials, unique_name};
use crate::selection::{after_removal, after_swap};
use crate::{Selection, paths, presets};

/// Adds a mesh file, with the materials of the file, named after it. `file` is written relative to `base_dir`, the
/// document's.
pub fn add_mesh(description: &mut Description, file: &Path, base_dir: &Path) -> Selection {
    let stem = file.file_stem().unwrap_or("mesh".as_ref());
    let surface = Surface::Mesh(paths::written(file, base_dir));
    add(description, &stem.to_string_lossy(), surface, None)
}

/// Adds a built-in shape at the origin. Without a material it gets the scene's first one, or a new steel where there is
/// none.
///
/// # Errors
/// [`ActionError::Missing`]: no such material.
pub fn add_shape(
    description: &mut Description,
    shape: Shape,
    material: Option<usize>,
) -> Result<Selection, ActionError> {
    if description.materials.is_empty() && material.is_none() {
        materials::add(description, presets::plain_steel());
    }
    let material = description.materials.get(material.unwrap_or(0));
    let material = material
        .ok_or(ActionError::Missing("material"))?
        .name
        .clone();
    let name = match shape {
        Shape::Plane { .. } => "plane",
        Shape::Disk { .. } => "disk",
        Shape::Sphere { .. } => "sphere",
        Shape::Lathe { .. } => "lathe",
    };
    Ok(add(
        description,
        name,
        Surface::Shape(shape),
        Some(material),
    ))
}

fn add(
    description: &mut Description,
    name: &str,
    surface: Surface,
    material: Option<String>,
) -> Selection {
    let name = unique(description, name);
    description.objects.push(Object {
        name,
        surface,
        material,
        translation_m: [0.0; 3],
        rotation_deg: [0.0; 3],
        scale: [1.0; 3],
    });
    Selection::Object(description.objects.len() - 1)
}

/// Adds a copy in the same place, with copies of its layers: they keep their seeds, so it is scratched alike.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let mut copy = get(description, index)?.clone();
    let name = unique(description, &copy.name);
    let original = std::mem::replace(&mut copy.name, name);
    let mut layers: Vec<_> = description
        .scratches
        .iter()
        .filter(|layer| layer.object == original)
        .cloned()
        .collect();
    for layer in &mut layers {
        layer.object.clone_from(&copy.name);
    }
    description.scratches.extend(layers);
    description.objects.insert(index + 1, copy);
    Ok(Selection::Object(index + 1))
}

/// Removes an object and its layers.
///
/// # Errors
/// [`ActionError::LastObject`], [`ActionError::Missing`].
pub fn delete(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    let name = get(description, index)?.name.clone();
    if description.objects.len() == 1 {
        return Err(ActionError::LastObject(name));
    }
    let neighbour = after_removal(index, index, description.objects.len() - 1)
        .map_or(Selection::None, Selection::Object);
    let selection = match selection {
        Selection::Object(i) => after_removal(i, index, description.objects.len() - 1)
            .map_or(Selection::None, Selection::Object),
        Selection::Layer(i) => match description.scratches.get(i) {
            Some(layer) if layer.object != name => {
                let before = description.scratches[..i].iter();
                Selection::Layer(before.filter(|layer| layer.object != name).count())
            }
            _ => neighbour,
        },
        other => other,
    };
    description.objects.remove(index);
    description.scratches.retain(|layer| layer.object != name);
    Ok(selection)
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
        .filter(|&other| other < description.objects.len())
    else {
        return Ok(selection);
    };
    description.objects.swap(index, other);
    Ok(match selection {
        Selection::Object(i) => Selection::Object(after_swap(i, index, other)),
        held => held,
    })
}

/// Renames an object; its layers stay on it.
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
    let mut others = description.objects.iter().enumerate();
    match name {
        "" => return Err(ActionError::EmptyName),
        _ if others.any(|(i, o)| i != index && o.name == name) => {
            return Err(ActionError::NameTaken {
                what: "an object",
                name: name.to_owned(),
            });
        }
        _ => {}
    }
    description.objects[index].name = name.to_owned();
    for layer in &mut description.scratches {
        if layer.object == old {
            layer.object = name.to_owned();
        }
    }
    Ok(Selection::Object(index))
}

/// The places of the layers on an object, in their order.
pub fn layers(description: &Description, index: usize) -> Vec<usize> {
    let Some(object) = description.objects.get(index) else {
        return Vec::new();
    };
    let layers = description.scratches.iter().enumerate();
    layers
        .filter(|(_, layer)| layer.object == object.name)
        .map(|(i, _)| i)
        .collect()
}

/// Gives an object another material of the scene; none where a mesh shall have those of its file.
///
/// # Errors
/// [`ActionError::Missing`]: no such object or material, or none for a shape.
pub fn set_material(
    description: &mut Description,
    index: usize,
    material: Option<usize>,
) -> Result<Selection, ActionError> {
    let object = get(description, index)?;
    let name = match material {
        Some(i) => {
            let material = description.materials.get(i);
            Some(
                material
                    .ok_or(ActionError::Missing("material"))?
                    .name
                    .clone(),
            )
        }
        None if matches!(object.surface, Surface::Shape(_)) => {
            return Err(ActionError::Missing("material"));
        }
        None => None,
    };
    description.objects[index].material = name;
    Ok(Selection::Object(index))
}

fn get(description: &Description, index: usize) -> Result<&Object, ActionError> {
    let object = description.objects.get(index);
    object.ok_or(ActionError::Missing("object"))
}

fn unique(description: &Description, name: &str) -> String {
    unique_name(name, description.objects.iter().map(|o| o.name.as_str()))
}

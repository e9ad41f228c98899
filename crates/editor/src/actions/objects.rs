//! Objects.

use std::path::Path;

use hairline_scene::Description;
use hairline_scene::description::{Grating, Material, Object, Scratches, Shape, Surface, Up};

use super::{ActionError, list, materials};
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
    let material: &Material = list::get(description, material.unwrap_or(0))?;
    let material = Some(material.name.clone());
    let name = shape.kind();
    Ok(add(description, name, Surface::Shape(shape), material))
}

fn add(
    description: &mut Description,
    name: &str,
    surface: Surface,
    material: Option<String>,
) -> Selection {
    let object = Object {
        name: name.to_owned(),
        surface,
        material,
        up: Up::default(),
        fit_m: None,
        time_s: None,
        animation: None,
        overrides: Vec::new(),
        translation_m: [0.0; 3],
        rotation_deg: [0.0; 3],
        scale: [1.0; 3],
        hidden: false,
    };
    list::insert(description, description.objects.len(), object)
}

/// Adds a copy in the same place, with copies of its gratings and its layers; these keep their seeds, so that its scratches
/// are equal.
///
/// # Errors
/// [`ActionError::Missing`].
pub fn duplicate(description: &mut Description, index: usize) -> Result<Selection, ActionError> {
    let copy: Object = list::get(description, index).cloned()?;
    let original = copy.name.clone();
    let selection = list::insert(description, index + 1, copy);
    let name = description.objects[index + 1].name.clone();
    let layers = description.scratches.iter();
    let copies: Vec<_> = layers
        .filter(|layer| layer.object == original)
        .map(|layer| Scratches {
            object: name.clone(),
            ..layer.clone()
        })
        .collect();
    description.scratches.extend(copies);
    let gratings = description.gratings.iter();
    let copies: Vec<_> = gratings
        .filter(|grating| grating.object == original)
        .map(|grating| Grating {
            object: name.clone(),
            ..grating.clone()
        })
        .collect();
    description.gratings.extend(copies);
    Ok(selection)
}

/// Removes an object with its layers and gratings.
///
/// # Errors
/// [`ActionError::LastObject`], [`ActionError::Missing`].
pub fn delete(
    description: &mut Description,
    index: usize,
    selection: Selection,
) -> Result<Selection, ActionError> {
    let name = list::get::<Object>(description, index)?.name.clone();
    if description.objects.len() == 1 {
        return Err(ActionError::LastObject(name));
    }
    let selection = match selection {
        Selection::Layer(i) => match description.scratches.get(i) {
            Some(layer) if layer.object != name => {
                let before = description.scratches[..i].iter();
                Selection::Layer(before.filter(|layer| layer.object != name).count())
            }
            // The layer goes with its object: as if that had been selected.
            _ => Selection::Object(index),
        },
        other => other,
    };
    description.scratches.retain(|layer| layer.object != name);
    description
        .gratings
        .retain(|grating| grating.object != name);
    list::remove::<Object>(description, index, selection)
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
    list::shift::<Object>(description, index, by, selection)
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
    let [old, name] = list::rename_known::<Object>(description, index, name)?;
    for layer in &mut description.scratches {
        if layer.object == old {
            layer.object.clone_from(&name);
        }
    }
    for grating in &mut description.gratings {
        if grating.object == old {
            grating.object.clone_from(&name);
        }
    }
    Ok(Selection::Object(index))
}

/// The places of the layers on an object, in their order.
pub fn layers(description: &Description, index: usize) -> Vec<usize> {
    let Some(object) = description.objects.get(index) else {
        return Vec::new();
    };
    list::places(description, |layer: &Scratches| layer.object == object.name)
}

/// Sets another material of the scene for an object; none where a mesh shall have those of its file.
///
/// # Errors
/// [`ActionError::Missing`]: no such object or material, or none for a shape.
pub fn set_material(
    description: &mut Description,
    index: usize,
    material: Option<usize>,
) -> Result<Selection, ActionError> {
    let object: &Object = list::get(description, index)?;
    let name = match material {
        Some(i) => Some(list::get::<Material>(description, i)?.name.clone()),
        None if matches!(object.surface, Surface::Shape(_)) => {
            return Err(ActionError::Missing("material"));
        }
        None => None,
    };
    description.objects[index].material = name;
    Ok(Selection::Object(index))
}

//! Objects.

use std::path::Path;

use glam::{DMat3, DVec3};
use hairline_document::Description;
use hairline_document::description::{Grating, Material, Object, Scratches, Shape, Surface, Up};

use super::{ActionError, list, materials};
use crate::presets::{self, ShapePreset};
use crate::{Selection, paths, rotation_deg};

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
    let name = shape.name();
    Ok(add(description, name, Surface::Shape(shape), material))
}

/// Adds a text on top of a box: as wide as the box, and upright for the camera.
///
/// # Errors
/// None.
pub fn add_text(
    description: &mut Description,
    (low_m, high_m): (DVec3, DVec3),
) -> Result<Selection, ActionError> {
    let camera = &description.camera;
    let up = camera.world_up();
    let middle_m = 0.5 * (low_m + high_m);
    let away = middle_m - DVec3::from(camera.position_m);
    // Along the edges of the box: away from the camera, and to its right.
    let along = nearest_axis(away - up * away.dot(up));
    let right = along.cross(up);
    let sides_m = high_m - low_m;
    let [width_m, length_m] = [right, along].map(|axis| sides_m.dot(axis).abs());
    let Shape::Text {
        line,
        height_m,
        depth_m,
    } = ShapePreset::Text.shape(TEXT_SHARE * width_m)
    else {
        return Err(ActionError::Missing("text"));
    };
    // On a narrow box it is as high as that is long.
    let narrower = (TEXT_SHARE * length_m / height_m).min(1.0);
    let shape = Shape::Text {
        line,
        height_m: height_m * narrower,
        depth_m: depth_m * narrower,
    };
    let top_m = middle_m + up * (0.5 * sides_m.dot(up).abs());
    let added = add_shape(description, shape, None)?;
    if let Some(text) = description.objects.last_mut() {
        // Digits that nobody sees, in a file that people read.
        text.translation_m = top_m.to_array().map(|m| (m * 1e6).round() / 1e6);
        text.rotation_deg = rotation_deg(DMat3::from_cols(right, along, up));
    }
    Ok(added)
}

/// Width of a text over that of what it stands on.
const TEXT_SHARE: f64 = 0.8;

/// The axis of the world that is nearest to a direction.
pub(super) fn nearest_axis(direction: DVec3) -> DVec3 {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let signed = axes.into_iter().flat_map(|axis| [axis, -axis]);
    let by_share = |a: &DVec3, b: &DVec3| a.dot(direction).total_cmp(&b.dot(direction));
    signed.max_by(by_share).unwrap_or(DVec3::Y)
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
    if description.objects.len() == 1 && description.ground.is_none() {
        return Err(ActionError::LastObject(name));
    }
    // What lies on the object goes with it: as if the object had been selected.
    let selection = match selection {
        Selection::Layer(i) => place_left(&description.scratches, i, |it| it.object == name)
            .map_or(Selection::Object(index), Selection::Layer),
        Selection::Grating(i) => place_left(&description.gratings, i, |it| it.object == name)
            .map_or(Selection::Object(index), Selection::Grating),
        other => other,
    };
    description.scratches.retain(|layer| layer.object != name);
    description
        .gratings
        .retain(|grating| grating.object != name);
    list::remove::<Object>(description, index, selection)
}

/// The place of a part once some parts of its list are gone; none if it is one of them.
fn place_left<P>(list: &[P], place: usize, goes: impl Fn(&P) -> bool) -> Option<usize> {
    let is_left = |part: &&P| !goes(part);
    list.get(place).filter(is_left)?;
    Some(list[..place].iter().filter(is_left).count())
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

/// The places of the gratings on an object, in their order.
pub fn gratings(description: &Description, index: usize) -> Vec<usize> {
    let Some(object) = description.objects.get(index) else {
        return Vec::new();
    };
    list::places(description, |grating: &Grating| {
        grating.object == object.name
    })
}

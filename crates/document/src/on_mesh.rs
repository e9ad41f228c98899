//! Scratches on a mesh in memory, without a scene about it: what other engines ask for.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DMat4, DVec3};
use hairline_image::FilePath;
use hairline_laying::Ground;
use hairline_scene::{Mesh, Object};

use crate::arrays::{Arrays, MeshArrays};
use crate::description::{self, Layer, standings};
use crate::error::Error;
use crate::grey_map::GreyMap;
use crate::loader::Loader;
use crate::scratches::{PlaceInputs, Table, lay, put_together};

/// Lays layers of scratches on a mesh whose unit is `metres_per_unit` long, and returns them in metres. The layers name one object, any;
/// pictures that they name are in `arrays`, and so are lists, or they are files. A seed means the same scratches as in a scene.
///
/// # Errors
/// What is wrong with a layer, by its key; a picture that is not in `arrays`, a part of a model.
pub fn lay_on_mesh(
    mesh: &MeshArrays,
    layers: &[description::Scratches],
    arrays: &Arrays,
    metres_per_unit: f64,
) -> Result<Object, Error> {
    let world_from_object = DMat4::from_scale(DVec3::splat(metres_per_unit));
    let baked = mesh.surface().baked(&world_from_object);
    if baked.triangles.is_empty() {
        let right = "must have triangles that span an area";
        return Err(Error::new("mesh", "found no surface", right));
    }
    let mesh = Arc::new(baked);
    let ground = Arc::new(Ground::new(mesh.clone(), world_from_object));
    let mut tables = Vec::new();
    let mut shown = Vec::new();
    for ((i, layer), standing) in (0..).zip(layers).zip(standings(layers)) {
        if !standing.is_shown {
            continue;
        }
        let key = format!("scratches[{i}]");
        refuse_parts(layer, arrays, &key)?;
        let picture = |name: &str, file: &Option<PathBuf>| {
            let key_path = format!("{key}.where.{name}");
            let known = file.as_ref().map(|file| picture(arrays, file, key_path));
            known.transpose()
        };
        tables.push(Table {
            layer: &layer.layer,
            section: &layer.profile,
            strokes: &layer.strokes,
            number: standing.number,
            ground: &ground,
            means: PlaceInputs {
                described: &layer.place,
                mask: picture("mask", &layer.place.mask)?,
                density: picture("density", &layer.place.density)?,
                whole: (layer.place.edges > 0.0).then(|| ground.clone()),
            },
            key,
        });
        shown.push(i);
    }
    let loader = Loader {
        arrays,
        ..Loader::default()
    };
    let laid = lay(&loader, &tables, &FilePath::default(), 0.0)?;
    let all = put_together(shown.into_iter().zip(&laid))?;
    Ok(Object {
        name: String::new(),
        mesh,
        scratches: Arc::new(all.scratches),
        segments: Arc::new(all.segments),
        parts: Arc::default(),
        gratings: Vec::new(),
        is_lamp: false,
    })
}

/// A picture in memory. `key_path` is where it is named.
fn picture(arrays: &Arrays, file: &Path, key_path: String) -> Result<Arc<GreyMap>, Error> {
    arrays.picture(file).cloned().ok_or_else(|| {
        let found = format!("found the file \"{}\"", file.display());
        Error::new(key_path, found, "must be the name of a picture in memory")
    })
}

/// An object with rows of grooves, in the frame of a mesh whose unit is the metre. Their pictures are left out: a mask has the number 0 of no texture. Its
/// mesh stands for the surface's material alone.
pub fn object_of_gratings(rows: &[description::Grating]) -> Object {
    let gratings = rows
        .iter()
        .map(|row| row.in_scene(&DMat4::IDENTITY, row.mask.as_ref().map(|_| 0), None));
    Object {
        name: String::new(),
        mesh: Arc::new(Mesh {
            triangle_materials: vec![0],
            ..Mesh::default()
        }),
        scratches: Arc::default(),
        segments: Arc::default(),
        parts: Arc::default(),
        gratings: gratings.collect(),
        is_lamp: false,
    }
}

/// Refuses what a mesh in memory does not have.
fn refuse_parts(layer: &description::Scratches, arrays: &Arrays, key: &str) -> Result<(), Error> {
    let keys = [
        ("material", layer.material.is_some()),
        ("node", layer.node.is_some()),
    ];
    if let Layer::Engraved(engraved) = &layer.layer
        && let Some(file) = engraved.line.file()
        && arrays.drawing(file).is_none()
    {
        return Err(Error::new(
            format!("{key}.{}", engraved.line.key().name),
            format!("found the drawing \"{}\"", file.display()),
            "must be the name of a drawing in memory",
        ));
    }
    match keys.iter().find(|(_, is_there)| *is_there) {
        None => Ok(()),
        Some((name, _)) => Err(Error::new(
            format!("{key}.{name}"),
            "found a part of a model",
            "must not be there where scratches are laid on a mesh in memory",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_told_by_its_key() {
        let corners = vec![[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.0, 0.04, 0.0]];
        let mesh = MeshArrays::new(corners, vec![[0, 1, 2]], None, None).unwrap();
        let layers = "
            [[scratches]]
            object = 'it'
            pattern = 'random'
            count = 40
            [[scratches]]
            object = 'it'
            pattern = 'random'
            count = 60
            where = { mask = 'a.png', tile_m = 0.1 }
        ";
        let layers = description::Scratches::from_toml(layers, Path::new("layers")).unwrap();
        let error = lay_on_mesh(&mesh, &layers, &Arrays::default(), 1.0).unwrap_err();
        assert_eq!(error.key(), "scratches[1].where.mask");
    }

    #[test]
    fn drawings_in_memory_are_engraved() {
        let corners = vec![[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.0, 0.04, 0.0]];
        let mesh = MeshArrays::new(corners, vec![[0, 1, 2]], None, None).unwrap();
        let layers = "[[scratches]]
            object = 'it'
            pattern = 'svg'
            file = 'ring.svg'
            fit_m = 0.004
            center_m = [0.01, 0.01, 0]";
        let layers = description::Scratches::from_toml(layers, Path::new("layers")).unwrap();
        let mut arrays = Arrays::default();
        let error = lay_on_mesh(&mesh, &layers, &arrays, 1.0).unwrap_err();
        assert_eq!(error.key(), "scratches[0].file");
        let svg = br#"<svg xmlns="http://www.w3.org/2000/svg"><circle r="5"/></svg>"#;
        arrays.insert_drawing("ring.svg", svg);
        let object = lay_on_mesh(&mesh, &layers, &arrays, 1.0).unwrap();
        assert!(!object.segments.is_empty());
    }
}

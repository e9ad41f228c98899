//! Scratches on a mesh in memory, without a scene about it: what other engines ask for.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};
use hairline_image::ToneMap;

use crate::arrays::{Arrays, MeshArrays};
use crate::description::{self, standings};
use crate::error::Error;
use crate::loader::Loader;
use crate::scene::{Base, Camera, Lens, Material, Mesh, Object, RenderSettings, Scene};
use crate::scratches::{Ground, PlaceInputs, Table, lay, put_together};
use crate::section_id::SectionId;

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
    let mut baked = Mesh::default();
    mesh.surface().bake(&world_from_object, 0, &mut baked);
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
        refuse_parts(layer, &key)?;
        let picture = |name: &str, file: &Option<PathBuf>| {
            let way = format!("{key}.where.{name}");
            let read = file.as_ref();
            let known = read.map(|file| {
                let found = format!("found the file \"{}\"", file.display());
                let right = "must be the name of a picture in memory";
                let picture = arrays.picture(file).cloned();
                picture.ok_or_else(|| Error::new(way, found, right))
            });
            known.transpose()
        };
        tables.push(Table {
            layer: &layer.layer,
            section: SectionId::new(&layer.profile),
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
    let laid = lay(&loader, &tables, Path::new(""), 0.0)?;
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

/// An object with rows of grooves, in the frame of a mesh whose unit is the metre. Their pictures are left out. Its mesh stands for the surface's material
/// alone.
pub fn object_of_gratings(rows: &[description::Grating]) -> Object {
    let gratings = rows
        .iter()
        .map(|row| row.in_scene(&DMat4::IDENTITY, None, None));
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
fn refuse_parts(layer: &description::Scratches, key: &str) -> Result<(), Error> {
    let keys = [
        ("material", layer.material.is_some()),
        ("node", layer.node.is_some()),
    ];
    match keys.iter().find(|(_, is_there)| *is_there) {
        None => Ok(()),
        Some((name, _)) => Err(Error::new(
            format!("{key}.{name}"),
            "found a part of a model",
            "must not be there where scratches are laid on a mesh in memory",
        )),
    }
}

impl Scene {
    /// Returns a scene of one object, whose one material has a coherence length, in µm, and of nothing else: for the index of its scratches.
    pub fn of_object(object: Object, coherence_um: f64) -> Self {
        let material = Material::plain(String::new(), Base::Mirror, 0.0);
        Self {
            camera: Camera {
                position_m: DVec3::Z,
                target_m: DVec3::ZERO,
                up: DVec3::Y,
                fov_y_rad: 1.0,
                shift_tan: DVec2::ZERO,
                exposure_ev: 0.0,
                lens: Lens::default(),
            },
            render: RenderSettings {
                size_px: [1; 2],
                filter_std_px: 0.5,
                tone_map: ToneMap::None,
            },
            environment: None,
            textures: Arc::default(),
            materials: vec![Material {
                coherence_um,
                ..material
            }],
            observer: Default::default(),
            objects: vec![object],
            lights: Vec::new(),
            notes: Vec::new(),
        }
    }
}

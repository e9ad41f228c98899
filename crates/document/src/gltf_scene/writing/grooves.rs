//! Gratings as programs draw them that compute no spectra: where their grooves run in the frame of their object, and the table of what they send.

use std::collections::HashMap;
use std::ops::Deref;

use hairline_model::gltf_file::GltfFile;
use hairline_scene::{PictureLie, Scene, ScratchTables, fine_grooves};
use serde_json::{Value, json};

use crate::description::Description;

/// Stands for everywhere: JSON has no infinity.
const FAR_M: f64 = 1e9;

/// Tables of gratings that are in the file, by their index.
pub(super) type Known = HashMap<usize, usize>;

/// Adds a grating; `tables` are made where they are asked for, which takes seconds. None where its grooves lie in spots or on several materials, or where its
/// mask is laid on from three sides, nor of one that is not fine unless `lays_all`.
pub(super) fn write(
    described: &Description,
    scene: &Scene,
    tables: &dyn Deref<Target = ScratchTables>,
    number: usize,
    lays_all: bool,
    known: &mut Known,
    file: &mut GltfFile,
) -> Option<Value> {
    let own = &described.gratings[number];
    let is_its = |name: &str| name == own.object;
    let object = described.objects.iter().position(|it| is_its(&it.name))?;
    let before = described.gratings[..number].iter();
    let at = before.filter(|it| !it.hidden && is_its(&it.object)).count();
    let in_scene = &scene.objects[object];
    let mut materials = in_scene.mesh.materials().into_iter();
    let (Some(material), None) = (materials.next(), materials.next()) else {
        return None;
    };
    let grating = in_scene.gratings.get(at).filter(|_| !own.hidden)?;
    if grating.mask.is_some_and(|it| it.lie != PictureLie::ByUv) {
        return None;
    }
    let field = grating.field.plain()?;
    if !lays_all && fine_grooves(grating, &scene.materials[material]).is_none() {
        return None;
    }
    let index = tables.grating_table(grating, material)?;
    let table = &tables.tables[index];
    let texels = *known.entry(index).or_insert_with(|| {
        file.push_wholes(table.for_engines(grating.row.depth_nm).as_flattened())
    });
    let object_from_world = described.objects[object].world_from_object().inverse();
    let mut laid = json!({
        "kind": field.kind,
        "center": object_from_world.transform_point3(field.center_m).to_array(),
        "radii_m": grating.radii_m.map(|radius_m| radius_m.min(FAR_M)),
        "curvature_per_m": field.curvature_per_m,
        "coverage": grating.coverage,
        "angle_std_rad": grating.angle_std_rad,
        "coherence_um": scene.materials[material].coherence_um,
        "is_fine": table.by_incidence,
        "texels": texels,
    });
    if let Some(axis) = object_from_world
        .transform_vector3(field.axis)
        .try_normalize()
    {
        laid["axis"] = json!(axis.to_array());
    }
    Some(laid)
}

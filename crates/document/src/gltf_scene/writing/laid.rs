//! Scratches of a layer as they lie, in the frame of their object.

use glam::{DMat3, DVec3, Vec3};
use hairline_model::gltf_file::GltfFile;
use hairline_scene::Scene;
use serde_json::{Value, json};

use crate::description::Description;

/// Adds the straight pieces of a layer, in order, those of a scratch side by side. None of a layer without scratches.
pub(super) fn write(
    described: &Description,
    scene: &Scene,
    layer: usize,
    file: &mut GltfFile,
) -> Option<Value> {
    let name = &described.scratches[layer].object;
    let number = described.objects.iter().position(|it| it.name == *name)?;
    let world_from_object = described.objects[number].world_from_object();
    let object_from_world = world_from_object.inverse();
    let object_from_normals = DMat3::from_mat4(world_from_object).transpose();
    let object = &scene.objects[number];
    let (mut starts, mut ends, mut normals) = (vec![], vec![], vec![]);
    let (mut widths, mut depths, mut numbers) = (vec![], vec![], vec![]);
    let of_layer = object
        .scratches
        .iter()
        .filter(|it| it.layer as usize == layer);
    for (number, scratch) in (0u32..).zip(of_layer) {
        let own = scratch.segments.start as usize..scratch.segments.end as usize;
        for piece in &object.segments[own] {
            let place = |at: Vec3| {
                let at = object_from_world.transform_point3(at.as_dvec3());
                at.as_vec3().to_array()
            };
            starts.extend(place(piece.start_m));
            ends.extend(place(piece.end_m));
            // Normals go back by the transpose of the way that places took.
            let normal = object_from_normals * piece.normal.as_dvec3();
            normals.extend(normal.normalize_or(DVec3::Z).as_vec3().to_array());
            widths.push(scratch.profile.width_um);
            depths.push(scratch.profile.depth_nm);
            numbers.push(number);
        }
    }
    if numbers.is_empty() {
        return None;
    }
    Some(json!({
        "start_m": file.push_floats(&starts, 3, false),
        "end_m": file.push_floats(&ends, 3, false),
        "normal": file.push_floats(&normals, 3, false),
        "width_um": file.push_floats(&widths, 1, false),
        "depth_nm": file.push_floats(&depths, 1, false),
        "scratch": file.push_wholes(&numbers),
    }))
}

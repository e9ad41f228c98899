//! What a scene has laid: the scratches of an object as arrays, and where its objects are.

use glam::Vec3;
use hairline_scene::{Object, Scene};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors;

/// The objects of a scene file, without the shapes of lamps.
fn objects(scene: &Scene) -> impl Iterator<Item = &Object> {
    scene.objects.iter().filter(|object| !object.is_lamp)
}

/// Index of an object by its name.
pub(crate) fn object_named(scene: &Scene, name: &str) -> PyResult<usize> {
    objects(scene)
        .position(|object| object.name == name)
        .ok_or_else(|| {
            let names: Vec<_> = objects(scene)
                .map(|object| format!("\"{}\"", object.name))
                .collect();
            let right = format!("must be one of {}", names.join(", "));
            errors::of_argument("object", format!("found \"{name}\""), right)
        })
}

/// The straight pieces of all scratches of an object: rows of arrays, by name.
pub(crate) fn laid<'py>(
    py: Python<'py>,
    scene: &Scene,
    name: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let object = &scene.objects[object_named(scene, name)?];
    let pieces = || {
        let scratches = object.scratches.iter().enumerate();
        scratches.flat_map(|(i, scratch)| {
            let own = scratch.segments.start as usize..scratch.segments.end as usize;
            object.segments[own]
                .iter()
                .map(move |piece| (i, scratch, piece))
        })
    };
    let vectors = |of: fn(&hairline_scene::Segment) -> Vec3| {
        let all: Vec<f64> = pieces()
            .flat_map(|(_, _, piece)| of(piece).as_dvec3().to_array())
            .collect();
        let rows = all.len() / 3;
        all.into_pyarray(py).reshape([rows, 3])
    };
    let made = PyDict::new(py);
    made.set_item("start_m", vectors(|piece| piece.start_m)?)?;
    made.set_item("end_m", vectors(|piece| piece.end_m)?)?;
    made.set_item("normal", vectors(|piece| piece.normal)?)?;
    let numbers = |of: fn(&hairline_scene::Profile) -> f32| {
        let all: Vec<f64> = pieces()
            .map(|(_, it, _)| f64::from(of(&it.profile)))
            .collect();
        all.into_pyarray(py)
    };
    made.set_item("width_um", numbers(|profile| profile.width_um))?;
    made.set_item("depth_nm", numbers(|profile| profile.depth_nm))?;
    let scratch: Vec<u32> = pieces().map(|(i, ..)| i as u32).collect();
    made.set_item("scratch", scratch.into_pyarray(py))?;
    let layer: Vec<u32> = pieces().map(|(_, it, _)| it.layer).collect();
    made.set_item("layer", layer.into_pyarray(py))?;
    made.set_item("area_m2", area_m2(object))?;
    Ok(made)
}

fn area_m2(object: &Object) -> f64 {
    let at = |i: u32| object.mesh.positions_m[i as usize].as_dvec3();
    let triangles = object.mesh.triangles.iter();
    let areas = triangles.map(|&[a, b, c]| 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).length());
    areas.sum()
}

/// The corners of the box around all objects, metres.
pub(crate) fn bounds_m(scene: &Scene) -> ([f32; 3], [f32; 3]) {
    let all = objects(scene).flat_map(|object| &object.mesh.positions_m);
    let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (least, most) = all.fold(nothing, |(least, most), &p| (least.min(p), most.max(p)));
    (least.to_array(), most.to_array())
}

//! Polygons of lights that are reshaped by hand.

use glam::DVec3;
use hairline_document::description::{Light, LightKind};
use hairline_scene::vector_area_m2;

use crate::ActionError;

/// Drags a vertex of a polygon. With more than three it stays in the plane of the polygon, at the place nearest to
/// `to_m`; three span a plane wherever they are.
///
/// # Errors
/// [`ActionError`], where the polygon would cross itself or lose its area; then it is as it was.
pub fn move_vertex(light: &mut Light, index: usize, to_m: DVec3) -> Result<(), ActionError> {
    reshape(light, |vertices| {
        let n = vertices.len();
        if index >= n {
            return Err(ActionError::Missing("corner"));
        }
        let to = match (n > 3, vector_area_m2(vertices).try_normalize()) {
            (true, Some(normal)) => {
                // Through the others, so that dragging to and fro does not let the plane drift.
                let others = vertices.iter().enumerate().filter(|(i, _)| *i != index);
                let through = others.map(|(_, v)| *v).sum::<DVec3>() / (n - 1) as f64;
                to_m - normal * (to_m - through).dot(normal)
            }
            _ => to_m,
        };
        vertices[index] = to;
        Ok(())
    })
}

/// Adds a vertex in the middle of the edge that begins at vertex `edge`; its index is `edge + 1`.
///
/// # Errors
/// [`ActionError`]; then the polygon is as it was.
pub fn insert_vertex(light: &mut Light, edge: usize) -> Result<(), ActionError> {
    reshape(light, |vertices| {
        let a = *vertices.get(edge).ok_or(ActionError::Missing("corner"))?;
        let b = vertices[(edge + 1) % vertices.len()];
        vertices.insert(edge + 1, 0.5 * (a + b));
        Ok(())
    })
}

/// Takes a vertex out.
///
/// # Errors
/// [`ActionError`], where fewer than three would be left or the rest would cross itself; then the polygon is as it was.
pub fn delete_vertex(light: &mut Light, index: usize) -> Result<(), ActionError> {
    reshape(light, |vertices| {
        if index >= vertices.len() {
            return Err(ActionError::Missing("corner"));
        }
        vertices.remove(index);
        Ok(())
    })
}

/// Changes the vertices of a polygon, unless the result is no light.
fn reshape(
    light: &mut Light,
    change: impl FnOnce(&mut Vec<DVec3>) -> Result<(), ActionError>,
) -> Result<(), ActionError> {
    let LightKind::Polygon {
        vertices_m,
        two_sided,
    } = &light.kind
    else {
        return Err(ActionError::Missing("corner"));
    };
    let mut vertices: Vec<DVec3> = vertices_m.iter().map(|&v| v.into()).collect();
    change(&mut vertices)?;
    let reshaped = Light {
        kind: LightKind::Polygon {
            vertices_m: vertices.into_iter().map(|v| v.to_array()).collect(),
            two_sided: *two_sided,
        },
        ..light.clone()
    };
    reshaped
        .check()
        .map_err(|flaw| ActionError::Shape(flaw.found_and_right()))?;
    *light = reshaped;
    Ok(())
}

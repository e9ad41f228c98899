//! What lies under the mouse.

use egui::Pos2;
use glam::{DMat4, DVec3};
use hairline_editor::navigate;

use crate::app::Viewer;

use super::Area;

/// A place on a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Picked {
    /// In the description's objects.
    pub object: usize,
    /// World space.
    pub point_m: DVec3,
    /// Unit, towards the eye.
    pub normal: DVec3,
}

/// The nearest surface under `pos`, of the newest scene that was built.
pub(super) fn surface(viewer: &Viewer, area: &Area, pos: Pos2) -> Option<Picked> {
    let built = viewer.engine.built()?;
    let camera = &viewer.document.description().camera;
    // A pixel of this frame is a point of the screen.
    let size = area.size();
    let frame = navigate::view(camera, [size.x as u32, size.y as u32]);
    let ray = frame.camera_ray(area.within(pos)).normalize();
    let hit = built.triangles.intersect(frame.position_m, ray)?;
    let mesh = &built.scene.objects.get(hit.object as usize)?.mesh;
    let corners = mesh.triangles.get(hit.triangle as usize)?;
    let normals = corners.map(|corner| mesh.normals[corner as usize].as_dvec3());
    let [b, c] = hit.barycentric;
    let normal = normals[0] * (1.0 - b - c) + normals[1] * b + normals[2] * c;
    let normal = normal.normalize_or_zero();
    Some(Picked {
        object: hit.object as usize,
        point_m: frame.position_m + ray * hit.distance_m,
        normal: if normal.dot(ray) > 0.0 {
            -normal
        } else {
            normal
        },
    })
}

/// An object's own frame, in which strokes are stored.
pub(super) fn world_from_object(viewer: &Viewer, object: usize) -> Option<DMat4> {
    let object = viewer.document.description().objects.get(object)?;
    Some(object.world_from_object())
}

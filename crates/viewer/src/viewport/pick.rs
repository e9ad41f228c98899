//! Surface under the mouse.

use egui::Pos2;
use glam::DVec3;

use crate::progressive::Built;
use crate::workspace::Workspace;

use super::{Area, lens::Lens};

/// A place on a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Picked {
    /// Index in the description's objects.
    pub object: usize,
    /// Index in the object's mesh.
    pub triangle: usize,
    /// World space.
    pub point_m: DVec3,
    /// Unit, towards the eye.
    pub normal: DVec3,
}

/// The nearest surface under `pos`, of the newest scene that was built.
pub(super) fn surface(work: &Workspace, area: &Area, pos: Pos2) -> Option<Picked> {
    let built = work.renderer.built()?;
    let lens = Lens::new(&work.camera(), area);
    pick(&built, &lens, pos)
}

/// Picks in a scene and a view that are at hand: two rays, some microseconds.
///
/// A ray that runs exactly along an edge may miss both of its triangles by a rounding, and then meets what lies behind; one
/// a hair beside it does not.
pub(super) fn pick(built: &Built, lens: &Lens, pos: Pos2) -> Option<Picked> {
    const HAIR: egui::Vec2 = egui::vec2(0.013, 0.007);
    let (hit, beside) = (meet(built, lens, pos), meet(built, lens, pos + HAIR));
    let distance_m = |hit: &Picked| hit.point_m.distance(lens.eye_m());
    match (hit, beside) {
        (Some(hit), Some(beside)) if distance_m(&beside) < 0.99 * distance_m(&hit) => Some(beside),
        (hit, beside) => hit.or(beside),
    }
}

/// Least cosine between a surface's normal and the way to the eye at which a line on it is seen.
const LEAST_FACING: f64 = 0.12;

/// Whether the camera sees a place on a surface from the side of this normal, with nothing before it.
pub(super) fn is_seen(built: &Built, lens: &Lens, point_m: DVec3, normal: DVec3) -> bool {
    let offset = point_m - lens.eye_m();
    let distance_m = offset.length();
    let ray = offset / distance_m;
    if !(-ray.dot(normal) > LEAST_FACING) {
        return false;
    }
    // The surface itself is met a rounding before or behind the place.
    let hit = built.triangles.intersect(lens.eye_m(), ray);
    hit.is_none_or(|hit| hit.distance_m > distance_m * (1.0 - 1e-4))
}

fn meet(built: &Built, lens: &Lens, pos: Pos2) -> Option<Picked> {
    let ray = lens.ray(pos);
    let hit = built.triangles.intersect(lens.eye_m(), ray)?;
    let mesh = &built.scene.objects.get(hit.object as usize)?.mesh;
    let corners = mesh.triangles.get(hit.triangle as usize)?;
    let normals = corners.map(|corner| mesh.normals[corner as usize].as_dvec3());
    let [b, c] = hit.barycentric;
    let normal = normals[0] * (1.0 - b - c) + normals[1] * b + normals[2] * c;
    let normal = normal.normalize_or(-ray);
    Some(Picked {
        object: hit.object as usize,
        triangle: hit.triangle as usize,
        point_m: lens.eye_m() + ray * hit.distance_m,
        normal: if normal.dot(ray) > 0.0 {
            -normal
        } else {
            normal
        },
    })
}

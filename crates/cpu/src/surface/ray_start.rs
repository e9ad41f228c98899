//! Where rays to lights start.

use glam::DVec3;
use hairline_scene::Scene;

use super::textured_hit::raised;
use super::{SeenHit, SurfacePoint};

/// A place on a surface from which rays start.
pub(crate) struct RayStart {
    /// As [`SurfacePoint::raised_m`].
    raised_m: DVec3,
    /// Normal of the triangle there, on the viewer's side, of any length.
    facet: DVec3,
}

impl RayStart {
    pub fn from_point(point: &SurfacePoint) -> Self {
        Self {
            raised_m: point.raised_m,
            facet: point.facet,
        }
    }

    /// The place of a hit, on the viewer's side.
    pub(crate) fn from_hit(scene: &Scene, seen: &SeenHit) -> Self {
        let SeenHit {
            hit,
            position_m,
            to_viewer,
        } = *seen;
        let mesh = &scene.objects[hit.object as usize].mesh;
        let corners = mesh.corners_m(hit.triangle as usize);
        let geometric = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let side = if geometric.dot(to_viewer) < 0.0 {
            -1.0
        } else {
            1.0
        };
        Self {
            raised_m: raised(position_m, hit, mesh, side),
            facet: side * geometric,
        }
    }

    /// Where a ray of a point starts: in the place, unless the surface there has turned away from its direction. Then it is the point itself, which sends
    /// light that way: a convex body does not stand before itself.
    pub fn position_m(&self, point: &SurfacePoint, direction: DVec3) -> DVec3 {
        match self.facet.dot(direction) > 0.0 {
            true => self.raised_m,
            false => point.raised_m,
        }
    }
}

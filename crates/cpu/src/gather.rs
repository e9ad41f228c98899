//! The segments that a point may see, by the tree over them: for points that no tile has a list for.

use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_index::scratch_index::REACH_STD;
use hairline_index::{IndexedSegment, SegmentTree};

/// Calls `visit` with the index in the tree of every segment of an object that may have a share at the point, and of some others.
pub fn gather(
    tree: &SegmentTree<IndexedSegment>,
    object: u32,
    point: &SurfacePoint,
    visit: impl FnMut(usize),
) {
    let (center_m, reach_m) = (point.position_m.as_vec3(), reach_m(point).as_vec3());
    tree.gather(object as usize, center_m, reach_m, visit);
}

/// Half the sides of the box around a point that holds every segment with a share there, world space.
fn reach_m(point: &SurfacePoint) -> DVec3 {
    let sigma_m = point.coherence_um * 1e-6;
    // Variances of position along the world's axes; 0.7 sigma^2 covers the window across and the ends' blur along.
    let [ax, ay] = point.footprint_axes_m;
    let variance = ax * ax + ay * ay + DVec3::splat(0.7 * sigma_m * sigma_m);
    let on_plane = variance.map(f64::sqrt);
    let aside = point.leaves() * variance.element_sum().sqrt();
    (on_plane + point.normal.abs() * aside) * REACH_STD as f64
}

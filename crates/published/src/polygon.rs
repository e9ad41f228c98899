//! Polygonal lights on the band's middle line, triangle by triangle in the talk's six steps (the sixth, to evaluate, is
//! [`crate::spectrum::published_radiance`]).
//!
//! Seen from above, in direction cosines, the hemisphere is the unit disk, the line xi_t = 0 is straight, x = -wo_t, and the
//! edge of a triangle is an arc of an ellipse about the disk's centre. A light that does not face the point
//! ([`hairline_optics::band::polygon_facing`] 0) is left out before; here both sides are alike.

use earcut::Earcut;
use glam::DVec3;

use crate::segments::BandSegments;

/// Distance outside an edge, in direction cosines, at which a point still counts as on it: the rounding of single precision.
/// A corner on the line is thus found twice rather than not at all.
const CULL_SLACK: f64 = 1e-6;
/// A place beyond the disk: sorts last.
const CULLED: f64 = 2.0;

/// The triangles of a planar polygon, convex or not, as corners into `vertices`. Their winding means nothing.
pub fn triangulate(vertices: &[DVec3]) -> Vec<[usize; 3]> {
    let Some(&origin) = vertices.first() else {
        return Vec::new();
    };
    let normal: DVec3 = vertices
        .windows(2)
        .map(|edge| (edge[0] - origin).cross(edge[1] - origin))
        .sum();
    let (x, y) = normal.normalize_or(DVec3::Z).any_orthonormal_pair();
    let flat = vertices
        .iter()
        .map(|&v| [(v - origin).dot(x), (v - origin).dot(y)]);
    let mut corners = Vec::<usize>::new();
    Earcut::new().earcut(flat, &[], &mut corners);
    corners.as_chunks::<3>().0.to_vec()
}

/// A triangle above the horizon: as unit directions, in order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClippedTriangle {
    /// 0, 3 or 4.
    pub count: usize,
    /// Corners; zero beyond `count`.
    pub corners: [DVec3; 4],
}

impl ClippedTriangle {
    /// The one or two triangles that it is split into.
    pub fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let c = self.corners;
        (2..self.count).map(move |i| [c[0], c[i - 1], c[i]])
    }
}

/// Step 1, clip to the upper hemisphere. Corners are relative to the point, in any frame with z along the normal.
pub fn clip_triangle(corners: [DVec3; 3]) -> ClippedTriangle {
    let mut clipped = ClippedTriangle::default();
    let mut push = |corner: DVec3| {
        clipped.corners[clipped.count] = corner.normalize_or_zero();
        clipped.count += 1;
    };
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if a.z >= 0.0 {
            push(a);
        }
        if (a.z >= 0.0) != (b.z >= 0.0) {
            let crossing = a + (b - a) * (a.z / (a.z - b.z));
            push(crossing.with_z(0.0));
        }
    }
    clipped
}

/// Inward unit normal of the plane through the edge from `a` to `b` and the point; `side` is 1 or -1 by the triangle's
/// sense.
fn edge_plane(a: DVec3, b: DVec3, side: f64) -> DVec3 {
    side * a.cross(b - a).normalize_or_zero()
}

/// Steps 3 and 4: y where the line at `x` meets the ellipse of one edge above the horizon and within the planes of the
/// other two, [`CULLED`] where it does not.
fn edge_places(x: f64, plane: DVec3, other: DVec3, another: DVec3) -> [f64; 2] {
    let extent2 = plane.y * plane.y + plane.z * plane.z;
    let s2 = extent2 - x * x;
    if s2 <= 0.0 {
        return [CULLED; 2];
    }
    let (s, middle) = (s2.sqrt() / extent2, -plane.x * x / extent2);
    [-s, s].map(|s| {
        let (y, z) = (
            middle * plane.y + s * plane.z,
            middle * plane.z - s * plane.y,
        );
        let point = DVec3::new(x, y, z);
        if z.min(other.dot(point)).min(another.dot(point)) >= -CULL_SLACK {
            y
        } else {
            CULLED
        }
    })
}

/// Finds the segments of the line xi_t = 0 that a triangle above the horizon covers. `wo` and the corners are unit
/// directions in the frame of the scratch.
pub fn triangle_segments(wo: DVec3, corners: [DVec3; 3]) -> BandSegments {
    let mut segments = BandSegments::default();
    let [a, b, c] = corners;
    let x = -wo.x;

    // 2 Project: an edge is the arc where its plane through the point meets the hemisphere. Normals point inwards.
    let volume = a.dot((b - a).cross(c - a));
    if volume == 0.0 {
        return segments;
    }
    let side = volume.signum();
    let (ab, bc, ca) = (
        edge_plane(a, b, side),
        edge_plane(b, c, side),
        edge_plane(c, a, side),
    );

    // 3 Intersect. 4 Cull.
    let mut places = [CULLED; 8];
    places[0..2].copy_from_slice(&edge_places(x, ab, bc, ca));
    places[2..4].copy_from_slice(&edge_places(x, bc, ca, ab));
    places[4..6].copy_from_slice(&edge_places(x, ca, ab, bc));

    // 5 Sort and assemble. An odd count is a corner found twice: the last segment ends at the last point.
    let places = bitonic_sort(places);
    let count = places.iter().filter(|&&place| place < CULLED).count();
    for i in 0..count / 2 {
        let last = count % 2 == 1 && i == count / 2 - 1;
        let (low, high) = (places[2 * i], places[2 * i + 1 + last as usize]);
        segments.push_segment(wo.y + low, wo.y + high);
    }
    segments
}

/// Sorts the places in ascending order by K. E. Batcher's bitonic network (*Sorting networks and their applications*, 1968):
/// six rounds, the same for any input.
pub fn bitonic_sort(mut places: [f64; 8]) -> [f64; 8] {
    for block in [2, 4, 8] {
        let mut distance = block / 2;
        while distance > 0 {
            for i in 0..8 {
                let other = i ^ distance;
                let ascending = i & block == 0;
                if other > i && (places[i] > places[other]) == ascending {
                    places.swap(i, other);
                }
            }
            distance /= 2;
        }
    }
    places
}

//! Lists, for each triangle, of the segments that any of its points can see without a footprint: the per-triangle arrays of Z.
//! Velinov, S. Werner and M. Hullin, *Real-Time Rendering of Wave-Optical Effects on Scratched Surfaces* (2018), reached from the
//! visibility buffer without a walk. Scratches of neighbouring triangles within the coherence window are in a list too.
//!
//! A footprint reaches further than the window, so lists serve points without one only.

use glam::{DVec2, DVec3, Vec3};
use hairline_index::scratch_index::REACH_STD;
use hairline_index::{IndexedSegment, ScratchIndex};
use hairline_scene::{Mesh, Object, Scene};
use rayon::prelude::*;

/// The segments of each triangle. An entry costs 4 bytes, and a triangle 4 more.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TriangleLists {
    /// Start of each triangle's list in `segments`, and the end of the last one. Triangles are counted over the whole scene, object
    /// by object.
    pub starts: Vec<u32>,
    /// Indices into the segments of [`ScratchIndex::tree`], ascending within a list.
    pub segments: Vec<u32>,
}

/// Number of triangles that a thread takes at a time.
const CHUNK: usize = 256;

/// Variance, in sigma squared, of the Gaussian by which renderers walk the tree. It bounds the window's 1/2 across a scratch and
/// the 0.68 of its blurred ends along it ([`hairline_optics::footprint::ends`]).
const WINDOW_VARIANCE: f64 = 0.7;

impl TriangleLists {
    /// Lists for all triangles of the scene whose index this is, all cores at work; the same for any number of them.
    ///
    /// # Panics
    /// Beyond 4 billion entries: 16 GiB.
    pub fn build(scene: &Scene, index: &ScratchIndex) -> Self {
        Self::with_reach(REACH_STD as f64, scene, index)
    }

    /// Builds the lists for points that see as far as `reach_std` standard deviations of the blur of a scratch.
    fn with_reach(reach_std: f64, scene: &Scene, index: &ScratchIndex) -> Self {
        let mut lists = Self {
            starts: vec![0],
            segments: Vec::new(),
        };
        for (o, object) in scene.objects.iter().enumerate() {
            let triangles: Vec<usize> = (0..object.mesh.triangles.len()).collect();
            let chunks: Vec<(Vec<usize>, Vec<u32>)> = triangles
                .par_chunks(CHUNK)
                .map(|chunk| {
                    let (mut lengths, mut segments) = (Vec::with_capacity(chunk.len()), Vec::new());
                    for &triangle in chunk {
                        let before = segments.len();
                        TriangleReach::new(reach_std, scene, object, triangle).list(
                            index,
                            o,
                            &mut segments,
                        );
                        lengths.push(segments.len() - before);
                    }
                    (lengths, segments)
                })
                .collect();
            for (lengths, segments) in chunks {
                let mut end = lists.segments.len();
                for length in lengths {
                    end += length;
                    assert!(end < u32::MAX as usize, "more than 4 billion entries");
                    lists.starts.push(end as u32);
                }
                lists.segments.extend(segments);
            }
        }
        lists
    }

    /// The list of a triangle, counted over the whole scene.
    #[inline]
    pub fn list(&self, triangle: usize) -> &[u32] {
        &self.segments[self.starts[triangle] as usize..self.starts[triangle + 1] as usize]
    }
}

/// A triangle in its own plane, micrometres from its first corner, and how far its points see.
struct TriangleReach {
    corners_m: [Vec3; 3],
    origin_m: DVec3,
    axis_x: DVec3,
    axis_y: DVec3,
    normal: DVec3,
    corners_um: [DVec2; 3],
    reach_std: f64,
    coherence_um: f64,
    /// Half of the side of the box with which a point walks the tree.
    walk_um: f64,
    /// The largest angle between the triangle's normal and a shading normal on it.
    tilt_rad: f64,
}

impl TriangleReach {
    fn new(reach_std: f64, scene: &Scene, object: &Object, triangle: usize) -> Self {
        let mesh = &object.mesh;
        let corners_m = mesh.triangles[triangle].map(|v| mesh.positions_m[v as usize]);
        let [a, b, c] = corners_m.map(|v| v.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let (axis_x, axis_y) = normal.any_orthonormal_pair();
        let material = &scene.materials[mesh.triangle_materials[triangle] as usize];
        let mut this = Self {
            corners_m,
            origin_m: a,
            axis_x,
            axis_y,
            normal,
            corners_um: [DVec2::ZERO; 3],
            reach_std,
            coherence_um: material.coherence_um,
            walk_um: reach_std * WINDOW_VARIANCE.sqrt() * material.coherence_um,
            // A normal map may turn it anywhere.
            tilt_rad: if material.normal_texture.is_some() || material.has_coat_normals() {
                std::f64::consts::FRAC_PI_2
            } else {
                tilt_rad(mesh, triangle, normal)
            },
        };
        this.corners_um = [a, b, c].map(|corner| this.in_plane(corner).truncate());
        this
    }

    /// Relative to the first corner in the triangle's axes, micrometres.
    fn in_plane(&self, position_m: DVec3) -> DVec3 {
        let v = (position_m - self.origin_m) * 1e6;
        DVec3::new(v.dot(self.axis_x), v.dot(self.axis_y), v.dot(self.normal))
    }

    /// Appends the segments that the triangle's points can see.
    fn list(&self, index: &ScratchIndex, object: usize, list: &mut Vec<u32>) {
        let [a, b, c] = self.corners_m;
        let reach = Vec3::splat((self.walk_um * 1e-6) as f32);
        let (lower, upper) = (a.min(b).min(c) - reach, a.max(b).max(c) + reach);
        let before = list.len();
        index.tree.walk(object, lower, upper, |segments| {
            for i in segments {
                if self.sees(&index.tree.segments[i]) {
                    list.push(i as u32);
                }
            }
        });
        list[before..].sort_unstable();
    }

    /// Whether a point of the triangle may see a segment: never false for one that does.
    ///
    /// A point looks at a segment's projection onto the plane of its shading normal, which is tilted to the triangle's by theta at
    /// most. Of a vector with the height h over the triangle's plane the projection is at least as long as its part in
    /// the plane times cos(theta) less |h| sin(theta), and that must be within reach.
    fn sees(&self, segment: &IndexedSegment) -> bool {
        let (start, end) = (
            self.in_plane(segment.start_m.as_dvec3()),
            self.in_plane(segment.end_m.as_dvec3()),
        );
        // Extent of the walk's box along the normal and in any other direction.
        let farthest = 3f64.sqrt() * self.walk_um;
        let (lowest, highest) = (start.z.min(end.z), start.z.max(end.z));
        if lowest > farthest || highest < -farthest {
            return false;
        }
        let (sin, cos) = self.tilt_rad.sin_cos();
        let height = highest.max(-lowest);
        let across = self.reach_std * 0.5f64.sqrt() * self.coherence_um;
        let around = across.hypot(self.reach_std * segment.blur_um as f64);
        let in_plane = if cos > 1e-3 {
            ((around + height * sin) / cos).min(farthest)
        } else {
            farthest
        };
        let (start2, end2) = (start.truncate(), end.truncate());
        if distance_to_triangle(start2, end2, &self.corners_um) > in_plane {
            return false;
        }
        // Across the line, which counts however far its ends are: there the reach is shorter.
        let along = end2 - start2;
        let length = along.length();
        let rise = end.z - start.z;
        let cos_line = (length.atan2(rise.abs()) - self.tilt_rad).sin();
        if length < 1e-3 || cos_line < 1e-3 {
            return true;
        }
        let along = along / length;
        let (mut nearest_left, mut nearest_right) = (f64::INFINITY, f64::INFINITY);
        let mut line_height: f64 = 0.0;
        for corner in self.corners_um {
            let v = corner - start2;
            let side = along.perp_dot(v);
            nearest_left = nearest_left.min(side);
            nearest_right = nearest_right.min(-side);
            line_height = line_height.max((start.z + rise * along.dot(v) / length).abs());
        }
        nearest_left.max(nearest_right) <= (across + line_height * sin) / cos_line
    }
}

/// The largest angle between a triangle's normal and the shading normals at its corners; those between lie within.
fn tilt_rad(mesh: &Mesh, triangle: usize, normal: DVec3) -> f64 {
    mesh.triangles[triangle]
        .iter()
        .map(|v| {
            let shading = mesh.normals[*v as usize].as_dvec3();
            shading.cross(normal).length().atan2(shading.dot(normal))
        })
        .fold(0.0, f64::max)
        .min(std::f64::consts::FRAC_PI_2)
}

/// Distance in the plane from a segment to a triangle of either winding.
fn distance_to_triangle(start: DVec2, end: DVec2, corners: &[DVec2; 3]) -> f64 {
    let [a, b, c] = *corners;
    let winding = (b - a).perp_dot(c - a).signum();
    let edges = [(a, b), (b, c), (c, a)];
    let inside = |p: DVec2| {
        edges
            .iter()
            .all(|(from, to)| winding * (*to - *from).perp_dot(p - *from) >= 0.0)
    };
    if inside(start) || inside(end) {
        return 0.0;
    }
    let mut nearest = f64::INFINITY;
    for (from, to) in edges {
        // They cross where each has the other's ends on both sides.
        let sides = |a: DVec2, b: DVec2, p: DVec2, q: DVec2| {
            (b - a).perp_dot(p - a) * (b - a).perp_dot(q - a)
        };
        if sides(start, end, from, to) < 0.0 && sides(from, to, start, end) < 0.0 {
            return 0.0;
        }
        nearest = nearest
            .min(distance_to_segment(from, start, end))
            .min(distance_to_segment(start, from, to))
            .min(distance_to_segment(end, from, to));
    }
    nearest
}

fn distance_to_segment(point: DVec2, start: DVec2, end: DVec2) -> f64 {
    let along = end - start;
    let t = ((point - start).dot(along) / along.length_squared().max(1e-30)).clamp(0.0, 1.0);
    point.distance(start + along * t)
}

#[cfg(test)]
mod tests;

//! Triangles along many rays of one origin: the tree is walked once for a narrow pyramid, and each ray within it tries the triangles found.

use crate::coverage::Coverage;
use crate::hit::Hit;
use crate::triangle_index::TriangleIndex;
use glam::DVec3;

/// A pyramid of directions from one point, and the triangles that rays within it may meet.
pub struct TriangleBeam {
    candidates: Vec<Candidate>,
    /// Whether there are too many triangles to be listed: rays walk the tree.
    is_full: bool,
    /// Nodes of the tree that wait.
    stack: Vec<u32>,
}

/// Past so many triangles a walk of the tree for each ray is faster.
const MAX_CANDIDATES: usize = 16;

/// A triangle for rays of one origin. With the edges e1 and e2 of the corner a and s = origin - a, Moeller's and Trumbore's products
/// of a ray's direction d are scalar products with vectors that all rays share.
struct Candidate {
    object: u32,
    triangle: u32,
    /// e2 x e1: the determinant.
    normal: DVec3,
    /// e2 x s and s x e1: the barycentric coordinates.
    across_u: DVec3,
    across_v: DVec3,
    /// e2 . (s x e1): the distance.
    height: f64,
}

impl Candidate {
    fn new(object: u32, triangle: u32, [a, b, c]: &[DVec3; 3], origin: DVec3) -> Self {
        let (e1, e2, s) = (*b - *a, *c - *a, origin - *a);
        let across_v = s.cross(e1);
        Self {
            object,
            triangle,
            normal: e2.cross(e1),
            across_u: e2.cross(s),
            across_v,
            height: e2.dot(across_v),
        }
    }

    fn intersect(&self, direction: DVec3, nearest_m: f64) -> Option<Hit> {
        let determinant = direction.dot(self.normal);
        let sign = 1.0f64.copysign(determinant);
        let size = determinant.abs();
        let (u, v) = (
            sign * direction.dot(self.across_u),
            sign * direction.dot(self.across_v),
        );
        let height = sign * self.height;
        let meets = u >= 0.0 && v >= 0.0 && u + v <= size && height > 0.0;
        if !meets || height >= nearest_m * size {
            return None;
        }
        let per_size = 1.0 / size;
        Some(Hit {
            object: self.object,
            triangle: self.triangle,
            distance_m: height * per_size,
            barycentric: [u * per_size, v * per_size],
        })
    }
}

impl TriangleBeam {
    /// Holds nothing until it is aimed.
    pub fn new() -> Self {
        Self {
            candidates: Vec::new(),
            is_full: false,
            stack: Vec::new(),
        }
    }

    /// Finds the triangles that the pyramid from `origin` with edges along `corners` may meet: in their order around it, either way round,
    /// less than 90 degrees from one another.
    pub fn aim(&mut self, triangles: &TriangleIndex, origin: DVec3, corners: [DVec3; 4]) {
        self.candidates.clear();
        self.stack.clear();
        self.is_full = false;
        let middle: DVec3 = corners.iter().sum();
        let sides: [DVec3; 4] = std::array::from_fn(|i| {
            let normal = corners[i].cross(corners[(i + 1) % 4]);
            normal * 1.0f64.copysign(normal.dot(middle))
        });
        let nodes = &triangles.tree().nodes;
        if nodes.is_empty() || triangles.triangles().is_empty() {
            return;
        }
        self.stack.push(0);
        while let Some(i) = self.stack.pop() {
            let node = &nodes[i as usize];
            let (low, high) = (node.aabb().min.as_dvec3(), node.aabb().max.as_dvec3());
            let center = 0.5 * (low + high) - origin;
            let half = 0.5 * (high - low);
            // A trifle wider, for rounding.
            let outside = sides.iter().any(|side| {
                side.dot(center) + (1.0 + 1e-12) * side.abs().dot(half)
                    < -1e-12 * side.abs().dot(center.abs())
            });
            if outside {
                continue;
            }
            if !node.is_leaf() {
                self.stack.extend([node.first_index, node.first_index + 1]);
                continue;
            }
            let first = node.first_index as usize;
            for (object, triangle, corners) in
                &triangles.triangles()[first..first + node.prim_count as usize]
            {
                let beyond = sides.iter().any(|side| {
                    corners.iter().all(|corner| {
                        let to = *corner - origin;
                        side.dot(to) < -1e-12 * side.abs().dot(to.abs())
                    })
                });
                if beyond || triangles.is_unseen(*object, corners, origin) {
                    continue;
                }
                if self.candidates.len() == MAX_CANDIDATES {
                    self.is_full = true;
                    return;
                }
                self.candidates
                    .push(Candidate::new(*object, *triangle, corners, origin));
            }
        }
    }

    /// The nearest hit of a ray along the unit `direction` within the pyramid, as [`TriangleIndex`] finds it. `triangles`
    /// and `origin` are what it was aimed with.
    pub fn intersect(
        &self,
        triangles: &TriangleIndex,
        origin: DVec3,
        direction: DVec3,
        coverage: Coverage,
    ) -> Option<Hit> {
        if self.is_full {
            return triangles.intersect_covered(origin, direction, coverage);
        }
        let mut nearest: Option<Hit> = None;
        for candidate in &self.candidates {
            let nearest_m = nearest.map_or(f64::INFINITY, |hit| hit.distance_m);
            let met = candidate.intersect(direction, nearest_m);
            let met = met.filter(|hit| triangles.is_there(hit, coverage));
            nearest = met.or(nearest);
        }
        nearest
    }
}

impl Default for TriangleBeam {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_fixtures::SceneFile;
    use hairline_scene::Scene;

    /// A bowl seen from the side, so that rays meet up to two sheets, over a floor of large triangles; with so many segments.
    fn scene(segments: usize) -> Scene {
        let bowl = format!(
            "lathe = {{ segments = {segments}, profile_m = [[0.0, 0.0], [0.03, 0.01], [0.05, 0.04], [0.055, 0.08]] }}"
        );
        SceneFile::seen_from([0.1, -0.3, 0.12])
            .fov_y_deg(40.0)
            .size_px([96, 64])
            .mirror("m")
            .object("bowl", "m", &bowl)
            .object("floor", "m", "plane = { size_m = [0.2, 0.2] }")
            .scene()
    }

    #[test]
    fn beams_find_what_rays_find() {
        let mut overflows = Vec::new();
        // Few triangles to a beam, and too many.
        for segments in [24, 2000] {
            let scene = scene(segments);
            let triangles = TriangleIndex::build(&scene);
            let camera = scene.camera.frame([96, 64]);
            let origin = camera.position_m;
            let mut beam = TriangleBeam::new();
            let (mut hits, mut misses, mut full, mut beside) = (0, 0, 0, 0);
            for y in 0..64 {
                for block in 0..12 {
                    let ray = |x: f64, dy: f64| {
                        let at = glam::DVec2::new(8.0 * f64::from(block) + x, f64::from(y) + dy);
                        camera.camera_ray(at)
                    };
                    beam.aim(
                        &triangles,
                        origin,
                        [ray(0.0, 0.0), ray(8.0, 0.0), ray(8.0, 1.0), ray(0.0, 1.0)],
                    );
                    full += u32::from(beam.is_full);
                    for x in 0..8 {
                        let direction = ray(f64::from(x) + 0.37, 0.61).normalize();
                        let expected = triangles.intersect(origin, direction);
                        let found = beam.intersect(&triangles, origin, direction, Coverage::Any);
                        let Some(expected) = expected else {
                            assert_eq!(found, None);
                            misses += 1;
                            continue;
                        };
                        let found = found.unwrap_or_else(|| panic!("missed {expected:?}"));
                        hits += 1;
                        assert_eq!(
                            (found.object, found.triangle),
                            (expected.object, expected.triangle)
                        );
                        // Double precision, and slivers of triangles.
                        assert!((found.distance_m / expected.distance_m - 1.0).abs() < 1e-11);
                        for i in 0..2 {
                            let off = found.barycentric[i] - expected.barycentric[i];
                            assert!(off.abs() < 1e-9, "{off:e}");
                        }
                    }
                    // A ray beside the beam is not its business: that it holds less than all is why it is fast.
                    let away = ray(40.0, 8.5).normalize();
                    let seen = triangles.intersect(origin, away);
                    beside += u32::from(
                        beam.intersect(&triangles, origin, away, Coverage::Any)
                            .is_none()
                            && seen.is_some(),
                    );
                }
            }
            assert!(hits > 1000 && misses > 500, "{hits} {misses}");
            overflows.push(full);
            assert!(beside > 50, "{beside}");
        }
        // Both kinds are among them.
        assert!(
            0 < overflows[0] && overflows[0] < overflows[1],
            "{overflows:?}"
        );
    }

    #[test]
    fn nothing_is_behind_the_origin() {
        let scene = scene(24);
        let triangles = TriangleIndex::build(&scene);
        let up = [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)]
            .map(|(x, y)| DVec3::new(x, y, 1.0));
        let mut beam = TriangleBeam::new();
        let above = DVec3::new(0.0, 0.0, 0.5);
        beam.aim(&triangles, above, up);
        assert_eq!(
            beam.intersect(&triangles, above, DVec3::Z, Coverage::Any),
            None
        );
        let down = up.map(|corner| corner * DVec3::new(1.0, 1.0, -1.0));
        beam.aim(&triangles, above, down);
        let direction = DVec3::new(0.01, 0.02, -1.0).normalize();
        let hit = beam.intersect(&triangles, above, direction, Coverage::Any);
        assert!(hit.is_some());
    }
}

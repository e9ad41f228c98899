//! Triangles in world space, and the parts of a file that they came from.

use std::ops::Range;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};

/// Largest coordinate, metres: beyond it single precision leaves less than a coherence width between neighbouring coordinates.
pub const LARGEST_M: f64 = 1e3;

/// Triangles in world space. The vertex arrays are equally long; those of other coordinates and of colours may be empty.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// World space, metres.
    pub positions_m: Vec<Vec3>,
    /// Unit shading normals.
    pub normals: Vec<Vec3>,
    /// Unit tangents in xyz, the sign of the bitangent in w, as in glTF.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates; (0, 0) is the upper left corner.
    pub uvs: Vec<Vec2>,
    /// A second set of texture coordinates; without it they are (0, 0).
    pub other_uvs: Vec<Vec2>,
    /// Factors on base colour and alpha, linear Rec.709; without them 1.
    pub colors: Vec<Vec4>,
    /// Vertex indices, counter-clockwise seen from outside. None is degenerate.
    pub triangles: Vec<[u32; 3]>,
    /// Index of the material, one for each triangle.
    pub triangle_materials: Vec<u32>,
}

impl Mesh {
    /// Materials of the triangles, each once, in order.
    pub fn materials(&self) -> Vec<usize> {
        let all = self.triangle_materials.iter();
        let mut all: Vec<usize> = all.map(|material| *material as usize).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// A triangle's corners in double precision, metres.
    pub fn corners_m(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.positions_m[v as usize].as_dvec3())
    }

    /// Change of the barycentric coordinates of the second and third vertex over a step in the plane of a triangle.
    pub fn barycentric_step(&self, triangle: u32, step_m: DVec3) -> DVec2 {
        let [a, b, c] = self.corners_m(triangle as usize);
        let (e1, e2) = (b - a, c - a);
        let geometric = e1.cross(e2);
        let along = DVec2::new(
            step_m.cross(e2).dot(geometric),
            e1.cross(step_m).dot(geometric),
        );
        along / geometric.length_squared()
    }

    /// The vertices that stand farthest out, one for each of some directions: a frame around them is one around the mesh, to a few
    /// hundredths of its size.
    pub fn extreme_points_m(&self) -> Vec<Vec3> {
        const DIRECTIONS: usize = 128;
        // Spread evenly over the sphere, by the golden angle.
        let direction = |i: usize| {
            let z = 1.0 - (2 * i + 1) as f32 / DIRECTIONS as f32;
            let (sine, cosine) = (2.399_963_2 * i as f32).sin_cos();
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * cosine, r * sine, z)
        };
        let directions: [Vec3; DIRECTIONS] = std::array::from_fn(direction);
        let mut farthest = [(f32::NEG_INFINITY, Vec3::ZERO); DIRECTIONS];
        let mut is_used = vec![false; self.positions_m.len()];
        for v in self.triangles.iter().flatten() {
            is_used[*v as usize] = true;
        }
        let used = self.positions_m.iter().zip(is_used);
        for (point, _) in used.filter(|(_, is_used)| *is_used) {
            for (direction, (distance, best)) in directions.iter().zip(&mut farthest) {
                let reach = direction.dot(*point);
                if reach > *distance {
                    (*distance, *best) = (reach, *point);
                }
            }
        }
        let found = farthest.iter().filter(|(distance, _)| distance.is_finite());
        found.map(|(_, point)| *point).collect()
    }

    /// The least box around the vertices that triangles use, as its two extreme corners, metres.
    pub fn bounds_m(&self) -> (Vec3, Vec3) {
        let used = self.triangles.iter().flatten();
        used.map(|&v| self.positions_m[v as usize])
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(least, most), p| {
                (least.min(p), most.max(p))
            })
    }
}

/// The triangles of one node of a model's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeTriangles {
    /// The names of the node and of those above it, from the innermost on.
    pub nodes: Arc<[String]>,
    /// Range of the part in [`Mesh::triangles`].
    pub triangles: Range<usize>,
}

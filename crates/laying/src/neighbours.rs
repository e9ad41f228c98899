//! Finds the triangle beyond each edge.

use glam::{DVec3, Vec3};
use hairline_scene::Mesh;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::facet::Facet;

/// Vertices this near to each other are one, relative to the mesh's diagonal: seams of texture coordinates and normals, and
/// borders between primitives, hold the same point twice, give or take a rounding.
const WELD: f32 = 1e-6;
/// A scratching edge does not follow the surface around a sharper bend than this: 60 degrees between the normals.
const CREASE_COS: f64 = 0.5;
const NONE: u32 = u32::MAX;

/// Triangle beyond each edge of each triangle, and the number of the shared edge in that triangle.
#[derive(Debug)]
pub(crate) struct Neighbours(Vec<[u32; 3]>);

impl Neighbours {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let mut beyond = vec![[NONE; 3]; mesh.triangles.len()];
        each_bend(mesh, |bend| {
            if bend.normals[0].dot(bend.normals[1]) >= CREASE_COS {
                beyond[bend.half_edge as usize / 4][bend.half_edge as usize % 4] = bend.beyond;
            }
        });
        Self(beyond)
    }

    /// The triangle beyond an edge and its own number for the edge; `None` at a boundary and at a crease.
    pub(crate) fn across_edge(&self, triangle: u32, edge: usize) -> Option<(u32, usize)> {
        match self.0[triangle as usize][edge] {
            NONE => None,
            other => Some((other / 4, other as usize % 4)),
        }
    }
}

/// An edge of a triangle with the triangle beyond it.
pub(crate) struct Bend {
    /// Four times the triangle's index, plus that of the edge.
    half_edge: u32,
    /// Half edge of the triangle beyond, numbered alike.
    beyond: u32,
    /// Unit normals of the triangle and of the one beyond.
    pub normals: [DVec3; 2],
}

impl Bend {
    /// The ends of the edge, in the triangle's own order.
    pub(crate) fn ends_m(&self, mesh: &Mesh) -> [DVec3; 2] {
        let corners_m = mesh.corners_m(self.half_edge as usize / 4);
        let edge = self.half_edge as usize % 4;
        [corners_m[edge], corners_m[(edge + 1) % 3]]
    }
}

/// All edges that a triangle has with another one, each from both sides.
pub(crate) fn each_bend(mesh: &Mesh, mut bend: impl FnMut(Bend)) {
    let welded = welded(mesh);
    let normals: Vec<DVec3> = (0..mesh.triangles.len() as u32)
        .into_par_iter()
        .map(|t| Facet::new(mesh, t).normal)
        .collect();

    // Half edges side by side with those of the same two ends.
    let mut half_edges: Vec<_> = mesh
        .triangles
        .par_iter()
        .enumerate()
        .flat_map_iter(|(t, triangle)| {
            let corners = triangle.map(|v| welded[v as usize]);
            (0..3u32).map(move |edge| {
                let from = corners[edge as usize];
                let to = corners[(edge as usize + 1) % 3];
                let ends = (from.min(to), from.max(to));
                (ends, from > to, t as u32 * 4 + edge)
            })
        })
        .collect();
    half_edges.par_sort_unstable();

    for group in half_edges.chunk_by(|a, b| a.0 == b.0) {
        for &(_, backwards, half_edge) in group {
            let normal = normals[half_edge as usize / 4];
            // Sheets that are closed by a back side have four triangles at an edge: go on with the one that bends least.
            let best = group
                .iter()
                .filter(|other| other.1 != backwards)
                .map(|other| (normals[other.2 as usize / 4].dot(normal), other.2))
                .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
            if let Some((_, beyond)) = best {
                bend(Bend {
                    half_edge,
                    beyond,
                    normals: [normal, normals[beyond as usize / 4]],
                });
            }
        }
    }
}

/// Index of the first vertex at the place of each vertex.
fn welded(mesh: &Mesh) -> Vec<u32> {
    let (least, most) = mesh.bounds_m();
    let tolerance = (most - least).length() * WELD;
    // Cells much wider than the tolerance: most vertices have to look into one only.
    let cell = (tolerance * 64.0).max(f32::MIN_POSITIVE);
    let cell_of = |p: Vec3| ((p - least) / cell).floor().as_i64vec3().to_array();
    // The last vertex in each, and the one before it there: a list for each cell would cost an allocation for most vertices.
    let mut last_in: FxHashMap<[i64; 3], u32> = FxHashMap::default();
    let mut before = vec![NONE; mesh.positions_m.len()];
    let mut first = Vec::with_capacity(mesh.positions_m.len());
    for (i, &position) in mesh.positions_m.iter().enumerate() {
        let low = cell_of(position - Vec3::splat(tolerance));
        let high = cell_of(position + Vec3::splat(tolerance));
        let mut found = None;
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut next = last_in.get(&[x, y, z]).copied().unwrap_or(NONE);
                    while next != NONE {
                        let v = next as usize;
                        let off2 = mesh.positions_m[v].distance_squared(position);
                        if off2 <= tolerance * tolerance {
                            found = Some(found.map_or(next, |known: u32| known.min(next)));
                        }
                        next = before[v];
                    }
                }
            }
        }
        first.push(found.unwrap_or_else(|| {
            let last = last_in.entry(cell_of(position)).or_insert(NONE);
            before[i] = std::mem::replace(last, i as u32);
            i as u32
        }));
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::mesh;

    fn open_edges(mesh: &Mesh) -> usize {
        Neighbours::new(mesh)
            .0
            .iter()
            .flatten()
            .filter(|&&n| n == NONE)
            .count()
    }

    #[test]
    fn seams_are_closed_and_boundaries_open() {
        assert_eq!(open_edges(&mesh("sphere = { radius_m = 0.3 }")), 0);
        assert_eq!(open_edges(&mesh("disk = { radius_m = 0.3 }")), 256);
        assert_eq!(open_edges(&mesh("plane = { size_m = [1.0, 1.0] }")), 4);
    }

    #[test]
    fn creases_are_open() {
        let bend = |rise: f64| {
            let profile = format!("[[0.01, 0.0], [0.02, 0.0], [0.03, {rise}]]");
            open_edges(&mesh(&format!(
                "lathe = {{ profile_m = {profile}, segments = 64 }}"
            )))
        };
        // Two rims of 64 edges; the 63.4 degree bend adds both sides of another ring.
        assert_eq!(bend(0.01), 128);
        assert_eq!(bend(0.02), 256);
    }

    #[test]
    fn the_two_sides_of_a_closed_sheet_keep_apart() {
        let mut sheet = mesh("plane = { size_m = [1.0, 1.0] }");
        for i in 0..2 {
            let [a, b, c] = sheet.triangles[i];
            sheet.triangles.push([a, c, b]);
        }
        let neighbours = Neighbours::new(&sheet);
        for triangle in 0..4u32 {
            for edge in 0..3 {
                if let Some((other, _)) = neighbours.across_edge(triangle, edge) {
                    assert_eq!(triangle / 2, other / 2);
                }
            }
        }
        assert_eq!(open_edges(&sheet), 8);
    }
}

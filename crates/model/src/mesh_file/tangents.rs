//! Tangents for normal maps of files that bring none: Morten S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008
//! (MikkTSpace), which glTF 2.0 asks for in section 3.7.2.1.

use std::collections::HashMap;

use glam::DVec3;

use crate::surface::{Surface, Vertex};

/// The surface with tangents from its normals and texture coordinates. Vertices whose triangles disagree are split.
pub(super) fn made_up(surface: &Surface) -> Surface {
    let mut corners = Corners {
        surface,
        tangents: vec![[[0.0; 4]; 3]; surface.triangles.len()],
    };
    match bevy_mikktspace::generate_tangents(&mut corners) {
        Ok(()) => {}
        Err(never) => unreachable!("{never}"),
    }
    let tangents = corners.tangents;
    let mut indexed = Surface::default();
    let mut known: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    for (triangle, tangents) in surface.triangles.iter().zip(&tangents) {
        let corner = |i: usize| {
            let [x, y, z, w] = tangents[i];
            let key = (triangle[i], tangents[i].map(f32::to_bits));
            *known.entry(key).or_insert_with(|| {
                indexed.vertices.push(Vertex {
                    tangent: DVec3::from_array([x, y, z].map(f64::from)).normalize_or_zero(),
                    handedness: if w < 0.0 { -1.0 } else { 1.0 },
                    ..surface.vertices[triangle[i] as usize]
                });
                indexed.vertices.len() as u32 - 1
            })
        };
        let corners = [0, 1, 2].map(corner);
        indexed.triangles.push(corners);
    }
    indexed
}

struct Corners<'a> {
    surface: &'a Surface,
    tangents: Vec<[[f32; 4]; 3]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> &Vertex {
        &self.surface.vertices[self.surface.triangles[face][corner] as usize]
    }
}

impl bevy_mikktspace::Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.surface.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        self.vertex(face, vert).position_m.as_vec3().to_array()
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.vertex(face, vert).normal.as_vec3().to_array()
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        // MikkTSpace takes v to increase upwards, as OpenGL does; glTF's increases downwards.
        let uv = self.vertex(face, vert).uv;
        [uv.x, 1.0 - uv.y]
    }

    fn set_tangent(
        &mut self,
        tangent: Option<bevy_mikktspace::TangentSpace>,
        face: usize,
        vert: usize,
    ) {
        // Without one the vertex gets any tangent perpendicular to its normal.
        self.tangents[face][vert] = tangent.map_or([0.0, 0.0, 0.0, 1.0], |t| t.tangent_encoded());
    }
}

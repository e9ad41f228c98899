//! Conversion of vertices in double precision, in a frame of their own, to a [`Mesh`] in world space.

use glam::{DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};

use crate::mesh::Mesh;

/// A vertex before it is moved to world space and rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Metres, in the frame of the surface.
    pub position_m: DVec3,
    /// Unit.
    pub normal: DVec3,
    /// Unit, along increasing u; or zero for that of the texture coordinates.
    pub tangent: DVec3,
    /// The bitangent is `normal x tangent` times this, as in glTF.
    pub handedness: f64,
    /// See [`Mesh::uvs`].
    pub uv: Vec2,
    /// See [`Mesh::other_uvs`].
    pub other_uv: Vec2,
    /// Linear, with alpha.
    pub color: Vec4,
}

impl Default for Vertex {
    fn default() -> Self {
        Self {
            position_m: DVec3::ZERO,
            normal: DVec3::ZERO,
            tangent: DVec3::ZERO,
            handedness: 1.0,
            uv: Vec2::ZERO,
            other_uv: Vec2::ZERO,
            color: Vec4::ONE,
        }
    }
}

/// Triangles of one material in a frame of their own.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Vertices that triangles refer to.
    pub vertices: Vec<Vertex>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Least height of a triangle, in roundings of its coordinates, at which its normal is more than noise.
const LEAST_HEIGHT_ROUNDINGS: f64 = 4.0;
/// Least height of a triangle, over its longest edge.
const LEAST_HEIGHT_SHARE: f64 = 1e-6;

impl Surface {
    /// The surface as a mesh, as by [`Self::bake`], with material 0.
    pub fn baked(&self, world_from_local: &DMat4) -> Mesh {
        let mut mesh = Mesh::default();
        self.bake(world_from_local, 0, &mut mesh);
        mesh
    }

    /// Appends the surface, moved by `world_from_local`, to `mesh`, without its degenerate triangles.
    pub fn bake(&self, world_from_local: &DMat4, material: u32, mesh: &mut Mesh) {
        let linear = DMat3::from_mat4(*world_from_local);
        // A mirror image turns both the winding and, by the determinant's sign, the normals.
        let mirror = if linear.determinant() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let cofactor = cofactor(&linear);
        let first = mesh.positions_m.len() as u32;
        let is_used = |what: fn(&Vertex) -> bool| self.vertices.iter().any(what);
        let has_other_uvs =
            !mesh.other_uvs.is_empty() || is_used(|vertex| vertex.other_uv != Vec2::ZERO);
        let has_colors = !mesh.colors.is_empty() || is_used(|vertex| vertex.color != Vec4::ONE);
        if has_other_uvs {
            // Fills up for the vertices before these.
            mesh.other_uvs.resize(first as usize, Vec2::ZERO);
            mesh.other_uvs
                .extend(self.vertices.iter().map(|vertex| vertex.other_uv));
        }
        if has_colors {
            mesh.colors.resize(first as usize, Vec4::ONE);
            mesh.colors
                .extend(self.vertices.iter().map(|vertex| vertex.color));
        }
        let tangents = self.tangents();
        for (vertex, (tangent, handedness)) in self.vertices.iter().zip(tangents) {
            let position = world_from_local.transform_point3(vertex.position_m);
            let normal = (mirror * (cofactor * vertex.normal)).normalize_or(DVec3::Z);
            let tangent = perpendicular(linear * tangent, normal);
            mesh.positions_m.push(position.as_vec3());
            mesh.normals.push(normal.as_vec3());
            let w = (handedness * mirror) as f32;
            mesh.tangents.push(tangent.as_vec3().extend(w));
            mesh.uvs.push(vertex.uv);
        }
        for &[a, b, c] in &self.triangles {
            let mut triangle = [first + a, first + b, first + c];
            if mirror < 0.0 {
                triangle.swap(1, 2);
            }
            if !is_degenerate(triangle.map(|v| mesh.positions_m[v as usize])) {
                mesh.triangles.push(triangle);
                mesh.triangle_materials.push(material);
            }
        }
    }

    /// Tangents and handedness of the vertices. Those without a tangent get the mean of their triangles' derivatives of the position by u: grooves and
    /// brushing follow it. It is zero where there are no texture coordinates.
    fn tangents(&self) -> Vec<(DVec3, f64)> {
        let own = self.vertices.iter().map(|it| (it.tangent, it.handedness));
        let mut tangents: Vec<_> = own.collect();
        let is_open = |vertex: &Vertex| vertex.tangent == DVec3::ZERO;
        if !self
            .vertices
            .iter()
            .any(|it| is_open(it) && it.uv != Vec2::ZERO)
        {
            return tangents;
        }
        let mut sides = vec![0.0; self.vertices.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| self.vertices[v as usize]);
            let [e1, e2] = [b, c].map(|it| it.position_m - a.position_m);
            let [d1, d2] = [b, c].map(|it| (it.uv - a.uv).as_dvec2());
            let area = d1.perp_dot(d2);
            let along_u = (e1 * d2.y - e2 * d1.y) / area;
            if !along_u.is_finite() {
                continue;
            }
            for v in triangle
                .map(|v| v as usize)
                .into_iter()
                .filter(|v| is_open(&self.vertices[*v]))
            {
                tangents[v].0 += along_u;
                // The bitangent is the way that v falls.
                let around = e1.cross(e2).dot(self.vertices[v].normal);
                sides[v] -= area.signum() * around;
            }
        }
        for ((_, handedness), side) in tangents.iter_mut().zip(sides) {
            if side != 0.0 {
                *handedness = side.signum();
            }
        }
        tangents
    }

    /// Winds each triangle as the normals of its vertices say, and returns how many were wound the other way. Exports of mirrored parts
    /// have such; shadows start on the side that a triangle shows, so both must agree on it.
    pub fn turn_to_normals(&mut self) -> usize {
        let mut turned = 0;
        for triangle in &mut self.triangles {
            let [a, b, c] = triangle.map(|v| self.vertices[v as usize]);
            let across = (b.position_m - a.position_m).cross(c.position_m - a.position_m);
            if across.dot(a.normal + b.normal + c.normal) < 0.0 {
                triangle.swap(1, 2);
                turned += 1;
            }
        }
        turned
    }

    /// Gives every triangle vertices of its own, with the triangle's normal, as glTF 2.0 requires where a file has no normals (section
    /// 3.7.2.1).
    pub fn make_flat_normals(&mut self) {
        let mut vertices = Vec::with_capacity(self.triangles.len() * 3);
        for triangle in &mut self.triangles {
            let corners = triangle.map(|v| self.vertices[v as usize]);
            let [a, b, c] = corners.map(|corner| corner.position_m);
            let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
            let first = vertices.len() as u32;
            vertices.extend(corners.map(|corner| Vertex { normal, ..corner }));
            *triangle = [first, first + 1, first + 2];
        }
        self.vertices = vertices;
    }
}

/// Cofactor matrix, the map of normals under a linear map; unlike the inverse it exists for flattened objects too.
pub fn cofactor(linear: &DMat3) -> DMat3 {
    DMat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    )
}

/// The unit part of `direction` perpendicular to `normal`; any perpendicular where there is none.
fn perpendicular(direction: DVec3, normal: DVec3) -> DVec3 {
    let direction = direction.normalize_or_zero();
    let across = direction - normal * direction.dot(normal);
    match across.length() > 1e-6 {
        true => across.normalize(),
        false => normal.any_orthonormal_vector(),
    }
}

fn is_degenerate(positions_m: [Vec3; 3]) -> bool {
    let [a, b, c] = positions_m.map(|p| p.as_dvec3());
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let largest_coordinate = [a, b, c]
        .iter()
        .map(|p| p.abs().max_element())
        .fold(0.0, f64::max);
    let height = (b - a).cross(c - a).length() / longest.max(f64::MIN_POSITIVE);
    let rounding = largest_coordinate * f64::from(f32::EPSILON) / 2.0;
    // Written so that a NaN is degenerate too.
    !(height > LEAST_HEIGHT_ROUNDINGS * rounding && height > LEAST_HEIGHT_SHARE * longest)
}

/// Scale first, then turn about the fixed axes x, y, z in that order, then move. Bit for bit the same on every platform.
pub fn world_from_object(
    translation_m: [f64; 3],
    rotation_deg: [f64; 3],
    scale: [f64; 3],
) -> DMat4 {
    let [(sx, cx), (sy, cy), (sz, cz)] = rotation_deg.map(|deg| {
        let quarter_turns = deg / 90.0;
        match quarter_turns == quarter_turns.round() {
            // Exact, so that a quarter turn leaves no dust in the coordinates.
            true => match quarter_turns.rem_euclid(4.0) as u8 {
                0 => (0.0, 1.0),
                1 => (1.0, 0.0),
                2 => (0.0, -1.0),
                _ => (-1.0, 0.0),
            },
            false => libm::sincos(deg.to_radians()),
        }
    });
    let x = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.0, cx, sx, 0.0, -sx, cx]);
    let y = DMat3::from_cols_array(&[cy, 0.0, -sy, 0.0, 1.0, 0.0, sy, 0.0, cy]);
    let z = DMat3::from_cols_array(&[cz, sz, 0.0, -sz, cz, 0.0, 0.0, 0.0, 1.0]);
    let linear = z * y * x * DMat3::from_diagonal(scale.into());
    DMat4::from_translation(translation_m.into()) * DMat4::from_mat3(linear)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_turn_about_x_then_y_then_z() {
        let turned = world_from_object([1.0, 2.0, 3.0], [90.0, 90.0, 0.0], [2.0; 3]);
        // y goes to z about x, then z goes to x about y.
        assert_eq!(turned.transform_point3(DVec3::Y), DVec3::new(3.0, 2.0, 3.0));
        let free = world_from_object([0.0; 3], [30.0, 40.0, 50.0], [1.0; 3]);
        let expected = DMat4::from_euler(
            glam::EulerRot::ZYX,
            50f64.to_radians(),
            40f64.to_radians(),
            30f64.to_radians(),
        );
        assert!(free.abs_diff_eq(expected, 1e-14));
    }

    #[test]
    fn tangents_follow_texture_coordinates() {
        // A strip around a cylinder; u runs around it, and back where `turn` is negative.
        for (turn, handedness) in [(1.0, 1.0), (-1.0, -1.0)] {
            let vertex = |i: u32| {
                let (column, row) = (i / 2, f64::from(i % 2));
                let angle = 0.2 * f64::from(column);
                let normal = DVec3::new(angle.cos(), angle.sin(), 0.0);
                Vertex {
                    position_m: normal + row * DVec3::Z,
                    normal,
                    uv: Vec2::new((turn * angle) as f32, (1.0 - row) as f32),
                    ..Vertex::default()
                }
            };
            let quad = |i: u32| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]];
            let surface = Surface {
                vertices: (0..20).map(vertex).collect(),
                triangles: (0..9).flat_map(quad).collect(),
            };
            for scale in [DVec3::ONE, DVec3::new(1.0, 1.0, -1.0)] {
                let mut mesh = Mesh::default();
                surface.bake(&DMat4::from_scale(scale), 0, &mut mesh);
                for (tangent, vertex) in mesh.tangents.iter().zip(&surface.vertices) {
                    let around = turn * DVec3::Z.cross(vertex.normal);
                    let along = tangent.truncate().as_dvec3();
                    assert!(along.dot(around) > 0.99, "{along} {around}");
                    assert_eq!(f64::from(tangent.w), handedness * scale.z);
                }
            }
        }
    }

    #[test]
    fn degenerate_triangles_are_dropped() {
        let vertex = |x: f64, y: f64| Vertex {
            position_m: DVec3::new(x, y, 0.0),
            normal: DVec3::Z,
            tangent: DVec3::X,
            ..Vertex::default()
        };
        let surface = Surface {
            vertices: vec![
                vertex(0.0, 0.0),
                vertex(1.0, 0.0),
                vertex(0.0, 1.0),
                vertex(2.0, 0.0),
                vertex(0.5, 1e-8),
            ],
            triangles: vec![[0, 1, 2], [0, 1, 3], [0, 0, 1], [0, 1, 4], [2, 2, 2]],
        };
        let mut mesh = Mesh::default();
        surface.bake(&DMat4::IDENTITY, 7, &mut mesh);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(mesh.triangle_materials, [7]);
    }
}

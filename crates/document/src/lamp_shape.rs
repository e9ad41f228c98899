//! The shapes of lights that the camera sees, as surfaces that shine and reflect nothing.

use crate::description::{self, LightKind, Shape};
use crate::shape;
use glam::{DMat4, DQuat, DVec2, DVec3};
use hairline_model::surface::{Surface, Vertex};
use hairline_scene::{Base, Material, Mesh, scene};

/// Facets around spheres and tubes: half a picture high they stay within 0.3 pixels of their outline.
const FACETS: u32 = 96;

/// Material of a light as the camera at a place sees it.
pub(crate) fn material(
    light: &description::Light,
    shining: &scene::Light,
    eye_m: DVec3,
) -> Material {
    // A light of one cone has one share in a place, that of its middle.
    let (middle_m, _) = shining.bounding_sphere();
    let share = match shining.cone {
        Some(cone) => cone.share((eye_m - middle_m).normalize_or(DVec3::Z)),
        None => 1.0,
    };
    let black = Base::Dielectric {
        ior: 1.0,
        base_color: [0.0; 3],
    };
    Material {
        emission: shining.radiance.map(|c| c * share),
        emission_texture: shining.picture,
        ..Material::plain(light.kind.title().to_owned(), black, 1.0)
    }
}

/// Surface of the light, of one material, facing outwards.
pub(crate) fn mesh(kind: &LightKind, material: u32) -> Mesh {
    let mut mesh = Mesh::default();
    match kind {
        LightKind::Sphere { center_m, radius_m } => {
            let place = DMat4::from_translation((*center_m).into());
            shape::capsule(0.0, *radius_m, FACETS).bake(&place, material, &mut mesh);
        }
        LightKind::Tube { ends_m, radius_m } => {
            let [a, b] = ends_m.map(DVec3::from);
            let turn = DQuat::from_rotation_arc(DVec3::Z, (b - a).normalize_or(DVec3::Z));
            let place = DMat4::from_rotation_translation(turn, a.midpoint(b));
            shape::capsule(0.5 * a.distance(b), *radius_m, FACETS)
                .bake(&place, material, &mut mesh);
        }
        LightKind::Disk {
            center_m, radius_m, ..
        } => {
            let turn = DQuat::from_rotation_arc(DVec3::Z, kind.axis().unwrap_or(DVec3::Z));
            let place = DMat4::from_rotation_translation(turn, (*center_m).into());
            let disk = shape::surface(&Shape::Disk {
                radius_m: *radius_m,
            });
            disk.bake(&place, material, &mut mesh);
        }
        // A sun has no shape that could be seen; a scene refuses a visible one.
        LightKind::Sun { .. } => {}
        // Flat, with corners.
        _ => {
            let axis = kind.axis().unwrap_or(DVec3::Z);
            flat(&kind.corners_m(), axis).bake(&DMat4::IDENTITY, material, &mut mesh);
        }
    }
    if kind.is_two_sided() {
        add_back(&mut mesh);
    }
    mesh
}

/// A polygon, convex or not, whose corners run counter-clockwise as seen against its axis.
fn flat(corners_m: &[DVec3], axis: DVec3) -> Surface {
    let tangent = axis.any_orthonormal_vector();
    let across = axis.cross(tangent);
    // Texture coordinates of a rectangle's picture; other lights have none.
    let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(glam::Vec2::from);
    let places_on = uvs.into_iter().chain(std::iter::repeat(glam::Vec2::ZERO));
    let vertices = corners_m
        .iter()
        .zip(places_on)
        .map(|(&position_m, uv)| Vertex {
            position_m,
            normal: axis,
            tangent,
            uv,
            ..Vertex::default()
        });
    let places: Vec<DVec2> = corners_m
        .iter()
        .map(|corner| DVec2::new(corner.dot(tangent), corner.dot(across)))
        .collect();
    Surface {
        vertices: vertices.collect(),
        triangles: triangles(&places),
    }
}

/// Cuts a simple polygon, counter-clockwise, into triangles: ear by ear.
fn triangles(places: &[DVec2]) -> Vec<[u32; 3]> {
    let at = |corner: u32| places[corner as usize];
    let mut ring: Vec<u32> = (0..places.len() as u32).collect();
    let mut triangles = Vec::new();
    while ring.len() > 2 {
        let n = ring.len();
        let around = |i: usize| [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
        let is_ear = |i: &usize| {
            let ear = around(*i);
            let [a, b, c] = ear.map(at);
            let left = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
            let is_inside =
                |p: DVec2| left(a, b, p) >= 0.0 && left(b, c, p) >= 0.0 && left(c, a, p) >= 0.0;
            left(a, b, c) > 0.0
                && !ring
                    .iter()
                    .any(|corner| !ear.contains(corner) && is_inside(at(*corner)))
        };
        // Rounding may hide the last ears, which have no area.
        let ear = (0..n).find(is_ear).unwrap_or(0);
        triangles.push(around(ear));
        ring.remove(ear);
    }
    triangles
}

/// Adds the same surface facing the other way.
fn add_back(mesh: &mut Mesh) {
    let first = mesh.positions_m.len() as u32;
    mesh.positions_m.extend_from_within(..);
    mesh.normals.extend_from_within(..);
    for normal in &mut mesh.normals[first as usize..] {
        *normal = -*normal;
    }
    mesh.tangents.extend_from_within(..);
    mesh.uvs.extend_from_within(..);
    let backs = mesh
        .triangles
        .iter()
        .map(|[a, b, c]| [first + a, first + c, first + b]);
    mesh.triangles.extend(backs.collect::<Vec<_>>());
    mesh.triangle_materials.extend_from_within(..);
}

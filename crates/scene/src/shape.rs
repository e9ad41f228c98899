//! The built-in shapes, z up about the origin. Each is fine enough for its outline to look round in a picture of 1280
//! pixels: a regular 256-gon of 640 pixels' radius stays within 0.05 pixels of its circle.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec2};

use crate::description::Shape;
use crate::surface::{Surface, Vertex};

/// Facets around a disk or a sphere.
const FACETS: u32 = 256;
/// A lathe's profile is rounded where it bends by less: 40 degrees.
const ROUNDED_BEND_COS: f64 = 0.766_044_443_118_978;

/// The surface of a shape.
pub(crate) fn surface(shape: &Shape) -> Surface {
    match shape {
        Shape::Plane { size_m } => plane(*size_m),
        Shape::Disk { radius_m } => disk(*radius_m),
        Shape::Sphere { radius_m } => sphere(*radius_m),
        Shape::Lathe {
            profile_m,
            segments,
            smooth,
        } => lathe(profile_m, *segments, *smooth),
    }
}

/// How many triangles and vertices a shape has at most.
pub(crate) fn size(shape: &Shape) -> [f64; 2] {
    let facets = f64::from(FACETS);
    match shape {
        Shape::Plane { .. } => [2.0, 4.0],
        Shape::Disk { .. } => [facets, facets],
        Shape::Sphere { .. } => [facets * facets, facets * (facets + 1.0)],
        Shape::Lathe {
            profile_m,
            segments,
            ..
        } => {
            let pieces = profile_m.len().saturating_sub(1) as f64;
            let around = f64::from(*segments);
            [2.0 * pieces * around, 2.0 * pieces * (around + 1.0)]
        }
    }
}

fn plane([x_m, y_m]: [f64; 2]) -> Surface {
    let corner = |x: f64, y: f64| flat_vertex(DVec3::new(x * x_m, y * y_m, 0.0), 1.0, x, y);
    Surface {
        vertices: vec![
            corner(-0.5, -0.5),
            corner(0.5, -0.5),
            corner(0.5, 0.5),
            corner(-0.5, 0.5),
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

fn disk(radius_m: f64) -> Surface {
    let mut surface = Surface::default();
    add_flat_disk(&mut surface, radius_m, 0.0, FACETS, 1.0);
    surface
}

/// A vertex that looks up (`facing` 1) or down (-1); x and y, from -0.5 to 0.5, are its place in the texture.
fn flat_vertex(position_m: DVec3, facing: f64, x: f64, y: f64) -> Vertex {
    Vertex {
        position_m,
        normal: DVec3::Z * facing,
        tangent: DVec3::X,
        handedness: facing,
        uv: Vec2::new((0.5 + x) as f32, (0.5 - y) as f32),
        ..Vertex::default()
    }
}

/// A disk from a ring of vertices alone: cutting off every second vertex, again and again, leaves large triangles inside. A
/// fan around the centre would cut every scratch into a piece per facet.
fn add_flat_disk(surface: &mut Surface, radius_m: f64, z_m: f64, facets: u32, facing: f64) {
    let first = surface.vertices.len() as u32;
    for i in 0..facets {
        let (sin, cos) = libm::sincos(2.0 * PI * f64::from(i) / f64::from(facets));
        let position = DVec3::new(radius_m * cos, radius_m * sin, z_m);
        surface
            .vertices
            .push(flat_vertex(position, facing, cos / 2.0, sin / 2.0));
    }
    let mut ring: Vec<u32> = (first..first + facets).collect();
    while ring.len() > 2 {
        let n = ring.len();
        for i in (1..n).step_by(2) {
            let (a, b, c) = (ring[i - 1], ring[i], ring[(i + 1) % n]);
            if a != c {
                let ear = if facing > 0.0 { [a, b, c] } else { [a, c, b] };
                surface.triangles.push(ear);
            }
        }
        ring = ring.into_iter().step_by(2).collect();
    }
}

/// A sphere about the origin.
pub(crate) fn sphere(radius_m: f64) -> Surface {
    let rows = FACETS / 2;
    let points: Vec<_> = (0..=rows)
        .map(|i| {
            // The poles exactly on the axis.
            let (sin, cos) = match i {
                0 => (0.0, 1.0),
                i if i == rows => (0.0, -1.0),
                i => libm::sincos(PI * f64::from(i) / f64::from(rows)),
            };
            DVec2::new(sin, cos)
        })
        .collect();
    let mut surface = Surface::default();
    for (i, row) in points.windows(2).enumerate() {
        let v = [i, i + 1].map(|i| i as f64 / f64::from(rows));
        let ends = [0, 1].map(|end| ProfileEnd {
            point_m: row[end] * radius_m,
            normal: row[end],
            v: v[end],
        });
        add_turned_piece(&mut surface, ends, FACETS);
    }
    surface
}

/// A profile turned about z, which faces to the left of its way.
fn lathe(profile_m: &[[f64; 2]], segments: u32, smooth: bool) -> Surface {
    let mut points: Vec<DVec2> = profile_m.iter().map(|&p| p.into()).collect();
    points.dedup();
    let lengths: Vec<_> = points.windows(2).map(|p| p[0].distance(p[1])).collect();
    let total: f64 = lengths.iter().sum();
    // The left side of each piece.
    let faces: Vec<_> = points
        .windows(2)
        .map(|p| (p[1] - p[0]).perp().normalize_or(DVec2::Y))
        .collect();
    let closed = points.first() == points.last();
    let neighbour = |piece: usize, forward: bool| {
        let n = faces.len();
        let end = points[if forward { piece + 1 } else { piece }];
        match (forward, piece) {
            (true, i) if i + 1 < n => Some(faces[i + 1]),
            (false, i) if i > 0 => Some(faces[i - 1]),
            // Across the axis lies the piece's own mirror image.
            (_, i) if end.x == 0.0 => Some(faces[i] * DVec2::new(-1.0, 1.0)),
            (true, _) if closed => faces.first().copied(),
            (false, _) if closed => faces.last().copied(),
            _ => None,
        }
    };
    // A floor has vertices at its rim only, so it stays flat and what follows on it is bent to meet it.
    let is_floor = |piece: usize| {
        points[piece].y == points[piece + 1].y && points[piece].x.min(points[piece + 1].x) == 0.0
    };
    let next_to_floor = |piece: usize, forward: bool| match forward {
        true => piece + 1 < faces.len() && is_floor(piece + 1),
        false => piece > 0 && is_floor(piece - 1),
    };
    let normal = |piece: usize, forward: bool| match neighbour(piece, forward) {
        Some(other) if smooth && faces[piece].dot(other) > ROUNDED_BEND_COS => {
            match next_to_floor(piece, forward) {
                true => other,
                false => (faces[piece] + other).normalize(),
            }
        }
        _ => faces[piece],
    };
    let mut surface = Surface::default();
    let mut way_m = 0.0;
    for (piece, ends) in points.windows(2).enumerate() {
        let (from, to) = (ends[0], ends[1]);
        let v = [way_m / total, (way_m + lengths[piece]) / total];
        way_m += lengths[piece];
        if is_floor(piece) {
            let facing = faces[piece].y.signum();
            add_flat_disk(&mut surface, from.x.max(to.x), from.y, segments, facing);
            continue;
        }
        let ends = [
            ProfileEnd {
                point_m: from,
                normal: normal(piece, false),
                v: v[0],
            },
            ProfileEnd {
                point_m: to,
                normal: normal(piece, true),
                v: v[1],
            },
        ];
        add_turned_piece(&mut surface, ends, segments);
    }
    surface
}

/// An end of a straight piece of a profile, in the half plane of r and z.
#[derive(Clone, Copy)]
struct ProfileEnd {
    point_m: DVec2,
    normal: DVec2,
    v: f64,
}

fn add_turned_piece(surface: &mut Surface, ends: [ProfileEnd; 2], segments: u32) {
    let first = surface.vertices.len() as u32;
    for i in 0..=segments {
        let turn = f64::from(i) / f64::from(segments);
        // The last column repeats the first one's place bit for bit.
        let (sin, cos) = libm::sincos(2.0 * PI * f64::from(i % segments) / f64::from(segments));
        for end in ends {
            let turned = |p: DVec2| DVec3::new(p.x * cos, p.x * sin, p.y);
            surface.vertices.push(Vertex {
                position_m: turned(end.point_m),
                normal: turned(end.normal),
                tangent: DVec3::new(-sin, cos, 0.0),
                uv: Vec2::new(turn as f32, end.v as f32),
                ..Vertex::default()
            });
        }
    }
    for i in 0..segments {
        let [a, b, c, d] = [0, 1, 3, 2].map(|corner| first + 2 * i + corner);
        // On the axis one side of the quadrangle has no length.
        if ends[1].point_m.x > 0.0 {
            surface.triangles.push([a, b, c]);
        }
        if ends[0].point_m.x > 0.0 {
            surface.triangles.push([a, c, d]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Mesh;
    use glam::DMat4;

    fn baked(shape: &Shape) -> Mesh {
        let mut mesh = Mesh::default();
        surface(shape).bake(&DMat4::IDENTITY, 0, &mut mesh);
        mesh
    }

    fn cup() -> Shape {
        Shape::Lathe {
            // Inside of the floor, inside of the wall, rim, outside of the wall, outside of the floor.
            profile_m: vec![
                [0.0, 0.01],
                [0.05, 0.01],
                [0.06, 0.05],
                [0.065, 0.05],
                [0.055, 0.0],
                [0.0, 0.0],
            ],
            segments: 100,
            smooth: true,
        }
    }

    fn area_m2(mesh: &Mesh) -> f64 {
        (0..mesh.triangles.len())
            .map(|i| {
                let [a, b, c] = mesh.corners_m(i);
                (b - a).cross(c - a).length() / 2.0
            })
            .sum()
    }

    #[test]
    fn areas_are_those_of_the_ideal_shapes() {
        let cases = [
            (Shape::Plane { size_m: [0.2, 0.3] }, 0.06, 1e-6),
            (Shape::Disk { radius_m: 0.1 }, PI * 0.01, 2e-4),
            (Shape::Sphere { radius_m: 0.1 }, 4.0 * PI * 0.01, 2e-4),
        ];
        for (shape, expected, tolerance) in cases {
            let area = area_m2(&baked(&shape));
            // An inscribed 256-gon lacks (2 pi / 256)^2 / 6 = 1e-4 of the disk's area.
            assert!(
                (area / expected - 1.0).abs() < tolerance,
                "{shape:?}: {area}"
            );
        }
    }

    /// The divergence theorem: the flux of r / 3 through a closed surface that faces outwards is its volume.
    #[test]
    fn a_closed_lathe_faces_outwards() {
        let mesh = baked(&cup());
        let volume: f64 = (0..mesh.triangles.len())
            .map(|i| {
                let [a, b, c] = mesh.corners_m(i);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let frustum = |r0: f64, r1: f64, h: f64| PI * h / 3.0 * (r0 * r0 + r0 * r1 + r1 * r1);
        let expected = frustum(0.055, 0.065, 0.05) - frustum(0.05, 0.06, 0.04);
        // An inscribed 100-gon lacks 7e-4; the difference of two volumes doubles that.
        assert!(
            (volume / expected - 1.0).abs() < 3e-3,
            "{volume} {expected}"
        );
    }

    #[test]
    fn shading_normals_and_tangents_are_unit_and_agree_with_the_triangles() {
        let shapes = [
            cup(),
            Shape::Disk { radius_m: 1.0 },
            Shape::Plane { size_m: [1.0, 2.0] },
            Shape::Sphere { radius_m: 0.3 },
        ];
        for shape in shapes {
            let mesh = baked(&shape);
            for (i, triangle) in mesh.triangles.iter().enumerate() {
                let [a, b, c] = mesh.corners_m(i);
                let normal = (b - a).cross(c - a).normalize();
                for &v in triangle {
                    let shading = mesh.normals[v as usize].as_dvec3();
                    let tangent = mesh.tangents[v as usize].truncate().as_dvec3();
                    assert!((shading.length() - 1.0).abs() < 1e-6);
                    assert!((tangent.length() - 1.0).abs() < 1e-6);
                    assert!(shading.dot(tangent).abs() < 1e-6);
                    assert!(normal.dot(shading) > 0.99, "{shape:?}");
                }
                // The bitangent runs up in the texture, where v decreases (glTF 2.0, section 3.7.2.1).
                let [p, q, r] = triangle.map(|v| mesh.uvs[v as usize].as_dvec2());
                let mirrored = (q - p).perp_dot(r - p) > 0.0;
                let w = f64::from(mesh.tangents[triangle[0] as usize].w);
                assert_eq!(w, if mirrored { -1.0 } else { 1.0 }, "{shape:?}");
            }
        }
    }

    #[test]
    fn sharp_corners_of_a_profile_stay() {
        let mesh = baked(&cup());
        // Inside corner of floor and wall: the bend is 76 degrees.
        for (position, normal) in mesh.positions_m.iter().zip(&mesh.normals) {
            let r = position.truncate().length();
            if (position.z - 0.01).abs() < 1e-6 && r < 0.0501 {
                let wall_side = normal.z < 0.9;
                assert!(wall_side || normal.z > 0.999, "{normal}");
            }
        }
    }
}

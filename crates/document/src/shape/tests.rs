use std::collections::HashSet;
use std::f64::consts::PI;

use glam::{DMat4, DVec3};

use hairline_model::surface::world_from_object;
use hairline_scene::Mesh;

use super::surface;
use crate::description::Shape;

fn baked(shape: &Shape) -> Mesh {
    surface(shape).baked(&DMat4::IDENTITY)
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

/// The divergence theorem: the flux of r / 3 through a closed surface that faces outwards is its volume.
fn volume_m3(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len())
        .map(|i| {
            let [a, b, c] = mesh.corners_m(i);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

#[test]
fn areas_are_those_of_the_ideal_shapes() {
    let cases = [
        (Shape::Plane { size_m: [0.2, 0.3] }, 0.06, 1e-6),
        (
            Shape::Dome {
                radius_m: 0.1,
                height_m: 0.04,
            },
            PI * (0.1 * 0.1 + 0.04 * 0.04),
            2e-4,
        ),
        (
            Shape::Sweep {
                size_m: [0.5, 0.4],
                height_m: 0.3,
                rounding_m: 0.1,
            },
            0.5 * (0.3 + 0.2 + PI / 2.0 * 0.1),
            2e-4,
        ),
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

/// Solids with their volumes and areas, by the formulas of Pappus and of Steiner for a body that grew by a radius r: with V and A of
/// the inner body and the integral M of its mean curvature, V + A r + M r^2 + 4/3 pi r^3 and A + 2 M r + 4 pi r^2.
fn rounded_solids() -> [(Shape, f64, f64); 6] {
    let grown = |volume: f64, area: f64, mean: f64, r: f64| {
        (
            volume + area * r + mean * r * r + 4.0 / 3.0 * PI * r.powi(3),
            area + 2.0 * mean * r + 4.0 * PI * r * r,
        )
    };
    let rounded_box = |size_m: [f64; 3], rounding_m: f64| {
        let [a, b, c] = size_m.map(|edge| edge - 2.0 * rounding_m);
        let area = 2.0 * (a * b + b * c + c * a);
        let (volume, area) = grown(a * b * c, area, PI * (a + b + c), rounding_m);
        (Shape::Box { size_m, rounding_m }, volume, area)
    };
    let cylinder = |radius_m: f64, height_m: f64, rounding_m: f64| {
        let (r, h) = (radius_m - rounding_m, height_m - 2.0 * rounding_m);
        let area = 2.0 * PI * r * (r + h);
        let (volume, area) = grown(PI * r * r * h, area, PI * h + PI * PI * r, rounding_m);
        let shape = Shape::Cylinder {
            radius_m,
            height_m,
            rounding_m,
        };
        (shape, volume, area)
    };
    let torus = Shape::Torus {
        radius_m: 0.1,
        tube_radius_m: 0.03,
    };
    [
        rounded_box([0.3, 0.2, 0.1], 0.0),
        rounded_box([0.3, 0.2, 0.1], 0.02),
        cylinder(0.1, 0.07, 0.0),
        cylinder(0.1, 0.07, 0.01),
        // The half of the height: no straight wall is left.
        cylinder(0.1, 0.06, 0.03),
        (
            torus,
            2.0 * PI * PI * 0.1 * 0.03 * 0.03,
            4.0 * PI * PI * 0.1 * 0.03,
        ),
    ]
}

#[test]
fn rounded_solids_have_their_volumes_and_areas() {
    for (shape, volume, area) in rounded_solids() {
        let mesh = baked(&shape);
        // Inscribed facets lack up to 5.6 degrees' worth of a rounding: (pi / 32)^2 / 6 = 1.6e-3 of its part.
        let lacks = [volume_m3(&mesh) / volume, area_m2(&mesh) / area];
        assert!(
            lacks.iter().all(|part| (0.998..1.000_001).contains(part)),
            "{shape:?}: {lacks:?}"
        );
    }
}

fn extent(mesh: &Mesh) -> (DVec3, DVec3) {
    let places = || mesh.positions_m.iter().map(|p| p.as_dvec3());
    let low = places().reduce(DVec3::min).expect("a solid");
    (low, places().reduce(DVec3::max).expect("a solid"))
}

/// Capitals without curves have the areas of their strokes, and all letters stand upright on their plane.
#[test]
fn letters_have_their_sizes() {
    let text = |line: &str| Shape::Text {
        line: line.to_owned(),
        height_m: 0.02,
        depth_m: 0.003,
    };
    // An I is one stroke: a box as high as capitals.
    let mesh = baked(&text("I"));
    let (low, high) = extent(&mesh);
    let size = high - low;
    assert!(
        (size.y - 0.02).abs() < 1e-6 && (size.z - 0.003).abs() < 1e-7,
        "{size}"
    );
    assert!((low + high).truncate().length() < 1e-7, "{low} {high}");
    let volume = size.x * size.y * size.z;
    assert!((volume_m3(&mesh) / volume - 1.0).abs() < 1e-5);
    // Holes are left out: an O has less than half of what is within its rim.
    let o = baked(&text("O"));
    let (low, high) = extent(&o);
    let size = high - low;
    let ellipse = PI / 4.0 * size.x * size.y * size.z;
    let part = volume_m3(&o) / ellipse;
    assert!((0.1..0.5).contains(&part), "{part}");
    // A word is its letters side by side.
    let sum: f64 = ["H", "a", "i", "r"]
        .map(|line| volume_m3(&baked(&text(line))))
        .iter()
        .sum();
    assert!((volume_m3(&baked(&text("Hair"))) / sum - 1.0).abs() < 1e-5);
    // All of them closed: no light from within, and sides that face outwards.
    for line in ["A&8@%gB\u{e4}i", "Hairline 0.1", "\u{416}\u{3a9}"] {
        assert!(volume_m3(&baked(&text(line))) > 0.0, "{line}");
        let mesh = baked(&text(line));
        let gap: DVec3 = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| mesh.positions_m[v as usize].as_dvec3());
                (b - a).cross(c - a)
            })
            .sum();
        assert!(gap.length() < 1e-9, "{line}: {gap}");
    }
}

/// Each edge is run through once each way, by places that are equal bit for bit.
#[test]
fn solids_have_no_crack() {
    let mut shapes: Vec<Shape> = rounded_solids().map(|(shape, ..)| shape).into();
    shapes.push(Shape::Sphere { radius_m: 0.1 });
    // Sizes without a short binary form, so that sums round.
    shapes.push(Shape::Cylinder {
        radius_m: 0.012_3,
        height_m: 0.007_7,
        rounding_m: 0.001_1,
    });
    for shape in shapes {
        let mesh = baked(&shape);
        // Adding 0 makes one zero of the two.
        let place = |v: u32| {
            (mesh.positions_m[v as usize] + 0.0)
                .to_array()
                .map(f32::to_bits)
        };
        let edges: HashSet<_> = mesh
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .map(|(a, b)| (place(a), place(b)))
            .collect();
        assert_eq!(edges.len(), 3 * mesh.triangles.len(), "{shape:?}");
        let open = edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a)));
        assert_eq!(open.count(), 0, "{shape:?}");
    }
}

#[test]
fn a_closed_lathe_faces_outwards() {
    let volume = volume_m3(&baked(&cup()));
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
        Shape::Dome {
            radius_m: 1.0,
            height_m: 0.3,
        },
        Shape::Sweep {
            size_m: [1.0, 2.0],
            height_m: 1.5,
            rounding_m: 0.5,
        },
    ];
    let closed = rounded_solids().map(|(shape, ..)| shape);
    for shape in shapes.into_iter().chain(closed) {
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

fn geometric_normal(mesh: &Mesh, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.corners_m(triangle);
    (b - a).cross(c - a).normalize()
}

#[test]
fn mirrored_objects_keep_their_outside() {
    let sphere = surface(&Shape::Sphere { radius_m: 0.1 });
    for scale in [[1.0; 3], [-1.0, 1.0, 1.0], [-1.0; 3], [1.0, -2.0, 0.5]] {
        let transform = world_from_object([0.0; 3], [10.0, 20.0, 30.0], scale);
        let mesh = sphere.baked(&transform);
        for (i, triangle) in mesh.triangles.iter().enumerate() {
            let outward = mesh.corners_m(i).iter().sum::<DVec3>();
            let normal = geometric_normal(&mesh, i);
            assert!(normal.dot(outward) > 0.0, "{scale:?}");
            let shading = mesh.normals[triangle[0] as usize].as_dvec3();
            // 15 degrees: flattened by 4, a facet of 1.4 degrees turns up to 5.6 from its vertices' normals.
            assert!(normal.dot(shading) > 0.96, "{scale:?}");
        }
    }
}

#[test]
fn flat_normals_are_those_of_the_triangles() {
    let mut sphere = surface(&Shape::Sphere { radius_m: 1.0 });
    sphere.make_flat_normals();
    let mesh = sphere.baked(&DMat4::IDENTITY);
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        for &v in triangle {
            let normal = mesh.normals[v as usize].as_dvec3();
            // The coordinates are rounded to 6e-8, the triangles down to 3e-4 high.
            assert!(normal.distance(geometric_normal(&mesh, i)) < 1e-3);
        }
    }
}

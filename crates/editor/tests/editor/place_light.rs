//! Lights moved by hand stay what they are; highlights come to be where they were asked for.

use crate::seeded;
use glam::{DVec3, dvec3};
use hairline_document::description::{Light, LightKind};
use hairline_document::place_light::*;
use hairline_editor::ActionError;
use hairline_editor::light_corners::{delete_vertex, insert_vertex, move_vertex};
use proptest::prelude::*;

fn point(range: f64) -> impl Strategy<Value = DVec3> {
    (-range..range, -range..range, -range..range).prop_map(|(x, y, z)| dvec3(x, y, z))
}

fn direction() -> impl Strategy<Value = DVec3> {
    point(1.0)
        .prop_filter("a length", |v| (0.2..1.0).contains(&v.length()))
        .prop_map(DVec3::normalize)
}

fn sphere() -> impl Strategy<Value = Light> {
    (point(2.0), 0.01..0.5).prop_map(|(center, radius_m)| {
        Light::new(LightKind::Sphere {
            center_m: center.into(),
            radius_m,
        })
    })
}

/// Star-shaped polygons of 3 to 8 vertices in any plane, convex or not.
fn polygon() -> impl Strategy<Value = Light> {
    let radii = prop::collection::vec(0.1..0.4_f64, 3..9);
    (point(2.0), direction(), radii, any::<bool>()).prop_map(
        |(middle, normal, radii, two_sided)| {
            let (x, y) = normal.any_orthonormal_pair();
            let n = radii.len() as f64;
            let vertex = |(i, r): (usize, &f64)| {
                let angle = std::f64::consts::TAU * i as f64 / n;
                (middle + (x * angle.cos() + y * angle.sin()) * *r).into()
            };
            Light::new(LightKind::Polygon {
                vertices_m: radii.iter().enumerate().map(vertex).collect(),
                two_sided,
            })
        },
    )
}

/// Disks and rectangles that face anywhere.
fn aimed() -> impl Strategy<Value = Light> {
    let sizes = (0.05..0.5_f64, 0.05..0.5_f64, -180.0..180.0_f64);
    (point(2.0), direction(), sizes, any::<bool>(), any::<bool>()).prop_map(
        |(center, axis, (a, b, rotation_deg), two_sided, is_disk)| {
            let (center_m, target_m) = (center.into(), (center + 0.7 * axis).into());
            Light::new(match is_disk {
                true => LightKind::Disk {
                    center_m,
                    target_m,
                    radius_m: a,
                    two_sided,
                },
                false => LightKind::Rectangle {
                    center_m,
                    target_m,
                    width_m: a,
                    height_m: b,
                    rotation_deg,
                    two_sided,
                },
            })
        },
    )
}

fn tube() -> impl Strategy<Value = Light> {
    (point(2.0), direction(), 0.1..1.0, 0.01..0.1).prop_map(
        |(center, along, length_m, radius_m)| {
            let end = |side: f64| <[f64; 3]>::from(center + side * length_m * along);
            let ends_m = [end(-0.5), end(0.5)];
            Light::new(LightKind::Tube { ends_m, radius_m })
        },
    )
}

fn light() -> impl Strategy<Value = Light> {
    prop_oneof![sphere(), aimed(), tube(), polygon()]
}

fn vertices(light: &Light) -> Vec<DVec3> {
    if let LightKind::Tube { ends_m, .. } = &light.kind {
        return ends_m.map(DVec3::from).into();
    }
    match light.kind.corners_m() {
        corners_m if corners_m.is_empty() => vec![center(light)],
        corners_m => corners_m,
    }
}

/// Distances between all vertices, and their handedness is that of a rotation by construction.
fn distances(light: &Light) -> Vec<f64> {
    let v = vertices(light);
    let pairs = v.iter().flat_map(|a| v.iter().map(|b| a.distance(*b)));
    pairs.collect()
}

fn same(a: &[f64], b: &[f64]) -> bool {
    // Coordinates of up to 5 m, each rounded a few times.
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn the_highlight_falls_where_it_was_asked_for(mut light in light(), eye in point(2.0), at in point(1.0), normal in direction()) {
        prop_assume!(eye.distance(at) > 0.1 && center(&light).distance(at) > 0.05);
        prop_assume!((eye - at).normalize().dot(normal).abs() > 0.05);
        let before = light.clone();
        place_highlight(&mut light, eye, at, normal);
        let (wo, wi) = ((eye - at).normalize(), (center(&light) - at).normalize());
        // The mirror's law: the half vector is the normal of the eye's side.
        let facing = normal * wo.dot(normal).signum();
        prop_assert!(((wo + wi).normalize() - facing).length() < 1e-9);
        prop_assert!((center(&light).distance(at) - center(&before).distance(at)).abs() < 1e-12);
        prop_assert!(same(&distances(&light), &distances(&before)));
        if let Some(normal) = light.kind.axis() {
            let two_sided = light.kind.is_two_sided();
            let cos = normal.dot(-wi);
            let cos = if two_sided { cos.abs() } else { cos };
            prop_assert!(cos > 1.0 - 1e-9);
            prop_assert!(light.check().is_ok());
        }
        // Again is nothing.
        let placed = light.clone();
        place_highlight(&mut light, eye, at, normal);
        prop_assert!(vertices(&light).iter().zip(vertices(&placed)).all(|(a, b)| a.distance(b) < 1e-9));
    }

    #[test]
    fn moves_and_turns_are_rigid(mut light in light(), delta in point(1.0), axis in direction(), angle in -4.0..4.0) {
        let before = light.clone();
        translate(&mut light, delta);
        prop_assert!((center(&light) - center(&before)).abs_diff_eq(delta, 1e-12));
        let moved = center(&light);
        rotate(&mut light, axis, angle);
        prop_assert!(center(&light).abs_diff_eq(moved, 1e-12));
        prop_assert!(same(&distances(&light), &distances(&before)));
        if let (Some(a), Some(b)) = (before.kind.axis(), light.kind.axis()) {
            prop_assert!((a.dot(axis) - b.dot(axis)).abs() < 1e-9);
        }
        rotate(&mut light, axis, -angle);
        translate(&mut light, -delta);
        prop_assert!(vertices(&light).iter().zip(vertices(&before)).all(|(a, b)| a.distance(b) < 1e-12));
        rotate(&mut light, DVec3::ZERO, 1.0);
        prop_assert!(light.check().is_ok());
    }

    #[test]
    fn sizes_scale_about_the_middle(mut light in light(), factor in 0.1..5.0) {
        let before = light.clone();
        resize(&mut light, factor);
        prop_assert!(center(&light).abs_diff_eq(center(&before), 1e-12));
        let scaled: Vec<_> = distances(&before).iter().map(|d| d * factor).collect();
        prop_assert!(same(&distances(&light), &scaled));
        for extreme in [0.0, -1.0, 1e30] {
            resize(&mut light, extreme);
            prop_assert!(light.check().is_ok(), "{}: {:?}", extreme, light);
        }
        let held = light.clone();
        resize(&mut light, f64::NAN);
        prop_assert_eq!(light, held);
    }

    #[test]
    fn dragged_vertices_leave_a_light_or_are_refused(mut light in polygon(), drags in prop::collection::vec((0usize..9, point(2.5)), 1..12)) {
        for (index, to) in drags {
            let before = light.clone();
            let n = vertices(&light).len();
            match move_vertex(&mut light, index, to) {
                Ok(()) => {
                    prop_assert!(light.check().is_ok());
                    let moved = vertices(&light)[index];
                    if n == 3 {
                        prop_assert_eq!(moved, to);
                    } else {
                        // The nearest point of the plane: what is left of the way is along its normal.
                        let normal = before.kind.axis().unwrap();
                        prop_assert!((to - moved).cross(normal).length() < 1e-9);
                        let others = vertices(&before).into_iter().enumerate().filter(|(i, _)| *i != index);
                        let off = others.map(|(_, v)| (v - moved).dot(normal).abs()).fold(0.0, f64::max);
                        prop_assert!(off < 1e-9, "{}", off);
                    }
                }
                Err(ActionError::Missing(_)) => prop_assert!(index >= n && light == before),
                Err(_) => prop_assert!(index < n && light == before),
            }
        }
    }
}

/// A sun shines from the side of the mirror image, turns about the scene, and has no place and no size by
/// hand.
#[test]
fn a_sun_is_placed_and_turned_by_its_direction_alone() {
    let mut light = Light::new(LightKind::sun([0.0, 0.0, -1.0]));
    let direction = |light: &Light| light.kind.sunbeam().unwrap();
    let [eye, at] = [DVec3::new(0.0, -3.0, 4.0), DVec3::ZERO];
    for normal in [DVec3::Z, DVec3::NEG_Z] {
        place_highlight(&mut light, eye, at, normal);
        assert!(direction(&light).distance(DVec3::new(0.0, -0.6, -0.8)) < 1e-6);
    }
    let before = light.clone();
    translate(&mut light, DVec3::ONE);
    resize(&mut light, 2.0);
    assert_eq!(light, before);
    rotate(&mut light, DVec3::X, std::f64::consts::FRAC_PI_2);
    assert!(direction(&light).distance(DVec3::new(0.0, 0.8, -0.6)) < 1e-6);
    light.check().unwrap();
}

fn square() -> Light {
    Light::new(LightKind::Polygon {
        vertices_m: vec![
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [1.0, 1.0, 1.0],
            [0.0, 1.0, 1.0],
        ],
        two_sided: false,
    })
}

#[test]
fn a_polygon_that_would_cross_itself_is_refused() {
    let mut light = square();
    let refused = move_vertex(&mut light, 2, dvec3(-1.0, 0.5, 1.0));
    let Err(ActionError::Shape(why)) = refused else {
        panic!("{refused:?}")
    };
    assert!(why.contains("crosses itself"), "{why}");
    assert_eq!(light, square());
    // Inwards is not across: polygons need not be convex.
    assert_eq!(move_vertex(&mut light, 2, dvec3(0.2, 0.2, 3.0)), Ok(()));
    assert_eq!(vertices(&light)[2], dvec3(0.2, 0.2, 1.0));
}

#[test]
fn vertices_come_and_go() {
    let mut light = square();
    assert_eq!(insert_vertex(&mut light, 3), Ok(()));
    assert_eq!(vertices(&light)[4], dvec3(0.0, 0.5, 1.0));
    assert!(center(&light).abs_diff_eq(dvec3(0.5, 0.5, 1.0), 1e-15));
    assert_eq!(delete_vertex(&mut light, 4), Ok(()));
    assert_eq!(light, square());
    assert_eq!(delete_vertex(&mut light, 0), Ok(()));
    let triangle = light.clone();
    assert!(matches!(
        delete_vertex(&mut light, 0),
        Err(ActionError::Shape(_))
    ));
    assert_eq!(light, triangle);
    for refused in [insert_vertex(&mut light, 3), delete_vertex(&mut light, 3)] {
        assert_eq!(refused, Err(ActionError::Missing("corner")));
    }
}

#[test]
fn a_rectangle_shows_its_middle_and_its_side() {
    let light = square();
    assert_eq!(center(&light), dvec3(0.5, 0.5, 1.0));
    assert_eq!(light.kind.axis(), Some(DVec3::Z));
}

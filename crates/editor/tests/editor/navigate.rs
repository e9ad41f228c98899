//! Tests of the camera's tools, by the points that must stay and those that must move along, for
//! cameras of any up direction.

use crate::seeded;
use glam::{DVec2, DVec3};
use hairline_document::description::Camera;
use hairline_document::navigate::*;
use proptest::prelude::*;

const SIZE_PX: DVec2 = DVec2::new(800.0, 500.0);

/// Where a renderer draws a point in a picture of whole pixels.
fn project(camera: &Camera, point_m: DVec3, size_px: DVec2) -> Option<DVec2> {
    let frame = camera.in_scene().frame(size_px.as_uvec2().into());
    frame.pixel_of(point_m)
}

fn camera() -> impl Strategy<Value = Camera> {
    let coordinate = || -2.0..2.0;
    let point = move || [coordinate(), coordinate(), coordinate()];
    (point(), point(), point(), 5.0..80.0)
        .prop_map(|(position_m, target_m, up, fov_y_deg)| Camera {
            position_m,
            target_m,
            up,
            fov_y_deg,
            ..Camera::default()
        })
        .prop_filter("a view that is not along its up", |c| {
            let view = DVec3::from(c.target_m) - DVec3::from(c.position_m);
            view.length() > 0.1
                && DVec3::from(c.up).length() > 0.1
                && view
                    .normalize()
                    .cross(DVec3::from(c.up).normalize())
                    .length()
                    > 0.05
        })
}

fn px(range: f64) -> impl Strategy<Value = DVec2> {
    (-range..range, -range..range).prop_map(|(x, y)| DVec2::new(x, y))
}

fn point_of(range: f64) -> impl Strategy<Value = DVec3> {
    (-range..range, -range..range, -range..range).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn offset(camera: &Camera) -> DVec3 {
    DVec3::from(camera.position_m) - DVec3::from(camera.target_m)
}

/// The point under a pixel at the target's depth.
fn point_under_pixel(camera: &Camera, pixel: DVec2) -> DVec3 {
    let frame = camera.in_scene().frame(SIZE_PX.as_uvec2().into());
    frame.position_m + frame.camera_ray(pixel) * offset(camera).length()
}

proptest! {
    #![proptest_config(seeded(400))]

    #[test]
    fn orbiting_keeps_target_distance_and_a_legal_view(mut camera in camera(), drags in prop::collection::vec(px(900.0), 1..20)) {
        let before = camera.clone();
        for drag in drags {
            orbit(&mut camera, drag, SIZE_PX);
            prop_assert_eq!(camera.target_m, before.target_m);
            prop_assert_eq!(camera.up, before.up);
            // Rounding of a sum and a difference each time.
            prop_assert!((offset(&camera).length() / offset(&before).length() - 1.0).abs() < 1e-11);
            // The scene's own bound is 1e-6.
            let up = DVec3::from(camera.up).normalize();
            prop_assert!(offset(&camera).normalize().cross(up).length() > 0.9e-3);
        }
    }

    #[test]
    fn orbiting_there_and_back_is_nothing_short_of_the_poles(mut camera in camera(), drag in px(40.0)) {
        let polar = |c: &Camera| offset(c).angle_between(DVec3::from(c.up));
        let there_and_back_rad = 40.0 * std::f64::consts::PI / SIZE_PX.y + 0.01;
        prop_assume!((there_and_back_rad..std::f64::consts::PI - there_and_back_rad).contains(&polar(&camera)));
        let before = camera.clone();
        orbit(&mut camera, drag, SIZE_PX);
        orbit(&mut camera, -drag, SIZE_PX);
        prop_assert!((offset(&camera) - offset(&before)).length() < 1e-12 * offset(&before).length().max(1.0));
    }

    #[test]
    fn a_pole_is_no_flip(mut camera in camera(), sign in prop::sample::select(vec![-1.0, 1.0])) {
        let level = |c: &Camera| {
            let up = DVec3::from(c.up).normalize();
            (offset(c) - up * offset(c).dot(up)).normalize()
        };
        let before = level(&camera);
        for _ in 0..10 {
            orbit(&mut camera, DVec2::new(0.0, sign * 300.0), SIZE_PX);
        }
        // Near the pole 1e-3 of the offset is level: its direction is known to 1e-13 or so.
        prop_assert!(level(&camera).dot(before) > 1.0 - 1e-9);
    }

    #[test]
    fn what_lies_at_the_targets_depth_follows_the_pointer(mut camera in camera(), at in px(300.0), drag in px(300.0)) {
        let pixel = 0.5 * SIZE_PX + at;
        let held = point_under_pixel(&camera, pixel);
        pan(&mut camera, drag, SIZE_PX);
        let seen = project(&camera, held, SIZE_PX).unwrap();
        prop_assert!((seen - (pixel + drag)).length() < 1e-8, "{} {}", seen, pixel + drag);
    }

    #[test]
    fn dollying_is_exponential_and_never_passes_the_target(mut camera in camera(), steps in -500.0..500.0) {
        let before = offset(&camera);
        dolly(&mut camera, steps);
        prop_assert!(offset(&camera).dot(before) > 0.0);
        prop_assert!((1e-5..=1.001e3).contains(&offset(&camera).length()));
        let mut twice = camera.clone();
        twice.position_m = (DVec3::from(camera.target_m) + before).into();
        dolly(&mut twice, 1.5);
        dolly(&mut twice, 1.5);
        camera.position_m = (DVec3::from(camera.target_m) + before).into();
        dolly(&mut camera, 3.0);
        prop_assert!((offset(&twice) - offset(&camera)).length() < 1e-12);
    }

    #[test]
    fn the_point_that_is_zoomed_to_stays_in_its_place(mut camera in camera(), point in point_of(3.0), steps in -5.0..5.0) {
        let Some(before) = project(&camera, point, SIZE_PX) else { return Ok(()) };
        // Far outside the view pixels are large numbers.
        prop_assume!(before.length() < 1e4);
        zoom_to(&mut camera, point, steps);
        let after = project(&camera, point, SIZE_PX).unwrap();
        prop_assert!((after - before).length() < 1e-6, "{} {}", before, after);
    }

    #[test]
    fn a_framed_box_is_in_view_and_fills_it(mut camera in camera(), low in point_of(2.0), size in point_of(2.0), aspect in 0.3..3.0) {
        let high = low + size.abs();
        prop_assume!(size.length() > 0.01);
        let before = camera.clone();
        frame_points(&mut camera, &corners(low, high), aspect);
        let size_px = DVec2::new(600.0 * aspect, 600.0).round();
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in corners(low, high) {
            let seen = project(&camera, corner, size_px).expect("in front of the camera") / size_px;
            least = least.min(seen);
            most = most.max(seen);
        }
        prop_assert!(least.min_element() >= 0.0 && most.max_element() <= 1.0, "{} {}", least, most);
        prop_assert!((most - least).max_element() > 0.6, "{} {}", least, most);
        prop_assert!(offset(&camera).normalize().dot(offset(&before).normalize()) > 1.0 - 1e-12);
        // The same with a box that is twice as wide shows that the bound is no matter of course.
        let far = offset(&camera) * 2.0 + DVec3::from(camera.target_m);
        camera.position_m = far.into();
        let spans: Vec<_> = corners(low, high).into_iter().filter_map(|c| project(&camera, c, size_px)).collect();
        let span = spans.iter().fold(DVec2::NEG_INFINITY, |a, b| a.max(*b)) - spans.iter().fold(DVec2::INFINITY, |a, b| a.min(*b));
        prop_assert!((span / size_px).max_element() < 0.65, "{}", span / size_px);
    }

    #[test]
    fn viewpoints_keep_target_and_distance(mut camera in camera()) {
        let up = DVec3::from(camera.up).normalize();
        let before = camera.clone();
        let mut directions = Vec::new();
        for viewpoint in Viewpoint::ALL {
            look_from(&mut camera, viewpoint);
            prop_assert_eq!(camera.target_m, before.target_m);
            prop_assert!((offset(&camera).length() / offset(&before).length() - 1.0).abs() < 1e-11);
            directions.push(offset(&camera).normalize());
        }
        let [front, back, left, right, top, bottom, quarter] = directions[..] else { unreachable!() };
        prop_assert!((front + back).length() < 1e-9 && (left + right).length() < 1e-9);
        prop_assert!(front.dot(up).abs() < 1e-9 && right.dot(up).abs() < 1e-9 && front.dot(right).abs() < 1e-9);
        prop_assert!(top.dot(up) > 0.999_999 && bottom.dot(up) < -0.999_999);
        prop_assert!(quarter.dot(front) > 0.3 && quarter.dot(right) > 0.3 && quarter.dot(up) > 0.3);
        // The right side of the front view is where the right view stands.
        look_from(&mut camera, Viewpoint::Front);
        let side = DVec3::from(camera.target_m) + 0.01 * right;
        prop_assert!(project(&camera, side, SIZE_PX).unwrap().x > 0.5 * SIZE_PX.x);
    }
}

#[test]
fn the_surface_follows_the_pointer() {
    let mut camera = Camera {
        position_m: [0.0, 0.0, 1.0],
        target_m: [0.0; 3],
        up: [0.0, 2.0, 0.0],
        fov_y_deg: 30.0,
        ..Camera::default()
    };
    let near = DVec3::new(0.0, 0.0, 0.1);
    orbit(&mut camera, DVec2::new(20.0, 10.0), SIZE_PX);
    let seen = project(&camera, near, SIZE_PX).unwrap();
    assert!(
        seen.x > 0.5 * SIZE_PX.x && seen.y > 0.5 * SIZE_PX.y,
        "{seen}"
    );
    look_from(&mut camera, Viewpoint::Front);
    assert!((DVec3::from(camera.position_m) - DVec3::Z).length() < 1e-12);
}

#[test]
fn a_point_is_centred() {
    let mut camera = Camera {
        position_m: [0.0, 0.0, 1.0],
        target_m: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_y_deg: 30.0,
        ..Camera::default()
    };
    let point = DVec3::new(0.2, 0.1, 0.0);
    frame_points(&mut camera, &[point], 1.5);
    assert_eq!(camera.target_m, [0.2, 0.1, 0.0]);
    assert_eq!(camera.position_m, [0.2, 0.1, 1.0]);
    frame_points(&mut camera, &[], 1.5);
    assert_eq!(camera.target_m, [0.2, 0.1, 0.0], "nothing");
}

/// What turns about the axis with the camera looks to it as before: distances to it and directions from it stay.
#[test]
fn surroundings_turn_as_the_camera_does() {
    let mut scene = hairline_fixtures::SceneFile::seen_from([0.1, -0.4, 0.3])
        .looking_at([0.1, 0.0, 0.02])
        .metal("steel", "steel")
        .object("disk", "steel", hairline_fixtures::DISK)
        .sphere([0.3, 0.2, 0.5], 0.02, 30.0)
        .description();
    scene
        .lights
        .push(hairline_document::description::Light::new(
            hairline_document::description::LightKind::Rectangle {
                center_m: [-0.2, 0.1, 0.4],
                target_m: [0.1, 0.0, 0.0],
                width_m: 0.2,
                height_m: 0.1,
                rotation_deg: 20.0,
                two_sided: false,
            },
        ));
    let seen = |scene: &hairline_document::Description| -> Vec<DVec2> {
        let points = scene.lights.iter().flat_map(|light| match &light.kind {
            hairline_document::description::LightKind::Sphere { center_m, .. } => {
                vec![(*center_m).into()]
            }
            other => other.corners_m(),
        });
        let seen = points.map(|point| project(&scene.camera, point, SIZE_PX));
        seen.map(|place| place.unwrap_or(DVec2::NAN)).collect()
    };
    let before = seen(&scene);
    let objects = scene.objects.clone();
    hairline_document::navigate::turn_surroundings(&mut scene, 1.1);
    for (a, b) in before.iter().zip(seen(&scene)) {
        assert!(a.distance(b) < 1e-3, "{a} {b}");
    }
    assert_eq!(scene.objects, objects);
}

/// What stands still with the lights and turns with the objects is the same picture, turned.
#[test]
fn a_turntable_of_the_lights_turns_all_light_and_nothing_else() {
    use hairline_document::navigate;
    let mut scene = hairline_fixtures::scenes::lit_plate()
        .part("[studio]\nrotation_deg = 10\n[environment]\nbuiltin = \"window\"\nrotation_deg = 350\n")
        .description();
    let before = scene.clone();
    let mut surroundings = scene.clone();
    let angle_rad = 30.0_f64.to_radians();
    navigate::turn_table(&mut scene, navigate::Turns::Lights, angle_rad);
    navigate::turn_table(&mut surroundings, navigate::Turns::Object, angle_rad);
    assert_eq!(scene.camera, before.camera);
    assert_eq!(scene.objects, before.objects);
    assert_eq!(scene.lights, surroundings.lights);
    assert_ne!(scene.lights, before.lights);
    assert_eq!(scene.environment, surroundings.environment);
    let turned = scene.environment.map(|it| it.rotation_deg).unwrap();
    assert!((turned - 20.0).abs() < 1e-9, "{turned}");
    // The studio does not go with a camera that stands still.
    assert!((scene.studio.rotation_deg - 40.0).abs() < 1e-9);
    assert_eq!(surroundings.studio, before.studio);
}

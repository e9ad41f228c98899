//! The studio and the ground that a scene without lights gets, and others ask for.

use std::path::Path;

use glam::DVec3;
use hairline_document::Description;
use hairline_document::description::{Ground, Studio};
use hairline_scene::Scene;

/// A ball of 10 cm about a point, seen from in front and above, with `up`.
fn ball(center_m: DVec3, up: DVec3, more: &str) -> Description {
    let aside = up.any_orthonormal_vector();
    let eye_m = center_m + 0.4 * aside + 0.2 * up;
    let [eye, target, up] = [eye_m, center_m, up].map(|v| format!("{:?}", v.to_array()));
    let text = format!(
        "[camera]\nposition_m = {eye}\ntarget_m = {target}\nup = {up}\n{more}\n\
         [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
         [[object]]\nname = \"ball\"\nmaterial = \"m\"\nshape = {{ sphere = {{ radius_m = 0.05 }} }}\ntranslation_m = {target}\n"
    );
    Description::from_toml(&text, Path::new("a.toml")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn built(description: &Description) -> Scene {
    hairline_document::build(description, Path::new("")).unwrap_or_else(|e| panic!("{e}"))
}

const LAMP: &str = "[[light]]\nkind = \"sphere\"\ncenter_m = [0, 0, 9]\nradius_m = 0.1\n";

#[test]
fn what_has_no_light_is_lit_on_a_ground() {
    let center_m = DVec3::new(0.3, -0.2, 0.1);
    for up in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
        let scene = built(&ball(center_m, up, ""));
        let [ball, ground] = &scene.objects[..] else {
            panic!("{} objects", scene.objects.len())
        };
        assert_eq!((&*ball.name, &*ground.name), ("ball", "ground"));
        // The ground carries the ball and faces up.
        for (position_m, normal) in ground.mesh.positions_m.iter().zip(&ground.mesh.normals) {
            let below_m = (center_m - position_m.as_dvec3()).dot(up);
            assert!((0.05..0.0501).contains(&below_m), "{up}: {below_m}");
            assert!(normal.as_dvec3().dot(up) > 0.999);
        }
        let rim_m = ground.mesh.positions_m.iter();
        let reach_m = rim_m.map(|p| p.as_dvec3().distance(center_m));
        assert!(reach_m.fold(0.0, f64::max) > 2.0);
        assert!(scene.environment.is_some_and(|room| room.visible()));
        // The lights stand above it, around the ball, and shine at it.
        assert_eq!(scene.lights.len(), 5);
        for light in &scene.lights {
            let (middle_m, _) = light.bounding_sphere();
            assert!((middle_m - center_m).dot(up) > 0.0, "{up}: {light:?}");
            if let hairline_scene::LightShape::Polygon { vertices_m, .. } = &light.shape {
                let facing = hairline_scene::vector_area_m2(vertices_m).normalize();
                let towards = (center_m - middle_m).normalize();
                assert!(facing.dot(towards) > 0.95, "{up}: {light:?}");
            }
        }
    }
}

#[test]
fn what_has_light_is_left_alone() {
    let dark = "[studio]\nhidden = true";
    for more in [LAMP, "[environment]\nbuiltin = \"window\"\n", dark] {
        let description = ball(DVec3::ZERO, DVec3::Z, more);
        let scene = built(&description);
        assert_eq!(scene.objects.len(), 1);
        assert_eq!(scene.lights.len(), usize::from(more == LAMP));
        assert_eq!(scene.environment.is_some(), more.contains("[env"));
    }
    // A lamp that is off is a choice.
    let off = format!("{LAMP}hidden = true\n");
    assert!(built(&ball(DVec3::ZERO, DVec3::Z, &off)).lights.is_empty());
}

#[test]
fn both_can_be_asked_for() {
    let more = format!(
        "[studio]\nintensity = 2.0\nrotation_deg = 180.0\n[ground]\nheight_m = -0.2\ncolor = [0.5, 0.4, 0.3]\nroughness = 0.9\n{LAMP}"
    );
    let [plain, asked] = ["", &more].map(|more| built(&ball(DVec3::ZERO, DVec3::Z, more)));
    assert_eq!(asked.lights.len(), 6);
    // The other way round, and twice as bright.
    for (light, other) in plain.lights.iter().zip(&asked.lights[1..]) {
        let [at, turned] = [light, other].map(|light| light.bounding_sphere().0);
        assert!((at + turned).truncate().length() < 1e-9 && (at.z - turned.z).abs() < 1e-9);
        assert_eq!(light.radiance.map(|c| 2.0 * c), other.radiance);
    }
    let ground = &asked.objects[1].mesh;
    assert!(ground.positions_m.iter().all(|p| p.z == -0.2));
    let material = &asked.materials[ground.triangle_materials[0] as usize];
    assert_eq!((&*material.name, material.roughness), ("ground", 0.9));
    // With an environment there is no room of the studio's.
    let more = "[studio]\n[environment]\nbuiltin = \"window\"\nvisible = false\n";
    let scene = built(&ball(DVec3::ZERO, DVec3::Z, more));
    assert!(!scene.environment.is_some_and(|own| own.visible()));
}

/// The studio in a hall stands about the camera's subject.
#[test]
fn a_room_does_not_widen_the_studio() {
    let hall = "[[object]]\nname = \"hall\"\nmaterial = \"m\"\nshape = { plane = { size_m = [20, 20] } }\ntranslation_m = [3, 3, -0.06]\n";
    let scene = built(&ball(DVec3::ZERO, DVec3::Z, hall));
    let far = scene.lights.iter().map(|l| l.bounding_sphere().0.length());
    assert!(far.fold(0.0, f64::max) < 1.0);
}

#[test]
fn what_is_saved_loads_again() {
    let mut lit = ball(DVec3::ZERO, DVec3::Z, "");
    assert_eq!(
        (&lit.studio, &lit.ground),
        (&Studio::default(), &Some(Ground::default()))
    );
    for (studio, ground) in [
        (Studio::default(), Some(Ground::default())),
        (Studio::default(), None),
        (Studio::NONE, None),
        (Studio::NONE, Some(Ground::default())),
        (
            Studio {
                intensity: 0.5,
                ..Studio::NONE
            },
            None,
        ),
    ] {
        (lit.studio, lit.ground) = (studio, ground);
        let text = lit.to_toml().unwrap();
        let again = Description::from_toml(&text, Path::new("a.toml")).unwrap();
        assert_eq!(lit, again, "{text}");
    }
}

#[test]
fn mistakes_are_named() {
    for (more, message) in [
        (
            "[studio]\nintensity = -1",
            "a.toml:6: studio.intensity: found -1; must be 0 or greater",
        ),
        (
            "[studio]\nkey = 1",
            "a.toml:6: studio.key: unknown key; the keys here are `hidden`, `intensity` and `rotation_deg`",
        ),
        (
            "[ground]\nroughness = 2",
            "a.toml:6: ground.roughness: found 2; must be from 0 to 1",
        ),
    ] {
        let text = format!(
            "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\n\n{more}\n\
             [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
             [[object]]\nname = \"ball\"\nmaterial = \"m\"\nshape = {{ sphere = {{ radius_m = 0.05 }} }}\n"
        );
        let error = hairline_document::from_toml(&text, "a.toml", "").unwrap_err();
        assert_eq!(error.to_string(), message);
    }
}

/// A `[ground]` in the place of objects is asked for; where it is not, the objects were forgotten.
#[test]
fn an_empty_studio_is_a_scene() {
    const CAMERA: &str =
        "[camera]\nposition_m = [0.1, -0.4, 0.3]\ntarget_m = [0.1, 0.2, 0.05]\nup = [0, 0, 1]\n";
    let text = format!("{CAMERA}[ground]\n");
    let empty = Description::from_toml(&text, Path::new("a.toml")).unwrap();
    let again = Description::from_toml(&empty.to_toml().unwrap(), Path::new("a.toml")).unwrap();
    assert_eq!(again, empty);
    let scene = built(&empty);
    assert!(scene.lights.len() > 3, "{} lights", scene.lights.len());
    let [ground] = &scene.objects[..] else {
        panic!("{} objects", scene.objects.len())
    };
    let (low_m, high_m) = ground.mesh.bounds_m();
    assert!(low_m.z > -1e-3 && high_m.z < 1e-6, "{low_m} {high_m}");
    let target_m = glam::Vec2::new(0.1, 0.2);
    assert!((0.5 * (low_m + high_m).truncate() - target_m).length() < 1e-3);
    let hidden = built(&Description {
        ground: Some(Ground {
            hidden: true,
            ..Ground::default()
        }),
        ..empty
    });
    assert!(hidden.objects.is_empty());
    let error = hairline_document::from_toml(CAMERA, "a.toml", "").unwrap_err();
    let message =
        "a.toml: object: found no object; must have at least one `[[object]]`, or a `[ground]`";
    assert_eq!(error.to_string(), message);
}

//! Lights that show scratches.

use std::path::Path;

use glam::DVec3;
use hairline_document::Description;
use hairline_document::description::{Light, LightKind};
use hairline_scene::Scene;

fn lit(objects: &str) -> (Description, Scene) {
    let text = format!(
        "[camera]\nposition_m = [0, -0.4, 0.2]\ntarget_m = [0, 0, 0]\nup = [0, 0, 1]\n\
         [studio]\nhidden = true\n[environment]\nbuiltin = \"overcast\"\n\
         [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
         [[material]]\nname = \"white\"\nkind = \"dielectric\"\nior = 1.5\nbase_color = [0.8, 0.8, 0.8]\n{objects}"
    );
    let mut description = Description::from_toml(&text, Path::new("a.toml")).unwrap();
    let build = |description: &Description| {
        hairline_document::build(description, Path::new("")).unwrap_or_else(|e| panic!("{e}"))
    };
    description.light_for_scratches(&build(&description));
    description.check().unwrap();
    let scene = build(&description);
    (description, scene)
}

const PLATE: &str =
    "[[object]]\nname = \"plate\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.05 } }\n";
const SCRATCHES: &str = "[[scratches]]\nobject = \"plate\"\npattern = \"random\"\ncount = 10\n";

fn lamps(description: &Description) -> Vec<(DVec3, f64)> {
    let lamp = |light: &Light| match light.kind {
        LightKind::Sphere { center_m, .. } => Some((center_m.into(), light.radiance)),
        _ => None,
    };
    description.lights.iter().filter_map(lamp).collect()
}

/// Unit normal at which a point mirrors a lamp to the eye.
fn half(eye_m: DVec3, lamp_m: DVec3, point_m: DVec3) -> DVec3 {
    let towards = |to: DVec3| (to - point_m).normalize();
    (towards(eye_m) + towards(lamp_m)).normalize()
}

const EYE_M: DVec3 = DVec3::new(0.0, -0.4, 0.2);

#[test]
fn a_plate_mirrors_its_lamp_near_its_middle() {
    let (description, scene) = lit(&format!("{PLATE}{SCRATCHES}"));
    let lamps = lamps(&description);
    let (lamp_m, _) = lamps[0];
    assert!(half(EYE_M, lamp_m, DVec3::ZERO).angle_between(DVec3::Z) < 5_f64.to_radians());
    // Nothing else shines but the strips and a dark room.
    assert_eq!(scene.lights.len(), lamps.len() + 2);
    assert!(description.environment.is_some_and(|it| it.intensity < 0.1));
}

#[test]
fn a_ball_has_highlights_that_lie_apart_and_nothing_hides() {
    let ball = PLATE.replace("disk", "sphere");
    let (description, scene) = lit(&format!("{ball}{SCRATCHES}"));
    let lamps = lamps(&description);
    assert_eq!(lamps.len(), 3);
    // A ball's normal is its place: the one that bisects eye and lamp.
    let highlight = |lamp_m: DVec3| {
        let mut normal = DVec3::Z;
        for _ in 0..50 {
            normal = half(EYE_M, lamp_m, 0.05 * normal);
        }
        normal
    };
    let normals: Vec<DVec3> = lamps.iter().map(|(lamp_m, _)| highlight(*lamp_m)).collect();
    for (i, normal) in normals.iter().enumerate() {
        assert!(
            normal.dot(EYE_M - 0.05 * *normal) > 0.0,
            "the camera sees it"
        );
        assert!(lamps[i].0.z > 0.0, "it stands above the ground");
        for other in &normals[..i] {
            assert!(normal.angle_between(*other) > 12_f64.to_radians());
        }
    }
    assert_eq!(scene.lights.len(), 5);
}

#[test]
fn what_hides_a_lamp_is_avoided() {
    let lid = "[[object]]\nname = \"lid\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.04 } }\ntranslation_m = [0, 0.08, 0.05]\n";
    let (open, _) = lit(&format!("{PLATE}{SCRATCHES}"));
    let (hidden, _) = lit(&format!("{PLATE}{SCRATCHES}{lid}"));
    let [first, other] = [&open, &hidden].map(|it| lamps(it)[0].0);
    assert!(first.distance(other) > 0.01, "{first} {other}");
}

#[test]
fn white_bodies_have_dimmer_lamps() {
    // Flat metal has dimmer ones too, as it mirrors them as a whole.
    let ball = PLATE.replace("disk", "sphere");
    let (steel, _) = lit(&ball);
    let (white, _) = lit(&ball.replace("\"m\"", "\"white\""));
    let [steel, white] = [&steel, &white].map(|it| lamps(it)[0].1);
    assert!(steel > 5.0 * white && white > 100.0, "{steel} {white}");
}

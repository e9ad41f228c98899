//! Tables `[[look]]`: what they replace, and what is wrong with them.

use std::path::Path;

use hairline_document::Description;
use hairline_document::description::Look;

use crate::common::{object, scene_with};

/// The text of a disk under a lamp, with further tables.
fn text(more: &str) -> String {
    let disk = object("{ disk = { radius_m = 0.08 } }");
    let lamp = "[[light]]\nkind = \"sphere\"\ncenter_m = [0, 0, 1]\nradius_m = 0.01\n";
    scene_with(&format!("{disk}{lamp}{more}"))
}

fn with_looks(looks: &str) -> Description {
    Description::from_toml(&text(looks), Path::new("a.toml")).unwrap()
}

/// The scene as its first look shows it.
fn seen(description: &Description) -> Description {
    let mut seen = description.clone();
    description.looks[0].apply(&mut seen);
    seen
}

#[test]
fn a_look_replaces_what_it_has() {
    let scene = with_looks("[[look]]\nname = \"a\"\nexposure_ev = 2\n");
    let brighter = seen(&scene);
    assert_eq!(brighter.camera.exposure_ev, 2.0);
    assert_eq!(brighter.camera.position_m, scene.camera.position_m);
    assert_eq!(brighter.lights, scene.lights);
    // A look with light has none of the scene's.
    let scene = with_looks("[[look]]\nname = \"a\"\n[look.environment]\nbuiltin = \"studio\"\n");
    let lit = seen(&scene);
    assert!(lit.lights.is_empty() && lit.studio.hidden);
    assert_eq!(lit.environment, scene.looks[0].environment);
    let camera = "camera = { position_m = [0, -1, 1], target_m = [0, 0, 0], focal_length_mm = 50 }";
    let scene = with_looks(&format!("[[look]]\nname = \"a\"\n{camera}\n"));
    let focal_length_mm = seen(&scene).camera.focal_length_mm(scene.render.size_px);
    assert!((focal_length_mm - 50.0).abs() < 1e-9);
}

#[test]
fn a_look_of_a_scene_shows_it_again() {
    let dark = Description {
        lights: Vec::new(),
        ..with_looks("")
    };
    let lit = with_looks("[studio]\nrotation_deg = 20\n[environment]\nbuiltin = \"window\"\n");
    for scene in [dark, lit] {
        let look = Look::from_description("a".to_owned(), &scene);
        let mut other = with_looks("[ground]\n");
        other.ground = scene.ground.clone();
        other.camera.position_m = [1.0, 2.0, 3.0];
        look.apply(&mut other);
        assert_eq!(other, scene);
    }
}

#[test]
fn a_mistake_in_a_look_is_named_by_its_line() {
    let lines = text("").trim_end().lines().count();
    let message = |look: &str| {
        let text = text(look);
        let read = Description::from_toml(&text, Path::new("a.toml"));
        let checked = read.and_then(|read| {
            let checked = read.check();
            checked.map_err(|error| error.in_scene_file(&text, Path::new("a.toml")))
        });
        checked.unwrap_err().to_string()
    };
    let at = |line: usize, rest: &str| format!("a.toml:{}: {rest}", lines + line);
    assert_eq!(
        message("[[look]]\nname = \"a\"\n[look.studio]\nintensity = -1\n"),
        at(
            4,
            "look[0].studio.intensity: found -1; must be 0 or greater"
        )
    );
    assert_eq!(
        message("[[look]]\nname = \"a\"\n[[look]]\nname = \"a\"\n"),
        at(
            4,
            "look[1].name: found a second look called \"a\"; names must differ"
        )
    );
    assert_eq!(
        message("[[look]]\nname = \"a\"\nroughness = 1\n")
            .split(": ")
            .nth(1),
        Some("look[0].roughness")
    );
    assert_eq!(
        message("[[look]]\nname = \"a\"\nexposure_ev = 99\n"),
        at(3, "look[0].exposure_ev: found 99; must be from -64 to 64")
    );
    assert_eq!(
        message("[[look]]\nname = \"a\"\n[look.light]\nkind = \"sphere\"\n"),
        at(
            3,
            "look[0].light: found a table; must be an array: write `light = [{ … }]` or `[[look.light]]`"
        )
    );
}

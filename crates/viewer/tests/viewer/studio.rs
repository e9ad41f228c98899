//! The studio and the ground of a scene that has no lights of its own, in the list and in their panels.

use crate::common::{self, click_on, description, viewer, wait_built};
use egui_kittest::{Harness, kittest::Queryable};
use hairline_document::Description;
use hairline_editor::Selection;
use hairline_scene::Scene;
use hairline_viewer::Viewer;

const BARE: &str = r#"
camera = { position_m = [0.0, -0.5, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0], fov_y_deg = 30.0 }
material = [{ name = "steel", kind = "metal", metal = "steel" }]
object = [{ name = "disk", shape = { disk = { radius_m = 0.1 } }, material = "steel" }]
"#;

fn bare() -> Harness<'static, Viewer> {
    let mut harness = viewer(BARE);
    wait_built(&mut harness);
    harness
}

fn built(harness: &Harness<'static, Viewer>) -> Scene {
    harness.state().renderer().built().unwrap().scene.clone()
}

#[test]
fn studio_and_ground_are_switched_in_the_list_and_by_a_key() {
    let mut harness = bare();
    let is_off = |d: &Description| (d.studio.hidden, d.ground.as_ref().is_none_or(|g| g.hidden));
    for (line, box_of, off) in [
        ("Studio lights", "Show the studio", (true, false)),
        ("Ground plane", "Show the ground", (false, true)),
    ] {
        let before = description(&harness);
        assert_eq!(is_off(&before), (false, false));
        click_on(&mut harness, box_of);
        assert_eq!(is_off(&description(&harness)), off, "{line}");
        common::undo(&mut harness);
        assert_eq!(*description(&harness), *before);
        click_on(&mut harness, line);
        common::key(&mut harness, egui::Key::H);
        assert_eq!(is_off(&description(&harness)), off, "{line}");
        common::undo(&mut harness);
    }
    // A scene with lights may have both, too.
    let mut harness = viewer(common::SMALL);
    wait_built(&mut harness);
    assert_eq!(is_off(&description(&harness)), (true, true));
    let lights = built(&harness).lights.len();
    click_on(&mut harness, "Show the studio");
    click_on(&mut harness, "Show the ground");
    wait_built(&mut harness);
    let scene = built(&harness);
    assert!(scene.lights.len() > lights + 3 && scene.objects.len() == 2);
}

#[test]
fn lights_in_the_place_of_the_studio_light_the_same_picture() {
    let mut harness = bare();
    click_on(&mut harness, "Studio lights");
    let (described, before) = (description(&harness), built(&harness));
    click_on(&mut harness, "Make ordinary lights of it");
    wait_built(&mut harness);
    let (now, after) = (description(&harness), built(&harness));
    assert_eq!(now.lights.len(), before.lights.len());
    assert_eq!(after.lights, before.lights);
    assert!(now.studio.hidden && now.environment == Some(described.studio.room()));
    let first = Selection::Light(0);
    assert_eq!(harness.state().document().selection(), first);
    // State after saving and reading.
    let text = now.to_toml().unwrap();
    let read = Description::from_toml(&text, std::path::Path::new("saved")).unwrap();
    assert_eq!(read, *now);
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *described);
}

#[test]
fn the_ground_lies_where_it_is_said_to() {
    let mut harness = bare();
    click_on(&mut harness, "Ground plane");
    let level = |harness: &Harness<'static, Viewer>| built(harness).objects[1].mesh.bounds_m().0.z;
    let under_m = level(&harness);
    assert!(under_m < 0.0 && under_m > -1e-3, "{under_m}");
    click_on(&mut harness, "Under all");
    harness
        .get_by_role_and_label(egui::accesskit::Role::SpinButton, "Height")
        .set_value_accesskit(-0.02);
    harness.run_steps(3);
    wait_built(&mut harness);
    assert!((level(&harness) + 0.02).abs() < 1e-6);
}

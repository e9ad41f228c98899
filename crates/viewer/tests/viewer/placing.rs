//! Lights that are placed by their highlights, in the picture.

use crate::common::{self, SMALL, description, light, picture, viewer, wait_built};
use egui::{Key, vec2};
use egui_kittest::Harness;
use glam::DVec3;
use hairline_document::place_light;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

/// A ball on the ground, seen from the side, and a lamp a metre off.
const BALL: &str = "[camera]\nposition_m = [0, -1, 0.1]\ntarget_m = [0, 0, 0.1]\nup = [0, 0, 1]\nfov_y_deg = 30\n\
    [ground]\n[[material]]\nname = \"steel\"\nkind = \"metal\"\nmetal = \"steel\"\n\
    [[object]]\nname = \"ball\"\nshape = { sphere = { radius_m = 0.1 } }\nmaterial = \"steel\"\ntranslation_m = [0, 0, 0.1]\n\
    [[object]]\nname = \"wall\"\nshape = { box = { size_m = [0.01, 1.0, 1.0] } }\nmaterial = \"steel\"\n\
    translation_m = [0.4, 0, 0.5]\n\
    [[light]]\nname = \"lamp\"\nkind = \"sphere\"\ncenter_m = [0, -0.5, 1.0]\nradius_m = 0.01\n";

fn placing(scene: &'static str) -> Harness<'static, Viewer> {
    let mut harness = viewer(scene);
    wait_built(&mut harness);
    let document = harness.state_mut().document_mut();
    document.select(Selection::Light(0));
    common::key(&mut harness, Key::L);
    harness
}

#[test]
fn a_light_is_put_neither_below_the_ground_nor_into_an_object() {
    let mut harness = placing(BALL);
    let middle = picture(&harness).center();
    // The radius of the ball on the screen: the picture is 16 : 9, in the middle.
    let radius = 0.1 / 0.268 * 0.5 * picture(&harness).width() * 9.0 / 16.0;
    for (at, what) in [
        (middle + vec2(0.0, 0.5 * radius), "The ground is in the way"),
        (middle + vec2(0.5 * radius, 0.0), "\"wall\" is in the way"),
    ] {
        let before = description(&harness);
        common::click_at(&mut harness, at);
        harness.run_steps(2);
        let told = harness.state().messages().concat();
        assert!(told.contains(what), "{told:?}");
        let center = place_light::center(&light(&harness, 0));
        assert!(center.z > 0.01 && center.x < 0.385, "{center}");
        assert_ne!(*description(&harness), *before);
        common::undo(&mut harness);
        assert_eq!(*description(&harness), *before);
    }
    // Without an obstacle the light keeps its distance.
    common::click_at(&mut harness, middle - vec2(0.0, 0.5 * radius));
    harness.run_steps(2);
    let center = place_light::center(&light(&harness, 0));
    assert!(center.z > 0.5, "{center}");
}

#[test]
fn a_drag_moves_the_highlight_and_is_one_step() {
    let mut harness = placing(SMALL);
    let before = description(&harness);
    let camera = harness.state().camera();
    let from = picture(&harness).center() + vec2(40.0, 60.0);
    common::press(&mut harness, from);
    let mut centers: Vec<DVec3> = Vec::new();
    for i in 1..=6 {
        let to = from - vec2(12.0 * i as f32, 0.0);
        common::move_to(&mut harness, to + vec2(12.0, 0.0), to, 1);
        centers.push(place_light::center(&light(&harness, 0)));
    }
    let steps = centers.windows(2).filter(|pair| pair[0].x > pair[1].x);
    assert!(steps.count() >= 4, "it follows the pointer: {centers:?}");
    common::release(&mut harness, from - vec2(72.0, 0.0));
    assert_eq!(harness.state().camera(), camera);
    harness.run_steps(2);
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

//! Boxes for numbers, as somebody types in them.

use crate::common::{SMALL, description, viewer, wait_built};
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use hairline_document::description::{Layer, LightKind};
use hairline_editor::Selection;
use hairline_viewer::Viewer;

/// Replaces the text of the box of this name.
fn type_into(harness: &mut Harness<'static, Viewer>, name: &str, text: &str) {
    harness
        .get_by_role_and_label(Role::SpinButton, name)
        .focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
}

fn shown(harness: &Harness<'static, Viewer>, name: &str) -> String {
    let node = harness.get_by_role_and_label(Role::SpinButton, name);
    node.accesskit_node().value().unwrap_or_default()
}

fn width_um(harness: &Harness<'static, Viewer>) -> f64 {
    match &description(harness).scratches[0].layer {
        Layer::Laid(laid) => laid.width_um.mean,
        other => panic!("{other:?}"),
    }
}

fn with_layer() -> Harness<'static, Viewer> {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    harness
        .state_mut()
        .document_mut()
        .select(Selection::Layer(0));
    harness.run_steps(3);
    harness
}

#[test]
fn units_and_sums_are_read() {
    let mut harness = with_layer();
    for (typed, wanted) in [
        ("0.004 mm", 4.0),
        ("6,5", 6.5),
        ("7/2", 3.5),
        ("4500 nm", 4.5),
        ("2 um + 500 nm", 2.5),
    ] {
        type_into(&mut harness, "Width", typed);
        let got = width_um(&harness);
        assert!((got - wanted).abs() < 1e-9, "{typed:?} became {got}");
        assert!(harness.state().messages().is_empty());
    }
}

#[test]
fn what_cannot_be_read_is_told_and_changes_nothing() {
    let mut harness = with_layer();
    let before = description(&harness);
    for typed in ["4 zz", "30°", "-", "1,000", "(2"] {
        type_into(&mut harness, "Width", typed);
        assert_eq!(*description(&harness), *before, "{typed:?}");
        let told = harness.state().messages().join(" ");
        assert!(told.contains("Width"), "{typed:?}: {told:?}");
    }
    // The next good one takes the message away.
    type_into(&mut harness, "Width", "4");
    assert_eq!(width_um(&harness), 4.0);
    assert!(harness.state().messages().is_empty());
    // A value that the scene does not allow is reported, too.
    type_into(&mut harness, "Width", "1 m");
    let told = harness.state().messages().join(" ");
    assert!(told.contains("at most 100 µm"), "{told:?}");
    // Given up.
    let before = description(&harness);
    harness
        .get_by_role_and_label(Role::SpinButton, "Width")
        .focus();
    harness.run_steps(2);
    harness.event(egui::Event::Text("3".to_owned()));
    harness.step();
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert_eq!(*description(&harness), *before);
    assert_eq!(harness.state().document().selection(), Selection::Layer(0));
}

#[test]
fn lengths_and_vectors_have_units_that_read_well() {
    let mut harness = with_layer();
    assert_eq!(shown(&harness, "Length"), "50 mm");
    assert_eq!(shown(&harness, "Width"), "5 µm");
    harness
        .state_mut()
        .document_mut()
        .select(Selection::Light(0));
    harness.run_steps(3);
    assert!(shown(&harness, "Position x").contains("-60 mm"));
    assert!(shown(&harness, "Position z").contains("100 mm"));
    type_into(&mut harness, "Position z", "0.12 m");
    type_into(&mut harness, "Radius", "8");
    let LightKind::Sphere { center_m, radius_m } = description(&harness).lights[0].kind.clone()
    else {
        panic!()
    };
    assert!((center_m[2] - 0.12).abs() < 1e-12);
    // Without a unit it counts in what the box shows, which is millimetres.
    assert!((radius_m - 0.008).abs() < 1e-12);
    // To go through a box changes nothing, though it does not show all digits.
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        if let LightKind::Sphere { radius_m, .. } = &mut d.lights[0].kind {
            *radius_m = 0.008_123_456_7;
        }
    });
    harness.run_steps(2);
    let before = description(&harness);
    harness
        .get_by_role_and_label(Role::SpinButton, "Radius")
        .focus();
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn a_sun_is_described_by_direction_angle_and_irradiance() {
    let mut harness = with_layer();
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        d.lights[0] = hairline_document::description::Light::new(LightKind::sun([0.0, 0.0, -1.0]));
    });
    document.select(Selection::Light(0));
    harness.run_steps(3);
    assert_eq!(shown(&harness, "Angle"), "0.53°");
    type_into(&mut harness, "Angle", "2");
    type_into(&mut harness, "Irradiance", "1.5");
    type_into(&mut harness, "Direction x", "0.5");
    let sun = LightKind::Sun {
        direction: [0.5, 0.0, -1.0],
        angle_deg: 2.0,
        irradiance: 1.5,
    };
    assert_eq!(description(&harness).lights[0].kind, sun);
    // A surface that the camera could see, a cone and flaps are those of other lights.
    for label in ["Radiance", "Visible", "Spot", "Barn doors"] {
        assert!(harness.query_by_label(label).is_none(), "{label}");
    }
    let saved = description(&harness).to_toml().unwrap();
    assert!(
        saved.contains("kind = \"sun\"") && !saved.contains("radiance = 1.0"),
        "{saved}"
    );
}

#[test]
fn a_camera_is_described_by_its_lens_too() {
    let mut harness = with_layer();
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        d.render.size_px = [1200, 800];
        d.camera.fov_y_deg = 2.0 * 0.24_f64.atan().to_degrees();
        (d.camera.aperture_mm, d.camera.focus_distance_m) = (Some(12.5), Some(0.3));
    });
    document.select(Selection::Camera);
    harness.run_steps(3);
    assert_eq!(shown(&harness, "Focal length"), "50 mm");
    assert_eq!(shown(&harness, "Sensor width"), "36 mm");
    assert_eq!(shown(&harness, "F-stop"), "4");
    let before = description(&harness);
    type_into(&mut harness, "Focal length", "100 mm");
    let camera = description(&harness).camera.clone();
    assert!((camera.fov_y_deg - 2.0 * 0.12_f64.atan().to_degrees()).abs() < 1e-9);
    assert!((camera.aperture_mm.unwrap() - 25.0).abs() < 1e-9);
    crate::common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    type_into(&mut harness, "Sensor width", "18 mm");
    type_into(&mut harness, "F-stop", "8");
    let camera = description(&harness).camera.clone();
    assert!((camera.fov_y_deg - 2.0 * 0.12_f64.atan().to_degrees()).abs() < 1e-9);
    assert!((camera.aperture_mm.unwrap() - 6.25).abs() < 1e-9);
    assert_eq!(camera.sensor_width_mm, Some(18.0));
    // The field of view and the opening are the same two numbers.
    type_into(&mut harness, "Field of view", "27");
    type_into(&mut harness, "Opening", "10 mm");
    let camera = description(&harness).camera.clone();
    assert_eq!(camera.fov_y_deg, 27.0);
    let f_stop = camera.focal_length_mm([1200, 800]) / 10.0;
    assert!((camera.f_stop([1200, 800]).unwrap() - f_stop).abs() < 1e-9);
    let saved = description(&harness).to_toml().unwrap();
    let again = hairline_document::Description::from_toml(&saved, std::path::Path::new("saved"));
    assert_eq!(again.unwrap(), *description(&harness));
}

#[test]
fn what_is_out_of_range_is_refused_with_the_range() {
    let mut harness = with_layer();
    let before = description(&harness);
    for (selection, name, typed, says) in [
        (
            Selection::Layer(0),
            "Width",
            "0-5",
            "greater than 0 and at most 100 µm",
        ),
        (Selection::Layer(0), "Width", "1 m", "at most 100 µm"),
        (Selection::Layer(0), "Seed", "-1", "from 0 to"),
        (Selection::Light(0), "Radiance", "1e99", "from 0 to"),
        (
            Selection::Object(0),
            "Rotation x",
            "1e99",
            "from -1000000° to 1000000°",
        ),
        (Selection::Studio, "Intensity", "1e99", "from 0 to"),
        (
            Selection::Camera,
            "Field of view",
            "0",
            "from 0.001° to 179°",
        ),
    ] {
        harness.state_mut().document_mut().select(selection);
        harness.run_steps(3);
        type_into(&mut harness, name, typed);
        assert_eq!(*description(&harness), *before, "{name}: {typed}");
        let told = harness.state().messages().join(" ");
        assert!(told.contains(name) && told.contains(typed), "{told:?}");
        assert!(told.contains(says), "{says:?} is not in {told:?}");
    }
}

#[test]
fn depth_of_field_comes_back_as_it_was() {
    let mut harness = with_layer();
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        d.camera.set_focal_length_mm(50.0, d.render.size_px);
        d.camera.aperture_mm = Some(50.0 / 5.6);
        d.camera.focus_distance_m = Some(0.4);
    });
    document.select(Selection::Camera);
    harness.run_steps(3);
    let before = description(&harness);
    assert_eq!(shown(&harness, "F-stop"), "5.6");
    let toggle = |harness: &mut Harness<'static, Viewer>| {
        harness
            .get_by_role_and_label(Role::CheckBox, "Depth of field")
            .click();
        harness.run_steps(3);
    };
    toggle(&mut harness);
    assert_eq!(description(&harness).camera.aperture_mm, None);
    toggle(&mut harness);
    assert_eq!(*description(&harness), *before);
}

/// From box to box, past the slider, forwards and back.
#[test]
fn tab_goes_on_to_the_next_value() {
    let mut harness = with_layer();
    let focused = |harness: &Harness<'static, Viewer>| {
        let id = harness.ctx.memory(|memory| memory.focused());
        let rect = id
            .and_then(|id| harness.ctx.read_response(id))
            .map(|it| it.rect);
        let boxes = harness.query_all_by_role(Role::SpinButton);
        let mut there =
            boxes.filter(|node| rect.is_some_and(|rect| rect.contains(node.rect().center())));
        there.next().and_then(|node| node.accesskit_node().label())
    };
    harness
        .get_by_role_and_label(Role::SpinButton, "Length")
        .focus();
    harness.run_steps(2);
    let first = focused(&harness).unwrap();
    let mut focus_order = vec![first];
    for _ in 0..4 {
        harness.key_press(Key::Tab);
        harness.run_steps(3);
        focus_order.push(focused(&harness).expect("a box"));
    }
    focus_order.dedup();
    assert_eq!(focus_order.len(), 5, "{focus_order:?}");
    harness.key_press_modifiers(egui::Modifiers::SHIFT, Key::Tab);
    harness.run_steps(3);
    assert_eq!(
        focused(&harness).as_deref(),
        Some(&*focus_order[3]),
        "{focus_order:?}"
    );
    // What was typed counts.
    let before = description(&harness);
    harness
        .get_by_role_and_label(Role::SpinButton, "Width")
        .focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text("7".to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Tab);
    harness.run_steps(3);
    assert_ne!(*description(&harness), *before);
    assert_eq!(width_um(&harness), 7.0);
}

/// Whether a box has a red rim.
fn has_rim(harness: &Harness<'static, Viewer>) -> bool {
    let color = harness
        .ctx
        .style_of(egui::Theme::Dark)
        .visuals
        .error_fg_color;
    let shapes = harness.output().shapes.iter();
    let mut rims = shapes.filter(|clipped| match &clipped.shape {
        egui::Shape::Rect(rect) => rect.stroke.color == color && rect.stroke.width > 0.0,
        _ => false,
    });
    rims.next().is_some()
}

/// With the value that it was refused for, with the part that it belongs to, and with its message.
#[test]
fn a_red_rim_goes_with_the_value() {
    let mut harness = with_layer();
    let refuse = |harness: &mut Harness<'static, Viewer>| {
        type_into(harness, "Width", "1 m");
        assert!(has_rim(harness) && !harness.state().messages().is_empty());
    };
    refuse(&mut harness);
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        if let Layer::Laid(laid) = &mut d.scratches[0].layer {
            laid.width_um.mean = 6.0;
        }
    });
    harness.run_steps(3);
    assert!(!has_rim(&harness) && harness.state().messages().is_empty());
    refuse(&mut harness);
    harness.get_by_label("Dismiss").click();
    harness.run_steps(3);
    assert!(!has_rim(&harness));
    refuse(&mut harness);
    let document = harness.state_mut().document_mut();
    document.select(Selection::Object(0));
    harness.run_steps(3);
    assert!(!has_rim(&harness));
}

/// Whatever the numbers are: the picture would start anew in another size.
#[test]
fn long_numbers_do_not_widen_the_panel() {
    let mut harness = with_layer();
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        d.camera.position_m = [-0.123_456, -0.543_217, 0.312_345];
        d.camera.target_m = [-1234.567, 0.000_123, 77.123_456];
    });
    document.select(Selection::None);
    harness.run_steps(3);
    let before = crate::common::picture(&harness);
    for selection in [
        Selection::Camera,
        Selection::Light(1),
        Selection::Object(0),
        Selection::Layer(0),
        Selection::Environment,
    ] {
        harness.state_mut().document_mut().select(selection);
        harness.run_steps(3);
        assert_eq!(crate::common::picture(&harness), before, "{selection:?}");
    }
}

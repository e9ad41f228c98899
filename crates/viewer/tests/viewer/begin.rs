//! What an artist begins with: an empty studio, examples, presets of their own, and the strength of a layer.

use crate::common::{
    self, SMALL, built_in, click_on, description, drag, key, undo, viewer, viewer_with, wait_built,
};
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_document::description::{Amount, Layer, Scratches};
use hairline_editor::Selection;
use hairline_viewer::examples::{Example, Examples};
use hairline_viewer::{Options, Viewer};

fn select(harness: &mut Harness<'static, Viewer>, selection: Selection) {
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(3);
}

fn add_shape(harness: &mut Harness<'static, Viewer>, name: &str) {
    harness.get_by_label("Add to objects").click();
    harness.run_steps(3);
    click_on(harness, name);
    wait_built(harness);
}

#[test]
fn a_new_scene_is_an_empty_studio_in_which_bodies_stand_side_by_side() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::N);
    harness.run_steps(3);
    wait_built(&mut harness);
    let empty = description(&harness);
    assert!(empty.objects.is_empty() && !empty.studio.hidden);
    let built = harness.state().renderer().built().unwrap();
    assert!(built.scene.lights.len() > 3, "the studio shines");
    assert_eq!(built.scene.objects.len(), 1, "the ground is there");
    for name in ["Sphere", "Box", "Torus", "Plane"] {
        add_shape(&mut harness, name);
    }
    let built = harness.state().renderer().built().unwrap();
    let bodies = &built.scene.objects[..4];
    let boxes: Vec<_> = bodies.iter().map(|body| body.mesh.bounds_m()).collect();
    let sizes = boxes.iter().map(|(low, high)| low.distance(*high));
    let (least, most) = sizes.fold((f32::MAX, 0.0_f32), |(a, b), size| {
        (a.min(size), b.max(size))
    });
    assert!(most < 1.2 * least, "{least} to {most} m");
    for (i, a) in boxes.iter().enumerate() {
        assert!(
            a.0.z.abs() < 1e-3 * most,
            "{a:?} does not stand on the ground"
        );
        for b in &boxes[..i] {
            let meet = a.0.cmplt(b.1).all() && b.0.cmplt(a.1).all();
            assert!(!meet, "{a:?} and {b:?}");
        }
    }
    for _ in 0..4 {
        undo(&mut harness);
    }
    assert_eq!(*description(&harness), *empty);
    assert!(
        harness
            .state()
            .messages()
            .iter()
            .all(|text| text.starts_with("Undone"))
    );
}

#[test]
fn the_last_object_of_a_scene_with_a_ground_may_go() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Object(0));
    key(&mut harness, Key::Delete);
    assert_eq!(description(&harness).objects.len(), 1, "it has no ground");
    select(&mut harness, Selection::Ground);
    key(&mut harness, Key::H);
    select(&mut harness, Selection::Object(0));
    key(&mut harness, Key::Delete);
    assert!(description(&harness).objects.is_empty());
    wait_built(&mut harness);
    // All that is about the objects is about the empty floor.
    for command in [Key::A, Key::F] {
        key(&mut harness, command);
    }
    assert!(
        harness
            .state()
            .camera()
            .position_m
            .iter()
            .all(|m| m.is_finite())
    );
}

/// A map of the gallery stands for any file.
const MAP: &[u8] = include_bytes!("../../assets/hairline.png");
const MASKED: &str = concat!(
    "[camera]\nposition_m = [0, -0.3, 0.2]\ntarget_m = [0, 0, 0]\n[[material]]\nname = \"m\"\nkind = \"mirror\"\n",
    "[[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.1 } }\n[[scratches]]\nobject = \"o\"\n",
    "pattern = \"random\"\ncount = 10\n[scratches.where]\ndensity = \"maps/mask.png\"\n",
);
static EXAMPLES: Examples = Examples {
    scenes: &[
        Example {
            name: "plain",
            text: SMALL,
        },
        Example {
            name: "masked",
            text: MASKED,
        },
    ],
    files: &[("maps/mask.png", MAP)],
    sheet: &[],
};

#[test]
fn an_example_opens_as_a_new_scene_with_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer_with(Options {
        state_dir: Some(folder.path().to_owned()),
        examples: &EXAMPLES,
        ..built_in(SMALL)
    });
    wait_built(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::O);
    harness.run_steps(3);
    harness.get_by_label("plain");
    click_on(&mut harness, "masked");
    wait_built(&mut harness);
    let document = harness.state().document();
    assert_eq!((document.path(), document.is_modified()), (None, false));
    assert_eq!(description(&harness).objects[0].name, "o");
    let mask = folder.path().join("examples/maps/mask.png");
    assert_eq!(std::fs::read(mask).unwrap(), MAP);
    assert!(harness.state().messages().is_empty());
    // With unsaved changes it is asked about first.
    select(&mut harness, Selection::Layer(0));
    key(&mut harness, Key::H);
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::O);
    harness.run_steps(3);
    click_on(&mut harness, "plain");
    click_on(&mut harness, "Discard the changes");
    wait_built(&mut harness);
    assert_eq!(description(&harness).objects[0].name, "disk");
}

#[test]
fn presets_of_ones_own_are_saved_and_given() {
    let folder = tempfile::tempdir().unwrap();
    let presets = folder.path().join("presets");
    std::fs::create_dir(&presets).unwrap();
    std::fs::write(presets.join("bad.toml"), "[[light]]\nkind = \"spher\"\n").unwrap();
    let mut harness = viewer_with(Options {
        state_dir: Some(folder.path().to_owned()),
        ..built_in(SMALL)
    });
    wait_built(&mut harness);
    let told = harness.state().messages().join("\n");
    assert!(told.contains("bad.toml:2: light[0].kind"), "{told}");
    // By its key, under a name that is typed.
    select(&mut harness, Selection::Layer(0));
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
    harness.run_steps(3);
    harness.event(egui::Event::Text("turned of mine".to_owned()));
    harness.run_steps(2);
    click_on(&mut harness, "Save the preset");
    assert!(presets.join("turned of mine.toml").is_file());
    // One that is there is replaced by a second click.
    let file = presets.join("turned of mine.toml");
    std::fs::write(
        &file,
        format!("# mine\n{}", std::fs::read_to_string(&file).unwrap()),
    )
    .unwrap();
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
    harness.run_steps(3);
    harness.event(egui::Event::Text("turned of mine".to_owned()));
    harness.run_steps(2);
    click_on(&mut harness, "Save the preset");
    assert!(
        std::fs::read_to_string(&file)
            .unwrap()
            .starts_with("# mine")
    );
    click_on(&mut harness, "Replace the preset turned of mine for good");
    assert!(
        !std::fs::read_to_string(&file)
            .unwrap()
            .starts_with("# mine")
    );
    // A broken file stays as it is.
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
    harness.run_steps(3);
    harness.event(egui::Event::Text("bad".to_owned()));
    harness.run_steps(2);
    click_on(&mut harness, "Save the preset");
    harness.get_by_label_contains("delete that file");
    click_on(&mut harness, "Cancel");
    // All lights, by the button in the panel.
    select(&mut harness, Selection::Light(0));
    click_on(&mut harness, "Save as a preset…");
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text("lamp and square".to_owned()));
    harness.run_steps(2);
    click_on(&mut harness, "All 2 lights of the scene");
    click_on(&mut harness, "Save the preset");
    let before = description(&harness);
    click_on(&mut harness, "+ scratches");
    click_on(&mut harness, "turned of mine");
    let after = description(&harness);
    let plain = |layer: &Scratches| Scratches {
        name: None,
        ..layer.clone()
    };
    let named = after.scratches[1].name.as_deref();
    assert_eq!(named, Some("turned of mine"));
    let [first, second] = [0, 1].map(|i| plain(&after.scratches[i]));
    assert_eq!(first.object, second.object);
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    click_on(&mut harness, "Add to lights");
    click_on(&mut harness, "lamp and square");
    assert_eq!(description(&harness).lights.len(), 4);
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    click_on(&mut harness, "+ scratches");
    harness.get_by_label("Delete turned of mine");
}

#[test]
fn strength_moves_count_width_and_depth_as_one_step() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Layer(0));
    let before = description(&harness);
    let numbers =
        |harness: &Harness<'static, Viewer>| match &description(harness).scratches[0].layer {
            Layer::Laid(laid) => match laid.amount {
                Amount::Count(count) => [count as f64, laid.width_um.mean, laid.depth_nm.mean],
                Amount::DensityPerM2(_) => panic!("it has a count"),
            },
            _ => panic!("it is laid"),
        };
    let slider = harness
        .get_by_role_and_label(Role::Slider, "Strength")
        .rect();
    let [from, to] = [0.3, 0.9].map(|x| slider.left_center() + egui::vec2(x * slider.width(), 0.0));
    let first = numbers(&harness);
    drag(&mut harness, from, to, 6);
    let heavy = numbers(&harness);
    assert!((0..3).all(|i| heavy[i] > first[i]), "{first:?} {heavy:?}");
    assert_eq!(harness.state().document().undo_label(), Some("Strength"));
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    // By keys.
    harness
        .get_by_role_and_label(Role::Slider, "Strength")
        .focus();
    harness.run_steps(2);
    key(&mut harness, Key::ArrowLeft);
    let less = numbers(&harness);
    assert!(
        (0..3).all(|i| less[i] <= first[i]) && less != first,
        "{first:?} {less:?}"
    );
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    common::undo(&mut harness);
}

#[test]
fn strength_is_typed_and_says_why_there_is_none() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Layer(0));
    let mut all = Vec::new();
    for typed in ["1", "0", "1"] {
        harness
            .get_by_role_and_label(Role::SpinButton, "Strength")
            .focus();
        harness.run_steps(2);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.event(egui::Event::Text(typed.to_owned()));
        harness.run_steps(2);
        key(&mut harness, Key::Enter);
        all.push(description(&harness));
    }
    assert_ne!(*all[0], *all[1]);
    assert_eq!(*all[0], *all[2], "the way back is the way there");
    harness.state_mut().document_mut().edit("None", |d| {
        if let Layer::Laid(laid) = &mut d.scratches[0].layer {
            laid.amount = Amount::Count(0);
        }
    });
    harness.run_steps(2);
    harness.get_by_label("there are no scratches: their number is 0");
}

//! Measuring: a click reads a scratch, a drag the distance along a surface; the list of a layer and its file.

use crate::common::{
    self, SMALL, click_at, click_on, drag, key, picture, viewer, wait_built, wait_for_text,
    wait_until,
};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

/// The small scene, once there is a picture of it.
fn shown() -> Harness<'static, Viewer> {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    harness
}

/// Place at which the window shows a point.
pub fn seen(harness: &Harness<'static, Viewer>, point_m: DVec3) -> Pos2 {
    let (area, size_px) = (
        picture(harness),
        common::description(harness).render.size_px,
    );
    let [width, height] = size_px.map(|side| side as f32);
    let fitting = (area.width() / width).min(area.height() / height);
    let frame = Rect::from_center_size(area.center(), vec2(width, height) * fitting);
    let camera = harness.state().camera().in_scene().frame(size_px);
    let px = camera.pixel_of(point_m).expect("it is in view");
    frame.min + vec2(px.x as f32, px.y as f32) * fitting
}

#[test]
fn a_click_reads_the_nearest_scratch() {
    let mut harness = shown();
    let before = common::description(&harness);
    key(&mut harness, Key::M);
    harness.get_by_label("Click on a scratch, or drag over a surface.");
    let (at, width, length) = {
        let built = harness.state().renderer().built().unwrap();
        let object = &built.scene.objects[0];
        // The one that is farthest from all others in its middle would be best; any will do that is met.
        let scratch = &object.scratches[17];
        let pieces = object.pieces(scratch);
        let middle = &pieces[pieces.len() / 2];
        let at = 0.5 * (middle.start_m + middle.end_m);
        let texts = (scratch.profile.width_um, 1e3 * object.length_m(scratch));
        (at.as_dvec3(), texts.0, texts.1)
    };
    let at = seen(&harness, at);
    click_at(&mut harness, at);
    harness.run_steps(3);
    harness.get_by_label("number 17 (of 200, from 0)");
    assert!(harness.query_all_by_label("turned").count() > 1);
    let shown = |of: String| {
        let texts = harness.query_all_by_label_contains(&of).count();
        assert!(texts > 0, "{of}");
    };
    shown(format!("{width:.2}")[..3].to_owned());
    shown(format!("{length:.1}")[..2].to_owned());
    assert_eq!(harness.state().document().selection(), Selection::Layer(0));
    // The scene is as it was; Escape forgets what was read, then lays the tool down.
    assert_eq!(*common::description(&harness), *before);
    key(&mut harness, Key::Escape);
    harness.get_by_label("Click on a scratch, or drag over a surface.");
    key(&mut harness, Key::Escape);
    assert!(
        harness
            .query_by_label("Click on a scratch, or drag over a surface.")
            .is_none()
    );
}

#[test]
fn a_drag_measures_along_the_surface_and_the_view_stays() {
    let mut harness = shown();
    let camera = harness.state().camera();
    key(&mut harness, Key::M);
    let ends = [[-0.03, -0.04, 0.0], [0.03, 0.04, 0.0]].map(|at| seen(&harness, at.into()));
    drag(&mut harness, ends[0], ends[1], 8);
    // Of few pixels the picture is stretched by some.
    let is_near = |m: f64| (m - 0.1).abs() < 1e-3;
    let start = std::time::Instant::now();
    loop {
        harness.step();
        std::thread::sleep(std::time::Duration::from_millis(10));
        let measured_m = harness.state().measured_m();
        if measured_m.is_some_and(|it| it.iter().all(|m| m.is_some_and(is_near))) {
            break;
        }
        assert!(start.elapsed().as_secs() < 60, "{measured_m:?}");
    }
    harness.run_steps(2);
    harness.get_by_label("Along the surface");
    assert_eq!(harness.state().camera(), camera);
    // Beside the disk there is nothing to be measured: the view turns, as ever.
    let beside = picture(&harness).left_bottom() + vec2(20.0, -20.0);
    drag(&mut harness, beside, beside + vec2(60.0, 0.0), 4);
    assert_ne!(harness.state().camera(), camera);
}

#[test]
fn the_list_shows_few_rows_and_its_file_is_laid_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("list.csv");
    let mut harness = shown();
    harness
        .state_mut()
        .document_mut()
        .select(Selection::Layer(0));
    harness.run_steps(3);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::M);
    harness.run_steps(4);
    harness.get_by_label("200 scratches");
    // Rows that are out of sight are not made.
    assert!(harness.query_by_label("3").is_some() && harness.query_by_label("150").is_none());
    click_on(&mut harness, "3");
    harness.get_by_label("number 3 (of 200, from 0)");
    // A number that is typed is gone to.
    harness
        .get_by_role_and_label(Role::SpinButton, "Go to")
        .focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("150".to_owned()));
    harness.run_steps(2);
    key(&mut harness, Key::Enter);
    harness.run_steps(2);
    harness.get_by_label("number 150 (of 200, from 0)");
    assert!(harness.query_by_label("150").is_some());
    // Messages stand at the lower edge.
    let button = harness.get_by_label("Save the list of scratches…").rect();
    assert!(button.max.y < picture(&harness).max.y - 150.0);
    click_on(&mut harness, "Save the list of scratches…");
    harness.get_by_label("Path").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(path.display().to_string()));
    harness.run_steps(2);
    key(&mut harness, Key::Enter);
    wait_until(&mut harness, "the file", |_| path.exists());
    let laid = harness.state().renderer().built().unwrap();
    // Dropped onto the window it is a layer with the same scratches.
    crate::files::drop_file(&mut harness, &path);
    wait_until(&mut harness, "the layer of the file", |viewer| {
        let built = viewer.renderer().built();
        built.is_some_and(|it| it.scene.objects[0].of_layer(1).len() == 200)
    });
    let built = harness.state().renderer().built().unwrap();
    let [before, after] = [&laid, &built].map(|it| &it.scene.objects[0]);
    for i in 0..200 {
        let [a, b] = [
            before.length_m(&before.scratches[i]),
            after.length_m(&after.scratches[200 + i]),
        ];
        assert!((a - b).abs() < 1e-5, "{a} {b}");
        assert_eq!(
            before.scratches[i].profile,
            after.scratches[200 + i].profile
        );
    }
}

#[test]
fn commands_without_a_layer_say_what_is_missing() {
    let mut harness = shown();
    harness.key_press_modifiers(Modifiers::SHIFT, Key::M);
    harness.run_steps(2);
    let told = harness.state().messages().concat();
    assert!(told.contains("Select a layer of scratches"), "{told}");
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
    harness.run_steps(2);
    let told = harness.state().messages().concat();
    assert!(told.contains("A preset is made of"), "{told}");
}

#[test]
fn there_is_no_way_between_two_objects() {
    let mut harness = viewer(format!("{SMALL}\n[ground]\n").leak());
    wait_built(&mut harness);
    key(&mut harness, Key::M);
    let from = seen(&harness, DVec3::new(0.0, -0.02, 0.0));
    let to = picture(&harness).right_bottom() - vec2(40.0, 40.0);
    drag(&mut harness, from, to, 4);
    // On the way there it is measured on the disk and up to its rim.
    wait_for_text(&mut harness, "no way: two objects");
}

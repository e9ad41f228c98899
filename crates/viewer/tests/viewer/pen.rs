//! The pen: engraved lines that are set point by point, and changed later.

use std::ffi::OsStr;
use std::path::Path;

use crate::common::{self, SMALL, description, picture, viewer, wait_built};
use crate::files::drop_file;
use egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_editor::{Selection, pen};
use hairline_viewer::Viewer;

fn with_pen() -> Harness<'static, Viewer> {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    common::key(&mut harness, Key::D);
    harness
}

/// Three places on the disk.
fn places(harness: &Harness<'static, Viewer>) -> [Pos2; 3] {
    let middle = picture(harness).center();
    [vec2(-60.0, 10.0), vec2(0.0, 40.0), vec2(60.0, 5.0)].map(|by| middle + by)
}

/// A line through three places, in hand.
fn with_line() -> (Harness<'static, Viewer>, usize) {
    let mut harness = with_pen();
    for place in places(&harness) {
        common::click_at(&mut harness, place);
    }
    let Selection::Layer(layer) = harness.state().document().selection() else {
        panic!("no layer is selected");
    };
    (harness, layer)
}

fn points(harness: &Harness<'static, Viewer>, layer: usize) -> Vec<[f64; 3]> {
    pen::points_m(&description(harness).scratches[layer]).to_vec()
}

#[test]
fn clicks_set_the_points_of_one_line_and_each_is_one_step() {
    let (mut harness, layer) = with_line();
    let count = description(&harness).scratches.len();
    let all = points(&harness, layer);
    assert_eq!(all.len(), 3);
    assert!(all[0][0] < all[1][0] && all[1][0] < all[2][0], "{all:?}");
    // After Enter a click begins another line.
    common::key(&mut harness, Key::Enter);
    let elsewhere = places(&harness)[1] - vec2(0.0, 30.0);
    common::click_at(&mut harness, elsewhere);
    assert_eq!(points(&harness, layer), all);
    common::key(&mut harness, Key::Escape);
    common::undo(&mut harness);
    assert_eq!(points(&harness, layer), all[..2]);
    common::undo(&mut harness);
    assert_eq!(description(&harness).scratches.len(), count - 1);
}

#[test]
fn a_double_click_ends_a_line_and_escape_leaves_the_pen() {
    let (mut harness, layer) = with_line();
    let last = places(&harness)[1] + vec2(0.0, 25.0);
    common::double_click_at(&mut harness, last);
    // A double click in one slow pass sets its point, too.
    assert_eq!(points(&harness, layer).len(), 4);
    let before = description(&harness);
    let begin = places(&harness)[1] - vec2(0.0, 30.0);
    common::click_at(&mut harness, begin);
    // The first Escape gives the begun line up, the second one the pen.
    common::key(&mut harness, Key::Escape);
    common::key(&mut harness, Key::Escape);
    assert_eq!(*description(&harness), *before);
    let at = places(&harness)[0] - vec2(0.0, 40.0);
    common::click_at(&mut harness, at);
    common::click_at(&mut harness, at + vec2(40.0, 0.0));
    assert_eq!(*description(&harness), *before);
}

#[test]
fn a_click_on_the_last_point_ends_a_line() {
    let (mut harness, layer) = with_line();
    let before = description(&harness);
    let [.., last] = places(&harness);
    common::click_at(&mut harness, last);
    assert_eq!(*description(&harness), *before);
    let elsewhere = places(&harness)[1] - vec2(0.0, 30.0);
    common::click_at(&mut harness, elsewhere);
    assert_eq!(*description(&harness), *before, "another line is begun");
    assert_eq!(points(&harness, layer).len(), 3);
}

#[test]
fn delete_and_undo_take_the_lone_point_first() {
    let (mut harness, layer) = with_line();
    let before = description(&harness);
    common::key(&mut harness, Key::Enter);
    let elsewhere = places(&harness)[1] - vec2(0.0, 30.0);
    let removals: [fn(&mut Harness<'static, Viewer>); 2] =
        [|harness| common::key(harness, Key::Delete), common::undo];
    for take in removals {
        common::click_at(&mut harness, elsewhere);
        take(&mut harness);
        assert_eq!(*description(&harness), *before);
        // Nothing is begun: the next click is a first one.
        common::click_at(&mut harness, elsewhere + vec2(20.0, 0.0));
        assert_eq!(*description(&harness), *before);
        common::key(&mut harness, Key::Enter);
    }
    common::undo(&mut harness);
    assert_eq!(points(&harness, layer).len(), 2);
    // The second point is undone alone: the line is made again from the first.
    common::undo(&mut harness);
    assert_eq!(description(&harness).scratches.len(), layer);
    let [_, second, _] = places(&harness);
    common::click_at(&mut harness, second);
    let again = points(&harness, layer);
    assert_eq!(again, pen::points_m(&before.scratches[layer])[..2]);
}

/// In a slow pass the pointer is elsewhere already when a click is seen.
#[test]
fn a_point_is_set_where_the_button_went_down() {
    let mut at = Vec::new();
    for by in [vec2(0.0, 0.0), vec2(70.0, -40.0)] {
        let mut harness = with_pen();
        for place in places(&harness) {
            harness.hover_at(place);
            harness.run_steps(2);
            for pressed in [true, false] {
                let event = common::button_event(place, pressed);
                harness.input_mut().events.push(event);
            }
            let moved = egui::Event::PointerMoved(place + by);
            harness.input_mut().events.push(moved);
            harness.step();
        }
        let layer = description(&harness).scratches.len() - 1;
        at.push(points(&harness, layer));
    }
    assert_eq!(at[0], at[1]);
}

#[test]
fn a_point_is_dragged_to_where_the_button_went_up() {
    let mut at = Vec::new();
    for steps in [1, 2] {
        let (mut harness, layer) = with_line();
        let from = places(&harness)[1];
        let to = from + vec2(24.0, 20.0);
        common::press(&mut harness, from);
        common::move_to(&mut harness, from, from.lerp(to, 0.5), 2);
        if steps == 2 {
            common::move_to(&mut harness, to, to, 1);
        }
        // The last way and the release are one pass.
        let events = [
            egui::Event::PointerMoved(to),
            common::button_event(to, false),
        ];
        harness.input_mut().events.extend(events);
        harness.run_steps(2);
        at.push(points(&harness, layer));
    }
    assert_eq!(at[0], at[1]);
}

#[test]
fn a_click_on_a_finished_line_inserts_a_point() {
    let (mut harness, layer) = with_line();
    common::key(&mut harness, Key::Enter);
    wait_built(&mut harness);
    let before = points(&harness, layer);
    // On the line, between its second and its third point.
    let middle_m = {
        let built = harness.state().renderer().built().unwrap();
        let object = &built.scene.objects[0];
        let own = object.of_layer(layer as u32);
        // The line is filled with scratches that follow one another.
        let scratch = &object.scratches[own.start + 3 * own.len() / 4];
        object.pieces(scratch)[0].start_m.as_dvec3()
    };
    let at = crate::measure::seen(&harness, middle_m);
    common::click_at(&mut harness, at);
    let after = points(&harness, layer);
    assert_eq!(
        [after[0], after[1], after[3]],
        [before[0], before[1], before[2]]
    );
    let inserted = glam::DVec3::from(after[2]);
    assert!(inserted.distance(middle_m) < 2e-3, "{inserted} {middle_m}");
    assert_eq!(
        harness.state().document().undo_label(),
        Some("Insert a point")
    );
}

#[test]
fn a_click_beside_objects_says_so() {
    let mut harness = with_pen();
    let beside = picture(&harness).left_top() + vec2(20.0, 80.0);
    common::click_at(&mut harness, beside);
    let told = harness.state().messages().concat();
    assert!(told.contains("click on one"), "{told}");
    let mut harness = viewer("[camera]\nposition_m = [0, -1, 1]\ntarget_m = [0, 0, 0]\n[ground]\n");
    wait_built(&mut harness);
    harness.get_by_label_contains("adds one");
    common::key(&mut harness, Key::D);
    let middle = picture(&harness).center();
    common::click_at(&mut harness, middle);
    let told = harness.state().messages().concat();
    assert!(told.contains("Add an object first"), "{told}");
}

#[test]
fn the_first_point_closes_a_line() {
    let (mut harness, layer) = with_line();
    let first = places(&harness)[0];
    common::click_at(&mut harness, first);
    let closed = |harness: &Harness<'static, Viewer>| {
        pen::curve(&description(harness).scratches[layer]).map(|(_, closed)| closed)
    };
    assert_eq!(closed(&harness), Some(true));
    common::undo(&mut harness);
    assert_eq!(closed(&harness), Some(false));
}

#[test]
fn points_of_an_older_line_are_moved_and_taken_away() {
    let (mut harness, layer) = with_line();
    // Away from the pen and back.
    common::key(&mut harness, Key::V);
    harness.state_mut().document_mut().select(Selection::None);
    common::key(&mut harness, Key::D);
    harness
        .state_mut()
        .document_mut()
        .select(Selection::Layer(layer));
    harness.run_steps(2);
    let before = points(&harness, layer);
    let camera = harness.state().camera();
    let from = places(&harness)[1];
    common::drag(&mut harness, from, from + vec2(10.0, 20.0), 5);
    let moved = points(&harness, layer);
    assert_eq!([moved[0], moved[2]], [before[0], before[2]]);
    assert!(
        moved[1][0] > before[1][0] && moved[1][1] < before[1][1],
        "{moved:?}"
    );
    assert_eq!(harness.state().camera(), camera);
    // The point that was held is the one that goes.
    common::key(&mut harness, Key::Delete);
    assert_eq!(points(&harness, layer), [before[0], before[2]]);
    common::undo(&mut harness);
    assert_eq!(points(&harness, layer), moved);
    common::undo(&mut harness);
    assert_eq!(points(&harness, layer), before);
    // Beside the points a drag turns the view.
    common::drag(
        &mut harness,
        from - vec2(0.0, 40.0),
        from - vec2(30.0, 40.0),
        3,
    );
    assert_ne!(harness.state().camera(), camera);
    assert_eq!(points(&harness, layer), before);
}

/// A ball whose middle is that of the picture.
pub const BALL: &str = "[camera]\nposition_m = [0, -1, 0]\ntarget_m = [0, 0, 0]\nup = [0, 0, 1]\nfov_y_deg = 30\n\
    [[material]]\nname = \"steel\"\nkind = \"metal\"\nmetal = \"steel\"\n\
    [[object]]\nname = \"ball\"\nshape = { sphere = { radius_m = 0.1 } }\nmaterial = \"steel\"\n";

#[test]
fn a_text_is_engraved_before_the_eye_and_dragged_by_its_middle() {
    let mut harness = viewer(BALL);
    wait_built(&mut harness);
    let before = description(&harness);
    common::click_on(&mut harness, "Tools");
    common::click_on(&mut harness, "Engrave a text");
    let layer = description(&harness).scratches[0].clone();
    assert_eq!(layer.layer.pattern_name(), "text");
    let at = points(&harness, 0);
    assert!((at[0][1] + 0.1).abs() < 1e-3, "{at:?}");
    common::key(&mut harness, Key::D);
    let middle = picture(&harness).center();
    common::drag(&mut harness, middle, middle + vec2(30.0, 0.0), 3);
    assert!(points(&harness, 0)[0][0] > 0.01);
    assert_eq!(harness.state().document().undo_label(), Some("Move a text"));
    common::undo(&mut harness);
    assert_eq!(points(&harness, 0), at);
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn a_drawing_that_is_dropped_is_engraved() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mark.svg");
    let mark = "<svg xmlns='http://www.w3.org/2000/svg'><circle cx='3' cy='3' r='2'/></svg>";
    std::fs::write(&file, mark).unwrap();
    let mut harness = viewer(BALL);
    wait_built(&mut harness);
    drop_file(&mut harness, &file);
    common::wait_until(&mut harness, "the drawing is laid", |viewer| {
        let built = viewer.renderer().built();
        built.is_some_and(|it| it.scene.objects[0].scratches.len() > 100)
    });
    let layer = description(&harness).scratches[0].clone();
    assert_eq!(layer.layer.pattern_name(), "svg");
}

/// Types into the line for a path, and enters it.
fn enter_path(harness: &mut Harness<'static, Viewer>, path: &Path) {
    harness.get_by_label("Path").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text(path.display().to_string()));
    harness.run_steps(2);
    common::key(harness, Key::Enter);
}

#[test]
fn lists_and_other_drawings_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let [mark, other, list] =
        ["mark.svg", "other.svg", "list.csv"].map(|name| folder.path().join(name));
    let drawing = "<svg xmlns='http://www.w3.org/2000/svg'><circle cx='3' cy='3' r='2'/></svg>";
    for file in [&mark, &other] {
        std::fs::write(file, drawing).unwrap();
    }
    let rows = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n0,-0.1,0,0.002,-0.1,0,4,200\n";
    std::fs::write(&list, rows).unwrap();
    let mut harness = viewer(BALL);
    wait_built(&mut harness);
    drop_file(&mut harness, &mark);
    common::click_on(&mut harness, "Choose file");
    enter_path(&mut harness, &other);
    let files = |harness: &Harness<'static, Viewer>| -> Vec<_> {
        let description = description(harness);
        let files = description.files().into_iter();
        files
            .map(|(_, file)| file.file_name().map(OsStr::to_owned))
            .collect()
    };
    assert_eq!(files(&harness), [other.file_name().map(OsStr::to_owned)]);
    common::click_on(&mut harness, "Tools");
    common::click_on(&mut harness, "Scratches from a list (CSV)…");
    enter_path(&mut harness, &list);
    assert_eq!(files(&harness)[1], list.file_name().map(OsStr::to_owned));
}

//! The pen: engraved lines that are set point by point, and changed later.

use crate::common::{self, SMALL, description, picture, viewer, wait_built};
use crate::files::drop_file;
use egui::{Key, Pos2, vec2};
use egui_kittest::Harness;
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
    let all = points(&harness, layer);
    assert!((3..=4).contains(&all.len()));
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
        let built = viewer.engine().built();
        built.is_some_and(|it| it.scene.objects[0].scratches.len() == 1)
    });
    let layer = description(&harness).scratches[0].clone();
    assert_eq!(layer.layer.pattern_name(), "svg");
}

//! Edits of which no scene can be built.

use crate::common::{self, description, viewer, wait_built};
use crate::files::drop_file;
use crate::pen::BALL;
use egui_kittest::Harness;
use hairline_editor::pen;
use hairline_viewer::Viewer;

/// What no scene can be built of is taken back, and what comes after it is taken.
#[test]
fn a_broken_drawing_and_a_point_far_off_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [broken, good] = ["broken.svg", "good.svg"].map(|name| folder.path().join(name));
    std::fs::write(&broken, "this is no xml").unwrap();
    let mark = "<svg xmlns='http://www.w3.org/2000/svg'><circle cx='3' cy='3' r='2'/></svg>";
    std::fs::write(&good, mark).unwrap();
    let mut harness = viewer(BALL);
    wait_built(&mut harness);
    let refused = |harness: &mut Harness<'static, Viewer>, why: &str| {
        common::wait_until(harness, why, |viewer| {
            let told = viewer.messages().concat();
            told.contains("it is as it was before") && told.contains(why)
        });
        wait_built(harness);
    };
    let before = description(&harness);
    drop_file(&mut harness, &broken);
    refused(&mut harness, "broken.svg:1: found no drawing");
    assert_eq!(*description(&harness), *before);
    assert_eq!(harness.state().document().undo_label(), None);
    drop_file(&mut harness, &good);
    common::wait_until(&mut harness, "the drawing is laid", |viewer| {
        let built = viewer.renderer().built();
        built.is_some_and(|it| it.scene.objects[0].scratches.len() > 100)
    });
    assert_eq!(harness.state().messages(), [""; 0]);
    let before = description(&harness);
    let document = harness.state_mut().document_mut();
    document.edit("Place", |d| pen::move_point(d, 0, 0, glam::DVec3::Z * 3.0));
    refused(
        &mut harness,
        "layer \"drawing\": center_m: found a point 2.90 m off",
    );
    assert_eq!(*description(&harness), *before);
    assert_eq!(
        harness.state().document().undo_label(),
        Some("Engrave a drawing")
    );
}

/// A scene that was wrong when it was opened is mended step by step.
#[test]
fn a_step_in_a_scene_that_was_wrong_before_stays() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("broken.svg"), "this is no xml").unwrap();
    let scene = folder.path().join("scene.toml");
    let layer = "[[scratches]]\nobject = \"ball\"\npattern = \"svg\"\nfile = \"broken.svg\"\nfit_m = 0.01\n";
    std::fs::write(&scene, format!("{BALL}{layer}")).unwrap();
    let mut harness = common::viewer_of_any_file(&scene);
    let document = harness.state_mut().document_mut();
    document.edit("Roughness", |d| d.materials[0].roughness = 0.3);
    common::wait_until(&mut harness, "the scene is looked at", |viewer| {
        !viewer.renderer().is_building() && viewer.messages().concat().contains("broken.svg")
    });
    harness.run_steps(3);
    assert_eq!(harness.state().document().undo_label(), Some("Roughness"));
}

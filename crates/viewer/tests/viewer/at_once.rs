//! What is shown at once: exposure while a picture refines, and nothing of a scene that was left.

use crate::common::{SMALL, description, viewer, viewer_in, wait_built, wait_until};
use crate::files::drop_file;
use hairline_scene::Transport;
use hairline_viewer::Options;
use hairline_viewer::progressive::Backend;

/// Sixty-four rays in each pixel take a while: the exposure does not wait for them.
#[test]
fn exposure_is_applied_while_a_picture_refines() {
    let mut harness = viewer_in(
        Options {
            scene: None,
            built_in: SMALL,
            backend: Backend::Cpu,
            state_dir: None,
            native_dialogs: false,
            transport: Transport {
                shadows: true,
                bounces: 1,
            },
            examples: &hairline_viewer::examples::Examples::NONE,
        },
        [1280.0, 800.0],
        0.5,
    );
    wait_built(&mut harness);
    wait_until(&mut harness, "all pixels", |viewer| {
        let frame = viewer.renderer().latest();
        frame.is_some_and(|frame| frame.painted.size_px == frame.view.size_px)
    });
    let document = harness.state_mut().document_mut();
    document.edit("Exposure", |description| {
        description.camera.exposure_ev += 1.5
    });
    let is_brighter = |viewer: &hairline_viewer::Viewer| {
        let frame = viewer.renderer().latest();
        frame.is_some_and(|frame| frame.view.display.exposure_ev > 1.0)
    };
    wait_until(&mut harness, "the new exposure", is_brighter);
    let frame = harness.state().renderer().latest().unwrap();
    assert!(!frame.painted.is_final, "it was still refining");
}

/// From the step in which another file is opened there is no picture, until there is one of that.
#[test]
fn nothing_of_another_scene_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let other = folder.path().join("other.toml");
    std::fs::write(
        &other,
        SMALL
            .replace("name = \"disk\"", "name = \"plate\"")
            .replace("object = \"disk\"", "object = \"plate\""),
    )
    .unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    drop_file(&mut harness, &other);
    assert_eq!(description(&harness).objects[0].name, "plate");
    wait_until(&mut harness, "a picture of the other scene", |viewer| {
        let renderer = viewer.renderer();
        let shown = renderer
            .latest()
            .map(|frame| frame.built.description.objects[0].name.clone());
        assert!(shown.as_deref() != Some("disk"), "the scene that was left");
        shown.is_some()
    });
}

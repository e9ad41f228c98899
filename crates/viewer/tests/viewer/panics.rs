//! A thread of the renderer that panics: the window says so, and the next change has its picture.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use hairline_viewer::Viewer;

use crate::common::{SMALL, viewer, wait_built, wait_until};

/// Whether the picture is that of the newest description.
fn is_pictured(viewer: &Viewer) -> bool {
    let frame = viewer.renderer().latest();
    frame.is_some_and(|frame| frame.built.revision == viewer.document().revision())
}

/// Each thread wakes the window when it has something new: in the middle of its work.
#[test]
fn a_panic_is_told_and_the_picture_goes_on() {
    for (thread, what) in [
        ("painter", "Painting failed"),
        ("scene builder", "Building the scene failed"),
    ] {
        let mut harness = viewer(SMALL);
        wait_built(&mut harness);
        let breaks = Arc::new(AtomicBool::new(true));
        let breaks_now = Arc::clone(&breaks);
        harness.ctx.set_request_repaint_callback(move |_| {
            let is_it = std::thread::current().name() == Some(thread);
            assert!(
                !(is_it && breaks_now.swap(false, Ordering::Relaxed)),
                "a broken lamp"
            );
        });
        let change = |d: &mut hairline_document::Description| {
            d.camera.position_m[0] += 0.1;
            d.objects[0].translation_m[0] += 0.001;
        };
        // egui calls back only if no pass is requested yet, so one edit may not be enough.
        while breaks.load(Ordering::Relaxed) {
            harness.state_mut().document_mut().edit("Break", change);
            wait_until(&mut harness, "a panic or a picture", |viewer| {
                !breaks.load(Ordering::Relaxed) || is_pictured(viewer)
            });
        }
        wait_until(&mut harness, "a message", |viewer| {
            let messages = viewer.messages();
            messages
                .iter()
                .any(|text| text.contains(what) && text.contains("a broken lamp"))
        });
        harness.state_mut().document_mut().edit("Turn", change);
        wait_until(&mut harness, "a picture after the panic", is_pictured);
    }
}

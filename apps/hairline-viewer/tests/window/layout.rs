//! Positions of widgets in the window, found by running the same interface without a window.

use std::path::Path;
use std::time::Instant;

use egui::accesskit::Role;
use egui::{Pos2, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};

use crate::PATIENCE;
use crate::display::Display;

pub struct Layout {
    picture: Rect,
    layer: Pos2,
    width: Pos2,
    lamp: Option<Lamp>,
}

/// A light of that name.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// Position of the lamp's line in the outliner.
    pub line: Pos2,
    /// Position of the handle that moves it across the view, once it is selected.
    pub handle: Pos2,
}

impl Layout {
    /// Layout of the viewer on this scene, in a window as large as the display.
    pub fn new(scene: &Path, display: &Display) -> Self {
        let scene = scene.to_owned();
        let mut harness = Harness::builder()
            .with_size(display.size_px().map(f32::from))
            .with_pixels_per_point(1.0)
            .build_eframe(|context| {
                let options = Options {
                    scene: Some(scene),
                    built_in: "",
                    backend: Backend::Cpu,
                    state_dir: None,
                    native_dialogs: false,
                    transport: hairline_scene::Transport::DIRECT,
                    examples: &hairline_viewer::examples::Examples::NONE,
                };
                Viewer::new(&context.egui_ctx, None, options).unwrap()
            });
        let start = Instant::now();
        while harness.state().renderer().built().is_none() {
            assert!(start.elapsed() < PATIENCE, "no scene was built");
            harness.step();
        }
        harness.run_steps(3);
        let lamp = harness.query_by_label("lamp").map(|it| it.rect().center());
        let lamp = lamp.map(|line| {
            harness.get_by_label("lamp").click();
            harness.run_steps(3);
            let handle = harness.get_by_label("Move light across the view");
            Lamp {
                line,
                handle: handle.rect().center(),
            }
        });
        let layer = harness.get_by_label("random scratches").rect().center();
        harness.get_by_label("random scratches").click();
        harness.run_steps(3);
        // With the layer's panel open: it may be wider.
        let picture = harness.get_by_label("Picture").rect();
        let width = harness
            .get_all_by_role(Role::SpinButton)
            .find(|node| {
                node.accesskit_node()
                    .labelled_by()
                    .any(|label| label.value().as_deref() == Some("Width"))
            })
            .expect("a box for the width")
            .rect()
            .center();
        Self {
            picture,
            layer,
            width,
            lamp,
        }
    }

    pub fn picture(&self) -> Rect {
        self.picture
    }

    /// The line of the layer in the outliner.
    pub fn layer(&self) -> Pos2 {
        self.layer
    }

    /// The box of the layer's width, once the layer is selected.
    pub fn width(&self) -> Pos2 {
        self.width
    }

    /// The light called "lamp", if there is one.
    pub fn lamp(&self) -> Option<Lamp> {
        self.lamp
    }
}

//! Where the window looks from: through the scene's camera, or from a place of its own, which changes nothing in the scene.
//!
//! Whoever turns, moves or frames the view leaves the scene's camera where it is, and can go back to it or bring it along. The
//! free view has the camera's up and exposure.

use glam::DVec3;
use hairline_editor::{DragKey, navigate};
use hairline_scene::description::Camera;

use crate::app::Viewer;

/// A turntable goes round in this time, seconds.
const ROUND_S: f64 = 12.0;

/// The view, if it is not that of the scene's camera.
#[derive(Default)]
pub(crate) struct FreeView {
    camera: Option<Camera>,
    /// Whether navigation moves the scene's camera.
    moves_camera: bool,
    /// Whether it goes round.
    turns: bool,
}

/// A wish about where to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ViewCommand {
    LookThroughCamera,
    SetCameraToView,
    /// Whether navigation moves the scene's camera.
    MoveCamera,
    Turntable,
    Bookmark,
    NextBookmark,
}

impl FreeView {
    pub fn is_free(&self) -> bool {
        self.camera.is_some()
    }

    pub fn turns(&self) -> bool {
        self.turns
    }

    /// Looks through the scene's camera again.
    pub fn end(&mut self) {
        self.camera = None;
        self.turns = false;
    }

    /// Ends the turntable; whether there was one.
    pub fn stop(&mut self) -> bool {
        std::mem::take(&mut self.turns)
    }
}

impl Viewer {
    /// The camera that the window looks through: the scene's, or that of a free view.
    pub fn camera(&self) -> Camera {
        let scene = &self.document.description().camera;
        match &self.free_view.camera {
            None => scene.clone(),
            Some(free) => Camera {
                up: scene.up,
                exposure_ev: scene.exposure_ev,
                ..free.clone()
            },
        }
    }

    /// The pinhole of it.
    pub(crate) fn eye_m(&self) -> DVec3 {
        self.camera().position_m.into()
    }

    /// Moves the view; the scene's camera where that is switched on, as a step, all of a drag of `key` being one.
    pub(crate) fn move_view(
        &mut self,
        label: &str,
        key: Option<DragKey>,
        change: impl FnOnce(&mut Camera),
    ) {
        self.free_view.turns = false;
        if self.free_view.moves_camera {
            match key {
                Some(key) => self.document.drag(label, key, |d| change(&mut d.camera)),
                None => self.document.edit(label, |d| change(&mut d.camera)),
            }
            return;
        }
        let mut camera = self.camera();
        change(&mut camera);
        self.look_from(camera);
    }

    /// Looks from there; nothing changes where that is where the window looks from already.
    fn look_from(&mut self, camera: Camera) {
        if camera != self.camera() {
            self.free_view.camera = Some(camera);
        }
    }

    pub(crate) fn change_view(&mut self, command: ViewCommand) {
        match command {
            ViewCommand::LookThroughCamera => self.free_view.end(),
            ViewCommand::SetCameraToView => {
                let camera = self.camera();
                self.document
                    .edit("Set the camera to the view", |d| d.camera = camera);
                self.free_view.end();
            }
            ViewCommand::MoveCamera => {
                self.free_view.moves_camera = !self.free_view.moves_camera;
                if self.free_view.moves_camera {
                    self.free_view.end();
                }
            }
            ViewCommand::Turntable => {
                self.free_view.turns = !self.free_view.turns;
            }
            ViewCommand::Bookmark => {
                let name = self.bookmarks.add(self.camera());
                self.notices.note(
                    "bookmark",
                    format!("{name} is kept; the camera's panel has the list."),
                );
            }
            ViewCommand::NextBookmark => {
                let list = self.bookmarks.list();
                let here = self.camera();
                let is_here = |camera: &Camera| {
                    camera.position_m == here.position_m && camera.target_m == here.target_m
                };
                let at = list.iter().position(|bookmark| is_here(&bookmark.camera));
                match list.len() {
                    0 => self.notices.note("bookmark", "No view is kept yet."),
                    len => self.go_to_bookmark(at.map_or(0, |at| (at + 1) % len)),
                }
            }
        }
    }

    /// Whether a switch is on; none for what is no switch.
    pub(crate) fn views(&self, command: ViewCommand) -> Option<bool> {
        match command {
            ViewCommand::LookThroughCamera => Some(!self.free_view.is_free()),
            ViewCommand::MoveCamera => Some(self.free_view.moves_camera),
            ViewCommand::Turntable => Some(self.free_view.turns),
            _ => None,
        }
    }

    /// Looks from a view that was kept.
    pub(crate) fn go_to_bookmark(&mut self, index: usize) {
        if let Some(bookmark) = self.bookmarks.list().get(index) {
            let camera = bookmark.camera.clone();
            let label = format!("Go to {}", bookmark.name);
            self.move_view(&label, None, |view| {
                *view = Camera {
                    up: view.up,
                    exposure_ev: view.exposure_ev,
                    ..camera
                };
            });
        }
    }

    /// Turns the view while the turntable goes round.
    pub(crate) fn turn_view(&mut self, ctx: &egui::Context) {
        if !self.free_view.turns {
            return;
        }
        // A pass that took long is no reason for a jump.
        let dt_s = ctx.input(|input| f64::from(input.stable_dt)).min(0.25);
        let mut camera = self.camera();
        navigate::turn(&mut camera, std::f64::consts::TAU * dt_s / ROUND_S);
        self.look_from(camera);
        ctx.request_repaint();
    }
}

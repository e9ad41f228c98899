//! Camera of the window, and its movements.

use glam::DVec3;
use hairline_document::description::Camera;
use hairline_document::navigate;
use hairline_editor::DragKey;

use super::Workspace;
use crate::free_view::ViewCommand;

/// A turntable goes round in this time, seconds.
const ROUND_S: f64 = 12.0;

impl Workspace {
    /// The camera that the window looks through: the scene's, or that of a free view.
    pub fn camera(&self) -> Camera {
        let scene = &self.document.description().camera;
        match &self.free_view.camera {
            None => scene.clone(),
            Some(free) => Camera {
                focus_distance_m: self.free_focus_m(free),
                ..scene.moved_to(free)
            },
        }
    }

    /// Distance at which a free view is in focus: the sharp point stays sharp while the view moves. None: at its
    /// target.
    fn free_focus_m(&self, free: &Camera) -> Option<f64> {
        let scene = &self.document.description().camera;
        scene.aperture_mm?;
        let of_scene = scene.focus_distance_m;
        let focused_m = self.free_view.focused_m;
        let point_m = focused_m.or(of_scene.map(|_| navigate::focused_m(scene)))?;
        navigate::depth_m(free, point_m).or(of_scene)
    }

    /// Puts a point in focus.
    pub fn focus_on(&mut self, point_m: DVec3) {
        let camera = self.camera();
        if camera.aperture_mm.is_none() {
            let text = "Depth of field is off, so all is in focus: switch it on in the camera's panel first.";
            self.notices.error("focus", text);
            return;
        }
        let Some(depth_m) = navigate::depth_m(&camera, point_m) else {
            return;
        };
        self.notices.clear("focus");
        if self.free_view.is_free() {
            self.free_view.focused_m = Some(point_m);
        } else {
            // To the micrometre, in a file that people read.
            let depth_m = (1e6 * depth_m).round() / 1e6;
            self.document.edit("Focus here", |d| {
                d.camera.focus_distance_m = Some(depth_m);
            });
        }
    }

    /// Pinhole of the view's camera.
    pub fn eye_m(&self) -> DVec3 {
        self.camera().position_m.into()
    }

    /// Moves the view; the scene's camera where that is switched on, as a step, all of a drag of `key` being one.
    pub fn move_view(
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

    pub fn change_view(&mut self, command: ViewCommand) {
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

    /// Looks from a view that was kept.
    pub fn go_to_bookmark(&mut self, index: usize) {
        if let Some(bookmark) = self.bookmarks.list().get(index) {
            let camera = bookmark.camera.clone();
            let label = format!("Go to {}", bookmark.name);
            self.move_view(&label, None, |view| {
                *view = view.moved_to(&camera);
            });
        }
    }

    /// Turns the view while the turntable goes round.
    pub fn turn_view(&mut self, ctx: &egui::Context) {
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

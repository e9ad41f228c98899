//! Camera of the window: the scene's, or a free one of its own, which changes nothing in the scene.
//!
//! Whoever turns, moves or frames the view leaves the scene's camera where it is, and can go back to it or bring it along. The
//! free view has the camera's up and exposure.

use glam::DVec3;
use hairline_document::description::Camera;

/// The view, if it is not that of the scene's camera.
#[derive(Default)]
pub(crate) struct FreeView {
    pub camera: Option<Camera>,
    /// Point in focus, chosen in the view; none: the point in focus of the scene's camera.
    pub focused_m: Option<DVec3>,
    /// Whether navigation moves the scene's camera.
    pub moves_camera: bool,
    /// Whether it goes round.
    pub turns: bool,
}

/// A command about where to look from.
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

    /// Looks through the scene's camera again.
    pub fn end(&mut self) {
        (self.camera, self.focused_m) = (None, None);
        self.turns = false;
    }

    /// Ends the turntable; whether there was one.
    pub fn stop(&mut self) -> bool {
        std::mem::take(&mut self.turns)
    }

    /// Whether a switch is on; none for commands that are no switch.
    pub fn is_on(&self, command: ViewCommand) -> Option<bool> {
        match command {
            ViewCommand::LookThroughCamera => Some(!self.is_free()),
            ViewCommand::MoveCamera => Some(self.moves_camera),
            ViewCommand::Turntable => Some(self.turns),
            _ => None,
        }
    }
}

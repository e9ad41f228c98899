//! Snapshots of the look: the whole description with its picture, to flip to, to lay beside the current look and to come back to.
//!
//! They are kept in memory for as long as the scene is open, and are no part of its file.

mod overlay;
mod strip;

use std::path::PathBuf;
use std::sync::Arc;

use hairline_editor::Document;
use hairline_scene::Description;

use crate::engine::{Frame, View};
use crate::notices::Notices;
use crate::seen::makes_same_scene;
use crate::viewport::canvas::CanvasTexture;

/// Largest number of snapshots: the picture of a window takes some megabytes.
const MOST: usize = 24;

/// All snapshots, and which is being looked at.
pub(crate) struct Snapshots {
    list: Vec<Snapshot>,
    /// Number of all snapshots that were ever taken, from which names are made.
    taken: usize,
    /// Index of the one that was chosen last.
    chosen: Option<usize>,
    /// Whether the chosen snapshot is shown, in the way of `way`.
    is_shown: bool,
    way: Way,
    /// Position of the divider from 0, left, to 1.
    divider: f32,
    /// Upper edge of the strip in the last pass, points.
    strip_top: f32,
}

impl Default for Snapshots {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            taken: 0,
            chosen: None,
            is_shown: false,
            way: Way::Flip,
            divider: 0.5,
            strip_top: f32::INFINITY,
        }
    }
}

hairline_image::listed! {
    /// Display of a snapshot.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Way {
        Flip = "Flip";
        SideBySide = "Side by side";
        Slider = "Slider";
    }
    fn name;
}

/// One look.
struct Snapshot {
    name: String,
    description: Arc<Description>,
    /// Folder of the scene when it was taken.
    base_dir: PathBuf,
    view: View,
    /// Picture of the snapshot; none until the first one is there.
    frame: Option<Arc<Frame>>,
    canvas: CanvasTexture,
}

impl Snapshot {
    /// Takes over a picture of the snapshot's look, unless the snapshot has a finished one.
    fn see(&mut self, frame: &Arc<Frame>) {
        let is_finished = |frame: &Frame| frame.painted.is_final;
        if self.frame.as_deref().is_some_and(is_finished) {
            return;
        }
        let is_of_this = frame.view == self.view
            && makes_same_scene(&frame.built.description, &self.description);
        if is_of_this {
            self.frame = Some(Arc::clone(frame));
        }
    }
}

impl Snapshots {
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Shows the one that was chosen last, or the current look again.
    pub fn flip(&mut self) {
        self.chosen = self.chosen.or(self.list.len().checked_sub(1));
        self.is_shown = !self.is_shown && self.chosen.is_some();
    }

    /// Shows the current look.
    pub fn show_current(&mut self) {
        self.is_shown = false;
    }

    /// Whether the snapshot covers the whole picture.
    pub fn cover(&self) -> bool {
        self.is_shown && self.way != Way::Slider
    }

    fn shown(&mut self) -> Option<&mut Snapshot> {
        let chosen = self.chosen.filter(|_| self.is_shown)?;
        self.list.get_mut(chosen)
    }

    fn choose(&mut self, index: usize) {
        self.is_shown = self.chosen != Some(index) || !self.is_shown;
        self.chosen = Some(index);
    }

    fn delete(&mut self, index: usize) {
        self.list.remove(index);
        self.is_shown &= self.chosen != Some(index);
        self.chosen = match self.chosen {
            Some(chosen) if chosen > index => Some(chosen - 1),
            Some(chosen) if chosen == index => None,
            other => other,
        };
    }

    /// Keeps the current look, to be drawn by `canvas`. Its picture is the newest one of it, until a finished one is there.
    pub fn take(
        &mut self,
        document: &Document,
        view: View,
        canvas: CanvasTexture,
        notices: &mut Notices,
    ) {
        if self.list.len() == MOST {
            let text = format!("{MOST} snapshots are kept at most: delete one first.");
            notices.error("snapshot", text);
            return;
        }
        notices.clear("snapshot");
        self.taken += 1;
        self.list.push(Snapshot {
            name: format!("Look {}", self.taken),
            description: Arc::clone(document.description()),
            base_dir: document.base_dir().to_owned(),
            view,
            frame: None,
            canvas,
        });
        self.chosen = Some(self.list.len() - 1);
        self.is_shown = false;
    }

    /// Makes a look the current one again, as one step of undo.
    fn restore(&mut self, index: usize, document: &mut Document) {
        let Some(snapshot) = self.list.get(index) else {
            return;
        };
        let restored = document.brought_here(&snapshot.description, &snapshot.base_dir);
        let label = format!("Restore {}", snapshot.name);
        document.edit(&label, |description| *description = restored);
        self.chosen = Some(index);
        self.is_shown = false;
    }
}

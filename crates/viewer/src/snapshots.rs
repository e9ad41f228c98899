//! Snapshots of the look: the whole description with its picture, to flip to, to lay beside the current look and to come back to.
//!
//! They belong to the scene's file, and are kept beside it; those of a scene without a file are written when it gets one.

mod overlay;
mod stored;
mod strip;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use egui::ColorImage;
use hairline_document::Description;
use hairline_editor::Document;

use crate::notices::Notices;
use crate::platform::HAS_DISK;
use crate::progressive::{Frame, Picture, View};
use crate::seen::makes_same_scene;
use crate::viewport::canvas::CanvasTexture;

/// Largest number of snapshots: the picture of a window takes some megabytes.
const MOST: usize = 24;

/// All snapshots, and which is being looked at.
pub(crate) struct Snapshots {
    list: Vec<Snapshot>,
    /// Folder where they are kept; none while the scene has no file.
    folder: Option<PathBuf>,
    /// Pictures of looks that were kept, as they are read.
    read: Option<Receiver<(String, Arc<ColorImage>)>>,
    /// Number of all snapshots that were ever taken, from which names are made.
    taken: usize,
    /// Index of the one that was chosen last.
    chosen: Option<usize>,
    /// Whether the chosen snapshot is shown, as `mode` says.
    is_shown: bool,
    mode: CompareMode,
    /// Position of the divider from 0, left, to 1.
    divider: f32,
    /// Upper edge of the strip in the last pass, points.
    strip_top: f32,
}

impl Default for Snapshots {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            folder: None,
            read: None,
            taken: 0,
            chosen: None,
            is_shown: false,
            mode: CompareMode::Flip,
            divider: 0.5,
            strip_top: f32::INFINITY,
        }
    }
}

hairline_image::listed! {
    /// Display of a snapshot.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum CompareMode {
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
    /// View that it was taken in; none of one that was read.
    view: Option<View>,
    size_px: [u32; 2],
    /// Picture of the snapshot; none until the first one is there.
    picture: Option<Seen>,
    canvas: CanvasTexture,
}

/// The picture of a snapshot.
#[derive(Clone)]
struct Seen {
    /// Number of the frame that it was in.
    number: u64,
    picture: Picture,
    is_final: bool,
}

impl Snapshot {
    /// Takes over a picture of the snapshot's look, unless the snapshot has a finished one; whether it is to be kept.
    fn see(&mut self, frame: &Frame) -> bool {
        let before = self.picture.as_ref().map(|seen| seen.is_final);
        let is_of_this = before != Some(true)
            && self.view == Some(frame.view)
            && makes_same_scene(&frame.built.description, &self.description);
        if is_of_this {
            self.picture = Some(Seen {
                number: frame.number,
                picture: frame.picture.clone(),
                is_final: frame.painted.is_final,
            });
        }
        is_of_this && (before.is_none() || frame.painted.is_final)
    }

    fn keep_picture(&self, folder: &Path) {
        if let Some(seen) = &self.picture
            && let Some(pixels) = self.canvas.pixels(&seen.picture)
        {
            stored::write_picture(folder, &self.name, pixels);
        }
    }

    fn keep(&self, folder: &Path, notices: &mut Notices) {
        match stored::write(folder, &self.name, &self.description, &self.base_dir) {
            Ok(()) => self.keep_picture(folder),
            Err(error) => notices.error("snapshot", format!("The snapshot is not kept: {error}.")),
        }
    }

    /// Its picture as a texture.
    fn texture(&mut self, ctx: &egui::Context) -> Option<egui::TextureId> {
        let seen = self.picture.as_ref()?;
        self.canvas.texture_of(ctx, seen.number, &seen.picture)
    }
}

impl Snapshots {
    /// Those that are kept beside a scene's file, to be drawn by others like `canvas`.
    pub fn open(scene: Option<&Path>, canvas: &CanvasTexture, ctx: &egui::Context) -> Self {
        let Some(folder) = scene.filter(|_| HAS_DISK).map(stored::folder) else {
            return Self::default();
        };
        let list: Vec<_> = stored::read(&folder)
            .into_iter()
            .take(MOST)
            .map(|stored| Snapshot {
                size_px: stored.description.render.size_px,
                name: stored.name,
                description: stored.description,
                base_dir: folder.clone(),
                view: None,
                picture: None,
                canvas: canvas.another(),
            })
            .collect();
        let numbers = list
            .iter()
            .filter_map(|it| it.name.rsplit(' ').next()?.parse().ok());
        let names: Vec<_> = list.iter().map(|it| it.name.clone()).collect();
        Self {
            taken: numbers.max().unwrap_or(0),
            read: (!names.is_empty()).then(|| stored::read_pictures(&folder, names, ctx.clone())),
            list,
            folder: Some(folder),
            ..Self::default()
        }
    }

    /// The scene was saved under a name: its snapshots go with it.
    pub fn saved_as(&mut self, scene: &Path, notices: &mut Notices) {
        let folder = stored::folder(scene);
        if HAS_DISK && self.folder.as_ref() != Some(&folder) {
            for snapshot in &self.list {
                snapshot.keep(&folder, notices);
            }
            self.folder = Some(folder);
        }
    }

    /// Takes over pictures: the newest one, and those that were read.
    fn see(&mut self, frame: &Frame) {
        for snapshot in &mut self.list {
            if snapshot.see(frame)
                && let Some(folder) = &self.folder
            {
                snapshot.keep_picture(folder);
            }
        }
        for (name, pixels) in self.read.iter().flat_map(Receiver::try_iter) {
            if let Some(snapshot) = self.list.iter_mut().find(|it| it.name == name) {
                snapshot.size_px = pixels.size.map(|side| side as u32);
                snapshot.picture = Some(Seen {
                    number: 0,
                    picture: Picture::Pixels(pixels),
                    is_final: true,
                });
            }
        }
    }

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
        self.is_shown && self.mode != CompareMode::Slider
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
        let removed = self.list.remove(index);
        if let Some(folder) = &self.folder {
            stored::remove(folder, &removed.name);
        }
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
        let snapshot = Snapshot {
            name: format!("Snapshot {}", self.taken),
            description: Arc::clone(document.description()),
            base_dir: document.base_dir().to_path_buf(),
            size_px: view.size_px,
            view: Some(view),
            picture: None,
            canvas,
        };
        if let Some(folder) = &self.folder {
            snapshot.keep(folder, notices);
        }
        self.list.push(snapshot);
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

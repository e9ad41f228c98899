//! Workspace of all panels: the edited scene, its renderer, its view, and messages about it.

mod engrave;
mod fit;
mod give;
mod list;
mod looks;
mod own;
mod view;

use std::path::{Path, PathBuf};

use hairline_document::description::{FileUse, Map};
use hairline_document::{Description, Error};
use hairline_editor::actions::layers;
use hairline_editor::actions::pictures::PictureOf;
use hairline_editor::bookmarks::Bookmarks;
use hairline_editor::own_presets::OwnPresets;
use hairline_editor::settings::Settings;
use hairline_editor::{ActionError, Document, DragKey, Selection, actions};
use hairline_scene::Transport;

use crate::command::Command;
use crate::examples::Examples;
use crate::files::is_same;
use crate::free_view::FreeView;
use crate::gallery::Gallery;
use crate::looks::Looks;
use crate::measure::Measure;
use crate::notices::Notices;
use crate::overlays::Overlays;
use crate::platform::{HAS_PAGE, HAS_THREADS};
use crate::progressive::{Backend, ProgressiveRenderer};
use crate::reading::ReadingState;
use crate::snapshots::Snapshots;
use crate::tools::{Tool, Toolbox};

/// Reason why some layers are no presets.
pub(crate) const NO_PRESET: &str = "A preset is made of a material, a light, or scratches that a pattern lays. Scratches that were drawn, engraved or listed lie where they lie: select another part.";

/// Workspace of all panels. It knows no panel: whoever shows a part of it takes it.
pub(crate) struct Workspace {
    pub document: Document,
    pub renderer: ProgressiveRenderer,
    pub notices: Notices,
    pub toolbox: Toolbox,
    /// Part of the picture's area that is rendered before the rest, in shares of it.
    pub region: Option<egui::Rect>,
    pub reading: ReadingState,
    pub measure: Measure,
    pub free_view: FreeView,
    /// Shadows and bounces in this window; no part of the scene.
    pub transport: Transport,
    pub overlays: Overlays,
    pub gallery: Gallery,
    pub examples: &'static Examples,
    pub bookmarks: Bookmarks,
    pub settings: Settings,
    pub own_presets: OwnPresets,
    pub snapshots: Snapshots,
    pub looks: Looks,
    /// Opening in millimetres and focus of the camera when depth of field was switched off, to be taken up again.
    pub closed_lens: Option<(f64, Option<f64>)>,
    /// Files that the scene names and that were not there when it was to be built.
    pub missing: Vec<(FileUse, PathBuf)>,
    /// Notes on the scene's models that were shown last.
    pub model_notes: Vec<String>,
    /// The picture whose file a panel wants to be chosen.
    pub wanted_picture: Option<PictureOf>,
    /// Commands of panels, to be run once all panels are shown.
    pub requested: Vec<Command>,
    /// Command to be run once the objects are built as they are described.
    pub requested_when_built: Option<Command>,
}

impl Workspace {
    /// Selected part.
    pub fn selection(&self) -> Selection {
        self.document.selection()
    }

    /// Applies an action as one step, or shows why it was refused.
    pub fn apply(
        &mut self,
        label: &str,
        action: impl FnOnce(&mut Description, Selection) -> Result<Selection, ActionError>,
    ) {
        match self.document.apply(label, action) {
            Ok(()) => {
                self.notices.clear("action");
                self.notices.clear("change");
            }
            Err(error) => self.notices.error("action", error.to_string()),
        }
    }

    /// Changes the scene as part of a drag, as [`Document::drag`] does; or tells which number a scene file could not hold, and changes
    /// nothing: an edited scene can be saved and loaded.
    pub fn drag(&mut self, label: &str, key: DragKey, change: impl FnOnce(&mut Description)) {
        let before = self.document.description();
        let mut changed = Description::clone(before);
        change(&mut changed);
        match flaw(&changed) {
            // An error that was there before is not this change's.
            Some(error) if flaw(before).as_ref() != Some(&error) => {
                let why = format!("{label}: {}.", error.found_and_right());
                self.notices.error("change", why);
            }
            _ => {
                self.notices.clear("change");
                self.document.drag(label, key, |d| *d = changed);
            }
        }
    }

    /// Whether there is an object to lay something on; else the window asks for one.
    pub fn has_object(&mut self) -> bool {
        let is_there = !self.document.description().objects.is_empty();
        if !is_there {
            let text = "Add an object first: scratches lie on objects.";
            self.notices.note("action", text);
        }
        is_there
    }

    /// Sets the map around the scene, or none.
    pub fn set_environment(&mut self, label: &str, map: Option<Map>) {
        let base_dir = self.document.base_dir().to_owned();
        self.apply(label, |d, _| {
            Ok(actions::set_environment(d, map, &base_dir))
        });
    }

    /// Asks for the file of a picture, if one is wanted.
    pub fn choose_picture(&mut self, wanted: Option<PictureOf>) {
        self.wanted_picture = wanted.or(self.wanted_picture);
    }

    /// Takes the scene from its file; `why` ends the sentence that tells of it.
    pub fn reload(&mut self, why: &str) {
        match self.document.reload() {
            Ok(()) => {
                self.notices.clear("open");
                let text = format!("{} {why}", self.document.title());
                self.notices.note("reloaded", text);
                self.tell_notes();
            }
            Err(error) => self.notices.error("open", error.to_string()),
        }
    }

    /// Tells the notes on the scene file for its author.
    pub fn tell_notes(&mut self) {
        let notes = &self.document.description().notes;
        if !notes.is_empty() {
            let text = notes.join("\n");
            eprintln!("note: {text}");
            self.notices.note("notes", text);
        }
    }

    /// Tells, once, the contents of the newest scene's models that the picture does not have.
    pub fn tell_model_notes(&mut self) {
        let Some(built) = self.renderer.built() else {
            return;
        };
        let is_of_model = |note: &&String| !built.description.notes.contains(note);
        let notes = built.scene.notes.iter().filter(is_of_model);
        if notes.clone().ne(&self.model_notes) {
            self.model_notes = notes.cloned().collect();
            for note in &self.model_notes {
                eprintln!("note: {note}");
            }
            match self.model_notes.is_empty() {
                true => self.notices.clear("models"),
                false => {
                    let titled = |note: &String| with_title(&built.description, note);
                    let notes: Vec<_> = self.model_notes.iter().map(titled).collect();
                    self.notices.note("models", notes.join("\n"));
                }
            }
        }
    }

    /// Whether a path leads to the document's file.
    pub fn is_own_file(&self, path: &Path) -> bool {
        self.document.path().is_some_and(|own| is_same(own, path))
    }

    /// Transport of light that the window orders.
    pub fn wanted_transport(&self) -> Transport {
        match self.transport.shadows {
            true => self.transport,
            false => Transport::DIRECT,
        }
    }

    /// Whether the command has something to work on.
    pub fn can(&self, command: Command) -> bool {
        let selection = self.selection();
        match command {
            _ if !command.is_here() => false,
            Command::Gallery => HAS_PAGE || !self.examples.scenes.is_empty(),
            // A page would stand still until the CPU has rendered all of a picture.
            Command::Screenshot => HAS_THREADS || !matches!(self.renderer.backend(), Backend::Cpu),
            Command::Undo | Command::Delete if self.toolbox.lone_point().is_some() => true,
            Command::Undo => self.document.undo_label().is_some(),
            Command::Redo => self.document.redo_label().is_some(),
            Command::Rename
            | Command::Duplicate
            | Command::Delete
            | Command::MoveUp
            | Command::MoveDown => {
                matches!(
                    selection,
                    Selection::Object(_)
                        | Selection::Layer(_)
                        | Selection::Grating(_)
                        | Selection::Light(_)
                        | Selection::Material(_)
                        | Selection::Look(_)
                )
            }
            Command::ToggleHidden => {
                matches!(
                    selection,
                    Selection::Object(_)
                        | Selection::Layer(_)
                        | Selection::Grating(_)
                        | Selection::Light(_)
                        | Selection::Studio
                        | Selection::Ground
                )
            }
            Command::SavePreset => self.preset_name().is_some(),
            Command::WholePicture => self.region.is_some(),
            Command::FlipSnapshot => !self.snapshots.is_empty(),
            Command::NextLook => !self.document.description().looks.is_empty(),
            Command::ToggleSolo | Command::ListScratches | Command::SaveList => {
                matches!(selection, Selection::Layer(_))
            }
            Command::Deselect => selection != Selection::None || self.toolbox.tool != Tool::Select,
            Command::Reload => self.document.path().is_some(),
            Command::Revert => self.document.can_revert(),
            _ => true,
        }
    }

    /// Reason why a command has nothing to work on, where the window does not show it.
    pub fn why_not(&self, command: Command) -> Option<&'static str> {
        match command {
            Command::SavePreset => Some(NO_PRESET),
            Command::ListScratches | Command::SaveList => {
                Some("Select a layer of scratches first.")
            }
            _ => None,
        }
    }

    /// Whether a switch is on; none for commands that are no switch.
    pub fn is_on(&self, command: Command) -> Option<bool> {
        match command {
            Command::Read(command) => self.reading.is_on(command),
            Command::View(command) => self.free_view.is_on(command),
            Command::Overlay(overlay) => Some(self.overlays.is_on(overlay)),
            Command::Overlays => Some(!self.overlays.are_hidden()),
            Command::Shadows => Some(self.transport.shadows),
            Command::Pause => Some(self.renderer.is_paused()),
            Command::ListScratches => Some(self.measure.has_list),
            Command::HighContrast => Some(self.settings.high_contrast()),
            _ => None,
        }
    }
}

/// Error of a scene that its file could not hold.
fn flaw(description: &Description) -> Option<Error> {
    let is_right = description.check();
    is_right.and_then(|()| description.check_references()).err()
}

/// A message about a scene with the title of a layer, as the list has it, in the place of its number.
pub(crate) fn with_title(description: &Description, message: &str) -> String {
    let titled = || {
        let (number, rest) = message.strip_prefix("scratches[")?.split_once(']')?;
        let layer = description.scratches.get(number.parse::<usize>().ok()?)?;
        let rest = rest.trim_start_matches(['.', ':', ' ']);
        Some(format!("layer \"{}\": {rest}", layers::title(layer)))
    };
    titled().unwrap_or_else(|| message.to_owned())
}

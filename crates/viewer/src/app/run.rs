//! Effects of commands.

use egui::ViewportCommand;
use hairline_document::navigate;
use hairline_editor::Selection;
use hairline_editor::actions::{layers, parts};

use super::Viewer;
use crate::command::{self, Command};
use crate::dialogs::{Choice, PendingAction, PresetLine, Question};
use crate::files::Purpose;
use crate::free_view::ViewCommand;
use crate::panels;
use crate::platform::{self, HAS_PAGE};
use crate::reading::ReadCommand;
use crate::tools::{BEGIN_LINE, Tool};

/// Factor of a press of a bracket on the brush.
const BRUSH_STEP: f64 = 1.25;

impl Viewer {
    /// Runs a command, or shows why it cannot be run.
    pub(super) fn run(&mut self, ctx: &egui::Context, command: Command) {
        if !self.work.can(command) {
            if let Some(why) = self.work.why_not(command) {
                self.work.notices.note("command", why);
            }
            return;
        }
        match command {
            Command::New => self.request(ctx, PendingAction::New),
            Command::Gallery if HAS_PAGE => platform::show_gallery(),
            Command::Gallery => {
                let choice = Choice::new(self.work.examples);
                self.dialogs.ask(Question::Examples(choice));
            }
            Command::Open => self.ask_path(ctx, Purpose::Open),
            Command::Save => self.save(ctx),
            Command::SaveAs => self.ask_path(ctx, Purpose::SaveAs),
            Command::CopyLink => self.copy_link(ctx),
            Command::Reload => self.request_reload(),
            Command::Revert => self.revert(),
            Command::AddModel => self.ask_path(ctx, Purpose::AddModel),
            Command::SetEnvironment => self.ask_path(ctx, Purpose::Environment),
            Command::Screenshot => self.export.ask(&mut self.work, Purpose::Screenshot),
            Command::Turntable => self.export.ask(&mut self.work, Purpose::Turntable),
            Command::ExportModel => self.ask_path(ctx, Purpose::ExportModel),
            Command::SaveList => self.ask_path(ctx, Purpose::ScratchList),
            Command::ListScratches => {
                let measure = &mut self.work.measure;
                (measure.has_list, measure.reveals) = (!measure.has_list, true);
            }
            Command::Compare => self.compare.toggle(),
            Command::TakeSnapshot => self.take_snapshot(),
            Command::FlipSnapshot => self.work.snapshots.flip(),
            Command::KeepLook => self.work.keep_look(),
            Command::NextLook => self.work.take_next_look(),
            Command::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            // The lone point of the pen is newer than any step.
            Command::Undo | Command::Delete if self.work.toolbox.take_lone_point() => {
                (self.work.notices).note("undo", "The first point is taken away.");
            }
            Command::Undo => {
                self.work.snapshots.show_current();
                if let Some(label) = self.work.document.undo() {
                    if label == BEGIN_LINE {
                        self.work.toolbox.begun = self.work.toolbox.first.take();
                    }
                    self.work.notices.note("undo", format!("Undone: {label}"));
                }
            }
            Command::Redo => {
                self.work.snapshots.show_current();
                self.work.toolbox.begun = None;
                if let Some(label) = self.work.document.redo() {
                    let text = format!("Done again: {label}");
                    self.work.notices.note("undo", text);
                }
            }
            Command::Rename => {
                self.hides_inspector = false;
                panels::form::name_anew(ctx);
            }
            Command::Duplicate
            | Command::Delete
            | Command::MoveUp
            | Command::MoveDown
            | Command::ToggleHidden
            | Command::ToggleSolo => self.on_selection(command),
            Command::LightForScratches => self.work.light_for_scratches(),
            Command::SavePreset => self.ask_preset_name(),
            Command::FrameAll => self.work.frame(None),
            Command::FrameSelection => self.work.frame_selection(),
            Command::FocusHere => match self.viewport.pointed_m(&self.work) {
                Some(point_m) => self.work.focus_on(point_m),
                None => self.work.notices.note(
                    "focus",
                    "Point at what is to be sharp and press Shift+F, or click it with the right button.",
                ),
            },
            Command::ToggleList => self.hides_list = !self.hides_list,
            Command::ToggleInspector => self.hides_inspector = !self.hides_inspector,
            Command::FullScreen => {
                let is_full = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
            }
            Command::Look(viewpoint) => self.work.move_view(command.label(), None, |camera| {
                navigate::look_from(camera, viewpoint)
            }),
            Command::Pick(tool) => self.work.toolbox.tool = tool,
            Command::BrushSmaller => self.work.scale_brush(1.0 / BRUSH_STEP),
            Command::BrushLarger => self.work.scale_brush(BRUSH_STEP),
            Command::EngraveText | Command::EngraveDrawing | Command::AddList
                if !self.work.has_object() => {}
            Command::EngraveText => self.work.engrave_text(),
            Command::EngraveDrawing => self.ask_path(ctx, Purpose::Drawing),
            Command::AddList => self.ask_path(ctx, Purpose::AddList),
            // One thing at a time: the tool first.
            Command::Deselect if self.work.toolbox.tool != Tool::Select => {
                self.work.toolbox.tool = Tool::Select;
            }
            Command::Deselect => self.work.document.select(Selection::None),
            Command::Help => self.dialogs.show_help(),
            Command::Read(command) => self.work.reading.run(command),
            Command::View(command) => self.work.change_view(command),
            Command::Overlay(overlay) => self.work.overlays.toggle(overlay),
            Command::Overlays => self.work.overlays.toggle_all(),
            Command::HighContrast => {
                let is_high = !self.work.settings.high_contrast();
                self.work.settings.set_high_contrast(is_high);
                crate::style::set(ctx, is_high);
            }
            Command::Pause => self.work.renderer.set_paused(!self.work.renderer.is_paused()),
            Command::WholePicture => self.work.region = None,
            Command::Shadows => self.work.transport.shadows = !self.work.transport.shadows,
        }
    }

    /// Tells for a moment what a plain key did: it may have been typed for a text.
    pub(super) fn tell_key(&mut self, command: Command) {
        // They are seen, or tell of themselves.
        let is_told = matches!(
            command,
            Command::Deselect
                | Command::Rename
                | Command::Help
                | Command::FocusHere
                | Command::View(ViewCommand::NextBookmark)
        );
        let keys = command.shortcut().filter(|keys| !keys.modifiers.command);
        let Some(keys) = keys.filter(|_| !is_told) else {
            return;
        };
        let label = command.label();
        let what = match (command, self.work.is_on(command)) {
            (
                Command::Read(
                    ReadCommand::Brighter | ReadCommand::Darker | ReadCommand::ResetExposure,
                ),
                _,
            ) => format!(
                "Exposure {:+} EV in the window",
                self.work.reading.exposure_ev
            ),
            (Command::Look(_), _) => format!("View {}", label.to_lowercase()),
            (_, Some(true)) => format!("{label}: on"),
            (_, Some(false)) => format!("{label}: off"),
            _ => label.to_owned(),
        };
        let text = format!("{what} ({})", command::key_text(&keys));
        self.work.notices.glance("key", text);
    }

    fn ask_preset_name(&mut self) {
        if let Some(name) = self.work.preset_name() {
            let line = self.preset_line(name);
            self.dialogs.ask(Question::Preset(line));
        }
    }

    /// The line for the name of a preset of what is selected.
    pub(super) fn preset_line(&self, name: String) -> PresetLine {
        let work = &self.work;
        let list = work.own_presets.list().iter();
        let taken = list.map(|preset| preset.name.clone()).collect();
        let lights = work.document.description().lights.len();
        let lights = matches!(work.selection(), Selection::Light(_)).then_some(lights);
        PresetLine::new(name, taken, lights)
    }

    fn take_snapshot(&mut self) {
        let work = &mut self.work;
        if let Some(view) = work.renderer.view() {
            let canvas = self.viewport.canvas.another();
            work.snapshots
                .take(&work.document, view, canvas, &mut work.notices);
        }
    }

    fn on_selection(&mut self, command: Command) {
        self.work
            .apply(command.label(), |d, selection| match command {
                Command::Duplicate => parts::duplicate(d, selection),
                Command::Delete => parts::delete(d, selection, selection),
                Command::MoveUp => parts::shift(d, selection, -1, selection),
                Command::MoveDown => parts::shift(d, selection, 1, selection),
                Command::ToggleHidden => parts::toggle_hidden(d, selection),
                Command::ToggleSolo if let Selection::Layer(i) = selection => {
                    layers::toggle_solo(d, i)
                }
                _ => Ok(selection),
            });
    }
}

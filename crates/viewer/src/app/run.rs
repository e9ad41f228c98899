//! Effects of commands.

use egui::ViewportCommand;
use hairline_editor::actions::{gratings, layers, lights, materials, objects, studio};
use hairline_editor::{Selection, navigate};

use super::Viewer;
use crate::command::Command;
use crate::dialogs::Wish;
use crate::files::Purpose;
use crate::panels;
use crate::tools::Tool;

/// Factor of a press of a bracket on the brush.
const BRUSH_STEP: f64 = 1.25;

impl Viewer {
    /// Runs a command, or shows why it cannot be run.
    pub(super) fn run(&mut self, ctx: &egui::Context, command: Command) {
        if !self.work.can(command) {
            return;
        }
        match command {
            Command::New => self.wish(ctx, Wish::New),
            Command::Gallery => crate::platform::show_gallery(),
            Command::Open => self.ask_path(ctx, Purpose::Open),
            Command::Save => self.save(ctx),
            Command::SaveAs => self.ask_path(ctx, Purpose::SaveAs),
            Command::CopyLink => self.copy_link(ctx),
            Command::Reload => self.wish_reload(),
            Command::Revert => self.revert(),
            Command::AddModel => self.ask_path(ctx, Purpose::AddModel),
            Command::SetEnvironment => self.ask_path(ctx, Purpose::Environment),
            Command::Screenshot => self.export.ask(&mut self.work, Purpose::Screenshot),
            Command::Turntable => self.export.ask(&mut self.work, Purpose::Turntable),
            Command::Compare => self.compare.toggle(),
            Command::TakeSnapshot => self.take_snapshot(),
            Command::FlipSnapshot => self.work.snapshots.flip(),
            Command::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            Command::Undo => {
                if let Some(label) = self.work.document.undo() {
                    self.work.notices.note("undo", format!("Undone: {label}"));
                }
            }
            Command::Redo => {
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
            Command::Shadows => self.work.transport.shadows = !self.work.transport.shadows,
        }
    }

    fn take_snapshot(&mut self) {
        let work = &mut self.work;
        if let Some(view) = work.engine.view() {
            let canvas = self.viewport.canvas.another();
            work.snapshots
                .take(&work.document, view, canvas, &mut work.notices);
        }
    }

    fn on_selection(&mut self, command: Command) {
        use Selection as S;
        self.work.apply(command.label(), |d, selection| {
            Ok(match (command, selection) {
                (Command::Duplicate, S::Object(i)) => objects::duplicate(d, i)?,
                (Command::Duplicate, S::Layer(i)) => layers::duplicate(d, i)?,
                (Command::Duplicate, S::Grating(i)) => gratings::duplicate(d, i)?,
                (Command::Duplicate, S::Light(i)) => lights::duplicate(d, i)?,
                (Command::Duplicate, S::Material(i)) => materials::duplicate(d, i)?,
                (Command::Delete, S::Object(i)) => objects::delete(d, i, selection)?,
                (Command::Delete, S::Layer(i)) => layers::delete(d, i, selection)?,
                (Command::Delete, S::Grating(i)) => gratings::delete(d, i, selection)?,
                (Command::Delete, S::Light(i)) => lights::delete(d, i, selection)?,
                (Command::Delete, S::Material(i)) => materials::delete(d, i, selection)?,
                (Command::MoveUp | Command::MoveDown, _) => {
                    let by = if command == Command::MoveUp { -1 } else { 1 };
                    match selection {
                        S::Object(i) => objects::shift(d, i, by, selection)?,
                        S::Layer(i) => layers::shift(d, i, by, selection)?,
                        S::Grating(i) => gratings::shift(d, i, by, selection)?,
                        S::Light(i) => lights::shift(d, i, by, selection)?,
                        S::Material(i) => materials::shift(d, i, by, selection)?,
                        other => other,
                    }
                }
                (Command::ToggleHidden, S::Object(i)) => objects::toggle_hidden(d, i)?,
                (Command::ToggleHidden, S::Grating(i)) => gratings::toggle_hidden(d, i)?,
                (Command::ToggleHidden, S::Layer(i)) => layers::toggle_hidden(d, i)?,
                (Command::ToggleHidden, S::Light(i)) => lights::toggle_hidden(d, i)?,
                (Command::ToggleHidden, S::Studio) => studio::toggle_hidden(d),
                (Command::ToggleHidden, S::Ground) => studio::toggle_ground(d),
                (Command::ToggleSolo, S::Layer(i)) => layers::toggle_solo(d, i)?,
                (_, other) => other,
            })
        });
    }
}

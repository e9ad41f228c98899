//! One pass of the interface.

use std::path::PathBuf;

use egui::Ui;

use super::Viewer;
use crate::command::Command;
use crate::files::Purpose;
use crate::missing;
use crate::panels;
use crate::platform::HAS_DISK;

impl Viewer {
    /// One pass of the interface.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        if self.loss.reason().is_some() {
            self.leave_lost_window(&ctx);
            return;
        }
        self.hear(&ctx);
        let has_popup = egui::Popup::is_any_open(&ctx);
        self.viewport.shield(&ctx, has_popup);
        self.take_keys(&ctx, has_popup);
        self.show_panels(ui);
        let area = self.show_picture(ui);
        self.show_notices(&ctx, area);
        if !self.dialogs.is_modal()
            && let Some(purpose) = self.export.show_form(&ctx, &mut self.work)
        {
            self.ask_path(&ctx, purpose);
        }
        self.export.show(&ctx, &mut self.work, area);
        for command in std::mem::take(&mut self.work.requested) {
            self.run(&ctx, command);
        }
        self.show_dialogs(&ctx);
        crate::style::show_focus(&ctx);
        self.end_drag_where_nothing_is_held(&ctx);
        self.ask_engine();
        if let Some(pause) = self.work.renderer.work() {
            ctx.request_repaint_after(pause);
        }
        if let Some(failed) = self.files.autosave(&self.work.document) {
            let text = format!("No autosave: {failed}");
            self.work.notices.error("autosave", text);
        }
        self.watch_close(&ctx);
        self.was_typing = ctx.text_edit_focused();
        self.set_title(&ctx);
    }

    /// Takes what came since the last pass: of the renderer, of files and of questions.
    fn hear(&mut self, ctx: &egui::Context) {
        self.hear_engine();
        self.refuse_what_makes_no_scene(ctx);
        self.work.try_lamps();
        self.work.turn_view(ctx);
        // Files that are dropped onto a page are handled by the page.
        let dropped = if HAS_DISK {
            dropped_files(ctx)
        } else {
            Vec::new()
        };
        for path in dropped {
            self.take_file(ctx, &path);
        }
        self.frame_what_was_added(ctx);
        while let Some(outcome) = self.files.chosen(ctx.input(|input| input.focused)) {
            self.take_choice(ctx, outcome);
        }
        self.hear_of_files(ctx);
        self.model_export.hear(&mut self.work.notices);
    }

    fn take_keys(&mut self, ctx: &egui::Context, has_popup: bool) {
        if !self.is_asking() {
            self.viewport.take_keys(ctx, &mut self.work);
        }
        // Escape closes popups and ends typing, and egui has taken the keyboard from a text by now.
        let escape_is_taken = has_popup || self.was_typing;
        // Keys typed after that of a command that asks a question belong to the answer.
        while !self.is_asking()
            && let Some(command) = Command::next_pressed(ctx, escape_is_taken)
        {
            let can = self.work.can(command);
            self.run(ctx, command);
            if can {
                self.tell_key(command);
            }
        }
    }

    fn show_panels(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        let is_comparing = self.compare.is_open();
        let recent = if crate::fingers::is_phone(&ctx) {
            self.show_sheets(ui)
        } else {
            let recent = panels::menu::show(ui, &mut self.work, &self.files, is_comparing);
            panels::status::show(ui, &mut self.work, &self.viewport);
            let (has_list, has_inspector) = (!self.hides_list, !self.hides_inspector);
            panels::sides::show(ui, &mut self.work, has_list, has_inspector);
            recent
        };
        if let Some(path) = recent {
            self.take_file(&ctx, &path);
        }
        if let Some(of) = self.work.wanted_picture.take() {
            self.ask_path(&ctx, Purpose::Picture(of));
        }
        match panels::number::told(&ctx) {
            Some(Ok(())) => self.work.notices.clear("number"),
            Some(Err(why)) => self.work.notices.error("number", why),
            None if !self.work.notices.has("number") => panels::number::forget(&ctx),
            None => {}
        }
    }

    /// Shows messages and missing files over the picture.
    fn show_notices(&mut self, ctx: &egui::Context, area: egui::Rect) {
        let is_building = self.work.renderer.is_building();
        let above_strip = self.work.snapshots.above_strip(area);
        let above_strip = self.work.looks.above_strip(above_strip);
        self.work.notices.show(ctx, above_strip, is_building);
        if let Some((of, path)) = missing::show(ctx, &self.work, area) {
            self.sought = Some(path);
            self.ask_path(ctx, Purpose::Find(of));
        }
    }

    fn set_title(&mut self, ctx: &egui::Context) {
        let document = &self.work.document;
        let sign = if document.is_modified() { " •" } else { "" };
        let title = format!("{}{sign} · Hairline", document.title());
        // A command to the window asks for another pass: without a change there would be no end of them.
        if self.title != title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}

fn dropped_files(ctx: &egui::Context) -> Vec<PathBuf> {
    ctx.input(|input| {
        let files = &input.raw.dropped_files;
        files.iter().map(|file| file.path().to_owned()).collect()
    })
}

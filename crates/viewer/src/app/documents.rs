//! Which document is edited: a new one, another one, one that is recovered; and the file that it is saved to.

use std::path::Path;

use egui::ViewportCommand;
use hairline_editor::Document;
use hairline_editor::autosave::Pending;
use hairline_editor::document::SaveError;

use super::Viewer;
use crate::dialogs::Wish;
use crate::files::{Purpose, is_same};
use crate::snapshots::Snapshots;
use crate::tools::Tool;

impl Viewer {
    /// Does what would lose unsaved changes, or asks first.
    pub(super) fn wish(&mut self, ctx: &egui::Context, wish: Wish) {
        if self.work.document.is_modified() {
            self.dialogs.ask_about_unsaved(wish);
        } else {
            self.fulfil(ctx, wish);
        }
    }

    pub(super) fn fulfil(&mut self, ctx: &egui::Context, wish: Wish) {
        match wish {
            Wish::New => match super::built_in(self.built_in) {
                Ok(document) => self.replace_document(document),
                Err(error) => self.work.notices.error("open", error.to_string()),
            },
            Wish::Open(path) => match super::open(&path) {
                Ok(document) => self.replace_document(document),
                Err(error) => self.work.notices.error("open", error.to_string()),
            },
            Wish::Quit => {
                self.dialogs.closing = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// Writes the scene to its file, or asks for one.
    pub(super) fn save(&mut self, ctx: &egui::Context) {
        if self.work.document.path().is_none() {
            self.ask_path(ctx, Purpose::SaveAs);
            return;
        }
        let done = self.work.document.save();
        self.saved(ctx, done);
    }

    /// Writes the scene to another file, or asks first where that is there. A dialog of the system `has_asked` about it, if the
    /// name is the one that was chosen in it.
    pub(super) fn save_as(&mut self, ctx: &egui::Context, chosen: &Path, has_asked: bool) {
        let path = match chosen.extension() {
            Some(_) => chosen.to_owned(),
            None => chosen.with_extension("toml"),
        };
        if self
            .work
            .document
            .path()
            .is_some_and(|own| is_same(own, &path))
        {
            self.save(ctx);
        } else if path.exists() && !(has_asked && path == chosen) {
            self.dialogs.ask_to_replace(path);
        } else {
            self.write_as(ctx, &path);
        }
    }

    pub(super) fn write_as(&mut self, ctx: &egui::Context, path: &Path) {
        let done = self.work.document.save_as(path);
        self.saved(ctx, done);
    }

    pub(super) fn saved(&mut self, ctx: &egui::Context, done: Result<(), SaveError>) {
        let after = self.dialogs.after_save.take();
        match done {
            Err(SaveError::ChangedOnDisk(_)) => {
                self.dialogs.after_save = after;
                self.dialogs.ask_to_save_over();
            }
            Err(error) => self.work.notices.error("save", error.to_string()),
            Ok(()) => {
                self.work.notices.clear("save");
                self.files.watch(&self.work.document);
                if let Some(path) = self.work.document.path() {
                    self.work.bookmarks.saved_as(path);
                    self.files.remember(path);
                    self.work
                        .notices
                        .note("saved", format!("Saved {}", path.display()));
                }
                if let Some(wish) = after {
                    self.fulfil(ctx, wish);
                }
            }
        }
    }

    /// Puts another document in the place of this one.
    pub(super) fn replace_document(&mut self, document: Document) {
        self.files.reopen();
        self.work.document = document;
        self.work.free_view.end();
        self.work.bookmarks.open(self.work.document.path());
        self.asked = None;
        self.work.toolbox.tool = Tool::Select;
        self.work.snapshots = Snapshots::default();
        self.work.notices.clear("open");
        self.tell_notes();
        if let Some(path) = self.work.document.path() {
            self.files.remember(path);
        }
    }

    /// What the author of the scene file should know about it.
    pub(super) fn tell_notes(&mut self) {
        let notes = &self.work.document.description().notes;
        if !notes.is_empty() {
            let text = notes.join("\n");
            eprintln!("note: {text}");
            self.work.notices.note("notes", text);
        }
    }

    pub(super) fn recover(&mut self, pending: Pending) {
        match pending.recover() {
            Ok(document) => {
                self.replace_document(document);
                self.files.take_over(pending);
                self.work
                    .notices
                    .note("recovered", "Recovered. Save it to keep it.");
            }
            Err(error) => self.work.notices.error("recovered", error.to_string()),
        }
    }

    /// Closing the window with unsaved changes asks first.
    pub(super) fn watch_close(&mut self, ctx: &egui::Context) {
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        if is_asked && !self.dialogs.closing && self.work.document.is_modified() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.dialogs.ask_about_unsaved(Wish::Quit);
        }
    }
}

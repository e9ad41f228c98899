//! Questions in the window, one at a time, and the help.

mod ask;
mod fit;
mod on_disk;
mod recovery;
mod thumbnails;

use std::path::PathBuf;

use egui::{Grid, Id, Modal, Ui};
use hairline_editor::autosave::Pending;

use crate::app::Viewer;
use crate::command::{self, Group};
use crate::files::{Purpose, from_home};
use ask::{Loses, ask};
use fit::Misfit;
pub(crate) use on_disk::is_same;
use recovery::Recovery;

/// What was asked for while there were unsaved changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Wish {
    New,
    Open(PathBuf),
    Quit,
}

/// What is being asked.
enum Question {
    /// Unsaved changes stand in the way of a wish.
    Unsaved(Wish),
    /// Autosaves of earlier runs that did not end as they should.
    Recover(Recovery),
    /// The path of a file, where the system has no dialog for it.
    Path(Purpose, String),
    /// Another program has written the scene file, and there are unsaved changes here.
    Changed,
    /// The scene file is to be loaded again, and there are unsaved changes here.
    Reload,
    /// Another program has written the scene file that is to be saved.
    SaveOver,
    /// The file that the scene is to be saved as is there already.
    Replace(PathBuf),
    /// A model that is to be added is much larger or smaller than what the scene shows.
    Fit(Misfit),
}

/// Which questions are open.
#[derive(Default)]
pub(crate) struct Dialogs {
    question: Option<Question>,
    help: bool,
    /// The window may close.
    pub closing: bool,
    /// Once the scene is saved, this is done.
    pub after_save: Option<Wish>,
}

impl Dialogs {
    /// Whether keys are answers and not commands.
    pub fn is_modal(&self) -> bool {
        self.question.is_some() || self.help
    }

    pub fn ask_about_unsaved(&mut self, wish: Wish) {
        self.question = Some(Question::Unsaved(wish));
    }

    pub fn offer_recovery(&mut self, pending: Vec<Pending>) {
        if !pending.is_empty() {
            self.question = Some(Question::Recover(Recovery::new(pending)));
        }
    }

    pub fn ask_for_path(&mut self, purpose: Purpose, proposal: String) {
        self.question = Some(Question::Path(purpose, proposal));
    }

    /// Another program has written the file that is to be saved.
    pub fn ask_to_save_over(&mut self) {
        self.question = Some(Question::SaveOver);
    }

    /// The file that is to be written is there already.
    pub fn ask_to_replace(&mut self, path: PathBuf) {
        self.question = Some(Question::Replace(path));
    }

    /// A model is `extent_m` large in its file, and `fit_m` would suit the scene.
    pub fn ask_to_fit(&mut self, path: PathBuf, extent_m: f64, fit_m: f64) {
        self.question = Some(Question::Fit(Misfit {
            path,
            extent_m,
            fit_m,
        }));
    }

    pub fn show_help(&mut self) {
        self.help = true;
    }
}

impl Viewer {
    pub(crate) fn show_dialogs(&mut self, ctx: &egui::Context) {
        if self.dialogs.help {
            let modal = Modal::new(Id::unique("help")).show(ctx, help);
            if modal.should_close() || modal.inner {
                self.dialogs.help = false;
            }
        }
        match self.dialogs.question.take() {
            None => {}
            Some(Question::Unsaved(wish)) => self.unsaved(ctx, wish),
            Some(Question::Recover(recovery)) => self.recovery(ctx, recovery),
            Some(Question::Path(purpose, text)) => self.path(ctx, purpose, text),
            Some(Question::Changed) => self.changed_on_disk(ctx),
            Some(Question::Reload) => self.load_again(ctx),
            Some(Question::SaveOver) => self.save_over(ctx),
            Some(Question::Replace(path)) => self.replace(ctx, path),
            Some(Question::Fit(misfit)) => self.fit(ctx, misfit),
        }
    }

    fn unsaved(&mut self, ctx: &egui::Context, wish: Wish) {
        let text = format!(
            "\"{}\" has changes that are not saved.",
            self.document.title()
        );
        let answers = ["Save the changes", "Discard the changes", "Cancel"];
        match ask(
            ctx,
            "unsaved",
            "Save the changes?",
            &text,
            &answers,
            Loses::Nothing,
        ) {
            Some(0) => {
                self.dialogs.after_save = Some(wish);
                self.save(ctx);
            }
            Some(1) => self.fulfil(ctx, wish),
            Some(_) => {}
            None => self.dialogs.question = Some(Question::Unsaved(wish)),
        }
    }

    fn path(&mut self, ctx: &egui::Context, purpose: Purpose, mut text: String) {
        let modal = Modal::new(Id::unique("path")).show(ctx, |ui| {
            ui.set_width(460.0);
            ui.heading(purpose.title());
            let label = ui.label("Path");
            let edit = egui::TextEdit::singleline(&mut text).desired_width(f32::INFINITY);
            let response = ui.add(edit).labelled_by(label.id);
            let entered =
                response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            // Asked for before it is read, the focus would not count as lost.
            if !entered && ctx.memory(|memory| memory.focused().is_none()) {
                response.request_focus();
            }
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let ok = ui.button("OK").clicked() || entered;
                let cancel = ui.button("Cancel").clicked();
                (ok, cancel)
            })
            .inner
        });
        let should_close = modal.should_close();
        match modal.inner {
            (true, _) if !text.trim().is_empty() => {
                self.take_typed_path(ctx, purpose, &from_home(text.trim()));
            }
            (_, true) => self.dialogs.after_save = None,
            _ if should_close => self.dialogs.after_save = None,
            _ => self.dialogs.question = Some(Question::Path(purpose, text)),
        }
    }
}

/// All keys and what the mouse does; true when it is to be closed.
fn help(ui: &mut Ui) -> bool {
    const MOUSE: [(&str, &str); 9] = [
        ("Drag", "turns the view"),
        ("Shift and drag, or the middle button", "moves the view"),
        (
            "Alt and drag, or the right button",
            "turns the view with any tool",
        ),
        (
            "Wheel forward, or fingers apart",
            "comes nearer to what is under the mouse",
        ),
        ("Wheel back, or fingers together", "goes away from it"),
        ("Click", "selects"),
        ("Right click", "shows what can be done with it"),
        ("Double click", "looks at the point"),
        (
            "Drop a file",
            "opens a scene, adds a model, sets the environment",
        ),
    ];
    ui.set_width(860.0);
    ui.heading("Keys and mouse");
    // A row for each line, with what is around it: so that all of it fits a small screen, and scrolls on a smaller one.
    let height = ui.ctx().content_rect().height() - 130.0;
    egui::ScrollArea::vertical()
        .max_height(height.max(120.0))
        .min_scrolled_height(height.max(120.0))
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            ui.columns(3, |columns| {
                for group in [Group::File, Group::Edit, Group::Inspect] {
                    keys(&mut columns[0], group);
                }
                keys(&mut columns[1], Group::View);
                for group in [Group::Tools, Group::Help] {
                    keys(&mut columns[2], group);
                }
                let ui = &mut columns[2];
                ui.strong("Mouse in the picture");
                for (what, does) in MOUSE {
                    ui.label(format!("{what}: {does}"));
                }
            });
        });
    ui.add_space(8.0);
    ui.button("Close").clicked()
}

fn keys(ui: &mut Ui, group: Group) {
    ui.strong(group.name());
    Grid::new(group.name()).num_columns(2).show(ui, |ui| {
        for entry in command::entries().filter(|entry| entry.group == group) {
            if let Some(shortcut) = &entry.shortcut {
                let also = command::further_keys(entry.command);
                let keys = std::iter::once(*shortcut).chain(also);
                let texts: Vec<String> = keys.map(|key| command::key_text(&key)).collect();
                ui.monospace(texts.join(", "));
                ui.label(entry.label);
                ui.end_row();
            }
        }
    });
    ui.add_space(8.0);
}

//! Questions in the window, one at a time, and the help.

use std::path::PathBuf;

use egui::{Grid, Id, Modal, Ui};
use hairline_editor::autosave::Pending;

use crate::app::Viewer;
use crate::command::{self, Group};
use crate::files::Purpose;

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
    Recover(Vec<Pending>),
    /// The path of a file, where the system has no dialog for it.
    Path(Purpose, String),
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
            self.question = Some(Question::Recover(pending));
        }
    }

    pub fn ask_for_path(&mut self, purpose: Purpose, proposal: String) {
        self.question = Some(Question::Path(purpose, proposal));
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
            Some(Question::Recover(pending)) => self.recovery(ctx, pending),
            Some(Question::Path(purpose, text)) => self.path(ctx, purpose, text),
        }
    }

    fn unsaved(&mut self, ctx: &egui::Context, wish: Wish) {
        enum Answer {
            Save,
            Discard,
            Stay,
        }
        let modal = Modal::new(Id::unique("unsaved")).show(ctx, |ui| {
            ui.set_width(380.0);
            ui.heading("Save the changes?");
            ui.label(format!(
                "\"{}\" has changes that are not saved.",
                self.document.title()
            ));
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                if ui.button("Save the changes").clicked() {
                    Some(Answer::Save)
                } else if ui.button("Discard the changes").clicked() {
                    Some(Answer::Discard)
                } else if ui.button("Cancel").clicked() {
                    Some(Answer::Stay)
                } else {
                    None
                }
            })
            .inner
        });
        let should_close = modal.should_close();
        match modal.inner {
            Some(Answer::Save) => {
                self.dialogs.after_save = Some(wish);
                self.save(ctx);
            }
            Some(Answer::Discard) => self.fulfil(ctx, wish),
            Some(Answer::Stay) => {}
            None if should_close => {}
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
            if ctx.memory(|memory| memory.focused().is_none()) {
                response.request_focus();
            }
            let entered =
                response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
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
                self.take_path(ctx, purpose, std::path::Path::new(text.trim()));
            }
            (_, true) => self.dialogs.after_save = None,
            _ if should_close => self.dialogs.after_save = None,
            _ => self.dialogs.question = Some(Question::Path(purpose, text)),
        }
    }

    fn recovery(&mut self, ctx: &egui::Context, mut pending: Vec<Pending>) {
        enum Answer {
            Recover(usize),
            Discard(usize),
            Later,
        }
        let modal = Modal::new(Id::unique("recover")).show(ctx, |ui| {
            ui.set_width(460.0);
            ui.heading("Unsaved work was found");
            ui.label("An earlier run ended before it was saved:");
            let mut answer = None;
            for (i, entry) in pending.iter().enumerate() {
                ui.horizontal(|ui| {
                    let name = entry
                        .path
                        .as_ref()
                        .map_or("untitled".into(), |path| path.display().to_string());
                    ui.label(name);
                    if ui.button("Recover").clicked() {
                        answer = Some(Answer::Recover(i));
                    }
                    if ui.button("Throw away").clicked() {
                        answer = Some(Answer::Discard(i));
                    }
                });
            }
            ui.add_space(8.0);
            if ui.button("Ask again later").clicked() {
                answer = Some(Answer::Later);
            }
            answer
        });
        let should_close = modal.should_close();
        match modal.inner {
            Some(Answer::Recover(i)) => self.recover(pending.remove(i)),
            Some(Answer::Discard(i)) => {
                pending.remove(i).discard();
                self.dialogs.offer_recovery(pending);
            }
            Some(Answer::Later) => {}
            None if should_close => {}
            None => self.dialogs.question = Some(Question::Recover(pending)),
        }
    }
}

/// All keys and what the mouse does; true when it is to be closed.
fn help(ui: &mut Ui) -> bool {
    const MOUSE: [(&str, &str); 8] = [
        ("Drag", "turns the view"),
        ("Shift and drag, or the middle button", "moves the view"),
        ("Right button and drag", "turns the view with any tool"),
        ("Alt and drag", "turns the view with any tool"),
        ("Wheel or pinch", "comes nearer to what is under the mouse"),
        ("Click", "selects"),
        ("Double click", "looks at the point"),
        (
            "Drop a file",
            "opens a scene, adds a model, sets the environment",
        ),
    ];
    ui.set_width(720.0);
    ui.heading("Keys and mouse");
    egui::ScrollArea::vertical()
        .max_height(480.0)
        .show(ui, |ui| {
            ui.columns(2, |columns| {
                let (left, right) = columns.split_at_mut(1);
                for group in Group::ALL {
                    let ui = match group {
                        Group::File | Group::Edit => &mut left[0],
                        Group::View | Group::Tools | Group::Help => &mut right[0],
                    };
                    keys(ui, group);
                }
                let ui = &mut left[0];
                ui.strong("Mouse in the picture");
                Grid::new("mouse").num_columns(1).show(ui, |ui| {
                    for (what, does) in MOUSE {
                        ui.label(format!("{what}: {does}"));
                        ui.end_row();
                    }
                });
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
                ui.monospace(ui.ctx().format_shortcut(shortcut));
                ui.label(entry.label);
                ui.end_row();
            }
        }
    });
    ui.add_space(8.0);
}

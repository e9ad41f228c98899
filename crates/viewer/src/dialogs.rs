//! Questions in the window, one at a time, and the help.

mod answer;
mod ask;
mod completion;
mod examples;
mod fit;
mod on_disk;
mod path_line;
mod preset;
mod recovery;
mod thumbnails;

use std::path::PathBuf;

use egui::{Grid, Id, Modal, Ui};
use hairline_editor::autosave::Pending;

use crate::command::{self, Group};
use crate::files::Purpose;
pub(crate) use answer::{Answer, PendingAction};
use ask::{Loses, ask};
pub(crate) use examples::Choice;
pub(crate) use path_line::PathLine;
pub(crate) use preset::PresetLine;
use recovery::Recovery;

/// Question in the window.
pub(crate) enum Question {
    /// Unsaved changes stand in the way of an action.
    Unsaved(PendingAction),
    /// Autosaves of earlier runs that did not end as they should.
    Recover(Recovery),
    /// The name of a preset.
    Preset(PresetLine),
    /// A scene of the examples is to be chosen.
    Examples(Choice),
    /// The path of a file, where the system has no dialog for it.
    Path(PathLine),
    /// Another program has written the scene file, and there are unsaved changes here.
    Changed,
    /// The scene file is to be loaded again, and there are unsaved changes here.
    Reload,
    /// Another program has written the scene file that is to be saved.
    SaveOver,
    /// The file that is to be written is there already.
    Replace(Purpose, PathBuf),
    /// A model that is to be added is much larger or smaller than the visible scene.
    Fit {
        path: PathBuf,
        /// Size of the model in its file.
        extent_m: f64,
        /// A size that suits the scene.
        fit_m: f64,
    },
}

/// Open questions.
#[derive(Default)]
pub(crate) struct Dialogs {
    question: Option<Question>,
    help: bool,
}

impl Dialogs {
    /// Whether keys are answers and not commands.
    pub fn is_modal(&self) -> bool {
        self.question.is_some() || self.help
    }

    pub fn ask(&mut self, question: Question) {
        self.question = Some(question);
    }

    pub fn offer_recovery(&mut self, pending: Vec<Pending>) {
        if !pending.is_empty() {
            self.ask(Question::Recover(Recovery::new(pending)));
        }
    }

    pub fn show_help(&mut self) {
        self.help = true;
    }

    /// Shows the help and the question that is open; `title` is the document's. Returns an answer, once there is one.
    pub fn show(&mut self, ctx: &egui::Context, title: &str) -> Option<Answer> {
        if self.help {
            let modal = Modal::new(Id::unique("help")).show(ctx, help);
            if modal.should_close() || modal.inner {
                self.help = false;
            }
        }
        let mut question = self.question.take()?;
        let answer = question.show(ctx, title);
        if answer.is_none() {
            self.question = Some(question);
        }
        answer
    }
}

impl Question {
    /// Shows the question; none until there is an answer.
    fn show(&mut self, ctx: &egui::Context, title: &str) -> Option<Answer> {
        match self {
            Self::Unsaved(action) => unsaved(ctx, title, action),
            Self::Recover(recovery) => recovery.show(ctx),
            Self::Preset(line) => line.show(ctx),
            Self::Examples(choice) => choice.show(ctx),
            Self::Path(line) => line.show(ctx),
            Self::Changed => on_disk::changed(ctx, title),
            Self::Reload => on_disk::reload(ctx, title),
            Self::SaveOver => on_disk::save_over(ctx, title),
            Self::Replace(purpose, path) => on_disk::replace(ctx, *purpose, path),
            Self::Fit {
                path,
                extent_m,
                fit_m,
            } => fit::fit(ctx, path, *extent_m, *fit_m),
        }
    }
}

fn unsaved(ctx: &egui::Context, title: &str, action: &PendingAction) -> Option<Answer> {
    let text = format!("\"{title}\" has changes that are not saved.");
    let answers = ["Save the changes", "Discard the changes", "Cancel"];
    let heading = "Save the changes?";
    let answer = ask(ctx, "unsaved", heading, &text, &answers, Loses::Nothing)?;
    Some(match answer {
        0 => Answer::SaveBefore(action.clone()),
        1 => Answer::Perform(action.clone()),
        _ => Answer::Cancel,
    })
}

/// Shorter than docs/first-shot.md, which has the same.
const ADVICE: [(&str, [&str; 4]); 2] = [
    (
        "Why do I see no scratches?",
        [
            "Soft boxes or a bright sky fill the mirror image around the highlight: Edit, Light for the scratches.",
            "The highlight lies elsewhere: L and a click put it where you want it.",
            "The base is rough: above 0.2 its own highlight drowns them.",
            "They are narrow and the object is far: come nearer, or lay more.",
        ],
    ),
    (
        "What gives beauty",
        [
            "Depths of 100 to 250 nm give the colour; a spread above 0.2 washes it out.",
            "Widths of 2 to 6 µm show the rainbow along a scratch.",
            "One pattern tells how the thing was made, a second one how it was used.",
            "A small lamp for colour, a strip for the form, darkness for the rest.",
        ],
    ),
];

/// Actions of the mouse in the picture.
const MOUSE: [(&str, &str); 10] = [
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
        "Drag a material, wear or scratches from their cards",
        "onto an object or a part",
    ),
    (
        "Drop a file",
        "opens a scene, adds a model, sets the environment",
    ),
];

/// Shows all keys and the actions of the mouse; true when it is to be closed.
fn help(ui: &mut Ui) -> bool {
    // egui has these keys by itself.
    const SIZES: &str = "Ctrl and +, - or 0: all of the window larger, smaller, as it was";
    const MENUS: &str = "Alt and the first letter of a menu: opens it";
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
                ui.label(SIZES);
                ui.label(MENUS);
            });
            for (title, lines) in ADVICE {
                ui.collapsing(title, |ui| {
                    for line in lines {
                        ui.label(line);
                    }
                });
            }
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

//! A line of the window for a path, where the system has no dialog.

use std::path::Path;

use egui::{Context, Event, Id, Key, Modal, TextEdit};

use super::answer::Answer;
use crate::files::{Purpose, from_home};

/// The line, with the path as typed.
pub(crate) struct PathLine {
    purpose: Purpose,
    text: String,
    /// Reason why the text before was of no use.
    refused: Option<String>,
}

impl PathLine {
    pub fn new(purpose: Purpose, text: String) -> Self {
        Self {
            purpose,
            text,
            refused: None,
        }
    }

    /// Asks again, with the path that was typed and its error.
    pub fn again(purpose: Purpose, path: &Path, why: String) -> Self {
        Self {
            refused: Some(why),
            ..Self::new(purpose, path.display().to_string())
        }
    }

    /// Shows the line; none until there is an answer.
    pub(super) fn show(&mut self, ctx: &Context) -> Option<Answer> {
        let is_new = ctx.memory(|memory| memory.focused().is_none());
        if is_new {
            self.take_what_is_typed(ctx);
        }
        let modal = Modal::new(Id::unique("path")).show(ctx, |ui| {
            ui.set_width(460.0);
            ui.heading(self.purpose.title());
            let label = ui.label("Path");
            let edit = TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY);
            let response = ui.add(edit).labelled_by(label.id);
            if response.changed() {
                self.refused = None;
            }
            let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            // Asked for before it is read, the focus would not count as lost.
            if !entered && ctx.memory(|memory| memory.focused().is_none()) {
                response.request_focus();
            }
            if let Some(refused) = &self.refused {
                ui.colored_label(ui.visuals().error_fg_color, refused);
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
        let text = self.text.trim();
        match modal.inner {
            (true, _) if !text.is_empty() => Some(Answer::Path(self.purpose, from_home(text))),
            (_, true) => Some(Answer::CancelSaving),
            _ => should_close.then_some(Answer::CancelSaving),
        }
    }

    /// The line has the keyboard from the next pass on.
    fn take_what_is_typed(&mut self, ctx: &Context) {
        ctx.input(|input| {
            for event in &input.events {
                if let Event::Text(text) = event {
                    self.text.push_str(text);
                }
            }
        });
    }
}

//! A line of the window for a path, where the system has no dialog.

use std::path::Path;

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Context, Event, Id, Key, Modal, Modifiers, Response, TextEdit};

use super::answer::Answer;
use super::completion::{Completion, completion};
use crate::files::{Purpose, from_home};

/// The line, with the path as typed.
pub(crate) struct PathLine {
    purpose: Purpose,
    text: String,
    /// Reason why the text before was of no use.
    refused: Option<String>,
    /// Names with which the path may go on, after Tab.
    choices: Vec<String>,
    /// The text was completed, and the cursor is to stand at its end.
    is_completed: bool,
}

impl PathLine {
    pub fn new(purpose: Purpose, text: String) -> Self {
        Self {
            purpose,
            text,
            refused: None,
            choices: Vec::new(),
            is_completed: false,
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
            if ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Tab)) {
                self.complete();
            }
            // Tab completes, and does not go on to the next widget.
            let edit = TextEdit::singleline(&mut self.text)
                .desired_width(f32::INFINITY)
                .lock_focus(true);
            let response = ui.add(edit).labelled_by(label.id);
            if std::mem::take(&mut self.is_completed) {
                end_at(&response, self.text.chars().count());
            }
            if response.changed() {
                self.refused = None;
                self.choices.clear();
            }
            let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            // Asked for before it is read, the focus would not count as lost.
            if !entered && ctx.memory(|memory| memory.focused().is_none()) {
                response.request_focus();
            }
            ui.weak(match self.choices.is_empty() {
                true => "Tab completes the path.".to_owned(),
                false => self.choices.join("   "),
            });
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

    /// Completes the path as far as there is one way to go on.
    fn complete(&mut self) {
        let Completion { text, choices } = completion(&self.text, self.purpose.filter().1);
        (self.text, self.choices) = (text, choices);
        self.is_completed = true;
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

/// Moves the cursor of a line behind its last character.
fn end_at(response: &Response, count: usize) {
    let mut state = TextEditState::load(&response.ctx, response.id).unwrap_or_default();
    let end = CCursorRange::one(CCursor::new(count));
    state.cursor.set_char_range(Some(end));
    state.store(&response.ctx, response.id);
}

//! The question for the name of a preset.

use egui::{Context, Id, Key, Modal, TextEdit};

use super::answer::Answer;
use crate::panels::form::select_all;

/// Name of a preset, as it is typed.
pub(crate) struct PresetLine {
    name: String,
    /// Names that are taken.
    taken: Vec<String>,
    /// Number of lights in the scene, where all of them may go into the preset.
    lights: Option<usize>,
    all_lights: bool,
    /// A name that is taken, whose preset is replaced if it is given once more.
    asked: Option<String>,
    /// Reason why the name before was of no use.
    refused: Option<String>,
    /// The line has not had the keyboard yet.
    is_new: bool,
}

impl PresetLine {
    pub fn new(name: String, taken: Vec<String>, lights: Option<usize>) -> Self {
        Self {
            name,
            taken,
            lights: lights.filter(|count| *count > 1),
            all_lights: false,
            asked: None,
            refused: None,
            is_new: true,
        }
    }

    /// Asks again, and says why.
    pub fn again(self, why: String, all_lights: bool) -> Self {
        Self {
            refused: Some(why),
            all_lights,
            ..self
        }
    }

    /// Shows the line; none until there is an answer.
    pub(super) fn show(&mut self, ctx: &Context) -> Option<Answer> {
        let modal = Modal::new(Id::unique("preset")).show(ctx, |ui| {
            ui.set_width(420.0);
            ui.heading("Save as a preset");
            let label = ui.label("Name");
            let edit = TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY);
            let response = ui.add(edit).labelled_by(label.id);
            if response.changed() {
                self.refused = None;
            }
            let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            // What had the keyboard before, as a button of a panel, gives it up a frame later.
            if self.is_new && response.has_focus() {
                self.is_new = false;
                select_all(&response, self.name.chars().count());
            }
            let is_free = ctx.memory(|memory| memory.focused().is_none());
            if self.is_new || !entered && is_free {
                response.request_focus();
            }
            if let Some(count) = self.lights {
                let text = format!("All {count} lights of the scene");
                ui.checkbox(&mut self.all_lights, text);
            }
            if let Some(refused) = &self.refused {
                ui.colored_label(ui.visuals().error_fg_color, refused);
            }
            let name = self.name.trim();
            let is_asked = self.asked.as_deref() == Some(name);
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let words = match is_asked {
                    true => format!("Replace the preset {name} for good"),
                    false => "Save the preset".to_owned(),
                };
                let save = ui.button(words).clicked() || entered;
                (save, ui.button("Cancel").clicked())
            })
            .inner
        });
        let should_close = modal.should_close();
        let name = self.name.trim();
        match modal.inner {
            (true, _)
                if self.asked.as_deref() != Some(name)
                    && self.taken.iter().any(|it| it == name) =>
            {
                self.asked = Some(name.to_owned());
                self.refused = Some(format!(
                    "There is a preset {name} already: once more replaces it."
                ));
                None
            }
            (true, _) => Some(Answer::SavePreset(self.name.clone(), self.all_lights)),
            (false, cancel) => (cancel || should_close).then_some(Answer::Cancel),
        }
    }
}

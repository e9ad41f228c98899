//! Recovery of an earlier run's work, when it ended by accident.

use std::time::SystemTime;

use egui::{Context, Id, Modal, Ui};
use hairline_editor::autosave::Pending;

use super::answer::Answer;
use super::thumbnails::Thumbnails;
use crate::panels::busy::Busy;

/// Autosaves that are offered, as they are shown.
pub(crate) struct Recovery {
    pending: Vec<Pending>,
    /// Small pictures; none until they are first shown.
    thumbnails: Option<Thumbnails>,
    /// Index of an autosave to be deleted, which must be confirmed.
    going: Option<usize>,
}

/// Button that was pressed.
enum RecoveryButton {
    Recover(usize),
    AskToDiscard(usize),
    Keep,
    Discard(usize),
    Later,
}

impl Recovery {
    pub fn new(pending: Vec<Pending>) -> Self {
        Self {
            pending,
            thumbnails: None,
            going: None,
        }
    }

    fn row(&mut self, ui: &mut Ui, i: usize) -> Option<RecoveryButton> {
        let ctx = ui.ctx().clone();
        let entry = &self.pending[i];
        let thumbnails = self
            .thumbnails
            .get_or_insert_with(|| Thumbnails::start(&self.pending, &ctx));
        let mut answer = None;
        ui.horizontal(|ui| {
            match thumbnails.texture(i, &ctx) {
                Some(texture) => ui.image(&texture),
                None => ui.add_sized([160.0, 90.0], Busy::size(24.0)),
            };
            ui.vertical(|ui| {
                ui.strong(entry.title());
                if let Some(path) = &entry.path {
                    ui.label(path.display().to_string());
                }
                ui.weak(age(entry.written));
                ui.horizontal(|ui| {
                    if self.going == Some(i) {
                        ui.label("For good?");
                        if ui.button("Yes, throw it away").clicked() {
                            answer = Some(RecoveryButton::Discard(i));
                        }
                        if ui.button("Keep it").clicked() {
                            answer = Some(RecoveryButton::Keep);
                        }
                    } else {
                        if ui.button("Recover").clicked() {
                            answer = Some(RecoveryButton::Recover(i));
                        }
                        if ui.button("Throw away…").clicked() {
                            answer = Some(RecoveryButton::AskToDiscard(i));
                        }
                    }
                });
            });
        });
        answer
    }

    /// Shows the autosaves; none until there is an answer.
    pub fn show(&mut self, ctx: &Context) -> Option<Answer> {
        let modal = Modal::new(Id::unique("recover")).show(ctx, |ui| {
            ui.set_width(520.0);
            ui.heading("Unsaved work was found");
            ui.label("An earlier run ended before it was saved:");
            ui.add_space(4.0);
            let mut answer = None;
            let height = ui.ctx().content_rect().height() - 160.0;
            egui::ScrollArea::vertical()
                .max_height(height.max(120.0))
                .show(ui, |ui| {
                    for i in 0..self.pending.len() {
                        answer = self.row(ui, i).or(answer.take());
                    }
                });
            ui.add_space(8.0);
            if ui.button("Ask again later").clicked() {
                answer = Some(RecoveryButton::Later);
            }
            answer
        });
        let should_close = modal.should_close();
        match modal.inner {
            Some(RecoveryButton::Recover(i)) => {
                return Some(Answer::Recover(self.pending.remove(i)));
            }
            Some(RecoveryButton::Discard(i)) => {
                self.pending.remove(i).discard();
                *self = Self::new(std::mem::take(&mut self.pending));
                if self.pending.is_empty() {
                    return Some(Answer::Cancel);
                }
            }
            Some(RecoveryButton::Later) => return Some(Answer::Cancel),
            Some(RecoveryButton::AskToDiscard(i)) => self.going = Some(i),
            Some(RecoveryButton::Keep) => self.going = None,
            None if should_close => return Some(Answer::Cancel),
            None => {}
        }
        None
    }
}

/// Age of an autosave, in words.
fn age(written: Option<SystemTime>) -> String {
    let seconds = written
        .and_then(|written| written.elapsed().ok())
        .map(|age| age.as_secs());
    let words = |n: u64, unit: &str| match n {
        1 => format!("1 {unit} ago"),
        n => format!("{n} {unit}s ago"),
    };
    match seconds {
        None => "at an unknown time".to_owned(),
        Some(s) if s < 60 => "less than a minute ago".to_owned(),
        Some(s) if s < 3600 => words(s / 60, "minute"),
        Some(s) if s < 48 * 3600 => words(s / 3600, "hour"),
        Some(s) => words(s / (24 * 3600), "day"),
    }
}

#[cfg(test)]
mod tests {
    use super::age;
    use std::time::{Duration, SystemTime};

    #[test]
    fn ages_in_words() {
        let ago = |s| age(SystemTime::now().checked_sub(Duration::from_secs(s)));
        assert_eq!(ago(5), "less than a minute ago");
        assert_eq!(ago(65), "1 minute ago");
        assert_eq!(ago(7300), "2 hours ago");
        assert_eq!(ago(3 * 24 * 3600 + 5), "3 days ago");
        assert_eq!(age(None), "at an unknown time");
    }
}

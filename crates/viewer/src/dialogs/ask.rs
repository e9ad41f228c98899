//! A question with some answers, one of which is chosen by a button or a key.

use egui::{Context, Id, Key, Modal};

/// Effect of the first answer on somebody's work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Loses {
    Nothing,
    Something,
}

/// Asks a question. Escape and a click outside are the last answer, which changes nothing; Enter is the first, where that loses
/// nothing. Returns the place of the answer, once there is one.
pub(super) fn ask(
    ctx: &Context,
    name: &'static str,
    heading: &str,
    text: &str,
    answers: &[&str],
    loses: Loses,
) -> Option<usize> {
    let modal = Modal::new(Id::unique(name)).show(ctx, |ui| {
        ui.set_width(420.0);
        ui.heading(heading);
        ui.label(text);
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            let mut chosen = None;
            for (i, answer) in answers.iter().enumerate() {
                if ui.button(*answer).clicked() {
                    chosen = Some(i);
                }
            }
            chosen
        })
        .inner
    });
    let nothing_has_the_keyboard = ctx.memory(|memory| memory.focused().is_none());
    let entered = loses == Loses::Nothing
        && nothing_has_the_keyboard
        && ctx.input(|input| input.key_pressed(Key::Enter));
    let closed = modal.should_close().then(|| answers.len() - 1);
    modal.inner.or(entered.then_some(0)).or(closed)
}

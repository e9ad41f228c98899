//! A box for a number: to drag in, or to type in with a unit or as a sum. What cannot be read is told, and changes nothing.

use std::cell::RefCell;

use egui::{Context, DragValue, Id, Key, Response, Stroke, StrokeKind, Ui};
use hairline_editor::quantity::{ShownUnit, parse};
use hairline_editor::ranges::Range;

/// Display of one number.
pub(super) struct NumberBox<'a> {
    pub label: &'a str,
    /// Text before the number, in one of several boxes.
    pub prefix: &'a str,
    pub range: &'a Range,
    pub shown: ShownUnit,
    pub width: f32,
}

/// Result of reading an input.
#[derive(Clone, Debug, Default)]
enum Typed {
    #[default]
    Taken,
    Refused(String),
}

impl NumberBox<'_> {
    pub fn show(&self, ui: &mut Ui, value: &mut f64) -> Response {
        let range = self.range;
        let before = *value;
        let text = self.shown.text(before);
        let typed = RefCell::new(None);
        let is_given_up = is_given_up(ui);
        let read = |words: &str| {
            // Left as it was: the digits that are not shown stay.
            if words.trim() == text || is_given_up {
                return Some(before);
            }
            let (outcome, number) = self.read(words);
            typed.replace(Some(outcome));
            number
        };
        let way = range.slider.end() - range.slider.start();
        let speed = if range.logarithmic {
            (before.abs() * 0.01).max(way * 1e-6)
        } else {
            way / 400.0
        };
        let mut drag = DragValue::new(value)
            .range(range.hard.clone())
            // A file may hold more than may be typed: to look at it changes nothing.
            .clamp_existing_to_range(false)
            .speed(speed)
            .prefix(self.prefix)
            .custom_formatter(|number, _| self.shown.text(number))
            .custom_parser(read)
            // Typing counts when it is done: half a number is no wish.
            .update_while_editing(false);
        if range.is_whole {
            drag = drag.max_decimals(0);
        }
        let response = ui.add_sized([self.width, ui.spacing().interact_size.y.max(20.0)], drag);
        remember(ui, &response, typed.into_inner());
        self.remark(ui, response)
    }

    /// Reads a typed number that the scene allows.
    fn read(&self, words: &str) -> (Typed, Option<f64>) {
        let hard = &self.range.hard;
        let number = match parse(words, self.range.unit, self.shown) {
            Ok(number) if self.range.is_whole => number.round(),
            Ok(number) => number,
            Err(error) => {
                let why = format!("{}: {error}.", self.label);
                return (Typed::Refused(why), None);
            }
        };
        if !hard.contains(&number) {
            let [least, most] =
                [hard.start(), hard.end()].map(|end| self.range.unit.shown(*end).text(*end));
            let right = match *hard.start() == f64::MIN_POSITIVE {
                // Zero is refused where the least is the smallest number that there is.
                true => format!("more than 0 and at most {most}"),
                false => format!("from {least} to {most}"),
            };
            let why = format!(
                "{}: \"{}\" is out of range; it must be {right}.",
                self.label,
                words.trim()
            );
            return (Typed::Refused(why), None);
        }
        (Typed::Taken, Some(number))
    }

    /// A red rim and the reason while the last input was refused; else the tooltip.
    fn remark(&self, ui: &Ui, response: Response) -> Response {
        let id = refused_id(&response);
        let why = ui.data(|data| data.get_temp::<String>(id));
        match why {
            Some(_) if response.changed() => ui.data_mut(|data| data.remove::<String>(id)),
            Some(why) => {
                let rim = Stroke::new(1.5, ui.visuals().error_fg_color);
                ui.painter()
                    .rect_stroke(response.rect, 3.0, rim, StrokeKind::Inside);
                return response.on_hover_text(why);
            }
            None => {}
        }
        response.on_hover_text(self.range.tooltip)
    }
}

/// Whether Escape was pressed a moment ago. egui takes up what was typed before it, a pass later.
fn is_given_up(ui: &Ui) -> bool {
    let id = Id::unique("when Escape was pressed");
    let pass = ui.ctx().cumulative_pass_nr();
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        ui.data_mut(|data| data.insert_temp(id, pass));
    }
    let pressed = ui.data(|data| data.get_temp::<u64>(id));
    pressed.is_some_and(|pressed| pass <= pressed + 2)
}

fn refused_id(response: &Response) -> Id {
    response.id.with("refused")
}

/// Id under which messages wait for the notices.
fn told_id() -> Id {
    Id::unique("what was typed for a number")
}

fn remember(ui: &Ui, response: &Response, typed: Option<Typed>) {
    let Some(typed) = typed else { return };
    ui.data_mut(|data| {
        match &typed {
            Typed::Refused(why) => {
                data.insert_temp(refused_id(response), why.clone());
            }
            Typed::Taken => data.remove::<String>(refused_id(response)),
        }
        data.insert_temp(told_id(), typed);
    });
}

/// Message about a number that was typed, or that all is well again.
pub(crate) fn told(ctx: &Context) -> Option<Result<(), String>> {
    let typed = ctx.data_mut(|data| data.remove_temp::<Typed>(told_id()))?;
    Some(match typed {
        Typed::Taken => Ok(()),
        Typed::Refused(why) => Err(why),
    })
}

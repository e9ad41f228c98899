//! A box for a number: to drag in, or to type in with a unit or as a sum. What cannot be read is told, and changes nothing.

use std::cell::RefCell;

use egui::{Color32, Context, DragValue, Id, Key, Response, Stroke, StrokeKind, Ui};
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

/// An input that was refused, until the value changes or its message goes.
#[derive(Clone)]
struct Refused {
    of: Id,
    /// The value that stayed.
    value: f64,
    why: String,
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
        let span = range.slider.end() - range.slider.start();
        let speed = if range.logarithmic {
            (before.abs() * 0.01).max(span * 1e-6)
        } else {
            span / 400.0
        };
        let mut drag = DragValue::new(value)
            .range(range.bounds.ends())
            // A file may hold more than may be typed: to look at it changes nothing.
            .clamp_existing_to_range(false)
            .speed(speed)
            .prefix(self.prefix)
            .custom_formatter(|number, _| self.shown.text(number))
            .custom_parser(read)
            // Typing counts when it is done: half a number is no value.
            .update_while_editing(false);
        if range.is_whole {
            drag = drag.max_decimals(0);
        }
        let response = ui
            .scope(|ui| {
                self.fit_text(ui, &text);
                ui.add_sized([self.width, ui.spacing().interact_size.y.max(20.0)], drag)
            })
            .inner;
        if let Some(typed) = typed.into_inner() {
            remember(ui, &response, before, typed);
        }
        self.remark(ui, response, *value)
    }

    /// Makes letters so small that the number fits: a wider box would widen the panel, and with it the picture would start anew.
    fn fit_text(&self, ui: &mut Ui, number: &str) {
        let style = ui.style().drag_value_text_style.clone();
        let font = style.resolve(ui.style());
        let text = format!("{}{number}", self.prefix);
        let galley = ui.painter().layout_no_wrap(text, font, Color32::WHITE);
        let room = self.width - 2.0 * ui.spacing().button_padding.x - 2.0;
        if galley.size().x > room
            && let Some(font) = ui.style_mut().text_styles.get_mut(&style)
        {
            font.size *= (room / galley.size().x).max(0.5);
        }
    }

    /// Reads a typed number that the scene allows.
    fn read(&self, words: &str) -> (Typed, Option<f64>) {
        let number = match parse(words, self.range.unit, self.shown) {
            Ok(number) if self.range.is_whole => number.round(),
            Ok(number) => number,
            Err(error) => {
                let why = format!("{}: {error}.", self.label);
                return (Typed::Refused(why), None);
            }
        };
        let shown = |end: f64| self.range.unit.shown(end).text(end);
        if let Some(right) = self.range.bounds.must(number, shown) {
            let why = format!(
                "{}: \"{}\" is out of range; it {right}.",
                self.label,
                words.trim()
            );
            return (Typed::Refused(why), None);
        }
        (Typed::Taken, Some(number))
    }

    /// A red rim and the reason while the last input was refused; else the tooltip.
    fn remark(&self, ui: &Ui, response: Response, value: f64) -> Response {
        let refused = ui.data(|data| data.get_temp::<Refused>(refused_id()));
        match refused.filter(|refused| refused.of == response.id) {
            Some(refused) if refused.value == value => {
                let rim = Stroke::new(1.5, ui.visuals().error_fg_color);
                ui.painter()
                    .rect_stroke(response.rect, 3.0, rim, StrokeKind::Inside);
                response.on_hover_text(refused.why)
            }
            changed => {
                if changed.is_some() {
                    remember(ui, &response, value, Typed::Taken);
                }
                response.on_hover_text(self.range.tooltip)
            }
        }
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

fn refused_id() -> Id {
    Id::unique("a number that was refused")
}

/// Takes the rim off the box whose input was refused: its message is gone.
pub(crate) fn forget(ctx: &Context) {
    ctx.data_mut(|data| data.remove::<Refused>(refused_id()));
}

/// Id under which messages wait for the notices.
fn told_id() -> Id {
    Id::unique("what was typed for a number")
}

fn remember(ui: &Ui, response: &Response, value: f64, typed: Typed) {
    ui.data_mut(|data| {
        match &typed {
            Typed::Refused(why) => {
                let (of, why) = (response.id, why.clone());
                data.insert_temp(refused_id(), Refused { of, value, why });
            }
            Typed::Taken => data.remove::<Refused>(refused_id()),
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

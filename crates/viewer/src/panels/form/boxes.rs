//! Controls in a row of a form: a line of text, a slider, boxes of numbers.

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{
    Align, Context, Event, FocusDirection, Id, Key as KeyboardKey, Layout, Response, Slider,
    SliderClamping, TextEdit, Ui,
};
use hairline_editor::DragKey;
use hairline_editor::quantity::ShownUnit;
use hairline_editor::ranges::Range;

use crate::panels::number::NumberBox;

/// Width of a number's box.
pub(super) const VALUE_WIDTH: f32 = 78.0;

/// The label of the row that a part is called by.
pub(in crate::panels) const NAME: &str = "Name";

/// A line of text beside its label; returns whether it was left with another text.
pub(super) fn line(
    ui: &mut Ui,
    width: f32,
    key: (DragKey, &str),
    label: &Response,
    value: &mut String,
) -> bool {
    let id = ui.make_persistent_id(key);
    // Unfinished input is in egui's memory.
    let mut typed = ui
        .data(|data| data.get_temp::<String>(id))
        .unwrap_or_else(|| value.clone());
    let edit = TextEdit::singleline(&mut typed).desired_width(width);
    let response = ui.add(edit).labelled_by(label.id);
    if key.1 == NAME && end_naming(ui.ctx()) {
        select_all(&response, value.chars().count());
    }
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, typed));
        return false;
    }
    ui.data_mut(|data| data.remove_temp::<String>(id));
    let is_given_up = ui.input(|input| input.key_pressed(KeyboardKey::Escape));
    let changed = response.lost_focus() && typed != *value && !is_given_up;
    if changed {
        // Pasted text may have line ends, which names and paths of scene files have not.
        typed.retain(|c| !c.is_control());
        *value = typed;
    }
    changed
}

pub(super) fn slider_and_box(
    ui: &mut Ui,
    label: &Response,
    range: &Range,
    value: &mut f64,
) -> bool {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let typed = NumberBox {
            label: range.label,
            prefix: "",
            range,
            shown: range.unit.shown(*value),
            width: VALUE_WIDTH,
        }
        .show(ui, value)
        .labelled_by(label.id);
        ui.spacing_mut().slider_width = (ui.available_width() - 8.0).max(24.0);
        let mut on_slider = *value;
        let slider = Slider::new(&mut on_slider, range.slider.clone())
            .logarithmic(range.logarithmic)
            .clamping(SliderClamping::Never)
            .show_value(false);
        let slid = ui
            .add(slider)
            .labelled_by(label.id)
            .on_hover_text(range.tooltip);
        pass_on_focus(ui, &slid, &typed);
        if slid.changed() {
            *value = range.bounds.clamp(on_slider);
        }
        typed.changed() || slid.changed()
    })
    .inner
}

/// The keyboard goes from box to box, in which all can be done that a slider can.
fn pass_on_focus(ui: &Ui, slid: &Response, typed: &Response) {
    // A screen reader may want the slider.
    let is_asked_for = |event: &Event| matches!(event, Event::AccessKitActionRequest(_));
    if !slid.gained_focus() || ui.input(|input| input.events.iter().any(is_asked_for)) {
        return;
    }
    let is_forward =
        ui.input(|input| input.key_pressed(KeyboardKey::Tab) && !input.modifiers.shift);
    ui.memory_mut(|memory| match is_forward {
        true => {
            memory.surrender_focus(slid.id);
            memory.move_focus(FocusDirection::Next);
        }
        false => memory.request_focus(typed.id),
    });
}

/// Width of one of `n` boxes in the rest of a row.
pub(super) fn share(ui: &Ui, n: usize) -> f32 {
    let gaps = ui.spacing().item_spacing.x * (n as f32 - 1.0);
    ((ui.available_width() - gaps) / n as f32).max(40.0)
}

/// Box for one of several numbers in a row, all with one unit.
pub(super) fn small_box(
    ui: &mut Ui,
    width: f32,
    label: &str,
    name: &str,
    (range, shown): (&Range, ShownUnit),
    value: &mut f64,
) -> bool {
    let prefix = format!("{name} ");
    let label = format!("{label} {name}");
    let response = ui
        .scope(|ui| {
            // Three numbers with their units are as much as a row holds.
            ui.spacing_mut().button_padding.x = 1.0;
            let number = NumberBox {
                label: &label,
                prefix: &prefix,
                range,
                shown,
                width,
            };
            number.show(ui, value)
        })
        .inner;
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_label(label));
    response.changed()
}

fn naming_id() -> Id {
    Id::unique("the name in the panel is to be typed anew")
}

/// Moves the keyboard's focus to the name in the panel, and selects all of the name.
pub(crate) fn name_anew(ctx: &Context) {
    ctx.data_mut(|data| data.insert_temp(naming_id(), ()));
    ctx.request_repaint();
}

/// Whether it was to get it: once, and not later where a panel has no name.
pub(in crate::panels) fn end_naming(ctx: &Context) -> bool {
    ctx.data_mut(|data| data.remove_temp::<()>(naming_id()))
        .is_some()
}

/// Moves the keyboard's focus to a text of `count` characters, and selects all characters.
pub(crate) fn select_all(response: &Response, count: usize) {
    response.request_focus();
    let ctx = &response.ctx;
    let mut state = TextEditState::load(ctx, response.id).unwrap_or_default();
    let all = CCursorRange::two(CCursor::new(0), CCursor::new(count));
    state.cursor.set_char_range(Some(all));
    state.store(ctx, response.id);
}

//! Rows of a panel: a label and a control, with the unit, the range and the tooltip of a parameter.
//!
//! A form is shown for a copy of a part of the description. Each row says whether it changed the copy and which control did
//! it, so that all that one control does while it is held becomes one step.

use std::hash::Hash;
use std::path::PathBuf;

use egui::{Response, Ui};
use hairline_document::Description;
use hairline_document::description::{Distribution, Laid, Panel, RowValue, Rows, Shape};
use hairline_document::schema::{Bounds, Form as Spelling, Key};
use hairline_editor::DragKey;
use hairline_editor::actions::pictures::PictureOf;
use hairline_editor::quantity::Unit;
use hairline_editor::ranges::{Range, range, second_range};

use super::number::NumberBox;
use crate::platform::HAS_DISK;
use boxes::{VALUE_WIDTH, line, share, slider_and_box, small_box};

mod boxes;

pub(super) use boxes::{NAME, end_naming};
pub(crate) use boxes::{name_anew, select_all};

/// Width of the labels' column, points.
const LABEL_WIDTH: f32 = 110.0;
/// Width of a box among others in which numbers can be read.
const LEAST_BOX_WIDTH: f32 = 54.0;
/// Steps of positions that are shown, over the size of the object.
const FINE: f64 = 1.0 / 300.0;

/// Change by a control.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Change {
    /// The step's name in the history.
    pub label: String,
    /// The control.
    pub key: DragKey,
}

/// Rows for one part of the scene.
pub(crate) struct Form<'a> {
    pub ui: &'a mut Ui,
    /// Diagonal of the object or the scene that lengths are to fit.
    pub diagonal_m: f64,
    /// Names the part, so that controls of two parts are two.
    scope: DragKey,
    change: Option<Change>,
    /// The picture whose file is to be chosen.
    wanted: Option<PictureOf>,
    /// Names of the keys that have a row, or are to have none.
    shown: Vec<&'static str>,
}

impl<'a> Form<'a> {
    pub fn new(ui: &'a mut Ui, scope: impl Hash, diagonal_m: f64) -> Self {
        Self {
            ui,
            diagonal_m,
            scope: DragKey::from_name(scope),
            change: None,
            wanted: None,
            shown: Vec::new(),
        }
    }

    /// Rows for all keys of a table that have a control and no row yet. Rows before it are for keys that need more than their control, or an order.
    pub fn rest(&mut self, table: &mut dyn Rows) {
        table.rows(&mut Rest(self));
    }

    /// Keys of a table that [`Self::rest`] shows no row for.
    pub fn leave_out(&mut self, keys: &[&Key]) {
        self.shown.extend(keys.iter().map(|key| key.name));
    }

    /// What the control of a key shows.
    fn range(&mut self, key: &Key) -> Range {
        self.shown.push(key.name);
        range(key, self.diagonal_m)
    }

    /// Change in this pass.
    pub fn change(self) -> Option<Change> {
        self.change
    }

    /// A title between rows.
    pub fn section(&mut self, title: &str) {
        self.ui.add_space(8.0);
        self.ui.strong(title);
    }

    fn note(&mut self, label: &str) {
        self.change = Some(Change {
            label: label.to_owned(),
            key: DragKey::from_name((self.scope, label)),
        });
    }

    /// A label with its tooltip, and `control` beside it.
    fn row(
        &mut self,
        label: &str,
        tooltip: &str,
        control: impl FnOnce(&mut Ui, &Response) -> bool,
    ) {
        let changed = self.ui.horizontal(|ui| {
            let text = ui
                .scope(|ui| {
                    ui.set_width(LABEL_WIDTH);
                    ui.add(egui::Label::new(label).wrap())
                })
                .inner;
            if !tooltip.is_empty() {
                text.clone().on_hover_text(tooltip);
            }
            control(ui, &text)
        });
        if changed.inner {
            self.note(label);
        }
    }

    /// A number: slider and box.
    pub fn number(&mut self, key: &Key, value: &mut f64) {
        let range = self.range(key);
        self.ranged(&range, value);
    }

    /// A length that scene files have in millimetres. What is not touched keeps all of its digits.
    pub fn in_metres(&mut self, key: &Key, before_mm: f64, set_mm: impl FnOnce(f64)) {
        let before_m = 1e-3 * before_mm;
        let mut after_m = before_m;
        self.number(key, &mut after_m);
        if after_m != before_m {
            // Not 18.000000000000004, in a file that people read.
            set_mm((1e12 * after_m).round() / 1e9);
        }
    }

    /// A whole number.
    pub fn whole(&mut self, key: &Key, value: &mut u64) {
        let mut number = *value as f64;
        self.number(key, &mut number);
        if number != *value as f64 {
            *value = number.max(0.0).round() as u64;
        }
    }

    /// A number that is drawn for each scratch: its mean, and how far it spreads.
    pub fn distribution(&mut self, key: &Key, value: &mut Distribution) {
        self.number(key, &mut value.mean);
        self.second(key, &mut value.spread);
    }

    /// The second of two numbers that differ.
    pub fn second(&mut self, key: &Key, value: &mut f64) {
        self.ranged(&second_range(key, self.diagonal_m), value);
    }

    fn ranged(&mut self, range: &Range, value: &mut f64) {
        self.row(range.label, range.tooltip, |ui, label| {
            slider_and_box(ui, label, range, value)
        });
    }

    /// Three numbers side by side.
    pub fn vector(&mut self, key: &Key, value: &mut [f64; 3]) {
        self.boxes(key, &["x", "y", "z"], value);
    }

    /// Numbers side by side, each a box to drag in.
    pub fn boxes(&mut self, key: &Key, names: &[&str], values: &mut [f64]) {
        let range = self.range(key);
        self.boxes_labelled(range.label, &range, names, values);
    }

    fn boxes_labelled(&mut self, label: &str, range: &Range, names: &[&str], values: &mut [f64]) {
        let shown = range.unit.shown_together(values, FINE * self.diagonal_m);
        let boxes = |ui: &mut Ui, _: &Response| {
            let width = share(ui, names.len());
            names
                .iter()
                .zip(values)
                .fold(false, |changed, (name, value)| {
                    small_box(ui, width, label, name, (range, shown), value) || changed
                })
        };
        let needed = LABEL_WIDTH + LEAST_BOX_WIDTH * names.len() as f32;
        if self.ui.available_width() > needed {
            self.row(label, range.tooltip, boxes);
            return;
        }
        // In a narrow panel below their label.
        let text = self.ui.label(label).on_hover_text(range.tooltip);
        if self.ui.horizontal(|ui| boxes(ui, &text)).inner {
            self.note(label);
        }
    }

    /// A slider from 0 to 1. Without a value it is grey, above the reason.
    pub fn fraction_slider(
        &mut self,
        [label, tooltip]: [&'static str; 2],
        value: Result<&mut f64, &'static str>,
    ) {
        let range = Range {
            label,
            slider: 0.0..=1.0,
            bounds: Bounds::Within(0.0, 1.0),
            logarithmic: false,
            unit: Unit::None,
            is_whole: false,
            tooltip,
        };
        match value {
            Ok(value) => self.ranged(&range, value),
            Err(why) => {
                self.row(label, tooltip, |ui, text| {
                    ui.disable();
                    slider_and_box(ui, text, &range, &mut 0.0)
                });
                self.row("", "", |ui, _| {
                    ui.weak(why);
                    false
                });
            }
        }
    }

    /// A linear colour, each channel in [0, 1].
    pub fn color(&mut self, key: &Key, value: &mut [f64; 3]) {
        let range = self.range(key);
        self.row(range.label, range.tooltip, |ui, label| {
            let mut rgb = value.map(|channel| channel as f32);
            let response = ui.color_edit_button_rgb(&mut rgb).labelled_by(label.id);
            if response.changed() {
                *value = rgb.map(f64::from);
            }
            response.changed()
        });
    }

    /// Yes or no.
    pub fn toggle(&mut self, label: &str, tooltip: &str, value: &mut bool) {
        self.row(label, tooltip, |ui, text| {
            ui.checkbox(value, "").labelled_by(text.id).changed()
        });
    }

    /// Yes or no, by the texts of a key.
    pub fn flag(&mut self, key: &Key, value: &mut bool) {
        let range = self.range(key);
        self.toggle(range.label, range.tooltip, value);
    }

    /// Whether there is a value, which begins as `begin` where it is turned on.
    pub fn optional<'v, T>(
        &mut self,
        [label, tooltip]: [&str; 2],
        value: &'v mut Option<T>,
        begin: impl FnOnce() -> T,
    ) -> Option<&'v mut T> {
        let mut is_there = value.is_some();
        self.toggle(label, tooltip, &mut is_there);
        match is_there {
            true => Some(value.get_or_insert_with(begin)),
            false => {
                *value = None;
                None
            }
        }
    }

    /// Row for the choice of one of several values, by name.
    pub fn choice<T: PartialEq + Clone>(
        &mut self,
        label: &str,
        tooltip: &str,
        options: impl IntoIterator<Item = (T, String)>,
        value: &mut T,
    ) {
        let options: Vec<_> = options.into_iter().collect();
        self.row(label, tooltip, |ui, text| {
            let chosen = options.iter().find(|(option, _)| option == value);
            let name = chosen.map_or("", |(_, name)| name.as_str());
            let before = value.clone();
            egui::ComboBox::from_id_salt(label)
                .selected_text(name)
                .width(ui.available_width() - 8.0)
                .show_ui(ui, |ui| {
                    for (option, name) in &options {
                        ui.selectable_value(value, option.clone(), name);
                    }
                })
                .response
                .labelled_by(text.id);
            *value != before
        });
    }

    /// An object of the scene, by its name.
    pub fn object(&mut self, tooltip: &str, description: &Description, value: &mut String) {
        let names = description.objects.iter().map(|object| object.name.clone());
        self.choice(
            "Object",
            tooltip,
            names.map(|name| (name.clone(), name)),
            value,
        );
    }

    /// The name of a part that may have none.
    pub fn optional_name(&mut self, value: &mut Option<String>) {
        let mut name = value.clone().unwrap_or_default();
        self.text(NAME, "What the outliner calls it", &mut name);
        *value = (!name.is_empty()).then_some(name);
    }

    /// A line of text, which counts when it is left.
    pub fn text(&mut self, label: &str, tooltip: &str, value: &mut String) {
        let scope = self.scope;
        self.row(label, tooltip, |ui, text| {
            let width = ui.available_width() - 8.0;
            line(ui, width, (scope, label), text, value)
        });
    }

    /// The file of a picture, as the scene file writes it, and a button to choose it.
    pub fn picture(
        &mut self,
        label: &str,
        tooltip: &str,
        file: &mut Option<PathBuf>,
        of: PictureOf,
    ) {
        const BUTTON_WIDTH: f32 = 30.0;
        let scope = self.scope;
        let shown = file.as_deref().map(|file| file.to_string_lossy());
        let mut typed = shown.unwrap_or_default().into_owned();
        let mut is_to_be_chosen = false;
        self.row(label, tooltip, |ui, text| {
            let left = if HAS_DISK { BUTTON_WIDTH } else { 0.0 };
            let width = ui.available_width() - 8.0 - left;
            let has_changed = line(ui, width, (scope, label), text, &mut typed);
            if HAS_DISK {
                let button = ui.button("…").on_hover_text("Choose the file");
                ui.ctx().accesskit_node_builder(button.id, |node| {
                    node.set_label(format!("Choose {}", label.to_lowercase()));
                });
                is_to_be_chosen = button.clicked();
            }
            has_changed
        });
        *file = (!typed.is_empty()).then(|| typed.into());
        if is_to_be_chosen {
            self.wanted = Some(of);
        }
    }

    /// The picture whose file is to be chosen, if its button was pressed.
    pub fn wanted(&self) -> Option<PictureOf> {
        self.wanted
    }

    /// Row for one of several places, counted from 1 on the screen.
    pub fn numbered(&mut self, key: &Key, i: usize, position_m: &mut [f64; 3]) {
        let range = self.range(key);
        let label = format!("{} {}", range.label, i + 1);
        self.boxes_labelled(&label, &range, &["x", "y", "z"], position_m);
    }

    /// A point of a lathe's profile.
    pub fn point(&mut self, i: usize, radius_m: &mut f64, height_m: &mut f64) {
        let range = self.range(Shape::PROFILE_M);
        let heights = second_range(Shape::PROFILE_M, self.diagonal_m);
        let label = format!("Point {}", i + 1);
        let fine_m = FINE * self.diagonal_m;
        self.row(&label, range.tooltip, |ui, _| {
            let width = share(ui, 2);
            let shown = range.unit.shown_together(&[*radius_m, *height_m], fine_m);
            let parts = [("r", &range, radius_m), ("z", &heights, height_m)];
            parts
                .into_iter()
                .fold(false, |changed, (name, range, value)| {
                    small_box(ui, width, &label, name, (range, shown), value) || changed
                })
        });
    }

    /// A number that stands for a draw of lots, with a die that throws another.
    pub fn seed(&mut self, value: &mut u64) {
        let range = self.range(Laid::SEED);
        self.row(range.label, range.tooltip, |ui, label| {
            let mut number = *value as f64;
            let typed = NumberBox {
                label: range.label,
                prefix: "",
                range: &range,
                shown: range.unit.shown(number),
                width: VALUE_WIDTH,
            }
            .show(ui, &mut number)
            .labelled_by(label.id);
            if typed.changed() {
                *value = number.max(0.0).round() as u64;
            }
            let die = ui.button("🎲").on_hover_text(
                "Another seed: the same kind of scratches or grooves in other places",
            );
            ui.ctx()
                .accesskit_node_builder(die.id, |node| node.set_label("Another seed"));
            if die.clicked() {
                *value = another_seed(*value);
            }
            typed.changed() || die.clicked()
        });
    }

    /// Buttons or words in the controls' column.
    pub fn custom(
        &mut self,
        label: &str,
        tooltip: &str,
        control: impl FnOnce(&mut Ui, &Response) -> bool,
    ) {
        self.row(label, tooltip, control);
    }
}

/// Rows as the entries of the keys have them.
impl Panel for Form<'_> {
    fn row(&mut self, key: &'static Key, value: RowValue) {
        match value {
            RowValue::Number(millimetres) if key.unit == "mm" => {
                self.in_metres(key, *millimetres, |after| *millimetres = after);
            }
            RowValue::Number(number) => self.number(key, number),
            RowValue::Whole(seed) if key == Laid::SEED => self.seed(seed),
            RowValue::Whole(number) => self.whole(key, number),
            RowValue::Count(count) => {
                let mut number = u64::from(*count);
                self.whole(key, &mut number);
                *count = u32::try_from(number).unwrap_or(u32::MAX);
            }
            RowValue::Numbers([first, second]) if key.second.is_some() => {
                self.number(key, first);
                self.second(key, second);
            }
            RowValue::Numbers([r, g, b]) if key.form == Spelling::Color => {
                let mut color = [*r, *g, *b];
                self.color(key, &mut color);
                [*r, *g, *b] = color;
            }
            RowValue::Numbers(numbers) => {
                let names = &["x", "y", "z"][..numbers.len().min(3)];
                self.boxes(key, names, numbers);
            }
            RowValue::Sizes(sizes) => self.distribution(key, sizes),
            RowValue::Flag(flag) => self.flag(key, flag),
            RowValue::Text(text) => {
                let range = self.range(key);
                self.text(range.label, range.tooltip, text);
            }
        }
    }
}

/// A form that takes rows for the keys that it has none of.
struct Rest<'f, 'a>(&'f mut Form<'a>);

impl Panel for Rest<'_, '_> {
    fn row(&mut self, key: &'static Key, value: RowValue) {
        if !self.0.shown.contains(&key.name) {
            Panel::row(self.0, key, value);
        }
    }
}

/// A throw of four digits, which comes back to no earlier one for long.
fn another_seed(seed: u64) -> u64 {
    let mixed = seed
        .wrapping_add(0x9e37_79b9)
        .wrapping_mul(0x5851_f42d_4c95_7f2d);
    let thrown = (mixed >> 33) % 9000 + 1000;
    if thrown == seed { thrown + 1 } else { thrown }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_document::description::Camera;

    #[test]
    fn the_rest_of_a_table_is_what_has_no_row_yet() {
        let mut camera = Camera::default();
        let mut shown = Vec::new();
        let _ = egui::Context::default().run_ui(egui::RawInput::default(), |ui| {
            let mut form = Form::new(ui, "camera", 0.3);
            form.number(Camera::FOV_Y_DEG, &mut camera.fov_y_deg);
            form.leave_out(&[Camera::EXPOSURE_EV]);
            form.rest(&mut camera);
            shown = form.shown;
        });
        let keys = [
            Camera::FOV_Y_DEG,
            Camera::EXPOSURE_EV,
            Camera::POSITION_M,
            Camera::TARGET_M,
            Camera::UP,
        ];
        assert_eq!(shown, keys.map(|key| key.name));
    }
}

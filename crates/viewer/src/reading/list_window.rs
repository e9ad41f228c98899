//! The window with the list of a layer's scratches.

use std::ops::Range;

use egui::{Align2, Button, DragValue, Label, Response, RichText, ScrollArea, TextStyle, Ui, vec2};
use hairline_editor::Selection;
use hairline_editor::actions::layers;

use super::window::window;
use crate::command::Command;
use crate::measure::{PickedScratch, ScratchTexts};
use crate::progressive::Built;
use crate::workspace::Workspace;

/// Columns with their widths, points.
const COLUMNS: [(&str, f32); 6] = [
    ("Scratch", 56.0),
    ("Width", 64.0),
    ("Depth", 64.0),
    ("Length", 72.0),
    ("Direction", 148.0),
    ("Middle", 164.0),
];
const HEIGHT: f32 = 240.0;

/// Shows the list of the selected layer, if it is open.
pub(super) fn show_list(ui: &Ui, work: &mut Workspace, picture: &Response) {
    let (true, Selection::Layer(layer)) = (work.measure.has_list, work.selection()) else {
        return;
    };
    let object = work.selection().object(work.document.description());
    let named = work.document.description().scratches.get(layer);
    let title = named.map_or(String::new(), |it| format!("List: {}", layers::title(it)));
    let built = work.renderer.built().filter(|built| !built.is_sketch());
    let corner = (
        // Messages stand at the lower edge, and badges in the corner.
        Align2::LEFT_TOP,
        picture.rect.left_top() + vec2(12.0, 44.0),
    );
    let mut is_open = true;
    window(&title, &mut is_open, corner, picture.rect)
        .id(egui::Id::unique("list of scratches"))
        .show(ui.ctx(), |ui| match (built, object) {
            (Some(built), Some(object)) => rows(ui, work, &built, object, layer),
            _ => drop(ui.label("The scratches are being laid.")),
        });
    work.measure.has_list = is_open;
}

/// The cells of a scratch; whether it was clicked.
fn cells(ui: &mut Ui, number: usize, is_picked: bool, texts: ScratchTexts, height: f32) -> bool {
    let size = |column: usize| [COLUMNS[column].1, height];
    let button = Button::selectable(is_picked, number.to_string());
    let is_clicked = ui.add_sized(size(0), button).clicked();
    let cells = [
        texts.width,
        texts.depth,
        texts.length,
        texts.direction,
        texts.place,
    ];
    for (i, text) in cells.into_iter().enumerate() {
        ui.add_sized(size(i + 1), Label::new(text).truncate());
    }
    is_clicked
}

fn rows(ui: &mut Ui, work: &mut Workspace, built: &Built, object: usize, layer: usize) {
    let Some(laid) = built.scene.objects.get(object) else {
        return;
    };
    let own = laid.of_layer(layer as u32);
    ui.horizontal(|ui| {
        for (name, width) in COLUMNS {
            let name = RichText::new(name).weak();
            ui.add_sized([width, 0.0], Label::new(name));
        }
    });
    let picked = work.measure.picked.as_ref();
    let picked = picked.filter(|it| it.layer() == layer && it.find(built).is_some());
    let picked = picked.map(PickedScratch::number);
    let mut area = ScrollArea::vertical().max_height(HEIGHT).auto_shrink(false);
    let height = ui
        .text_style_height(&TextStyle::Body)
        .max(ui.spacing().interact_size.y);
    if std::mem::take(&mut work.measure.reveals)
        && let Some(number) = picked
    {
        let row = height + ui.spacing().item_spacing.y;
        area = area.vertical_scroll_offset((number as f32 * row - 0.4 * HEIGHT).max(0.0));
    }
    let show = |ui: &mut Ui, shown: Range<usize>| {
        let mut chosen = None;
        for number in shown {
            let scratch = &laid.scratches[own.start + number];
            let texts = ScratchTexts::new(laid, scratch);
            let is_picked = picked == Some(number);
            let row = ui.horizontal(|ui| cells(ui, number, is_picked, texts, height));
            if row.inner {
                chosen = Some(own.start + number);
            }
        }
        chosen
    };
    let mut chosen = area.show_rows(ui, height, own.len(), show).inner;
    ui.separator();
    ui.horizontal(|ui| {
        ui.label(format!("{} scratches", own.len()));
        let label = ui.label("Go to");
        let mut number = picked.unwrap_or(0);
        let last = own.len().saturating_sub(1);
        let go = DragValue::new(&mut number).range(0..=last);
        let go = ui.add_enabled(!own.is_empty(), go.update_while_editing(false));
        if go.labelled_by(label.id).changed() {
            chosen = Some(own.start + number);
            work.measure.reveals = true;
        }
        if ui.button(Command::SaveList.label()).clicked() {
            work.requested.push(Command::SaveList);
        }
    });
    if let Some(index) = chosen {
        work.measure.picked = PickedScratch::new(built, object, index);
    }
}

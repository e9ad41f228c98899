//! The examples with their pictures, to choose one.

use egui::{Context, Grid, Id, Modal, Rect, Sense, TextureHandle, TextureOptions, Ui, pos2, vec2};

use super::answer::{Answer, PendingAction};
use crate::examples::{COLUMNS, Examples, PICTURE_PX};
use crate::gallery::{sheet_of, tile};

/// The examples, as they are shown.
pub(crate) struct Choice {
    examples: &'static Examples,
    /// The sheet of pictures; none until it is first shown.
    sheet: Option<TextureHandle>,
}

impl Choice {
    pub fn new(examples: &'static Examples) -> Self {
        Self {
            examples,
            sheet: None,
        }
    }

    /// Shows the examples; none until there is an answer.
    pub fn show(&mut self, ctx: &Context) -> Option<Answer> {
        let modal = Modal::new(Id::unique("examples")).show(ctx, |ui| {
            ui.heading("Examples");
            let height = ui.ctx().content_rect().height() - 130.0;
            let chosen = egui::ScrollArea::vertical()
                .max_height(height.max(120.0))
                .show(ui, |ui| self.grid(ui));
            ui.add_space(8.0);
            let cancel = ui.button("Cancel").clicked();
            (chosen.inner, cancel)
        });
        let should_close = modal.should_close();
        match modal.inner {
            (Some(chosen), _) => Some(Answer::Request(PendingAction::Example(chosen))),
            (None, cancel) => (cancel || should_close).then_some(Answer::Cancel),
        }
    }

    /// The pictures; the index of the one that was clicked.
    fn grid(&mut self, ui: &mut Ui) -> Option<usize> {
        let sheet = self.sheet.get_or_insert_with(|| {
            // An empty sheet shows nothing, where the program was built with a broken one.
            let image = sheet_of(self.examples.sheet).unwrap_or_default();
            (ui.ctx()).load_texture("examples", image, TextureOptions::LINEAR)
        });
        let size = PICTURE_PX.map(|side| side as f32);
        let room = ui.ctx().content_rect().width() - 80.0;
        let width = size[0] + 12.0;
        let columns = ((room / width) as usize).clamp(1, COLUMNS as usize);
        ui.set_width(columns as f32 * width);
        let mut chosen = None;
        Grid::new(Id::unique("examples"))
            .spacing(vec2(4.0, 4.0))
            .show(ui, |ui| {
                for (i, example) in self.examples.scenes.iter().enumerate() {
                    if i > 0 && i % columns == 0 {
                        ui.end_row();
                    }
                    let picture = (sheet.id(), part(sheet, i as u32));
                    let size = vec2(size[0], size[1]);
                    let (tile, _) =
                        tile(ui, Some(picture), size, example.name, Sense::click(), false);
                    if tile.clicked() {
                        chosen = Some(i);
                    }
                }
            });
        chosen
    }
}

/// The share of the sheet that a picture has.
fn part(sheet: &TextureHandle, place: u32) -> Rect {
    let corner = [place % COLUMNS, place / COLUMNS];
    let size = PICTURE_PX.map(|side| side as f32);
    let min = pos2(corner[0] as f32 * size[0], corner[1] as f32 * size[1]);
    let part = Rect::from_min_size(min, vec2(size[0], size[1]));
    // Half a pixel of the neighbours would be seen at the rim.
    let part = part.shrink(0.5);
    let whole = sheet.size_vec2();
    Rect::from_min_max(
        (part.min.to_vec2() / whole).to_pos2(),
        (part.max.to_vec2() / whole).to_pos2(),
    )
}

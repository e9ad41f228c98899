//! Small pictures of the choices: presets, materials, lights, shapes, environments, grades of wear.
//!
//! All of them are on one sheet, `assets/tiles.jpg`, which `scenes.rs` renders: its tests say when it is out of date, and
//! `HAIRLINE_WRITE=1 cargo test --release -p hairline-viewer-lib --lib tiles` makes it anew.

mod cards;
#[cfg(test)]
mod scenes;
mod thumb;

use egui::{ColorImage, Rect, TextureHandle, TextureId, TextureOptions, pos2, vec2};

pub(crate) use cards::{SIDE, card, cards, metal_swatches, tile};
pub(crate) use thumb::{StandIn, Thumb};

/// Width and height of a picture.
const SIDE_PX: u32 = 96;
/// Pictures in a row of the sheet.
const COLUMNS: u32 = 12;
const SHEET: &[u8] = include_bytes!("../assets/tiles.jpg");

/// The sheet, once a menu that shows a part of it was open.
#[derive(Default)]
pub(crate) struct Gallery {
    sheet: Option<TextureHandle>,
}

impl Gallery {
    /// The picture: the sheet's texture, and the part of it.
    pub fn picture(&mut self, ctx: &egui::Context, thumb: Thumb) -> Option<(TextureId, Rect)> {
        let place = Thumb::all().position(|other| other == thumb)? as u32;
        let sheet = self.sheet.get_or_insert_with(|| {
            // An empty sheet shows nothing, where the program was built with a broken one.
            let image = sheet_of(SHEET).unwrap_or_default();
            ctx.load_texture("presets", image, TextureOptions::LINEAR)
        });
        // Half a pixel of the neighbours would be seen at the rim.
        let corner = [place % COLUMNS, place / COLUMNS].map(|i| (i * SIDE_PX) as f32 + 0.5);
        let side = vec2(1.0, 1.0) * (SIDE_PX as f32 - 1.0);
        let part = Rect::from_min_size(pos2(corner[0], corner[1]), side);
        let size = sheet.size_vec2();
        let share = Rect::from_min_max(
            (part.min.to_vec2() / size).to_pos2(),
            (part.max.to_vec2() / size).to_pos2(),
        );
        Some((sheet.id(), share))
    }
}

/// The pixels of a sheet.
pub(crate) fn sheet_of(jpeg: &[u8]) -> Option<ColorImage> {
    let format = image::ImageFormat::Jpeg;
    let sheet = image::load_from_memory_with_format(jpeg, format).ok()?;
    let size = [sheet.width() as usize, sheet.height() as usize];
    Some(ColorImage::from_rgb(size, sheet.into_rgb8().as_raw()))
}

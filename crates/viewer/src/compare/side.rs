//! The picture right of the divider.

use std::sync::Arc;

use egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, Ui, pos2};
use hairline_image::{Display, png};

use super::work::Comparison;

/// The picture right of the divider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Reference,
    Errors,
}

impl Side {
    pub fn name(self) -> &'static str {
        match self {
            Self::Reference => "Reference",
            Self::Errors => "Error map",
        }
    }
}

/// The right side as something that egui can draw, until it changes.
#[derive(Default)]
pub(super) struct SideTexture {
    texture: Option<TextureHandle>,
    held: Option<(u64, Side, Option<Display>)>,
}

impl SideTexture {
    /// Forgets the picture when another reference begins: numbers count from the start.
    pub fn forget(&mut self) {
        self.held = None;
    }

    pub fn paint(
        &mut self,
        ui: &Ui,
        rect: Rect,
        shown: &Comparison,
        side: Side,
        display: &Display,
    ) {
        let key = (
            shown.number,
            side,
            (side == Side::Reference).then_some(*display),
        );
        if self.held != Some(key) {
            let image = match side {
                Side::Reference => {
                    let size = shown.reference.size_px.map(|side| side as usize);
                    let codes = png::quantize(&shown.reference, display);
                    ColorImage::from_rgb(size, &codes).into()
                }
                Side::Errors => match &shown.compared {
                    Some(compared) => Arc::clone(&compared.errors),
                    None => return,
                },
            };
            let options = TextureOptions::LINEAR;
            match &mut self.texture {
                Some(texture) => texture.set(image, options),
                None => {
                    self.texture = Some(ui.ctx().load_texture("reference", image, options));
                }
            }
            self.held = Some(key);
        }
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter()
                .image(texture.id(), rect, whole, Color32::WHITE);
        }
    }
}

//! The newest picture as something that egui can draw.

use eframe::egui_wgpu::RenderState;
use egui::{Color32, Rect, TextureHandle, TextureId, TextureOptions, pos2};

use crate::engine::{Frame, Picture};

use super::Area;

/// Holds the texture of one frame until the next.
pub(super) struct CanvasTexture {
    render_state: Option<RenderState>,
    number: Option<u64>,
    held: Held,
}

enum Held {
    Nothing,
    Copied(TextureHandle),
    /// The renderer's own, by the name that egui knows it under.
    Registered(TextureId),
}

impl CanvasTexture {
    pub fn new(render_state: Option<RenderState>) -> Self {
        Self {
            render_state,
            number: None,
            held: Held::Nothing,
        }
    }

    /// Fills the area. While a coarser picture of another shape is all there is, it is stretched.
    pub fn paint(&mut self, ui: &egui::Ui, area: &Area, frame: &Frame) {
        if self.number != Some(frame.number) {
            self.take(ui.ctx(), frame);
            self.number = Some(frame.number);
        }
        let id = match &self.held {
            Held::Nothing => return,
            Held::Copied(texture) => texture.id(),
            Held::Registered(id) => *id,
        };
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(id, area.rect, whole, Color32::WHITE);
    }

    fn take(&mut self, ctx: &egui::Context, frame: &Frame) {
        match (&frame.picture, &self.render_state) {
            (Picture::Pixels(image), _) => {
                let options = TextureOptions::LINEAR;
                match &mut self.held {
                    Held::Copied(texture) => texture.set(image.clone(), options),
                    _ => {
                        let texture = ctx.load_texture("picture", image.clone(), options);
                        self.hold(Held::Copied(texture));
                    }
                }
            }
            (Picture::Texture(view), Some(state)) => {
                let id = state.renderer.write().register_native_texture(
                    &state.device,
                    view,
                    wgpu::FilterMode::Linear,
                );
                self.hold(Held::Registered(id));
            }
            // Only a window with a device is given textures of it.
            (Picture::Texture(_), None) => {}
        }
    }

    fn hold(&mut self, next: Held) {
        if let (Held::Registered(id), Some(state)) =
            (std::mem::replace(&mut self.held, next), &self.render_state)
        {
            state.renderer.write().free_texture(&id);
        }
    }
}

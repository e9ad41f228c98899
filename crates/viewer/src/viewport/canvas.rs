//! The newest picture as something that egui can draw.

use eframe::egui_wgpu::RenderState;
use egui::{Color32, Rect, TextureHandle, TextureId, TextureOptions, pos2};

use crate::engine::{Frame, Picture, View};

use super::Area;

/// Holds the texture of one frame until the next.
pub(crate) struct CanvasTexture {
    render_state: Option<RenderState>,
    number: Option<u64>,
    held: Held,
    /// The picture is one of another view since then, seconds.
    stale_since: Option<f64>,
    is_stale: bool,
}

/// A picture of another view is shown for so long without a sign: while something moves there is a new one before.
const STALE_S: f64 = 0.4;
/// What it is dimmed by then.
const STALE: Color32 = Color32::from_gray(110);

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
            stale_since: None,
            is_stale: false,
        }
    }

    /// Fills the area. While a coarser picture of another shape is all there is, it is stretched; one from elsewhere that stays for
    /// long is dimmed.
    pub fn paint(&mut self, ui: &egui::Ui, area: &Area, frame: &Frame, wanted: &View) {
        let Some(id) = self.texture(ui.ctx(), frame) else {
            return;
        };
        let now = ui.input(|input| input.time);
        let is_stale = !frame.view.has_same_pixels(wanted);
        let since = *self.stale_since.get_or_insert(now);
        let age_s = now - since;
        if !is_stale {
            self.stale_since = None;
        } else if age_s < STALE_S {
            let rest = std::time::Duration::from_secs_f64(STALE_S - age_s);
            ui.ctx().request_repaint_after(rest);
        }
        self.is_stale = is_stale && age_s >= STALE_S;
        let tint = if self.is_stale { STALE } else { Color32::WHITE };
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(id, area.rect, whole, tint);
        if self.is_stale {
            let at = area.rect.center_top() + egui::vec2(0.0, 12.0);
            let font = egui::FontId::proportional(14.0);
            let text = "Earlier view. The new one is being rendered";
            let galley = ui
                .painter()
                .layout_no_wrap(text.into(), font, Color32::WHITE);
            let rect = egui::Align2::CENTER_TOP.anchor_size(at, galley.size());
            let painter = ui.painter();
            painter.rect_filled(rect.expand(5.0), 4.0, Color32::from_black_alpha(190));
            painter.galley(rect.min, galley, Color32::WHITE);
        }
    }

    /// Whether what was drawn last is a picture of another view, and has been for long enough to be noticed.
    pub fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// The frame as a texture; none where it lies on a device that the window has not.
    pub fn texture(&mut self, ctx: &egui::Context, frame: &Frame) -> Option<TextureId> {
        if self.number != Some(frame.number) {
            self.take(ctx, frame);
            self.number = Some(frame.number);
        }
        match &self.held {
            Held::Nothing => None,
            Held::Copied(texture) => Some(texture.id()),
            Held::Registered(id) => Some(*id),
        }
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

    /// The state of the device that draws the window, if there is one.
    pub fn render_state(&self) -> Option<&RenderState> {
        self.render_state.as_ref()
    }

    fn hold(&mut self, next: Held) {
        if let (Held::Registered(id), Some(state)) =
            (std::mem::replace(&mut self.held, next), &self.render_state)
        {
            state.renderer.write().free_texture(&id);
        }
    }
}

impl Drop for CanvasTexture {
    fn drop(&mut self) {
        self.hold(Held::Nothing);
    }
}

//! The newest picture as something that egui can draw.

use std::sync::Arc;

use eframe::egui_wgpu::RenderState;
use egui::layers::ShapeIdx;
use egui::{Color32, ColorImage, Rect, Shape, TextureHandle, TextureId, TextureOptions, pos2};

use crate::progressive::{Frame, Picture, View};

use super::Area;

/// Holds the texture of one frame until the next.
pub(crate) struct CanvasTexture {
    render_state: Option<RenderState>,
    number: Option<u64>,
    held: CanvasSource,
    /// The picture is one of another view since then, seconds.
    stale_since: Option<f64>,
    is_stale: bool,
}

/// Time for which a picture of another view is shown without a sign: while something moves, a new picture comes earlier.
const STALE_S: f64 = 0.4;
/// Distance of words on a picture from its upper edge, points: badges stand above.
pub(crate) const BELOW_BADGES: f32 = 46.0;
/// Tint of a picture that is out of date.
const STALE: Color32 = Color32::from_gray(110);

enum CanvasSource {
    Nothing,
    Copied(TextureHandle),
    /// The renderer's own texture, by its id in egui.
    Registered(TextureId),
}

impl CanvasTexture {
    pub fn new(render_state: Option<RenderState>) -> Self {
        Self {
            render_state,
            number: None,
            held: CanvasSource::Nothing,
            stale_since: None,
            is_stale: false,
        }
    }

    /// Fills the area with the picture, at its place in the order of drawing. While a coarser picture of another shape is all there is, it is stretched; one
    /// from elsewhere that stays for long is dimmed.
    pub fn paint(
        &mut self,
        ui: &egui::Ui,
        place: ShapeIdx,
        area: &Area,
        frame: &Frame,
        wanted: &View,
    ) {
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
        let mut shapes = vec![Shape::image(id, area.rect, whole, tint)];
        if self.is_stale {
            let at = area.rect.center_top() + egui::vec2(0.0, BELOW_BADGES);
            let font = egui::FontId::proportional(14.0);
            let text = "Earlier view. The new one is being rendered";
            let galley = ui
                .painter()
                .layout_no_wrap(text.into(), font, Color32::WHITE);
            let rect = egui::Align2::CENTER_TOP.anchor_size(at, galley.size());
            let ground = crate::style::UNDER_WORDS;
            shapes.push(Shape::rect_filled(rect.expand(5.0), 4.0, ground));
            shapes.push(Shape::galley(rect.min, galley, Color32::WHITE));
        }
        ui.painter().set(place, Shape::Vec(shapes));
    }

    /// Draws the picture of a region over its part of the area.
    pub fn paint_region(&mut self, ui: &egui::Ui, place: ShapeIdx, area: &Area, part: &Frame) {
        let (Some(id), Some(region)) = (self.texture(ui.ctx(), part), part.view.region) else {
            return;
        };
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let rect = area.region_rect(region);
        ui.painter()
            .set(place, Shape::image(id, rect, whole, Color32::WHITE));
    }

    /// Whether the picture drawn last is of another view, and has been for long enough to be noticed.
    pub fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// The frame as a texture; none where it lies on a device that the window has not.
    pub fn texture(&mut self, ctx: &egui::Context, frame: &Frame) -> Option<TextureId> {
        self.texture_of(ctx, frame.number, &frame.picture)
    }

    /// The picture of that number as a texture.
    pub fn texture_of(
        &mut self,
        ctx: &egui::Context,
        number: u64,
        picture: &Picture,
    ) -> Option<TextureId> {
        if self.number != Some(number) {
            self.take(ctx, picture);
            self.number = Some(number);
        }
        match &self.held {
            CanvasSource::Nothing => None,
            CanvasSource::Copied(texture) => Some(texture.id()),
            CanvasSource::Registered(id) => Some(*id),
        }
    }

    /// The picture in main memory.
    pub fn pixels(&self, picture: &Picture) -> Option<Arc<ColorImage>> {
        match (picture, &self.render_state) {
            (Picture::Pixels(pixels), _) => Some(Arc::clone(pixels)),
            (Picture::Texture(view), Some(state)) => read(state, view.texture()).map(Arc::new),
            (Picture::Texture(_), None) => None,
        }
    }

    fn take(&mut self, ctx: &egui::Context, picture: &Picture) {
        match (picture, &self.render_state) {
            (Picture::Pixels(image), _) => {
                let options = TextureOptions::LINEAR;
                match &mut self.held {
                    CanvasSource::Copied(texture) => texture.set(image.clone(), options),
                    _ => {
                        let texture = ctx.load_texture("picture", image.clone(), options);
                        self.hold(CanvasSource::Copied(texture));
                    }
                }
            }
            (Picture::Texture(view), Some(state)) => {
                let id = state.renderer.write().register_native_texture(
                    &state.device,
                    view,
                    wgpu::FilterMode::Linear,
                );
                self.hold(CanvasSource::Registered(id));
            }
            // Only a window with a device is given textures of it.
            (Picture::Texture(_), None) => {}
        }
    }

    /// Room for another picture on the same device.
    pub fn another(&self) -> Self {
        Self::new(self.render_state.clone())
    }

    fn hold(&mut self, next: CanvasSource) {
        if let (CanvasSource::Registered(id), Some(state)) =
            (std::mem::replace(&mut self.held, next), &self.render_state)
        {
            state.renderer.write().free_texture(&id);
        }
    }
}

/// Reads a texture of four bytes a pixel, and waits for it.
fn read(state: &RenderState, texture: &wgpu::Texture) -> Option<ColorImage> {
    let [width, height] = [texture.width(), texture.height()];
    let row_bytes = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = state.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture of a snapshot"),
        size: u64::from(row_bytes) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = state.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    state.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    state
        .device
        .poll(wgpu::PollType::wait_indefinitely())
        .ok()?;
    let mapped = buffer.slice(..).get_mapped_range().ok()?;
    let rows = mapped.chunks(row_bytes as usize);
    let pixels: Vec<u8> = rows
        .flat_map(|row| &row[..4 * width as usize])
        .copied()
        .collect();
    let size = [width as usize, height as usize];
    Some(ColorImage::from_rgba_premultiplied(size, &pixels))
}

impl Drop for CanvasTexture {
    fn drop(&mut self) {
        self.hold(CanvasSource::Nothing);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progressive::ProgressiveRenderer;
    use egui::{Context, FullOutput, RawInput};
    use hairline_fixtures::scenes::bare_plate;

    fn frame() -> Arc<Frame> {
        let description = bare_plate().description();
        let camera = super::super::camera(&description.camera);
        let mut renderer = ProgressiveRenderer::start_in_turn(Arc::new(|| {}));
        renderer.set_scene(1, Arc::new(description), "");
        renderer.set_view(View {
            camera,
            size_px: [40, 30],
            display: hairline_image::Display {
                exposure_ev: 0.0,
                tone_map: Default::default(),
            },
            filter_std_px: 0.5,
            transport: hairline_scene::Transport::DIRECT,
            reading: Default::default(),
            region: None,
        });
        loop {
            renderer.work();
            if let Some(frame) = renderer.latest() {
                return frame;
            }
        }
    }

    /// Whether the picture is dimmed, and whether a text says why.
    fn signs(output: &FullOutput) -> (bool, bool) {
        let shapes = output
            .shapes
            .iter()
            .flat_map(|clipped| match &clipped.shape {
                Shape::Vec(shapes) => shapes.iter().collect(),
                shape => vec![shape],
            });
        let is_dimmed = |shape: &Shape| match shape {
            Shape::Mesh(mesh) => mesh.vertices.iter().all(|vertex| vertex.color == STALE),
            Shape::Rect(rect) => rect.brush.is_some() && rect.fill == STALE,
            _ => false,
        };
        let tells = |shape: &Shape| match shape {
            Shape::Text(text) => text.galley.text().contains("Earlier view"),
            _ => false,
        };
        (shapes.clone().any(is_dimmed), shapes.clone().any(tells))
    }

    #[test]
    fn a_picture_from_elsewhere_is_dimmed_and_named_until_the_new_one_is_there() {
        let frame = frame();
        let here = frame.view;
        let mut there = here;
        there.camera.position_m.x += 0.1;
        let (context, mut canvas) = (Context::default(), CanvasTexture::new(None));
        let mut signs_at = |time_s: f64, wanted: &View| {
            let input = RawInput {
                time: Some(time_s),
                ..RawInput::default()
            };
            let output = context.run_ui(input, |ui| {
                let area = Area::new(ui.max_rect(), [40, 30], 1.0);
                let place = ui.painter().add(Shape::Noop);
                canvas.paint(ui, place, &area, &frame, wanted);
            });
            let (is_dimmed, tells) = signs(&output);
            assert_eq!(canvas.is_stale(), tells);
            (is_dimmed, tells)
        };
        assert_eq!(signs_at(0.0, &here), (false, false));
        // While something moves the next one is there before this matters.
        assert_eq!(signs_at(10.0, &there), (false, false));
        assert_eq!(signs_at(10.0 + 0.9 * STALE_S, &there), (false, false));
        assert_eq!(signs_at(10.0 + 1.1 * STALE_S, &there), (true, true));
        assert_eq!(signs_at(60.0, &there), (true, true));
        assert_eq!(signs_at(60.1, &here), (false, false));
        // The next movement has its own time.
        assert_eq!(signs_at(60.2, &there), (false, false));
    }
}

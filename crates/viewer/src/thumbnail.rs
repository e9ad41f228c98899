//! Small pictures with names, side by side over the lower edge of the picture.

use egui::{
    Align2, Color32, CornerRadius, Painter, Rect, Response, Role, Sense, Stroke, StrokeKind,
    TextureId, Ui, Vec2, WidgetInfo, pos2, vec2,
};

/// Height of a thumbnail, points; as wide as its picture needs, within bounds.
pub(crate) const HEIGHT: f32 = 72.0;
const WIDTHS: std::ops::RangeInclusive<f32> = 48.0..=150.0;
const NAME_HEIGHT: f32 = 18.0;
/// Height of the picture below which a strip is one line of names and tools.
pub(crate) const LOW: f32 = 420.0;

/// A picture of a look.
pub(crate) struct Thumbnail<'n> {
    pub name: &'n str,
    /// Name for screen readers.
    pub label: &'n str,
    pub size_px: [u32; 2],
    pub texture: Option<TextureId>,
    pub is_chosen: bool,
    pub is_shown: bool,
}

impl Thumbnail<'_> {
    pub fn show(&self, ui: &mut Ui) -> Response {
        let [width, height] = self.size_px.map(|side| side.max(1) as f32);
        let wide = (HEIGHT * width / height).clamp(*WIDTHS.start(), *WIDTHS.end());
        let size = Vec2::new(wide, HEIGHT + NAME_HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        response
            .widget_info(|| WidgetInfo::selected(Role::Button, true, self.is_shown, self.label));
        let image = Rect::from_min_size(rect.min, vec2(wide, HEIGHT));
        let visuals = ui.visuals();
        let (text, selected) = (visuals.text_color(), visuals.selection.stroke.color);
        let painter = ui.painter();
        painter.rect_filled(image, 2.0, Color32::BLACK);
        if let Some(texture) = self.texture {
            // The middle of a picture that is wider than a thumbnail may be.
            let share = (wide / (HEIGHT * width / height)).min(1.0);
            let part =
                Rect::from_min_max(pos2(0.5 - 0.5 * share, 0.0), pos2(0.5 + 0.5 * share, 1.0));
            small(painter, texture, image, part, height / HEIGHT);
        }
        let line = match (self.is_shown, self.is_chosen || response.hovered()) {
            (true, _) => Stroke::new(3.0, selected),
            (false, true) => Stroke::new(1.5, selected),
            (false, false) => Stroke::new(1.0, Color32::from_gray(90)),
        };
        painter.rect_stroke(image, CornerRadius::same(2), line, StrokeKind::Inside);
        let at = pos2(rect.center().x, rect.bottom());
        let font = egui::FontId::proportional(13.0);
        painter.text(at, Align2::CENTER_BOTTOM, self.name, font, text);
        response
    }
}

/// Draws a part of a texture `times` as small: the mean of several taps, since one of four texels would leave out the others.
fn small(painter: &Painter, texture: TextureId, image: Rect, part: Rect, times: f32) {
    let taps = (0.5 * times).ceil().clamp(1.0, 6.0) as u8;
    let texel = part.size() / image.size();
    for i in 0..taps * taps {
        let place = vec2(f32::from(i % taps), f32::from(i / taps)) + Vec2::splat(0.5);
        let offset = (place / f32::from(taps) - Vec2::splat(0.5)) * texel;
        // The first whole, the second a half, the third a third: all have the same weight in the end.
        let tint = Color32::WHITE.gamma_multiply(1.0 / f32::from(i + 1));
        painter.image(texture, image, part.translate(offset), tint);
    }
}

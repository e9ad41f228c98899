//! Choices with their pictures.

use egui::{
    Align2, Color32, FontId, Grid, Id, Rect, Response, Role, Sense, TextureId, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use hairline_editor::presets::MaterialPreset;
use hairline_image::tone_map::srgb_from_linear;
use hairline_optics::metal::Metal;

use super::{Gallery, Thumb};
use crate::style::tooltip_beside_menu;

/// Side of a picture in a menu, points.
pub(crate) const SIDE: f32 = 76.0;
/// Cards in a row.
const COLUMNS: usize = 4;

/// Shows a menu of cards; returns the one that was clicked.
pub(crate) fn cards<T: Copy>(
    ui: &mut Ui,
    gallery: &mut Gallery,
    id: &str,
    choices: impl IntoIterator<Item = (T, Thumb, &'static str, &'static str)>,
) -> Option<T> {
    let mut chosen = None;
    let mut shown = Vec::new();
    let grid = Grid::new(Id::unique(("cards", id)))
        .spacing(vec2(4.0, 4.0))
        .show(ui, |ui| {
            for (i, (choice, thumb, name, hint)) in choices.into_iter().enumerate() {
                if i > 0 && i % COLUMNS == 0 {
                    ui.end_row();
                }
                let card = card(ui, gallery, (thumb, SIDE), name, false);
                if card.clicked() {
                    chosen = Some(choice);
                }
                if !hint.is_empty() {
                    shown.push((card, hint));
                }
            }
        });
    for (card, hint) in shown {
        tooltip_beside_menu(&card, grid.response.rect, hint);
    }
    chosen
}

/// A picture, `side` points wide, with a name below it, to be clicked, or dragged onto an object.
pub(crate) fn card(
    ui: &mut Ui,
    gallery: &mut Gallery,
    (thumb, side): (Thumb, f32),
    name: &'static str,
    is_selected: bool,
) -> Response {
    let is_given = thumb.given_name().is_some();
    let sense = match is_given {
        true => Sense::click_and_drag(),
        false => Sense::click(),
    };
    let shown = gallery.picture(ui.ctx(), thumb);
    let size = vec2(side, side);
    let (response, picture) = tile(ui, shown, size, name, sense, is_selected);
    if is_given {
        response.dnd_set_drag_payload(thumb);
    }
    if let Thumb::Material(MaterialPreset::Metal(metal), _) = thumb
        && ui.is_rect_visible(picture)
    {
        let at = picture.right_bottom() - vec2(10.0, 10.0);
        ui.painter()
            .circle_filled(at, 8.0, Color32::from_black_alpha(160));
        ui.painter().circle_filled(at, 6.5, color(metal));
    }
    response
}

/// A picture with a name below it; returns where the picture is, too.
pub(crate) fn tile(
    ui: &mut Ui,
    picture: Option<(TextureId, Rect)>,
    picture_size: Vec2,
    name: &str,
    sense: Sense,
    is_selected: bool,
) -> (Response, Rect) {
    let size = picture_size + vec2(8.0, 24.0);
    let (rect, response) = ui.allocate_exact_size(size, sense);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_selected, name));
    let place = Rect::from_min_size(rect.min + vec2(4.0, 4.0), picture_size);
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact_selectable(&response, is_selected);
        if is_selected || response.hovered() || response.has_focus() {
            ui.painter().rect(
                rect,
                4.0,
                visuals.weak_bg_fill,
                visuals.bg_stroke,
                egui::StrokeKind::Inside,
            );
        }
        if let Some((texture, part)) = picture {
            ui.painter().image(texture, place, part, Color32::WHITE);
        }
        let middle = pos2(rect.center().x, place.max.y + 10.0);
        let font = FontId::proportional(fitting(ui, name, picture_size.x));
        ui.painter().text(
            middle,
            Align2::CENTER_CENTER,
            name,
            font,
            visuals.text_color(),
        );
    }
    (response, place)
}

/// The size of letters in which a name fits below its picture.
fn fitting(ui: &Ui, name: &str, side: f32) -> f32 {
    const SIZE: f32 = 12.0;
    let galley =
        ui.painter()
            .layout_no_wrap(name.to_owned(), FontId::proportional(SIZE), Color32::WHITE);
    (SIZE * (side + 6.0) / galley.size().x).min(SIZE)
}

/// A metal's colour: its reflectance at normal incidence under D65, as a display shows it.
fn color(metal: Metal) -> Color32 {
    let [r, g, b] = metal
        .reflectance_rgb(1.0)
        .map(|c| (255.0 * srgb_from_linear(c.clamp(0.0, 1.0) as f32)).round() as u8);
    Color32::from_rgb(r, g, b)
}

/// The metals by their colours; says whether another one was chosen.
pub(crate) fn metal_swatches(ui: &mut Ui, chosen: &mut Metal) -> bool {
    let before = *chosen;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 3.0);
        for preset in MaterialPreset::all() {
            let MaterialPreset::Metal(metal) = preset else {
                continue;
            };
            let (rect, response) = ui.allocate_exact_size(vec2(18.0, 18.0), Sense::click());
            let name = format!("Make it {}", preset.name().to_lowercase());
            response.widget_info(|| {
                WidgetInfo::selected(Role::Button, true, metal == *chosen, name.as_str())
            });
            let ring = match (metal == *chosen, response.hovered() || response.has_focus()) {
                (true, _) => Color32::WHITE,
                (false, true) => Color32::from_gray(170),
                (false, false) => Color32::TRANSPARENT,
            };
            ui.painter().circle_filled(rect.center(), 9.0, ring);
            ui.painter()
                .circle_filled(rect.center(), 7.6, Color32::from_gray(20));
            ui.painter().circle_filled(rect.center(), 7.0, color(metal));
            if response.on_hover_text(preset.name()).clicked() {
                *chosen = metal;
            }
        }
    });
    *chosen != before
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metals_have_their_colours() {
        let [gold, copper, silver, steel] = [
            Metal::Gold,
            Metal::Copper,
            Metal::Silver,
            Metal::StainlessSteel,
        ]
        .map(color);
        assert!(gold.r() > gold.g() && gold.g() > gold.b() + 40, "{gold:?}");
        assert!(
            copper.r() > copper.g() + 20 && copper.g() > copper.b(),
            "{copper:?}"
        );
        assert!(
            silver.r() > 240 && silver.r() - silver.b() < 25,
            "{silver:?}"
        );
        assert!(
            steel.r() < 220 && steel.r().abs_diff(steel.b()) < 25,
            "{steel:?}"
        );
    }
}

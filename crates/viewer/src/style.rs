//! Colours and fonts of the interface.

use egui::{Color32, Rect, RectAlign, Response, Stroke, ThemePreference, Tooltip, Visuals};

/// Text of errors.
pub(crate) const ERROR: Color32 = Color32::from_rgb(255, 140, 120);

/// Background of words on a picture: light ones are read on white.
pub(crate) const UNDER_WORDS: Color32 = Color32::from_black_alpha(180);

/// Background of panels.
pub(crate) const GROUND: Color32 = Color32::from_gray(30);

/// Sets colours, fonts and gaps; `is_high` is the contrast.
pub(crate) fn set(ctx: &egui::Context, is_high: bool) {
    #[cfg(target_arch = "wasm32")]
    ctx.set_fonts(fonts());
    ctx.set_theme(ThemePreference::Dark);
    ctx.set_visuals_of(
        egui::Theme::Dark,
        match is_high {
            true => high_contrast(),
            false => usual(),
        },
    );
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        style.interaction.tooltip_delay = 0.3;
    });
}

/// White on black, with a line around each control.
fn high_contrast() -> Visuals {
    let mut visuals = usual();
    let line = Stroke::new(1.0, Color32::from_gray(220));
    for fill in [
        &mut visuals.panel_fill,
        &mut visuals.window_fill,
        &mut visuals.extreme_bg_color,
    ] {
        *fill = Color32::BLACK;
    }
    visuals.window_stroke = line;
    visuals.weak_text_color = Some(Color32::from_gray(220));
    visuals.hyperlink_color = Color32::from_rgb(150, 210, 255);
    visuals.error_fg_color = Color32::from_rgb(255, 170, 150);
    // Dark enough for white, in which texts beside and over a marked part are.
    visuals.selection.bg_fill = Color32::from_rgb(0, 80, 180);
    visuals.selection.stroke = Stroke::new(2.0, Color32::WHITE);
    visuals.disabled_alpha = 0.75;
    let widgets = &mut visuals.widgets;
    for widget in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.fg_stroke.color = Color32::WHITE;
        widget.bg_stroke = line;
        widget.weak_bg_fill = Color32::BLACK;
        widget.bg_fill = Color32::from_gray(40);
    }
    for widget in [&mut widgets.hovered, &mut widgets.active] {
        widget.bg_stroke = Stroke::new(2.0, Color32::WHITE);
        widget.weak_bg_fill = Color32::from_gray(50);
    }
    visuals
}

/// Dark and without hue, so that the eye judges the picture's colours and not the frame's.
fn usual() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = GROUND;
    visuals.window_fill = Color32::from_gray(34);
    visuals.extreme_bg_color = Color32::from_gray(16);
    visuals.selection.bg_fill = Color32::from_gray(70);
    visuals.selection.stroke.color = Color32::from_gray(240);
    visuals.hyperlink_color = Color32::from_gray(210);
    // Contrast of all texts against their grounds is 4.5 : 1 or more, for faint ones too.
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(190);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(205);
    visuals.weak_text_color = Some(Color32::from_gray(150));
    visuals.error_fg_color = ERROR;
    // Disabled controls should be legible as well.
    visuals.disabled_alpha = 0.65;
    visuals
}

/// One font of text, and the signs that it lacks. On a desktop both come from egui's own fonts, which would be a fifth of what a browser loads.
#[cfg(target_arch = "wasm32")]
fn fonts() -> egui::FontDefinitions {
    use egui::{FontData, FontFamily, FontTweak};
    let mut fonts = egui::FontDefinitions::empty();
    let files: [(&str, &'static [u8]); 2] = [
        ("text", hairline_document::FONT),
        ("signs", include_bytes!("../assets/signs.ttf")),
    ];
    for (name, bytes) in files {
        // The fonts have no hints, and egui's own hinting takes bars off letters.
        let tweak = FontTweak {
            hinting: Some(false),
            ..FontTweak::default()
        };
        let data = FontData::from_static(bytes).tweak(tweak);
        fonts.font_data.insert(name.to_owned(), data.into());
        for family in [FontFamily::Proportional, FontFamily::Monospace] {
            fonts
                .families
                .entry(family)
                .or_default()
                .push(name.to_owned());
        }
    }
    fonts
}

/// Draws a line around what has the keyboard.
pub(crate) fn show_focus(ctx: &egui::Context) {
    let focused = ctx.memory(|memory| memory.focused());
    let Some(response) = focused.and_then(|id| ctx.read_response(id)) else {
        return;
    };
    // What is scrolled away is empty.
    if response.interact_rect.is_positive() {
        let stroke = ctx.global_style().visuals.selection.stroke.color;
        let rect = response.interact_rect.expand(1.0);
        ctx.layer_painter(response.layer_id).rect_stroke(
            rect,
            4.0,
            Stroke::new(1.5, stroke),
            egui::StrokeKind::Middle,
        );
    }
}

/// A tooltip of one of several choices in `menu`: beside all of them, where it covers none.
pub(crate) fn tooltip_beside_menu(response: &Response, menu: Rect, text: &str) {
    let row = Rect::from_x_y_ranges(menu.x_range(), response.rect.y_range());
    let mut tooltip = Tooltip::for_enabled(response);
    tooltip.popup = tooltip
        .popup
        .anchor(row)
        .align(RectAlign::RIGHT_START)
        .align_alternatives(&[RectAlign::LEFT_START]);
    tooltip.show(|ui| ui.label(text));
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_image::tone_map::linear_from_srgb;

    /// Luminance of an sRGB colour, by WCAG 2.
    fn luminance(color: Color32) -> f64 {
        let linear = |c: u8| f64::from(linear_from_srgb(f32::from(c) / 255.0));
        0.2126 * linear(color.r()) + 0.7152 * linear(color.g()) + 0.0722 * linear(color.b())
    }

    fn contrast(text: Color32, ground: Color32) -> f64 {
        let (a, b) = (luminance(text) + 0.05, luminance(ground) + 0.05);
        a.max(b) / a.min(b)
    }

    #[test]
    fn all_text_can_be_read() {
        check(&usual(), 4.5);
        // By WCAG 2, level AAA.
        check(&high_contrast(), 7.0);
    }

    /// Checks that texts have a contrast of `least` or more.
    fn check(visuals: &Visuals, least: f64) {
        let widgets = &visuals.widgets;
        let grounds = [
            visuals.panel_fill,
            visuals.window_fill,
            visuals.extreme_bg_color,
        ];
        for ground in grounds {
            for text in [
                visuals.text_color(),
                visuals.strong_text_color(),
                visuals.weak_text_color(),
                visuals.hyperlink_color,
                visuals.error_fg_color,
                visuals.warn_fg_color,
            ] {
                let contrast = contrast(text, ground);
                assert!(contrast >= least, "{text:?} on {ground:?}: {contrast}");
            }
        }
        for widget in [
            &widgets.noninteractive,
            &widgets.inactive,
            &widgets.hovered,
            &widgets.active,
            &widgets.open,
        ] {
            let contrast = contrast(widget.text_color(), widget.weak_bg_fill);
            assert!(contrast >= least, "{widget:?}: {contrast}");
        }
        let selected = contrast(visuals.selection.stroke.color, visuals.selection.bg_fill);
        assert!(selected >= least, "{selected}");
    }
}

//! How the interface looks.

use egui::{Color32, ThemePreference, Visuals};

/// Dark and without hue, so that the eye judges the picture's colours and not the frame's.
pub(crate) fn set(ctx: &egui::Context) {
    ctx.set_theme(ThemePreference::Dark);
    let mut visuals = Visuals::dark();
    visuals.panel_fill = Color32::from_gray(30);
    visuals.window_fill = Color32::from_gray(34);
    visuals.extreme_bg_color = Color32::from_gray(16);
    visuals.selection.bg_fill = Color32::from_gray(78);
    visuals.selection.stroke.color = Color32::from_gray(240);
    visuals.hyperlink_color = Color32::from_gray(210);
    ctx.set_visuals_of(egui::Theme::Dark, visuals);
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        style.interaction.tooltip_delay = 0.3;
    });
}

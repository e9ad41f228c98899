//! Sizes of what fingers touch and read, in windows as narrow as a telephone.

use egui::{Context, Id, Style, TextStyle, vec2};

/// The narrowest window with panels beside the picture, points.
const NARROWEST: f32 = 600.0;
/// Height of what a finger touches.
pub(crate) const TARGET: f32 = 44.0;
/// Size of texts.
pub(crate) const TEXT: f32 = 16.0;
/// What fingers do, for someone who has selected nothing.
pub(crate) const WORDS: [&str; 3] = [
    "Tap an object in the picture, or a line under Parts, to change it here.",
    "One finger turns the view, two move it and bring it nearer.",
    "A long press shows what can be done with an object.",
];

/// Whether the window is a telephone's; sizes of texts and targets follow.
pub(crate) fn is_phone(ctx: &Context) -> bool {
    let is_phone = ctx.content_rect().width() < NARROWEST;
    let id = Id::unique("telephone");
    if ctx.data(|data| data.get_temp(id)).unwrap_or(false) != is_phone {
        ctx.data_mut(|data| data.insert_temp(id, is_phone));
        ctx.all_styles_mut(|style| set_sizes(style, is_phone));
    }
    is_phone
}

fn set_sizes(style: &mut Style, is_phone: bool) {
    let usual = Style::default();
    let spacing = &mut style.spacing;
    spacing.interact_size = usual.spacing.interact_size;
    spacing.button_padding = usual.spacing.button_padding;
    spacing.icon_width = usual.spacing.icon_width;
    style.text_styles = usual.text_styles;
    if is_phone {
        spacing.interact_size = vec2(TARGET, TARGET);
        spacing.button_padding = vec2(10.0, 6.0);
        spacing.icon_width = 24.0;
        for name in [TextStyle::Body, TextStyle::Button] {
            style
                .text_styles
                .entry(name)
                .and_modify(|font| font.size = TEXT);
        }
    }
}

//! Drawing of handles.

use egui::{Align2, Color32, FontId, Painter, Pos2, Vec2, vec2};

use super::body::Body;
use super::handles::{Handle, Placed};
use crate::viewport::lens::Lens;
use crate::viewport::{Area, ink};

/// Muted red, green and blue for the axes, so that they draw no attention to themselves.
const AXES: [Color32; 3] = [
    Color32::from_rgb(214, 112, 104),
    Color32::from_rgb(134, 184, 112),
    Color32::from_rgb(112, 152, 218),
];
const LIT: Color32 = Color32::from_rgb(255, 226, 150);
const PLAIN: Color32 = Color32::from_gray(226);

/// Draws all handles; the one that is hovered or held is lit, and while one is held the others step
/// back.
pub(super) fn draw_handles(
    painter: &Painter,
    placed: &[Placed],
    active: Option<Handle>,
    held: Option<Handle>,
) {
    for placed in placed {
        let is_active = active == Some(placed.handle);
        let color = match placed.handle {
            _ if is_active => LIT,
            Handle::Axis(i) => AXES[i],
            Handle::Ring(i) => AXES[i].gamma_multiply(0.8),
            _ => PLAIN,
        };
        let color = match held.is_some() && !is_active {
            true => color.gamma_multiply(0.35),
            false => color,
        };
        one(painter, placed, is_active, color);
    }
}

fn one(painter: &Painter, placed: &Placed, is_active: bool, color: Color32) {
    let grown = if is_active { 1.0 } else { 0.0 };
    let knob = placed.knob;
    match placed.handle {
        Handle::Axis(_) => {
            if let [from, tip] = placed.line[..] {
                let along = (tip - from).normalized();
                let aside = along.rot90() * (4.5 + grown);
                let foot = tip - along * (11.0 + grown);
                ink::segment(painter, [from, foot], 2.0 + 0.5 * grown, color);
                ink::blot(
                    painter,
                    vec![tip + along, foot + aside, foot - aside],
                    color,
                );
            }
        }
        Handle::Ring(_) | Handle::Rim(_) => {
            ink::line(painter, placed.line.clone(), 1.5 + grown, color)
        }
        Handle::Middle => {
            ink::circle(painter, knob, 7.0 + grown, 1.5, color);
            ink::dot(painter, knob, 2.0 + grown, color);
        }
        Handle::Size => {
            if let [from, _] = placed.line[..] {
                ink::segment(painter, [from, knob], 1.0, color.gamma_multiply(0.5));
            }
            ink::blot(painter, square(knob, 4.5 + grown, Vec2::RIGHT), color);
        }
        Handle::Corner(_) => {
            let slant = Vec2::angled(std::f32::consts::FRAC_PI_4);
            ink::blot(painter, square(knob, 4.0 + grown, slant), color);
        }
    }
}

/// A square about `middle`, half as wide as `half`, one side along `along`.
fn square(middle: Pos2, half: f32, along: Vec2) -> Vec<Pos2> {
    let (a, b) = (along * half, along.rot90() * half);
    vec![
        middle + a + b,
        middle + a - b,
        middle - a - b,
        middle - a + b,
    ]
}

/// A few words beside the pointer.
pub(super) fn draw_words(painter: &Painter, pos: Pos2, words: &str, color: Color32) {
    let at = pos + vec2(18.0, -26.0);
    boxed(painter, at, Align2::LEFT_CENTER, words, color);
}

fn boxed(painter: &Painter, at: Pos2, align: Align2, words: &str, color: Color32) {
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::proportional(13.0), color);
    let rect = align.anchor_size(at, galley.size());
    let inside = painter.clip_rect().shrink(8.0);
    // Keeps the text within the picture.
    let shift = (inside.min - rect.min).max(Vec2::ZERO) + (inside.max - rect.max).min(Vec2::ZERO);
    let rect = rect.translate(shift);
    painter.rect_filled(rect.expand2(vec2(5.0, 2.0)), 3.0, crate::style::UNDER_WORDS);
    painter.galley(rect.min, galley, color);
}

/// Draws a mark at the edge of the picture towards a body outside of it.
pub(super) fn draw_off_screen(painter: &Painter, lens: &Lens, body: &Body, area: &Area) {
    let direction = lens.screen_direction(body.center_m);
    let inside = area.rect.shrink(18.0);
    let half = 0.5 * inside.size();
    if direction == Vec2::ZERO || half.min_elem() <= 0.0 {
        return;
    }
    // Distance from the middle to the edge in this direction.
    let reach = (half.x / direction.x.abs().max(1e-6)).min(half.y / direction.y.abs().max(1e-6));
    let tip = inside.center() + direction * reach;
    let (back, aside) = (direction * 12.0, direction.rot90() * 7.0);
    ink::blot(
        painter,
        vec![tip, tip - back + aside, tip - back - aside],
        LIT,
    );
    let words = format!("the {} lies outside; F brings it into view", body.noun);
    boxed(
        painter,
        tip - direction * 26.0,
        Align2::CENTER_CENTER,
        &words,
        PLAIN,
    );
}

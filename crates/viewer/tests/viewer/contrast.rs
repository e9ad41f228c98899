//! All text can be read: its contrast against its background is 4.5 : 1 at least, by WCAG 2.

use crate::common::{SMALL, click_on, key, viewer, wait_built, wait_until};
use egui::epaint::TextShape;
use egui::{Color32, Key, Modifiers, Pos2, Rect, Rgba, Shape};
use egui_kittest::Harness;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

fn luminance(color: Color32) -> f32 {
    let color = Rgba::from(color.to_opaque());
    0.2126 * color.r() + 0.7152 * color.g() + 0.0722 * color.b()
}

fn contrast(text: Color32, ground: Color32) -> f32 {
    let (a, b) = (luminance(text) + 0.05, luminance(ground) + 0.05);
    a.max(b) / a.min(b)
}

/// Rectangles drawn until now, with their colours. Pictures count as white, on which light text is hardest to
/// read.
type Grounds = Vec<(Rect, Color32)>;

fn ground(grounds: &Grounds, at: Pos2) -> Color32 {
    let below = grounds.iter().filter(|(rect, _)| rect.contains(at));
    below.fold(Color32::BLACK, |below, (_, color)| below.blend(*color))
}

/// Colours of a text that is more than spaces.
fn colors(text: &TextShape) -> Vec<Color32> {
    let job = &text.galley.job;
    let sections = job.sections.iter();
    let written = sections.filter(|section| {
        let bytes = section.byte_range.clone();
        !job.text[bytes.start.0..bytes.end.0].trim().is_empty()
    });
    let color = |own: Color32| match own {
        Color32::PLACEHOLDER => text.fallback_color,
        own => own,
    };
    written
        .map(|section| {
            text.override_text_color
                .unwrap_or(color(section.format.color))
        })
        .map(|color| color.gamma_multiply(text.opacity_factor))
        .collect()
}

fn walk(shape: &Shape, clip: Rect, grounds: &mut Grounds, faint: &mut Vec<String>) {
    match shape {
        Shape::Vec(shapes) => {
            for shape in shapes {
                walk(shape, clip, grounds, faint);
            }
        }
        Shape::Rect(rect) if rect.brush.is_some() => {
            grounds.push((rect.rect.intersect(clip), Color32::WHITE));
        }
        Shape::Rect(rect) => grounds.push((rect.rect.intersect(clip), rect.fill)),
        Shape::Mesh(mesh) if mesh.texture_id != egui::TextureId::default() => {
            grounds.push((mesh.calc_bounds().intersect(clip), Color32::WHITE));
        }
        Shape::Text(text) => {
            let at = text.visual_bounding_rect().center();
            if !clip.contains(at) {
                return;
            }
            let ground = ground(grounds, at);
            for color in colors(text) {
                let contrast = contrast(ground.blend(color), ground);
                if contrast < 4.5 {
                    let words = &text.galley.job.text;
                    faint.push(format!("{words:?}: {color:?} on {ground:?}: {contrast:.2}"));
                }
            }
        }
        _ => {}
    }
}

fn is_read(harness: &Harness<'static, Viewer>, state: &str) {
    let mut grounds = Grounds::new();
    let mut faint = Vec::new();
    for clipped in &harness.output().shapes {
        walk(&clipped.shape, clipped.clip_rect, &mut grounds, &mut faint);
    }
    assert!(grounds.len() > 20, "{state}: {grounds:?}");
    assert_eq!(faint, [""; 0], "{state}");
}

#[test]
fn all_text_can_be_read() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    harness.run_steps(4);
    is_read(&harness, "first start");
    for selection in [
        Selection::Object(0),
        Selection::Layer(0),
        Selection::Light(0),
        Selection::Material(0),
        Selection::Environment,
        Selection::Camera,
    ] {
        harness.state_mut().document_mut().select(selection);
        harness.run_steps(4);
        is_read(&harness, &format!("{selection:?}"));
    }
    for menu in ["File", "Edit", "View", "Add to lights"] {
        click_on(&mut harness, menu);
        harness.run_steps(4);
        is_read(&harness, menu);
        key(&mut harness, Key::Escape);
    }
    for (modifiers, pressed, what) in [
        (Modifiers::NONE, Key::I, "probe"),
        (Modifiers::NONE, Key::G, "histogram"),
        (Modifiers::NONE, Key::X, "false colour"),
        (Modifiers::NONE, Key::B, "brush"),
        (Modifiers::NONE, Key::C, "compare"),
        (Modifiers::NONE, Key::F1, "help"),
        (Modifiers::COMMAND | Modifiers::SHIFT, Key::S, "save as"),
    ] {
        harness.key_press_modifiers(modifiers, pressed);
        harness.run_steps(6);
        is_read(&harness, what);
    }
}

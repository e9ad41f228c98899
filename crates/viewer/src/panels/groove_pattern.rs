//! Controls for the directions of a grating's grooves.

use hairline_document::description::{GroovePattern, PatternAxis, Rows, UvAxis};
use hairline_editor::actions::pictures::PictureOf;

use super::form::Form;

/// Rows for the pattern of the grating with this index.
pub(super) fn rows(form: &mut Form, pattern: &mut GroovePattern, index: usize) {
    let mut name = pattern.name();
    form.choice(
        "Pattern",
        "Which way the grooves run over the surface",
        PATTERNS.map(|(name, label)| (name, label.to_owned())),
        &mut name,
    );
    if name != pattern.name() {
        *pattern = begin(name, pattern, form.diagonal_m);
    }
    pattern.rows(form);
    if let GroovePattern::Uv {
        along, directions, ..
    } = pattern
    {
        form.choice(
            "Along",
            "Which texture coordinate the grooves run along",
            [(UvAxis::U, "u".to_owned()), (UvAxis::V, "v".to_owned())],
            along,
        );
        form.picture(
            "Direction map",
            "A picture, relative to the scene file, that turns the grooves: red and green are the parts along the coordinate and across it, as in anisotropy textures of glTF. None: as they are",
            directions,
            PictureOf::GratingDirections(index),
        );
    }
}

/// Patterns with their labels.
const PATTERNS: [(&str, &str); 6] = [
    ("parallel", "parallel"),
    ("circular", "circular"),
    ("radial", "radial"),
    ("spun", "spun"),
    ("swirl", "swirl"),
    ("uv", "texture coordinates"),
];

/// Makes the pattern of a name for an object of this size, with the axis and the scatter of angles of the pattern before.
fn begin(name: &str, before: &GroovePattern, diagonal_m: f64) -> GroovePattern {
    let around = match before {
        GroovePattern::Circular(around)
        | GroovePattern::Radial(around)
        | GroovePattern::Spun { around, .. }
        | GroovePattern::Swirl { around, .. } => *around,
        GroovePattern::Parallel { jitter_deg, .. } | GroovePattern::Uv { jitter_deg, .. } => {
            PatternAxis {
                jitter_deg: *jitter_deg,
                ..PatternAxis::default()
            }
        }
    };
    let jitter_deg = around.jitter_deg;
    match name {
        "parallel" => GroovePattern::Parallel {
            direction: [1.0, 0.0, 0.0],
            jitter_deg,
        },
        "circular" => GroovePattern::Circular(around),
        "radial" => GroovePattern::Radial(around),
        "spun" => GroovePattern::Spun {
            around,
            curvature_per_m: 20.0,
        },
        "swirl" => GroovePattern::Swirl {
            around,
            spacing_m: 0.05 * diagonal_m,
        },
        _ => GroovePattern::Uv {
            along: UvAxis::U,
            directions: None,
            jitter_deg,
        },
    }
}

//! Controls for the directions of a grating's grooves.

use hairline_editor::actions::pictures::PictureOf;
use hairline_scene::description::{Around, GroovePattern, UvAxis};
use hairline_scene::schema;

use super::form::Form;

/// Rows for the pattern of the grating with this index.
pub(super) fn rows(form: &mut Form, pattern: &mut GroovePattern, index: usize) {
    let mut kind = PatternName::of(pattern);
    form.choice(
        "Pattern",
        "Which way the grooves run over the surface",
        PatternName::ALL.map(|kind| (kind, kind.name().to_owned())),
        &mut kind,
    );
    if kind != PatternName::of(pattern) {
        *pattern = kind.begin(pattern, form.diagonal_m);
    }
    match pattern {
        GroovePattern::Parallel {
            direction,
            jitter_deg,
        } => {
            form.number(&schema::grating::JITTER_DEG, jitter_deg);
            form.vector(&schema::scratches::DIRECTION, direction);
        }
        GroovePattern::Circular(around) | GroovePattern::Radial(around) => axis(form, around),
        GroovePattern::Spun {
            around,
            curvature_per_m,
        } => {
            axis(form, around);
            form.number(&schema::grating::CURVATURE_PER_M, curvature_per_m);
        }
        GroovePattern::Swirl { around, spacing_m } => {
            axis(form, around);
            form.number(&schema::grating::SPACING_M, spacing_m);
        }
        GroovePattern::Uv {
            along,
            directions,
            jitter_deg,
        } => {
            form.number(&schema::grating::JITTER_DEG, jitter_deg);
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
}

fn axis(form: &mut Form, around: &mut Around) {
    form.number(&schema::grating::JITTER_DEG, &mut around.jitter_deg);
    form.vector(&schema::scratches::AXIS, &mut around.axis);
    form.vector(&schema::scratches::CENTER_M, &mut around.center_m);
}

/// A pattern by name.
#[derive(Clone, Copy, PartialEq)]
enum PatternName {
    Parallel,
    Circular,
    Radial,
    Spun,
    Swirl,
    Uv,
}

impl PatternName {
    const ALL: [Self; 6] = [
        Self::Parallel,
        Self::Circular,
        Self::Radial,
        Self::Spun,
        Self::Swirl,
        Self::Uv,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Parallel => "parallel",
            Self::Circular => "circular",
            Self::Radial => "radial",
            Self::Spun => "spun",
            Self::Swirl => "swirl",
            Self::Uv => "texture coordinates",
        }
    }

    fn of(pattern: &GroovePattern) -> Self {
        match pattern {
            GroovePattern::Parallel { .. } => Self::Parallel,
            GroovePattern::Circular(_) => Self::Circular,
            GroovePattern::Radial(_) => Self::Radial,
            GroovePattern::Spun { .. } => Self::Spun,
            GroovePattern::Swirl { .. } => Self::Swirl,
            GroovePattern::Uv { .. } => Self::Uv,
        }
    }

    /// Makes the pattern for an object of this size, with the axis and the scatter of angles of the pattern before.
    fn begin(self, before: &GroovePattern, diagonal_m: f64) -> GroovePattern {
        let around = match before {
            GroovePattern::Circular(around)
            | GroovePattern::Radial(around)
            | GroovePattern::Spun { around, .. }
            | GroovePattern::Swirl { around, .. } => *around,
            GroovePattern::Parallel { jitter_deg, .. } | GroovePattern::Uv { jitter_deg, .. } => {
                Around {
                    jitter_deg: *jitter_deg,
                    ..Around::default()
                }
            }
        };
        let jitter_deg = around.jitter_deg;
        match self {
            Self::Parallel => GroovePattern::Parallel {
                direction: [1.0, 0.0, 0.0],
                jitter_deg,
            },
            Self::Circular => GroovePattern::Circular(around),
            Self::Radial => GroovePattern::Radial(around),
            Self::Spun => GroovePattern::Spun {
                around,
                curvature_per_m: 20.0,
            },
            Self::Swirl => GroovePattern::Swirl {
                around,
                spacing_m: 0.05 * diagonal_m,
            },
            Self::Uv => GroovePattern::Uv {
                along: UvAxis::U,
                directions: None,
                jitter_deg,
            },
        }
    }
}

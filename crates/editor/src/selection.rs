//! The part of a scene that the panel shows.

use hairline_document::Description;

/// One part of a scene, or none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Selection {
    /// No part.
    #[default]
    None,
    /// `[camera]`
    Camera,
    /// `[environment]`, even if the scene has none.
    Environment,
    /// `[studio]`, lit or not.
    Studio,
    /// `[ground]`, even if the scene has none.
    Ground,
    /// `[render]`
    Render,
    /// An `[[object]]`, by its place in the description, as in all that follow.
    Object(usize),
    /// A `[[material]]`.
    Material(usize),
    /// A `[[scratches]]`.
    Layer(usize),
    /// A `[[grating]]`.
    Grating(usize),
    /// A `[[light]]`.
    Light(usize),
    /// A `[[look]]`.
    Look(usize),
}

impl Selection {
    /// Whether the description has it.
    pub fn is_in(self, description: &Description) -> bool {
        match self {
            Self::None
            | Self::Camera
            | Self::Environment
            | Self::Studio
            | Self::Ground
            | Self::Render => true,
            Self::Object(i) => i < description.objects.len(),
            Self::Material(i) => i < description.materials.len(),
            Self::Layer(i) => i < description.scratches.len(),
            Self::Grating(i) => i < description.gratings.len(),
            Self::Light(i) => i < description.lights.len(),
            Self::Look(i) => i < description.looks.len(),
        }
    }

    /// Returns the selection if the description has that part, else the last of its kind, else nothing.
    #[must_use]
    pub(crate) fn held_by(self, description: &Description) -> Self {
        let last = |n: usize, make: fn(usize) -> Self| n.checked_sub(1).map_or(Self::None, make);
        match self {
            held if held.is_in(description) => held,
            Self::Object(_) => last(description.objects.len(), Self::Object),
            Self::Material(_) => last(description.materials.len(), Self::Material),
            Self::Layer(_) => last(description.scratches.len(), Self::Layer),
            Self::Grating(_) => last(description.gratings.len(), Self::Grating),
            Self::Light(_) => last(description.lights.len(), Self::Light),
            Self::Look(_) => last(description.looks.len(), Self::Look),
            _ => Self::None,
        }
    }

    /// The object that it is or belongs to: that of a layer or a grating is the one that it lies on.
    pub fn object(self, description: &Description) -> Option<usize> {
        let name = match self {
            Self::Object(i) => return (i < description.objects.len()).then_some(i),
            Self::Layer(i) => &description.scratches.get(i)?.object,
            Self::Grating(i) => &description.gratings.get(i)?.object,
            _ => return None,
        };
        description.objects.iter().position(|o| o.name == *name)
    }
}

/// Index of item `i` after item `removed` was taken out of `left` remaining ones: the one that took the place of a removed
/// one, or the last.
pub(crate) fn after_removal(i: usize, removed: usize, left: usize) -> Option<usize> {
    let i = if i > removed { i - 1 } else { i };
    left.checked_sub(1).map(|last| i.min(last))
}

/// Index of item `i` after items `a` and `b` changed places.
pub(crate) fn after_swap(i: usize, a: usize, b: usize) -> usize {
    match i {
        i if i == a => b,
        i if i == b => a,
        i => i,
    }
}

//! Serialization of values: by name, or left out.

use hairline_image::ToneMap;
use hairline_optics::metal::Metal;
use hairline_optics::section::Section;
use hairline_sky::BuiltInMap;
use serde::{Serialize, Serializer};

use crate::schema::scratches::PROFILES;

/// Values that a scene file calls by name.
pub(crate) trait Named: Copy + PartialEq + 'static {
    /// Each with its name.
    const NAMES: &'static [(&'static str, Self)];
}

impl Named for ToneMap {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("neutral", ToneMap::Neutral),
        ("agx", ToneMap::Agx),
        ("aces", ToneMap::Aces),
        ("none", ToneMap::None),
    ];
}

impl Named for Metal {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("iron", Metal::Iron),
        ("steel", Metal::StainlessSteel),
        ("aluminium", Metal::Aluminium),
        ("copper", Metal::Copper),
        ("gold", Metal::Gold),
        ("silver", Metal::Silver),
        ("brass", Metal::Brass),
        ("chromium", Metal::Chromium),
        ("titanium", Metal::Titanium),
        ("nickel", Metal::Nickel),
    ];
}

/// The names of a [`Named`], for the schema.
pub(crate) const fn names<T, const N: usize>(named: &[(&'static str, T)]) -> [&'static str; N] {
    assert!(named.len() == N, "as many as there are");
    let mut names = [""; N];
    let mut i = 0;
    while i < N {
        names[i] = named[i].0;
        i += 1;
    }
    names
}

/// Names of the metals in scene files.
pub fn metal_names() -> &'static [(&'static str, Metal)] {
    Metal::NAMES
}

impl Named for BuiltInMap {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("studio", BuiltInMap::Studio),
        ("window", BuiltInMap::Window),
        ("overcast", BuiltInMap::Overcast),
    ];
}

/// Writes the name.
pub(super) fn serialize_named<T: Named, S: Serializer>(
    value: &T,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let (name, _) = T::NAMES
        .iter()
        .find(|(_, named)| named == value)
        .ok_or_else(|| serde::ser::Error::custom("a value that scene files have no name for"))?;
    serializer.serialize_str(name)
}

/// Cross sections that have a name.
pub(crate) const SECTIONS: [(&str, Section); 4] = [
    (PROFILES[0], Section::Rectangle),
    (PROFILES[1], Section::V),
    (PROFILES[2], Section::Round),
    (PROFILES[3], Section::Shoulders),
];

/// Names of the cross sections of grooves in scene files.
pub fn profile_names() -> [(&'static str, Section); 4] {
    SECTIONS
}

/// Writes the name, or the depths.
pub(super) fn serialize_section<S: Serializer>(
    section: &Section,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    if let Section::Listed(depths) = section {
        return depths.serialize(serializer);
    }
    let name = SECTIONS.iter().find(|(_, named)| named == section);
    serializer.serialize_str(name.map_or("", |(name, _)| name))
}

pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

pub(super) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

pub(super) fn is_false(value: &bool) -> bool {
    !value
}

pub(super) fn serialize_scale<S: Serializer>(
    scale: &[f64; 3],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    if scale[0] == scale[1] && scale[1] == scale[2] {
        scale[0].serialize(serializer)
    } else {
        scale.serialize(serializer)
    }
}

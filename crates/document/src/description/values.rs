//! Values that files call by name.

use hairline_image::ToneMap;
use hairline_optics::metal::Metal;
use hairline_optics::section::Section;
use hairline_sky::BuiltInMap;
use serde::{Serialize, Serializer};

use super::ranges::Numbers;

/// Values that a scene file calls by name.
pub(crate) trait Named: Copy + PartialEq + Numbers + 'static {
    /// Each with its name.
    const NAMES: &'static [(&'static str, Self)];
    /// The names.
    const TEXTS: &'static [&'static str];
}

/// Names values.
macro_rules! named {
    ($Type:ty { $($name:literal => $Value:ident,)* }) => {
        impl $crate::description::ranges::Numbers for $Type {}

        impl $crate::description::values::Named for $Type {
            const NAMES: &'static [(&'static str, Self)] = &[$(($name, Self::$Value)),*];
            const TEXTS: &'static [&'static str] = &[$($name),*];
        }
    };
}

pub(super) use named;

named! { ToneMap {
    "neutral" => Neutral,
    "agx" => Agx,
    "aces" => Aces,
    "none" => None,
} }

impl Numbers for Metal {}

impl Named for Metal {
    const NAMES: &'static [(&'static str, Self)] = Self::NAMED;
    const TEXTS: &'static [&'static str] = Self::NAMES;
}

named! { BuiltInMap {
    "studio" => Studio,
    "window" => Window,
    "overcast" => Overcast,
} }

/// A value that is written by its name.
pub(super) struct Name<T>(pub(super) T);

impl<T: Named> Serialize for Name<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut names = T::NAMES.iter();
        let (name, _) = names.find(|(_, named)| *named == self.0).ok_or_else(|| {
            serde::ser::Error::custom("a value that scene files have no name for")
        })?;
        serializer.serialize_str(name)
    }
}

/// Names of cross sections.
pub(super) const PROFILES: [&str; 4] = ["rectangle", "v", "round", "shoulders"];

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

/// A cross section that is written by its name, or by its depths.
pub(super) struct Profile<'s>(pub(super) &'s Section);

impl Serialize for Profile<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if let Section::Listed(depths) = self.0 {
            return depths.serialize(serializer);
        }
        let name = SECTIONS.iter().find(|(_, named)| named == self.0);
        serializer.serialize_str(name.map_or("", |(name, _)| name))
    }
}

//! Sizes of grooves: as lists give them, and as layers draw them.

use hairline_optics::section::Section;
use hairline_scene::Profile;

use crate::description::Distribution;
use crate::error::Error;
use crate::schema::Bounds;

/// Size of a groove that a list gives for each scratch.
pub(crate) struct ListedSize {
    /// Name of the size: of its column in a file, and of its array in memory.
    pub key: &'static str,
    range: (f64, f64),
    pub of: fn(&mut Profile) -> &mut f32,
}

/// Sizes in the order of the columns.
pub(crate) const LISTED_SIZES: [ListedSize; 2] = [
    ListedSize {
        key: "width_um",
        range: Profile::WIDTHS_UM,
        of: |profile| &mut profile.width_um,
    },
    ListedSize {
        key: "depth_nm",
        range: Profile::DEPTHS_NM,
        of: |profile| &mut profile.depth_nm,
    },
];

/// Name and range of each size of a groove, in the order of the columns of a list.
pub const LISTED_RANGES: [(&str, (f64, f64)); 2] = [
    (LISTED_SIZES[0].key, LISTED_SIZES[0].range),
    (LISTED_SIZES[1].key, LISTED_SIZES[1].range),
];

impl ListedSize {
    /// # Errors
    /// At `key`: a number that is out of range, or none at all.
    pub(crate) fn check(&self, key: impl FnOnce() -> String, value: f64) -> Result<(), Error> {
        let (least, most) = self.range;
        match Bounds::Within(least, most).must(value, |end| end.to_string()) {
            None => Ok(()),
            Some(right) => Err(Error::new(key(), format!("found {value}"), right)),
        }
    }
}

/// Profile whose sizes lie `normals` standard deviations from their means, times factors.
pub(super) fn scratch_profile(
    [width_um, depth_nm]: [Distribution; 2],
    normals: [f64; 2],
    [width, depth]: [f64; 2],
) -> Profile {
    let drawn = |size: Distribution, normal: f64, factor: f64, (least, most): (f64, f64)| {
        (size.log_normal_at(normal) * factor).clamp(least, most) as f32
    };
    Profile {
        width_um: drawn(width_um, normals[0], width, Profile::WIDTHS_UM),
        depth_nm: drawn(depth_nm, normals[1], depth, Profile::DEPTHS_NM),
        section: Section::default(),
    }
}

//! Refuses points that are far off the object that they are given for.

use hairline_laying::Ground;

use crate::error::{Error, length};

/// Refuses a point that is farther than `most_m` from the box about the object; `key` is its path.
pub(super) fn refuse_far(
    ground: &Ground,
    point: [f64; 3],
    most_m: f64,
    key: impl FnOnce() -> String,
) -> Result<(), Error> {
    let off_m = ground.off_box_m(point);
    match off_m <= most_m {
        true => Ok(()),
        false => Err(Error::new(
            key(),
            format!("found a point {} off the object", length(off_m)),
            at_most(most_m),
        )),
    }
}

/// How far points may be off, as half of a sentence.
pub(super) fn at_most(most_m: f64) -> String {
    let most = length(most_m);
    format!("must be at most {most} off, in metres of the object's own frame")
}

//! OpenEXR: the layers of a render as channels of one part, and any RGB file as a plain picture.
//!
//! Layout after the OpenEXR convention of dotted channel names ("Technical Introduction to OpenEXR", section on layers):
//! the beauty is R, G, B, so that every viewer shows it; the layers are `base.R` and so on, `depth.Z`, `normal.X`. A
//! Monte Carlo estimate adds `variance.R` (of the beauty), `variance.base.R` and so on, and `samples`, a channel of whole
//! numbers. Notes are text attributes whose names start with `hairline.`.

pub(crate) mod contents;
pub(crate) mod encode;
pub(crate) mod names;
mod window;

use std::path::Path;

use crate::{Error, FilePath, Image, Picture, in_gamut};

use contents::Contents;
use names::{ALPHA, channel_names, listed};

pub use names::Notes;
pub use window::{Window, size_px, window};

/// Reads a render that [`crate::Output::write_image`] wrote.
///
/// # Errors
/// [`Error::CannotRead`], and [`Error::Unusable`] where a layer is missing, or a part of what says how sure it is.
pub fn read_image(path: &Path) -> std::result::Result<Image, Error> {
    Ok(read_image_with_notes(path)?.0)
}

/// Reads a render with the notes that [`crate::Output::write_image_with_notes`] wrote; the notes are empty in files
/// that have none, and attributes of other software are left alone.
///
/// # Errors
/// As [`read_image`].
pub fn read_image_with_notes(path: &Path) -> std::result::Result<(Image, Notes), Error> {
    let file = Contents::read(&path.into())?;
    let whole = |names: [&str; 3]| {
        file.find(names).ok_or_else(|| Error::Unusable {
            path: path.to_path_buf(),
            reason: format!(
                "no channels {}: this is not a layered render",
                listed(names)
            ),
        })
    };
    let part = |layer| whole(channel_names(layer));
    let alpha = file.find([ALPHA; 3]);
    let base = part(crate::Layer::Base)?;
    let plane = |it: &Picture| it.rgb.iter().map(|z| z[0]).collect();
    let mut image = Image {
        size_px: base.size_px,
        base: base.rgb,
        scratches: part(crate::Layer::Scratches)?.rgb,
        density: part(crate::Layer::Density)?.rgb,
        depth_m: plane(&part(crate::Layer::Depth)?),
        normal: part(crate::Layer::Normal)?.rgb,
        alpha: alpha.map(|it| plane(&it)),
        noise: None,
        traced: None,
    };
    image.noise = file.noise(path)?;
    check_lengths(&image, path)?;
    Ok((image, file.notes))
}

/// Reads any EXR file with channels R, G and B (or X, Y and Z, or Y alone: grey) in one of its parts, else those of the first layer that has
/// them, such as `ViewLayer.Combined.R`; the largest level of a mip map. Colours of other primaries become those of Rec.709, as near as light can be, and what of the display window has no pixels is black.
///
/// # Errors
/// [`Error::CannotRead`], and [`Error::Unusable`] for files without such channels and for deep images.
pub fn read_picture(path: impl Into<FilePath>) -> std::result::Result<Picture, Error> {
    let path = path.into();
    let file = Contents::read(&path)?;
    let picture = file.beauty().or_else(|| file.layer());
    let mut picture = picture.ok_or_else(|| Error::Unusable {
        path: path.to_path_buf(),
        reason: "no channels R, G and B".to_owned(),
    })?;
    if file.is_converted() {
        picture.rgb.iter_mut().for_each(|rgb| *rgb = in_gamut(*rgb));
    }
    Ok(picture)
}

/// Layers may come from parts of different sizes in files that others made.
fn check_lengths(image: &Image, path: &Path) -> std::result::Result<(), Error> {
    let count = image.pixel_count();
    let mut lengths = vec![
        image.scratches.len(),
        image.density.len(),
        image.depth_m.len(),
        image.normal.len(),
    ];
    lengths.extend(image.alpha.as_ref().map(Vec::len));
    if let Some(noise) = &image.noise {
        lengths.push(noise.samples.len());
        let layers = crate::Layer::ALL
            .into_iter()
            .filter_map(|l| noise.variance(l));
        lengths.extend(layers.map(<[_]>::len));
    }
    if lengths.iter().all(|&length| length == count) {
        return Ok(());
    }
    Err(Error::Unusable {
        path: path.to_path_buf(),
        reason: "its layers have different sizes".to_owned(),
    })
}

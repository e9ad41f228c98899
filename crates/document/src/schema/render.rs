//! The keys of `[render]`.

use hairline_image::ToneMap;

use super::key::{Form, Initial, Key, linear};
use super::section::Section;
use crate::description::values::{Named, names};

const NAMES: &[&str] = &names::<ToneMap, { ToneMap::NAMES.len() }>(ToneMap::NAMES);

/// `[render]`
pub static RENDER: Section = Section::one(
    "render",
    "Settings",
    "how the picture is sampled and shown.",
    &[
        &SIZE_PX,
        &FILTER_STD_PX,
        &TONE_MAP,
        &TRANSPARENT,
        &BEHIND,
        &PNG_BITS,
    ],
);

pub static SIZE_PX: Key = Key::new("size_px", Form::Wholes(2))
    .unit("pixels")
    .is(Initial::Numbers(&[1280.0, 720.0]))
    .within(1.0, 16_384.0)
    .means("Width and height.")
    .control("Size", linear(64.0, 4096.0), "Width and height of the picture. Larger pictures resolve single scratches; smaller ones blend them into sheen.");

pub static FILTER_STD_PX: Key = Key::new("filter_std_px", Form::Number)
    .unit("pixels")
    .number(0.5)
    .within(0.1, 10.0)
    .means("Standard deviation of the pixel's Gaussian filter: larger is softer.")
    .control("Filter", linear(0.3, 2.0), "How softly pixels blend into one another. Small: crisp scratches that may look jagged. Large: smooth lines, less sparkle.");

pub static TONE_MAP: Key = Key::new("tone_map", Form::Name(NAMES))
    .text("neutral")
    .range_words("see below")
    .means("The curve from radiance to the display.");

pub static TRANSPARENT: Key = Key::new("transparent", Form::Flag)
    .flag(false)
    .means("Whether pictures have an alpha, the share of each pixel that objects cover. The environment lights them and is not seen then.");

pub static BEHIND: Key = Key::new("behind", Form::File)
    .none()
    .range_words("`.png`, `.jpg`, `.webp`")
    .means("A picture behind the objects, relative to the scene file, in the place of the environment. It fills the whole of a `.png`, from the middle, with its own colours: no exposure and no tone curve changes them. An `.exr` keeps its alpha instead.");

pub static PNG_BITS: Key = Key::new("png_bits", Form::Whole)
    .number(8.0)
    .range_words("8 or 16")
    .means("Bits of each channel of a `.png`. 16 leave room for changes of brightness afterwards.");

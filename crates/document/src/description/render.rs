//! `[render]`: how the picture is sampled and shown.

use std::path::PathBuf;

use hairline_image::ToneMap;
use hairline_keys::Keyed;
use toml::de::{DeTable, DeValue};

use super::keyed::Keyed;
use super::ranges::Check;
use super::table::Table;
use super::toml_value::{Read, Value, wrong_type};
use crate::error::Error;
use crate::schema::section::keys;

/// `[render]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(own_reader, default, check = Render::check_bits)]
pub struct Render {
    /// Width and height.
    #[key(unit("pixels").is(Initial::Numbers(&[1280.0, 720.0])).in_range(1.0, 16_384.0)
        .control("Size", linear(64.0, 4096.0), "Width and height of the picture. Larger pictures resolve single scratches; smaller ones blend them into sheen."))]
    pub size_px: [u32; 2],
    /// Standard deviation of the pixel's Gaussian filter: larger is softer.
    #[key(unit("pixels").number(0.5).in_range(0.1, 10.0)
        .control("Filter", linear(0.3, 2.0), "How softly pixels blend into one another. Small: crisp scratches that may look jagged. Large: smooth lines, less sparkle."))]
    pub filter_std_px: f64,
    /// The curve from radiance to the display.
    #[key(text("neutral").range_words("see below"))]
    pub tone_map: ToneMap,
    /// Whether pictures have an alpha, the share of each pixel that objects cover. The environment lights them and is not seen then.
    #[key(flag(false).omitted().labelled("Transparent", "Saved pictures have an alpha: the share of each pixel that objects cover. The window shows what is behind."))]
    pub transparent: bool,
    /// A picture behind the objects, relative to the scene file, in the place of the environment. It fills the whole of a `.png`, from the middle,
    /// with its own colours: no exposure and no tone curve changes them. An `.exr` keeps its alpha instead.
    #[key(none().range_words("`.png`, `.jpg`, `.webp`"))]
    pub behind: Option<PathBuf>,
    /// Bits of each channel of a `.png`. 16 leave room for changes of brightness afterwards.
    #[key(number(8.0).range_words("8 or 16").omitted())]
    pub png_bits: u32,
}

impl Render {
    fn check_bits(&self, key: &str) -> Check {
        if matches!(self.png_bits, 8 | 16) {
            return Ok(());
        }
        let found = format!("found {}", self.png_bits);
        let name = Self::PNG_BITS.name;
        Err(Error::new(
            format!("{key}.{name}"),
            found,
            "must be 8 or 16",
        ))
    }
}

/// A key of earlier versions.
const GATHER: &str = "gather";

/// Keys of earlier versions that are there, and why they have no effect.
pub(super) fn keys_without_effect(
    root: &DeTable,
) -> impl Iterator<Item = (&'static str, &'static str)> {
    let render = root.get("render").map(|value| value.get_ref());
    let gather = match render {
        Some(DeValue::Table(render)) => render.get(GATHER),
        _ => None,
    };
    let why = "this key has no effect any more; every scratch counts for itself";
    gather.map(|_| ("render.gather", why)).into_iter()
}

impl Read for Render {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let older = match value.get_ref() {
            DeValue::Table(entries) => entries.get(GATHER).map(|_| GATHER),
            _ => None,
        };
        let known = keys(Self::KEYS).into_iter().map(|key| key.name);
        let known: Vec<_> = known.chain(older).collect();
        let table = Table::read(value, key, &known)?;
        if let Some(bits) = table.get(Self::PNG_BITS.name)
            && !matches!(bits.get_ref(), DeValue::Integer(_))
        {
            let key = table.key_path(Self::PNG_BITS.name);
            return Err(wrong_type(bits, &key, "8 or 16"));
        }
        Self::read_keys(&table)
    }
}

//! OpenEXR: the layers of a render as channels of one part, and any RGB file as a plain picture.
//!
//! Layout after the OpenEXR convention of dotted channel names ("Technical Introduction to OpenEXR", section on layers):
//! the beauty is R, G, B, so that every viewer shows it; the layers are `base.R` and so on, `depth.Z`, `normal.X`.

use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::Path;

use exr::prelude::*;

use crate::{Error, Image, Picture};

/// Encodes all layers of a render. The file reads back bit for bit, NaN payloads aside.
pub(crate) fn encode_image(image: &Image) -> std::result::Result<Vec<u8>, String> {
    let mut channels = Vec::with_capacity(16);
    push_channels(&mut channels, ["R", "G", "B"], &image.beauty().rgb);
    push_channels(&mut channels, ["base.R", "base.G", "base.B"], &image.base);
    push_channels(
        &mut channels,
        ["scratches.R", "scratches.G", "scratches.B"],
        &image.scratches,
    );
    push_channels(
        &mut channels,
        ["density.R", "density.G", "density.B"],
        &image.density,
    );
    push_channels(
        &mut channels,
        ["normal.X", "normal.Y", "normal.Z"],
        &image.normal,
    );
    channels.push(AnyChannel::new(
        "depth.Z",
        FlatSamples::F32(image.depth_m.clone()),
    ));
    encode(image.size_px, channels)
}

/// Encodes a plain picture.
pub(crate) fn encode_picture(picture: &Picture) -> std::result::Result<Vec<u8>, String> {
    let mut channels = Vec::with_capacity(3);
    push_channels(&mut channels, ["R", "G", "B"], &picture.rgb);
    encode(picture.size_px, channels)
}

/// Reads a render that [`crate::Output::write_image`] wrote.
///
/// # Errors
/// [`Error::CannotRead`], and [`Error::Unusable`] where a layer is missing.
pub fn read_image(path: &Path) -> std::result::Result<Image, Error> {
    let file = read_channels(path)?;
    let part = |names: [&str; 3]| {
        file.iter()
            .find_map(|part| part.interleaved(names))
            .ok_or_else(|| Error::Unusable {
                path: path.to_owned(),
                reason: format!(
                    "no channels {}: this is not a layered render",
                    names.join(", ")
                ),
            })
    };
    let base = part(["base.R", "base.G", "base.B"])?;
    Ok(Image {
        size_px: base.size_px,
        base: base.rgb,
        scratches: part(["scratches.R", "scratches.G", "scratches.B"])?.rgb,
        density: part(["density.R", "density.G", "density.B"])?.rgb,
        depth_m: part(["depth.Z"; 3])?.rgb.iter().map(|z| z[0]).collect(),
        normal: part(["normal.X", "normal.Y", "normal.Z"])?.rgb,
    })
}

/// Reads any EXR file with channels R, G and B (or Y alone: grey) in one of its parts; the largest level of a mip map.
///
/// # Errors
/// [`Error::CannotRead`], and [`Error::Unusable`] for files without such channels and for deep images.
pub fn read_picture(path: &Path) -> std::result::Result<Picture, Error> {
    let file = read_channels(path)?;
    let find = |names| file.iter().find_map(|part| part.interleaved(names));
    find(["R", "G", "B"])
        .or_else(|| find(["Y"; 3]))
        .ok_or_else(|| Error::Unusable {
            path: path.to_owned(),
            reason: "no channels R, G and B".to_owned(),
        })
}

fn push_channels(
    channels: &mut Vec<AnyChannel<FlatSamples>>,
    names: [&str; 3],
    values: &[[f32; 3]],
) {
    for (i, name) in names.into_iter().enumerate() {
        let samples = values.iter().map(|v| v[i]).collect();
        channels.push(AnyChannel::new(name, FlatSamples::F32(samples)));
    }
}

fn encode(
    size_px: [u32; 2],
    channels: Vec<AnyChannel<FlatSamples>>,
) -> std::result::Result<Vec<u8>, String> {
    let size = (size_px[0] as usize, size_px[1] as usize);
    let mut layer = Layer::new(
        size,
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.into()),
    );
    layer.attributes.software_name =
        Text::new_or_none(concat!("Hairline ", env!("CARGO_PKG_VERSION")));
    let mut file = exr::prelude::Image::from_layer(layer);
    file.attributes.chromaticities = Some(REC_709);
    let mut bytes = Cursor::new(Vec::new());
    file.write()
        .to_buffered(&mut bytes)
        .map_err(|e| e.to_string())?;
    Ok(bytes.into_inner())
}

/// ITU-R BT.709, white D65.
const REC_709: attribute::Chromaticities = attribute::Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// One part of an EXR file.
struct Part {
    size_px: [u32; 2],
    channels: Vec<AnyChannel<FlatSamples>>,
}

impl Part {
    /// Three channels side by side, if the part has them all in full resolution.
    fn interleaved(&self, names: [&str; 3]) -> Option<Picture> {
        let channel = |name: &str| {
            self.channels
                .iter()
                .find(|c| c.name.eq(name) && c.sampling == Vec2(1, 1))
        };
        let [r, g, b] = [channel(names[0])?, channel(names[1])?, channel(names[2])?];
        let rgb = r
            .sample_data
            .values_as_f32()
            .zip(g.sample_data.values_as_f32())
            .zip(b.sample_data.values_as_f32())
            .map(|((r, g), b)| [r, g, b])
            .collect();
        Some(Picture {
            size_px: self.size_px,
            rgb,
        })
    }
}

fn read_channels(path: &Path) -> std::result::Result<Vec<Part>, Error> {
    let file = File::open(path).map_err(|e| Error::cannot_read(path, &e))?;
    let contents = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(BufReader::new(file))
        .map_err(|e| match e {
            exr::error::Error::Io(e) => Error::cannot_read(path, &e),
            e => Error::Unusable {
                path: path.to_owned(),
                reason: format!("not an EXR file that can be read: {e}"),
            },
        })?;
    Ok(contents
        .layer_data
        .into_iter()
        .map(|layer| Part {
            size_px: [layer.size.0 as u32, layer.size.1 as u32],
            channels: layer.channel_data.list.into_vec(),
        })
        .collect())
}

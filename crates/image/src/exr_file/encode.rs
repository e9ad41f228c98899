//! Pictures as the bytes of a file.

use std::io::Cursor;

use exr::prelude::*;

use super::names::{
    ALPHA, BATCH_ATTRIBUTE, NOTE_PREFIX, Notes, SAMPLES, channel_names, variance_channel_names,
};
use crate::{Image, Picture, Primaries};

/// Encodes all layers of a render with its noise and notes. The file reads back bit for bit, NaN payloads aside. [`Image::alpha`] is
/// the beauty's channel A; colours are multiplied by it, as OpenEXR wants them.
pub(crate) fn encode_image(image: &Image, notes: &Notes) -> std::result::Result<Vec<u8>, String> {
    use crate::Layer as L;
    let mut channels = Vec::with_capacity(30);
    if let Some(alpha) = &image.alpha {
        channels.push(AnyChannel::new(ALPHA, FlatSamples::F32(alpha.clone())));
    }
    for layer in [L::Beauty, L::Base, L::Scratches, L::Density, L::Normal] {
        push_channels(&mut channels, channel_names(layer), &image.layer(layer));
    }
    channels.push(AnyChannel::new(
        "depth.Z",
        FlatSamples::F32(image.depth_m.clone()),
    ));
    let mut attributes = note_attributes(notes)?;
    if let Some(noise) = &image.noise {
        for layer in L::ALL {
            if let (Some(names), Some(values)) =
                (variance_channel_names(layer), noise.variance(layer))
            {
                push_channels(&mut channels, names, values);
            }
        }
        channels.push(AnyChannel::new(
            SAMPLES,
            FlatSamples::U32(noise.samples.clone()),
        ));
        let batch = i32::try_from(noise.batch).map_err(|_| "a batch of too many samples")?;
        attributes.push((
            Text::new_or_panic(BATCH_ATTRIBUTE),
            attribute::AttributeValue::I32(batch),
        ));
    }
    encode(image.size_px, channels, attributes)
}

/// Encodes a plain picture.
pub(crate) fn encode_picture(picture: &Picture) -> std::result::Result<Vec<u8>, String> {
    let mut channels = Vec::with_capacity(3);
    push_channels(&mut channels, ["R", "G", "B"], &picture.rgb);
    encode(picture.size_px, channels, Vec::new())
}

fn push_channels(
    channels: &mut Vec<AnyChannel<FlatSamples>>,
    names: [impl AsRef<str>; 3],
    values: &[[f32; 3]],
) {
    for (i, name) in names.iter().enumerate() {
        let samples = values.iter().map(|v| v[i]).collect();
        channels.push(AnyChannel::new(name.as_ref(), FlatSamples::F32(samples)));
    }
}

type Attributes = Vec<(Text, attribute::AttributeValue)>;

/// Notes as attributes. The bytes are UTF-8, as OpenEXR asks for.
fn note_attributes(notes: &Notes) -> std::result::Result<Attributes, String> {
    notes
        .iter()
        .map(|(name, text)| {
            let name = format!("{NOTE_PREFIX}{name}");
            // 255 is the longest name of the format; names end with a zero byte.
            if name.len() == NOTE_PREFIX.len() || name.len() > 255 || name.contains('\0') {
                return Err(format!("the note `{name}` has a name that EXR cannot hold"));
            }
            Ok((
                Text::from_slice_unchecked(name.as_bytes()),
                attribute::AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes())),
            ))
        })
        .collect()
}

pub(crate) fn encode(
    size_px: [u32; 2],
    channels: Vec<AnyChannel<FlatSamples>>,
    attributes: Attributes,
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
    layer.attributes.other.extend(attributes);
    let mut file = exr::prelude::Image::from_layer(layer);
    file.attributes.chromaticities = Some(REC_709);
    let mut bytes = Cursor::new(Vec::new());
    file.write()
        .to_buffered(&mut bytes)
        .map_err(|e| e.to_string())?;
    Ok(bytes.into_inner())
}

/// Primaries of this program's pictures.
const REC_709: attribute::Chromaticities = {
    let Primaries {
        red,
        green,
        blue,
        white,
    } = Primaries::REC_709;
    attribute::Chromaticities {
        red: Vec2(red[0] as f32, red[1] as f32),
        green: Vec2(green[0] as f32, green[1] as f32),
        blue: Vec2(blue[0] as f32, blue[1] as f32),
        white: Vec2(white[0] as f32, white[1] as f32),
    }
};

//! Labels of a picture as OpenEXR, by the convention that compositors read: J. Friedman, A. Jones, *Fully automatic ID mattes with support for
//! motion blur and transparency* (Psyop, 2015), specification 1.2. A name's identifier is its hash, MurmurHash3 by A. Appleby, held
//! in the bits of a float.

use std::collections::BTreeMap;
use std::path::Path;

use exr::prelude::*;

use crate::exr_file::encode::encode;
use crate::{Error, output};

/// What a pixel of a [`Matte`] has at a rank that nothing takes.
pub const NOTHING: u32 = u32::MAX;

/// Kind of things that pixels show.
pub struct Matte<'a> {
    /// Its name, which channels begin with.
    pub name: &'a str,
    /// Number of things that each pixel names.
    pub ranks: usize,
    /// Things of each pixel, those that cover most of it first; [`NOTHING`] for none.
    pub things: &'a [u32],
    /// Share of the pixel that each of these covers.
    pub coverage: &'a [f32],
    /// Name of a thing.
    pub name_of: &'a dyn Fn(u32) -> String,
}

/// A channel of numbers, and its name.
pub type Plane<'a> = (&'a str, Vec<f32>);

/// Writes labels: mattes, and planes of numbers beside them. The whole file or none.
///
/// # Errors
/// [`Error::UnknownEnding`] for another ending than .exr, [`Error::CannotWrite`].
pub fn write_labels(
    path: &Path,
    size_px: [u32; 2],
    mattes: &[Matte<'_>],
    planes: Vec<Plane<'_>>,
) -> std::result::Result<(), Error> {
    if output::Format::from_ending(path)? != output::Format::Exr {
        return Err(Error::UnknownEnding {
            path: path.to_owned(),
        });
    }
    let mut channels = Vec::new();
    let mut attributes = Vec::new();
    for matte in mattes {
        add(matte, &mut channels, &mut attributes);
    }
    channels.extend(
        planes
            .into_iter()
            .map(|(name, values)| AnyChannel::new(name, FlatSamples::F32(values))),
    );
    let encoded = encode(size_px, channels, attributes);
    let bytes = encoded.map_err(|reason| Error::CannotWrite {
        path: path.to_owned(),
        reason,
    })?;
    output::write_atomically(path, &bytes)
}

fn add(
    matte: &Matte<'_>,
    channels: &mut Vec<AnyChannel<FlatSamples>>,
    attributes: &mut Vec<(Text, attribute::AttributeValue)>,
) {
    // A name is hashed once.
    let mut known: BTreeMap<u32, (String, f32)> = BTreeMap::new();
    for thing in matte.things {
        if *thing != NOTHING && !known.contains_key(thing) {
            let name = (matte.name_of)(*thing);
            let id = identifier(&name);
            known.insert(*thing, (name, id));
        }
    }
    let id_of = |thing: &u32| known.get(thing).map_or(0.0, |(_, id)| *id);
    for rank in 0..matte.ranks {
        let (pair, letters) = (rank / 2, [["R", "G"], ["B", "A"]][rank % 2]);
        let of = |letter: &str| format!("{}{pair:02}.{letter}", matte.name);
        let pick = |i: usize| i * matte.ranks + rank;
        let pixels = matte.things.len() / matte.ranks.max(1);
        let ids = (0..pixels).map(|i| id_of(&matte.things[pick(i)])).collect();
        let covers = (0..pixels).map(|i| matte.coverage[pick(i)]).collect();
        channels.push(AnyChannel::new(
            of(letters[0]).as_str(),
            FlatSamples::F32(ids),
        ));
        channels.push(AnyChannel::new(
            of(letters[1]).as_str(),
            FlatSamples::F32(covers),
        ));
    }
    let manifest: serde_json::Map<String, serde_json::Value> = known
        .values()
        .map(|(name, id)| (name.clone(), format!("{:08x}", id.to_bits()).into()))
        .collect();
    let key = format!("{:08x}", murmur3(matte.name.as_bytes()));
    let told = [
        ("name", matte.name.to_owned()),
        ("hash", "MurmurHash3_32".to_owned()),
        ("conversion", "uint32_to_float32".to_owned()),
        ("manifest", serde_json::Value::Object(manifest).to_string()),
    ];
    for (what, text) in told {
        let name = Text::new_or_panic(format!("cryptomatte/{}/{what}", &key[..7]));
        let value = Text::from_bytes_unchecked(text.bytes().collect());
        attributes.push((name, attribute::AttributeValue::Text(value)));
    }
}

/// The hash of a name in the bits of a float that is neither infinite, nor NaN, nor denormal.
fn identifier(name: &str) -> f32 {
    let hash = murmur3(name.as_bytes());
    let exponent = hash >> 23 & 0xff;
    f32::from_bits(if exponent == 0 || exponent == 255 {
        hash ^ (1 << 23)
    } else {
        hash
    })
}

/// MurmurHash3 of 32 bits with seed 0.
fn murmur3(bytes: &[u8]) -> u32 {
    let mix = |k: u32| {
        k.wrapping_mul(0xcc9e_2d51)
            .rotate_left(15)
            .wrapping_mul(0x1b87_3593)
    };
    let (words, rest) = bytes.as_chunks::<4>();
    let mut hash = words.iter().fold(0u32, |hash, word| {
        let hash = (hash ^ mix(u32::from_le_bytes(*word))).rotate_left(13);
        hash.wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    if !rest.is_empty() {
        let tail = rest
            .iter()
            .rev()
            .fold(0u32, |tail, byte| tail << 8 | u32::from(*byte));
        hash ^= mix(tail);
    }
    hash ^= bytes.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the reference implementation.
    #[test]
    fn hashes_are_those_of_the_reference() {
        for (text, hash) in [
            ("", 0),
            ("hello", 0x248b_fa47),
            ("hello, world", 0x149b_bb7f),
        ] {
            assert_eq!(murmur3(text.as_bytes()), hash, "{text}");
        }
    }
}

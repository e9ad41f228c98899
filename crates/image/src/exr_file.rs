//! OpenEXR: the layers of a render as channels of one part, and any RGB file as a plain picture.
//!
//! Layout after the OpenEXR convention of dotted channel names ("Technical Introduction to OpenEXR", section on layers):
//! the beauty is R, G, B, so that every viewer shows it; the layers are `base.R` and so on, `depth.Z`, `normal.X`. A
//! Monte Carlo estimate adds `variance.R` (of the beauty), `variance.base.R` and so on, and `samples`, a channel of whole
//! numbers. Notes are text attributes whose names start with `hairline.`.

use std::collections::BTreeMap;
use std::fmt;
use std::io::Cursor;
use std::path::Path;

use exr::prelude::*;

use crate::{Error, FilePath, Image, Noise, Picture, Primaries, ToRec709, in_gamut};

/// Notes on the making of a render (scene, model, seed), by name. Any text; names of 246 bytes at most.
pub type Notes = BTreeMap<String, String>;

/// Prefix of the names of notes in a file, so that they do not meet the attributes of other software.
const NOTE_PREFIX: &str = "hairline.";

/// Samples in a batch, an integer attribute. Outside the notes' prefix: no note can have its name.
const BATCH_ATTRIBUTE: &str = "hairlineBatch";

pub(crate) const SAMPLES: &str = "samples";
/// The channel of [`Image::alpha`].
const ALPHA: &str = "A";

/// The three channels of a layer of the render.
pub(crate) fn channel_names(layer: crate::Layer) -> [&'static str; 3] {
    match layer {
        crate::Layer::Beauty => ["R", "G", "B"],
        crate::Layer::Base => ["base.R", "base.G", "base.B"],
        crate::Layer::Scratches => ["scratches.R", "scratches.G", "scratches.B"],
        crate::Layer::Density => ["density.R", "density.G", "density.B"],
        crate::Layer::Depth => ["depth.Z"; 3],
        crate::Layer::Normal => ["normal.X", "normal.Y", "normal.Z"],
        crate::Layer::Alpha => [ALPHA; 3],
    }
}

/// The three channels of a layer's variance, if it has one.
pub(crate) fn variance_channel_names(layer: crate::Layer) -> Option<[String; 3]> {
    use crate::Layer as L;
    let has_variance = matches!(layer, L::Beauty | L::Base | L::Scratches | L::Density);
    has_variance.then(|| channel_names(layer).map(|name| format!("variance.{name}")))
}

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

/// Reads a render that [`crate::Output::write_image`] wrote.
///
/// # Errors
/// [`Error::CannotRead`], and [`Error::Unusable`] where a layer is missing, or a part of what says how sure it is.
pub fn read_image(path: &Path) -> std::result::Result<Image, Error> {
    Ok(read_image_with_notes(path)?.0)
}

/// Reads the window of a file: of its largest part, of which only the head is read.
///
/// # Errors
/// [`Error::CannotRead`], [`Error::Unusable`].
pub fn window(path: impl Into<FilePath>) -> std::result::Result<Window, Error> {
    let path = path.into();
    let file = path.open().map_err(|e| Error::cannot_read(&path, &e))?;
    let unusable = |reason: String| Error::Unusable {
        path: path.to_path_buf(),
        reason,
    };
    let meta = exr::meta::MetaData::read_from_buffered(file, false);
    let meta = meta.map_err(|e| match e {
        exr::error::Error::Io(e) => Error::cannot_read(&path, &e),
        e => unusable(format!("not an EXR file that can be read: {e}")),
    })?;
    let parts = meta.headers.iter().map(|header| {
        Window::new(
            header.own_attributes.layer_position,
            header.layer_size,
            header.shared_attributes.display_window,
        )
    });
    let largest = parts.max_by_key(|window| window.size_px[0] as u64 * window.size_px[1] as u64);
    let largest = largest.ok_or_else(|| unusable("it has no parts".to_owned()))?;
    let [width, height] = largest.size_px;
    if u64::from(width) * u64::from(height) > LARGEST_PX {
        return Err(unusable(format!(
            "it says that it has {width} x {height} pixels"
        )));
    }
    Ok(largest)
}

/// The width and height of the picture in a file: of its display window.
///
/// # Errors
/// As of [`window`].
pub fn size_px(path: impl Into<FilePath>) -> std::result::Result<[u32; 2], Error> {
    Ok(window(path)?.of_px)
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

/// Names for a message, each once: depth has one channel.
fn listed(names: [impl AsRef<str>; 3]) -> String {
    match names.each_ref().map(AsRef::as_ref) {
        [name, other, _] if name == other => name.to_owned(),
        names => names.join(", "),
    }
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

/// Pixels of a picture that a file holds: its data window in its display window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The first pixel, from the upper left corner of the picture.
    pub at_px: [i64; 2],
    /// Width and height of the window.
    pub size_px: [u32; 2],
    /// Width and height of the whole picture.
    pub of_px: [u32; 2],
}

impl Window {
    fn new(at: Vec2<i32>, size: Vec2<usize>, display: IntegerBounds) -> Self {
        let at = [at.0, at.1].map(i64::from);
        let corner = [display.position.0, display.position.1].map(i64::from);
        // Windows that end before they begin are huge to the library.
        let px = |size: Vec2<usize>| [size.0, size.1].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
        Self {
            at_px: [at[0] - corner[0], at[1] - corner[1]],
            size_px: px(size),
            of_px: px(display.size),
        }
    }

    /// Whether it has all pixels of the picture, and no other.
    pub fn is_whole(&self) -> bool {
        self.at_px == [0; 2] && self.size_px == self.of_px
    }

    /// Whether it has all pixels of the picture, and perhaps others around it.
    pub fn covers(&self) -> bool {
        (0..2).all(|i| {
            let end_px = self.at_px[i] + i64::from(self.size_px[i]);
            self.at_px[i] <= 0 && end_px >= i64::from(self.of_px[i])
        })
    }

    /// A value for each pixel of the picture: those of the file, and none elsewhere.
    fn placed<T: Copy + Default>(&self, values: &[T]) -> Vec<T> {
        let [width, height] = self.of_px.map(i64::from);
        let mut placed = vec![T::default(); (width * height) as usize];
        let own_width = self.size_px[0] as usize;
        let from = self.at_px[0].clamp(0, width);
        let to = (self.at_px[0] + own_width as i64).clamp(from, width);
        for (y, row) in (self.at_px[1]..).zip(values.chunks_exact(own_width)) {
            if (0..height).contains(&y) && from < to {
                let first = (from - self.at_px[0]) as usize;
                let own = &row[first..first + (to - from) as usize];
                placed[(y * width + from) as usize..][..own.len()].copy_from_slice(own);
            }
        }
        placed
    }
}

impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y], [width, height], [of_width, of_height]) =
            (self.at_px, self.size_px, self.of_px);
        let rest = match self.covers() {
            true => "what is outside of that is not seen",
            false => "the rest of that is black",
        };
        write!(
            f,
            "its pixels are {width} x {height} from column {x} and row {y} on, of a picture of {of_width} x {of_height}; {rest}"
        )
    }
}

/// The largest picture that is read, or that a few pixels may be placed in.
const LARGEST_PX: u64 = 1 << 29;

/// Contents of a file.
pub(crate) struct Contents {
    parts: Vec<Part>,
    pub(crate) notes: Notes,
    batch: Option<u32>,
    /// Conversion of the colours in its channels R, G and B.
    to_rec_709: Option<ToRec709>,
}

/// One part of an EXR file.
struct Part {
    window: Window,
    channels: Vec<AnyChannel<FlatSamples>>,
}

impl Part {
    /// A channel in full resolution.
    fn channel(&self, name: &str) -> Option<&AnyChannel<FlatSamples>> {
        self.channels
            .iter()
            .find(|c| c.name.eq(name) && c.sampling == Vec2(1, 1))
    }

    fn has(&self, names: &[String; 3]) -> bool {
        names.iter().all(|name| self.channel(name).is_some())
    }

    /// Three channels side by side, if the part has them all.
    fn interleaved(&self, names: [&str; 3]) -> Option<Picture> {
        let [r, g, b] = [
            self.channel(names[0])?,
            self.channel(names[1])?,
            self.channel(names[2])?,
        ];
        let rgb = r
            .sample_data
            .values_as_f32()
            .zip(g.sample_data.values_as_f32())
            .zip(b.sample_data.values_as_f32())
            .map(|((r, g), b)| [r, g, b])
            .collect();
        Some(Picture {
            size_px: self.window.of_px,
            rgb,
        })
    }

    /// Puts the values of all channels where they are in the picture.
    fn place(&mut self) -> std::result::Result<(), String> {
        let window = self.window;
        if window.is_whole() {
            return Ok(());
        }
        let count = window.of_px.map(u64::from).iter().product::<u64>();
        if count == 0 || count > LARGEST_PX {
            return Err(format!(
                "its display window has {} x {} pixels",
                window.of_px[0], window.of_px[1]
            ));
        }
        // Others are not read.
        self.channels
            .retain(|channel| channel.sampling == Vec2(1, 1));
        for channel in &mut self.channels {
            channel.sample_data = match &channel.sample_data {
                FlatSamples::F16(values) => FlatSamples::F16(window.placed(values)),
                FlatSamples::F32(values) => FlatSamples::F32(window.placed(values)),
                FlatSamples::U32(values) => FlatSamples::U32(window.placed(values)),
            };
        }
        Ok(())
    }
}

impl Contents {
    pub(crate) fn read(path: &FilePath) -> std::result::Result<Self, Error> {
        // Before anything is decoded.
        window(path)?;
        let file = path.open().map_err(|e| Error::cannot_read(path, &e))?;
        let file = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_buffered(file)
            .map_err(|e| match e {
                exr::error::Error::Io(e) => Error::cannot_read(path, &e),
                e => Error::Unusable {
                    path: path.to_path_buf(),
                    reason: format!("not an EXR file that can be read: {e}"),
                },
            })?;
        let unusable = |reason: String| Error::Unusable {
            path: path.to_path_buf(),
            reason,
        };
        let primaries = file.attributes.chromaticities.map(|own| {
            let xy = |at: Vec2<f32>| [at.0, at.1].map(f64::from);
            Primaries {
                red: xy(own.red),
                green: xy(own.green),
                blue: xy(own.blue),
                white: xy(own.white),
            }
        });
        let to_rec_709 = primaries.map_or(Ok(None), |it| it.to_rec_709());
        let mut contents = Self {
            parts: Vec::with_capacity(file.layer_data.len()),
            notes: Notes::new(),
            batch: None,
            to_rec_709: to_rec_709.map_err(unusable)?,
        };
        let display = file.attributes.display_window;
        for layer in file.layer_data {
            for (name, value) in &layer.attributes.other {
                contents.take_attribute(name, value);
            }
            let mut part = Part {
                window: Window::new(layer.attributes.layer_position, layer.size, display),
                channels: layer.channel_data.list.into_vec(),
            };
            part.place().map_err(unusable)?;
            contents.parts.push(part);
        }
        for (name, value) in &file.attributes.other {
            contents.take_attribute(name, value);
        }
        Ok(contents)
    }

    fn take_attribute(&mut self, name: &Text, value: &attribute::AttributeValue) {
        let Ok(name) = std::str::from_utf8(name.as_slice()) else {
            return;
        };
        match value {
            attribute::AttributeValue::I32(batch) if name == BATCH_ATTRIBUTE => {
                self.batch = u32::try_from(*batch).ok();
            }
            attribute::AttributeValue::Text(text) => {
                if let Some(name) = name.strip_prefix(NOTE_PREFIX)
                    && let Ok(text) = std::str::from_utf8(text.as_slice())
                {
                    self.notes.insert(name.to_owned(), text.to_owned());
                }
            }
            _ => {}
        }
    }

    /// Three channels of one part.
    pub(crate) fn find(&self, names: [impl AsRef<str>; 3]) -> Option<Picture> {
        let names = names.each_ref().map(AsRef::as_ref);
        self.parts.iter().find_map(|part| part.interleaved(names))
    }

    /// Names of the channels of a layer with colours: of the one that is the whole picture by its name, else of the first. Their last letters may be
    /// small ones.
    fn layer_of_colors(&self) -> Option<[String; 3]> {
        let channels = self.parts.iter().flat_map(|part| &part.channels);
        let names = channels.map(|channel| channel.name.to_string());
        let layers = names.filter_map(|name| {
            let start = name.strip_suffix(['R', 'r'])?;
            let layer = start.strip_suffix('.').unwrap_or(start);
            let layer = layer.rsplit('.').next()?.to_ascii_lowercase();
            let is_layer = start.is_empty() || start.ends_with('.');
            let letters = match name.ends_with('R') {
                true => ["R", "G", "B"],
                false => ["r", "g", "b"],
            };
            let names = letters.map(|letter| format!("{start}{letter}"));
            let is_there = self.parts.iter().any(|part| part.has(&names));
            // Numbers of objects are no colours.
            (is_layer && is_there && !layer.starts_with("crypto")).then_some((layer, names))
        });
        let mut layers: Vec<_> = layers.collect();
        // Those of Blender, of Arnold, of V-Ray and others; the sort is stable.
        layers.sort_by_key(|(layer, _)| {
            !["", "combined", "beauty", "rgba", "rgb"].contains(&layer.as_str())
        });
        layers.into_iter().next().map(|(_, names)| names)
    }

    /// Colours of the file in Rec.709: from R, G, B, else from X, Y, Z, else from Y alone.
    pub(crate) fn beauty(&self) -> Option<Picture> {
        let xyz = Primaries::XYZ.to_rec_709().ok().flatten();
        self.converted(["R", "G", "B"], self.to_rec_709)
            .or_else(|| self.converted(["X", "Y", "Z"], xyz))
            .or_else(|| self.converted(["Y"; 3], None))
    }

    /// Colours of the layer that stands for the picture where the file has none of its own, in Rec.709.
    fn layer(&self) -> Option<Picture> {
        self.converted(self.layer_of_colors()?, self.to_rec_709)
    }

    fn converted(&self, names: [impl AsRef<str>; 3], to: Option<ToRec709>) -> Option<Picture> {
        let mut picture = self.find(names)?;
        if let Some(to) = to {
            picture.rgb.iter_mut().for_each(|rgb| *rgb = to.color(*rgb));
        }
        Some(picture)
    }

    /// Whether its colours were of other primaries.
    fn is_converted(&self) -> bool {
        self.to_rec_709.is_some() || self.find(["R", "G", "B"]).is_none()
    }

    /// Window of the file, where that is not the whole picture.
    pub(crate) fn window(&self) -> Option<Window> {
        let mut windows = self.parts.iter().map(|part| part.window);
        windows.find(|window| !window.is_whole())
    }

    /// Number of samples of each pixel, and the size of a batch; only if the file says both.
    pub(crate) fn samples(&self) -> Option<(Vec<u32>, u32)> {
        let samples = self.parts.iter().find_map(|part| {
            match &part.channel(SAMPLES)?.sample_data {
                FlatSamples::U32(samples) => Some(samples.clone()),
                // A count that went through floating point may have lost samples.
                FlatSamples::F16(_) | FlatSamples::F32(_) => None,
            }
        })?;
        Some((samples, self.batch?))
    }

    /// The noise of a layered render: all of it, or none where the file has nothing of the kind.
    fn noise(&self, path: &Path) -> std::result::Result<Option<Noise>, Error> {
        let samples = self.samples();
        let mut missing = Vec::new();
        let mut found = 0;
        if samples.is_none() {
            missing.push(format!("{SAMPLES} (whole numbers, with {BATCH_ATTRIBUTE})"));
        }
        let mut variance = |layer| {
            let names = variance_channel_names(layer)?;
            let part = self.find(names.each_ref());
            match &part {
                Some(_) => found += 1,
                None => missing.push(listed(names)),
            }
            Some(part?.rgb)
        };
        let beauty = variance(crate::Layer::Beauty);
        let base = variance(crate::Layer::Base);
        let scratches = variance(crate::Layer::Scratches);
        let density = variance(crate::Layer::Density);
        match (beauty, base, scratches, density, samples) {
            (Some(beauty), Some(base), Some(scratches), Some(density), Some((samples, batch))) => {
                Ok(Some(Noise {
                    beauty,
                    base,
                    scratches,
                    density,
                    samples,
                    batch,
                }))
            }
            (.., samples) if found == 0 && samples.is_none() => Ok(None),
            _ => Err(Error::Unusable {
                path: path.to_path_buf(),
                reason: format!(
                    "a part of the variance is missing: no channels {}",
                    missing.join(", ")
                ),
            }),
        }
    }
}

//! All channels and attributes of a file, with the pixels where they are in the picture.

use std::path::Path;

use exr::prelude::*;

use super::names::{BATCH_ATTRIBUTE, NOTE_PREFIX, Notes, SAMPLES, listed, variance_channel_names};
use super::window::{LARGEST_PX, Window, window};
use crate::{Error, FilePath, Noise, Picture, Primaries, ToRec709};

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
    pub(super) fn layer(&self) -> Option<Picture> {
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
    pub(super) fn is_converted(&self) -> bool {
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
    pub(super) fn noise(&self, path: &Path) -> std::result::Result<Option<Noise>, Error> {
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

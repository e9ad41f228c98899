//! One file: opened, rendered, and asked which of its contents are left out.

use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use anyhow::{Context, Result};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_document::description::Description;
use hairline_document::{Error, Loader, SceneBuilder};
use hairline_image::{Display, Output};
use serde_json::Value;

const SIZE_PX: [u32; 2] = [96, 54];

/// Outcomes of the files of a source.
pub struct Source {
    pub name: String,
    pub files: Vec<Opened>,
}

/// Outcome of a file.
pub struct Opened {
    /// Below its source.
    pub name: String,
    pub outcome: Outcome,
    /// Contents that are left out, with their meaning, and whether that changes the picture.
    pub left_out: Vec<(String, String, bool)>,
    /// The extensions that its own text lists as used, found without Hairline's reader.
    pub used: BTreeSet<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    Rendered,
    /// Refused, with the reason.
    Refused(String),
    /// Panicked, with the message.
    Panicked(String),
    /// Rendered with this number of pixels that are no numbers.
    NotFinite(usize),
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rendered => write!(f, "rendered"),
            Self::Refused(reason) => write!(f, "refused: {reason}"),
            Self::Panicked(message) => write!(f, "**panicked**: {message}"),
            Self::NotFinite(count) => write!(f, "**{count} pixels are no numbers**"),
        }
    }
}

impl Opened {
    /// Opens a file; `picture` is the path of its picture.
    pub fn new(
        name: String,
        path: &Path,
        builder: &mut SceneBuilder,
        picture: Option<&Path>,
    ) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("read {}", path.display()))?;
        let mut opened = Self {
            name,
            outcome: Outcome::Rendered,
            left_out: Vec::new(),
            used: used(&bytes),
        };
        let attempt = catch_unwind(AssertUnwindSafe(|| opened.open(path, builder, picture)));
        match attempt {
            Ok(Ok(outcome)) => opened.outcome = outcome,
            Ok(Err(error)) => {
                // Messages name files by where they lie here.
                let folder = format!("{}/", path.parent().unwrap_or(Path::new("")).display());
                let reason = format!("{}; {}", error.found(), error.right());
                opened.outcome = Outcome::Refused(reason.replace(&folder, ""));
            }
            Err(cause) => {
                let text = cause.downcast_ref::<&str>().map(|text| (*text).to_owned());
                let text = text.or_else(|| cause.downcast_ref::<String>().cloned());
                opened.outcome = Outcome::Panicked(text.unwrap_or_default());
                // The builder may hold incomplete parts.
                *builder = SceneBuilder::new();
            }
        }
        Ok(opened)
    }

    fn open(
        &mut self,
        path: &Path,
        builder: &mut SceneBuilder,
        picture: Option<&Path>,
    ) -> Result<Outcome, Error> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut description = Description::for_model(path)?;
        description.scratches.clear();
        description.render.size_px = SIZE_PX;
        let left_out = description.left_out(folder);
        self.left_out = left_out
            .into_iter()
            .flat_map(|(_, all)| all)
            .map(|it| (it.what, it.meaning, it.matters))
            .collect();
        let scene = builder.build(&Loader::default(), &description, folder)?;
        let image = Prepared::new(&scene).render(&RenderOptions::default(), &|_| {});
        let is_wrong = |rgb: &&[f32; 3]| !rgb.iter().all(|value| value.is_finite());
        let wrong = image.base.iter().filter(is_wrong).count();
        if let Some(picture) = picture {
            let display = Display {
                exposure_ev: scene.camera.exposure_ev,
                tone_map: scene.render.tone_map,
            };
            let written =
                Output::check(picture).and_then(|output| output.write_image(&image, &display));
            written.map_err(|error| Error::new("", error.to_string(), "give another folder"))?;
        }
        Ok(match wrong {
            0 => Outcome::Rendered,
            count => Outcome::NotFinite(count),
        })
    }
}

/// The `extensionsUsed` of a file; none where its text is broken.
fn used(bytes: &[u8]) -> BTreeSet<String> {
    let text = match bytes.starts_with(b"glTF") {
        true => {
            let length = bytes.get(12..16).map(|b| [b[0], b[1], b[2], b[3]]);
            let length = length.map_or(0, |length| u32::from_le_bytes(length) as usize);
            bytes.get(20..20 + length).unwrap_or_default()
        }
        false => bytes,
    };
    let root: Value = serde_json::from_slice(text).unwrap_or_default();
    let used = root.get("extensionsUsed").and_then(Value::as_array);
    let names = used.into_iter().flatten().filter_map(Value::as_str);
    names.map(str::to_owned).collect()
}

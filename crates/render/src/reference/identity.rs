//! Record of a reference's making, and the check whether samples may be added to it.

use std::path::Path;

use anyhow::anyhow;
use hairline_image::{Image, Notes, exr_file};
use hairline_optics::mask::Mask;
use hairline_reference::{BATCH_SAMPLES, Model, REVISION, Settings};

use crate::failure::Failure;

/// The names of notes, with their names in messages.
const NOTES: [(&str, &str); 7] = [
    ("version", "version of Hairline"),
    ("model", "model"),
    ("mask", "mask"),
    ("bounces", "number of bounces"),
    ("shadows", "setting of shadows"),
    ("seed", "seed of the samples"),
    ("scene", "scene"),
];

/// The name of a model on the command line and in files.
pub fn model_name(model: Model) -> &'static str {
    match model {
        Model::Separable => "separable",
        Model::Full => "full",
    }
}

fn mask_name(settings: &Settings) -> &'static str {
    match (settings.model, settings.mask) {
        // The full model has no mask: the field includes the energy that scratches take.
        (Model::Full, _) => "none",
        (Model::Separable, Mask::Energy) => "energy",
        (Model::Separable, Mask::Linear) => "linear",
        (Model::Separable, Mask::Density) => "density",
    }
}

/// Notes on everything that two runs must have in common so that their samples make one picture.
pub fn notes(settings: &Settings, scene_fingerprint: &str) -> Notes {
    let values = [
        format!(
            "{} (samples of revision {REVISION})",
            env!("CARGO_PKG_VERSION")
        ),
        model_name(settings.model).to_owned(),
        mask_name(settings).to_owned(),
        settings.bounces.to_string(),
        if settings.shadows { "on" } else { "off" }.to_owned(),
        settings.seed.to_string(),
        scene_fingerprint.to_owned(),
    ];
    let names = NOTES.iter().map(|(name, _)| (*name).to_owned());
    names.zip(values).collect()
}

/// Reads the reference in a file, to add samples of the picture that `wanted` notes and a size describe.
///
/// # Errors
/// [`Failure::Input`] where it is another picture, naming what differs, or no reference at all.
pub fn read_to_resume(path: &Path, size_px: [u32; 2], wanted: &Notes) -> Result<Image, Failure> {
    let refuse = |reason: &str| {
        Failure::Input(anyhow!(
            "{}: cannot go on from this file: {reason}; give another name with -o, or leave --resume out to start anew in its \
             place",
            path.display()
        ))
    };
    let (mut image, notes) = match exr_file::read_image_with_notes(path) {
        Ok(read) => read,
        Err(hairline_image::Error::Unusable { reason, .. }) => {
            return Err(refuse(&format!("it is not a reference ({reason})")));
        }
        Err(error) => return Err(error.into()),
    };
    check(&image, &notes, size_px, wanted).map_err(|reason| refuse(&reason))?;
    // What stands in pixels without samples is their neighbours' light.
    let samples = image.noise.as_ref().map_or(&[][..], |noise| &noise.samples);
    for (i, _) in samples.iter().enumerate().filter(|(_, n)| **n == 0) {
        for layer in [&mut image.base, &mut image.scratches, &mut image.density] {
            layer[i] = [0.0; 3];
        }
    }
    Ok(image)
}

/// Checks whether samples of the picture that `wanted` notes and a size describe may be added to an image with its
/// notes.
///
/// # Errors
/// Why not, naming what differs.
pub fn check(
    image: &Image,
    notes: &Notes,
    size_px: [u32; 2],
    wanted: &Notes,
) -> Result<(), String> {
    let Some(noise) = &image.noise else {
        return Err("it is not a reference (it does not say how many samples it has)".to_owned());
    };
    let mut differences = Vec::new();
    if image.size_px != size_px {
        differences.push(format!(
            "its size is {} and not {}",
            size_text(image.size_px),
            size_text(size_px)
        ));
    }
    for (name, called) in NOTES {
        match (notes.get(name), wanted.get(name)) {
            (None, _) => {
                return Err(format!(
                    "it is not a reference of Hairline (it does not say its {called})"
                ));
            }
            (its, ours) if its == ours => {}
            _ if name == "scene" => differences.push("its scene is another one".to_owned()),
            (its, ours) => {
                let value = |note: Option<&String>| note.map_or("unknown", |v| v).to_owned();
                differences.push(format!(
                    "its {called} is {} and not {}",
                    value(its),
                    value(ours)
                ));
            }
        }
    }
    if noise.batch != BATCH_SAMPLES {
        differences.push(format!(
            "its batches are of {} samples and not {BATCH_SAMPLES}",
            noise.batch
        ));
    } else if noise.samples.iter().any(|n| n % BATCH_SAMPLES != 0) {
        differences.push("it has batches that are not whole".to_owned());
    }
    if differences.is_empty() {
        Ok(())
    } else {
        Err(differences.join(", "))
    }
}

fn size_text(size_px: [u32; 2]) -> String {
    format!("{}x{}", size_px[0], size_px[1])
}

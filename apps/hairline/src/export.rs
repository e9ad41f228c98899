//! `hairline export`: a scene as one file for other programs.

use anyhow::anyhow;
use hairline_console::{Switch, tell};
use hairline_document::Loader;
use hairline_document::export::{Export, Format};
use hairline_image::output::{check_writable, write_atomically};
use hairline_memory::in_words;
use hairline_work::failure::Failure;

use crate::cli;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::scene_file::{self, Overrides};

/// Bytes of a straight piece of a scratch in the file; some pieces are cut further.
const PIECE_BYTES: usize = 44;
/// Size in bytes from which a file is told to be mostly laid scratches.
const LARGE: f64 = 1e6;

/// Writes the file.
pub fn run(arguments: &cli::Export) -> Result<(), Failure> {
    let output = arguments.output.as_path();
    let export = contents(arguments)?;
    check_writable(output)?;
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    let overrides = Overrides {
        scratch_seed: arguments.scene_flags.seed,
        time_s: arguments.time,
        camera: arguments.scene_flags.camera.as_deref(),
        is_lit_for_scratches: arguments.scene_flags.show_scratches,
        wear: arguments.scene_flags.wear,
        interrupt: Some(&interrupt),
        ..Overrides::default()
    };
    let stopped = |failure| match interrupt.is_asked() {
        true => Failure::Work(anyhow!("interrupted: {} is not written", output.display())),
        false => failure,
    };
    let loaded = scene_file::load(Some(&arguments.scene), &overrides, &[output]);
    let loaded = loaded.map_err(stopped)?;
    let loader = Loader {
        cancelled: &|| interrupt.is_asked(),
        ..Loader::default()
    };
    let exported = loader.export(&loaded.description, &loaded.folder, export);
    let exported = exported.map_err(|error| stopped(error.into()))?;
    write_atomically(output, &exported.bytes)?;
    for note in &exported.notes {
        tell(format_args!("note: {note}"));
    }
    let bytes = exported.bytes.len() as f64;
    tell(format_args!("{}: {}", output.display(), in_words(bytes)));
    let objects = loaded.scene.objects.iter();
    let pieces: usize = objects.map(|object| object.segments.len()).sum();
    let laid = (PIECE_BYTES * pieces) as f64;
    if export.laid && bytes > LARGE && laid > 0.5 * bytes {
        tell(format_args!(
            "note: {} of it and more are scratches as they lie, for programs that lay none; without `--laid on` they are left out",
            in_words(laid)
        ));
    }
    Ok(())
}

/// Contents of the file, by its ending and the flags.
fn contents(arguments: &cli::Export) -> Result<Export, Failure> {
    let output = &arguments.output;
    let format = Format::from_path(output).ok_or_else(|| {
        Failure::Input(anyhow!(
            "--output: found \"{}\"; {}",
            output.display(),
            Format::RIGHT
        ))
    })?;
    Ok(Export {
        format,
        laid: arguments.laid == Switch::On,
        bake_px: arguments.bake,
    })
}

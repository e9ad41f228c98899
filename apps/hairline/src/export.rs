//! `hairline export`: a scene as one glTF file.

use anyhow::anyhow;
use hairline_console::{Switch, tell};
use hairline_image::output::{check_writable, write_atomically};
use hairline_memory::in_words;
use hairline_scene::Loader;
use hairline_scene::gltf_scene::Export;
use hairline_work::failure::Failure;

use crate::cli;
use crate::scene_file::{self, Overrides};

/// Writes the file.
pub fn run(arguments: &cli::Export) -> Result<(), Failure> {
    let output = arguments.output.as_path();
    let ending = output.extension().unwrap_or_default();
    if !ending.eq_ignore_ascii_case("glb") {
        return Err(Failure::Input(anyhow!(
            "--output: found \"{}\"; must end in .glb",
            output.display()
        )));
    }
    check_writable(output)?;
    let overrides = Overrides {
        scratch_seed: arguments.scene_flags.seed,
        time_s: arguments.time,
        camera: arguments.scene_flags.camera.as_deref(),
        is_lit_for_scratches: arguments.scene_flags.show_scratches,
        wear: arguments.scene_flags.wear,
        ..Overrides::default()
    };
    let loaded = scene_file::load(Some(&arguments.scene), &overrides, &[output])?;
    let export = Export {
        laid: arguments.laid == Switch::On,
    };
    let exported = Loader::default().export(&loaded.description, &loaded.folder, export)?;
    write_atomically(output, &exported.bytes)?;
    for note in &exported.notes {
        tell(format_args!("note: {note}"));
    }
    tell(format_args!(
        "{}: {}",
        output.display(),
        in_words(exported.bytes.len() as f64)
    ));
    Ok(())
}

//! `hairline scratches`: the laid scratches of an object as a list, for other programs.

use std::fs::File;
use std::io::{BufWriter, Write};

use anyhow::{Context, anyhow};
use glam::DMat4;
use hairline_console::tell;
use hairline_document::text::shown;
use hairline_document::write_scratches;
use hairline_scene::Object;

use crate::cli;
use crate::scene_file::{self, Loaded, Overrides};
use hairline_render::failure::Failure;

/// Writes the list.
pub fn run(arguments: &cli::Scratches) -> Result<(), Failure> {
    let output = arguments.output.as_path();
    let loaded = scene_file::load(Some(&arguments.scene), &Overrides::default(), &[output])?;
    let object = chosen(&loaded.scene.objects, arguments.object.as_deref())?;
    let scratches: Vec<_> = object
        .scratches
        .iter()
        .filter(|scratch| arguments.layer.is_none_or(|layer| scratch.layer == layer))
        .collect();
    if scratches.is_empty() {
        let found = arguments.layer.map_or_else(
            || "no scratches".to_owned(),
            |layer| format!("no scratches of layer {layer}"),
        );
        let name = shown(&object.name);
        return Err(Failure::Input(anyhow!(
            "found {found} on object \"{name}\""
        )));
    }
    let frame_from_world = match arguments.own_frame {
        true => own_from_world(&loaded, object),
        false => DMat4::IDENTITY,
    };
    let write = || -> anyhow::Result<()> {
        let mut out = BufWriter::new(File::create(output)?);
        write_scratches(
            object,
            scratches.iter().copied(),
            &frame_from_world,
            &mut out,
        )?;
        out.flush()?;
        Ok(())
    };
    write()
        .with_context(|| format!("{}: cannot write", output.display()))
        .map_err(Failure::Work)?;
    tell(format_args!(
        "{}: scratches of \"{}\": {}",
        output.display(),
        object.name,
        scratches.len()
    ));
    Ok(())
}

/// From world space to the frame of an object. The ground and the shapes of lamps are in world space.
fn own_from_world(loaded: &Loaded, object: &Object) -> DMat4 {
    let mut described = loaded.description.objects.iter();
    let described = described.find(|it| it.name == object.name);
    described.map_or(DMat4::IDENTITY, |it| it.world_from_object().inverse())
}

/// The object of a name, or the only one that wears scratches.
fn chosen<'a>(objects: &'a [Object], name: Option<&str>) -> Result<&'a Object, Failure> {
    let scratched: Vec<_> = objects
        .iter()
        .filter(|object| name.map_or(!object.scratches.is_empty(), |name| object.name == name))
        .collect();
    match (&scratched[..], name) {
        ([object], _) => Ok(object),
        (_, Some(name)) => Err(Failure::Input(anyhow!(
            "--object: found no object called \"{}\"; must be one of {}",
            shown(name),
            names(objects)
        ))),
        ([], None) => Err(Failure::Input(anyhow!(
            "found no scratches in the scene; must have a [[scratches]] table"
        ))),
        (_, None) => Err(Failure::Input(anyhow!(
            "found scratches on several objects; must be told which by --object: {}",
            names(scratched.into_iter())
        ))),
    }
}

fn names<'a>(objects: impl IntoIterator<Item = &'a Object>) -> String {
    let names = objects
        .into_iter()
        .map(|o| format!("\"{}\"", shown(&o.name)));
    names.collect::<Vec<_>>().join(", ")
}

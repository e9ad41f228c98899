//! `hairline bench`: how long the default method and the published one take, and how far they are from the truth.

mod curves;
mod error;
mod figures;
mod machine;
mod methods;
mod stage;
mod table;
mod talk;
mod text;
mod thoroughness;
mod timing;
mod worker;

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use hairline_console::{print, tell};
use hairline_image::output::{check_writable, write_atomically};
use hairline_scene::{Object, Scene};

use crate::cli::{self, BenchPart};
use crate::progress::Progress;
use crate::scene_file::{self, Overrides};
use figures::Figures;
use hairline_render::failure::Failure;
use machine::Machine;
use stage::{Stage, TALK_SIZE_PX};
use thoroughness::Thoroughness;
use worker::Worker;

/// A quarter of the talk's pixels.
const QUICK_SIZE_PX: [u32; 2] = [640, 360];

/// Measures, prints and writes.
pub fn run(arguments: &cli::Bench) -> Result<(), Failure> {
    if let Some(path) = &arguments.write_scene {
        check_writable(path)?;
        let stage = stage(arguments, TALK_SIZE_PX);
        return Ok(write_atomically(path, stage.to_toml().as_bytes())?);
    }
    if arguments.scene.is_some() && arguments.scratches.is_some() {
        return Err(Failure::Input(anyhow!(
            "--scratches is for the bench's own scene; a SCENE says itself how many it has"
        )));
    }
    if arguments.scene.is_some() && arguments.part.iter().any(|part| *part != BenchPart::Table) {
        return Err(Failure::Input(anyhow!(
            "--part scratches, zoom, lights and pixels vary the bench's own scene; with a SCENE there is --part table alone"
        )));
    }
    // Before the work: nobody should wait for figures that then have no place to go.
    for path in [&arguments.json, &arguments.output].into_iter().flatten() {
        check_writable(path)?;
    }
    let mut worker = Worker::open(arguments.backend)?;
    let machine = Machine::describe(&worker);
    tell(format_args!("measuring on {}", machine.in_words()));
    let figures = measure(arguments, &mut worker, machine)?;
    let text = text::document(&figures);
    print(&text)?;
    if let Some(path) = &arguments.json {
        let json = serde_json::to_vec_pretty(&figures).map_err(|e| Failure::Work(e.into()))?;
        write_atomically(path, &json)?;
    }
    if let Some(path) = &arguments.output {
        write_atomically(path, text.as_bytes())?;
    }
    Ok(())
}

/// Scene of the bench, by the command line.
fn stage(arguments: &cli::Bench, size_px: [u32; 2]) -> Stage {
    let stage = Stage::default();
    Stage {
        size_px: arguments.size.unwrap_or(size_px),
        scratches: arguments.scratches.unwrap_or(stage.scratches),
        ..stage
    }
}

fn measure(
    arguments: &cli::Bench,
    worker: &mut Worker,
    machine: Machine,
) -> Result<Figures, Failure> {
    let thoroughness = Thoroughness::from_arguments(arguments);
    let base = stage(
        arguments,
        if arguments.quick {
            QUICK_SIZE_PX
        } else {
            TALK_SIZE_PX
        },
    );
    let mut figures = Figures {
        hairline: env!("CARGO_PKG_VERSION"),
        machine,
        scene: "bench scene".to_owned(),
        size_px: base.size_px,
        scratches: base.scratches,
        quick: arguments.quick,
        talk: talk::SOURCE,
        table: Vec::new(),
        curves: Vec::new(),
    };
    let progress = Progress::start("measuring");
    if let Some(path) = &arguments.scene {
        let scene = load(arguments, path)?;
        figures.scene = file_name(path);
        figures.size_px = scene.render.size_px;
        let of = |object: &Object| object.scratches.len() as u32;
        figures.scratches = scene.objects.iter().map(of).sum();
        figures.table = table::of_scene(worker, &scene, &thoroughness, &progress)?;
        return Ok(figures);
    }
    let wanted = |part| arguments.part.is_empty() || arguments.part.contains(&part);
    if wanted(BenchPart::Table) {
        progress.restart("the table");
        figures.table = table::of_the_talk(worker, base, &thoroughness, &progress)?;
    }
    for (part, stages) in [
        (BenchPart::Scratches, curves::scratches as curves::Stages),
        (BenchPart::Zoom, curves::zoom),
        (BenchPart::Lights, curves::lights),
        (BenchPart::Pixels, curves::pixels),
    ] {
        if wanted(part) {
            let curve = curves::measure(
                worker,
                stages(base, arguments.quick),
                &thoroughness,
                &progress,
            )?;
            figures.curves.push(curve);
        }
    }
    Ok(figures)
}

/// Loads the scene that is to be measured.
fn load(arguments: &cli::Bench, path: &Path) -> Result<Scene, Failure> {
    let overrides = Overrides {
        size_px: arguments.size,
        ..Overrides::default()
    };
    let outputs = [&arguments.json, &arguments.output];
    let outputs: Vec<&Path> = outputs
        .into_iter()
        .flatten()
        .map(PathBuf::as_path)
        .collect();
    Ok(scene_file::load(Some(path), &overrides, &outputs)?.scene)
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

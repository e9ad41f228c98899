//! `hairline bench`: how long the default method and the published one take, and how far they are from the truth.

mod by_lookup;
mod counts;
mod error;
mod figures;
mod machine;
mod off;
mod plots;
mod report;
mod scaling;
mod stage;
mod table;
mod talk;
mod text;
mod timing;
mod worker;

use std::path::Path;
use std::time::Duration;

use anyhow::anyhow;
use hairline_image::output::{check_writable, write_atomically};
use hairline_optics::method::Method;
use hairline_scene::Object;

use crate::cli::{self, Part};
use crate::failure::Failure;
use crate::method_flags::flags_of;
use crate::progress::Progress;
use crate::scene_file::{self, Overrides};
use error::Accuracy;
use figures::Figures;
use machine::Machine;
use stage::{Stage, TALK_SIZE_PX};
use timing::Effort;
use worker::Worker;

/// A quarter of the talk's pixels.
const QUICK_SIZE_PX: [u32; 2] = [640, 360];

/// How thoroughly to measure.
struct Thoroughness {
    effort: Effort,
    accuracy: Accuracy,
    quick: bool,
}

/// Measures, prints and writes.
pub fn run(arguments: &cli::Bench) -> Result<(), Failure> {
    let ours = ours(arguments)?;
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
    if arguments.scene.is_some() && arguments.part.iter().any(|part| *part != Part::Table) {
        return Err(Failure::Input(anyhow!(
            "--part scratches, zoom, lights, resolution and off vary the bench's own scene; with a SCENE there is --part table alone"
        )));
    }
    // Before the work: nobody should wait for figures that then have no place to go.
    for path in [&arguments.json, &arguments.output].into_iter().flatten() {
        check_writable(path)?;
    }
    if let Some(path) = &arguments.output {
        report::check_name(path)?;
    }
    let mut worker = Worker::open(arguments.backend)?;
    let machine = Machine::of(&worker);
    eprintln!("measuring on {}", machine.in_words());
    let thoroughness = thoroughness(arguments);
    let figures = measure(arguments, &ours, &mut worker, machine, &thoroughness)?;
    text::print(&figures)?;
    if let Some(path) = &arguments.json {
        let json = serde_json::to_vec_pretty(&figures).map_err(|e| Failure::Work(e.into()))?;
        write_atomically(path, &json)?;
    }
    if let Some(path) = &arguments.output {
        report::write(path, &figures)?;
    }
    Ok(())
}

/// The bench's scene as it is asked for.
fn stage(arguments: &cli::Bench, size_px: [u32; 2]) -> Stage {
    let stage = Stage::default();
    Stage {
        size_px: arguments.size.unwrap_or(size_px),
        scratches: arguments.scratches.unwrap_or(stage.scratches),
        ..stage
    }
}

/// What is held against the published method.
fn ours(arguments: &cli::Bench) -> Result<Method, Failure> {
    if arguments.method.footprint.is_some() || arguments.method.index.is_some() {
        return Err(Failure::Input(anyhow!(
            "--footprint and --index are what the bench's columns differ in; leave them out"
        )));
    }
    arguments.method.method()
}

fn thoroughness(arguments: &cli::Bench) -> Thoroughness {
    let quick = arguments.quick;
    let pick =
        |thorough: u64, quickly: u64| Duration::from_millis(if quick { quickly } else { thorough });
    let (least, most) = match arguments.repetitions {
        Some(count) => (count as usize, count as usize),
        None if quick => (2, 5),
        None => (3, 25),
    };
    Thoroughness {
        effort: Effort {
            cell: pick(8000, 250),
            least,
            most,
        },
        accuracy: Accuracy {
            crop_px: if quick { [48, 27] } else { [96, 54] },
            time: pick(8000, 300),
        },
        quick,
    }
}

fn measure(
    arguments: &cli::Bench,
    ours: &Method,
    worker: &mut Worker,
    machine: Machine,
    thoroughness: &Thoroughness,
) -> Result<Figures, Failure> {
    let base = stage(
        arguments,
        if arguments.quick {
            QUICK_SIZE_PX
        } else {
            TALK_SIZE_PX
        },
    );
    let wanted = |part| arguments.part.is_empty() || arguments.part.contains(&part);
    let mut figures = Figures {
        hairline: env!("CARGO_PKG_VERSION"),
        machine,
        ours: flags_of(ours),
        scene: "bench scene".to_owned(),
        size_px: base.size_px,
        scratches: base.scratches,
        quick: thoroughness.quick,
        talk: talk::SOURCE,
        table: Vec::new(),
        scaling: Vec::new(),
        counts: Vec::new(),
        off: None,
    };
    if let Some(path) = &arguments.scene {
        let overrides = Overrides {
            size_px: arguments.size,
            ..Overrides::default()
        };
        let scene = scene_file::load(Some(path.as_path()), &overrides)?.scene;
        figures.scene = file_name(path);
        figures.size_px = scene.render.size_px;
        let of = |object: &Object| object.scratches.len() as u32;
        figures.scratches = scene.objects.iter().map(of).sum();
        let progress = Progress::start("measuring");
        figures.table = table::of_scene(worker, &scene, ours, thoroughness, &progress)?;
        return Ok(figures);
    }
    let progress = Progress::start("measuring");
    if wanted(Part::Table) {
        progress.restart("the table");
        figures.table = table::of_the_talk(worker, base, ours, thoroughness, &progress)?;
        figures.counts = counts::of_the_table(base, ours, worker.adapter().is_some())?;
    }
    for (part, measure) in [
        (Part::Scratches, scaling::scratches as scaling::Measure),
        (Part::Zoom, scaling::zoom),
        (Part::Lights, scaling::lights),
        (Part::Resolution, scaling::resolution),
    ] {
        if wanted(part) {
            let curve = measure(worker, base, ours, thoroughness, &progress)?;
            figures.scaling.push(curve);
        }
    }
    if wanted(Part::Off) {
        let off = off::measure(worker, base, ours, thoroughness, &progress)?;
        figures.off = Some(off);
    }
    Ok(figures)
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

//! `cargo lab passes`: time of each pass of a graphics adapter, by its own clock, for pictures with default options.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use hairline_document::description::Description;
use hairline_document::{DEFAULT_SAMPLES, DEFAULT_TRANSPORT, Loader, SceneBuilder};
use hairline_gpu::{Gpu, GpuScene, Method, RenderOptions, Renderer, headless, steps};
use hairline_image::Display;
use hairline_index::ScratchIndex;
use hairline_scene::{Scene, ScratchTables};
use serde::Serialize;

/// Pixels of a submission, those of the viewer on a GPU.
const SUBMISSION_PX: u32 = 1 << 20;

/// Options of `passes`.
#[derive(clap::Args)]
pub struct Passes {
    /// Scene files or models.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,

    /// Width and height of the pictures.
    #[arg(long, num_args = 2, default_values_t = [1280, 720])]
    size_px: Vec<u32>,

    /// Pictures of each kind, of which the median counts.
    #[arg(long, default_value_t = 9)]
    repetitions: usize,

    /// A file for the figures, JSON.
    #[arg(long)]
    json: Option<PathBuf>,
}

/// Milliseconds for one scene.
#[derive(Serialize)]
struct Figures {
    scene: String,
    /// Uploading the scene and compiling its passes, with shadows, by the clock.
    upload_ms: f64,
    /// The closed form without shadows, one sample: a picture in motion.
    moving: Times,
    /// The picture with default options, filtered and shown.
    still: Times,
}

/// Medians over several pictures.
#[derive(Serialize)]
struct Times {
    /// From the first call to the last pass, by the clock.
    wall_ms: f64,
    /// By pass; empty where the device has no clock.
    passes_ms: BTreeMap<&'static str, f64>,
}

impl Passes {
    /// Measures all, and prints the tables.
    pub fn run(self) -> Result<()> {
        let gpu = headless::open(&Default::default())?;
        println!("{}\n", gpu.adapter);
        let mut all = Vec::new();
        for path in &self.scenes {
            let figures = self
                .figures(&gpu, path)
                .with_context(|| path.display().to_string())?;
            println!(
                "{}: upload {:.0} ms, moving {:.2} ms, still {:.2} ms",
                figures.scene, figures.upload_ms, figures.moving.wall_ms, figures.still.wall_ms
            );
            all.push(figures);
        }
        print_table("Moving", &all, |figures| &figures.moving);
        print_table("Still", &all, |figures| &figures.still);
        if let Some(path) = &self.json {
            std::fs::write(path, serde_json::to_string_pretty(&all)?)?;
        }
        Ok(())
    }

    fn figures(&self, gpu: &Gpu, path: &Path) -> Result<Figures> {
        let mut scene = load(path)?;
        scene.render.size_px = [self.size_px[0], self.size_px[1]];
        let index = Arc::new(ScratchIndex::build(&scene));
        let tables = ScratchTables::new(&scene);
        let mut renderer = gpu.block_on(Renderer::new(gpu))?;
        gpu.block_on(renderer.time_passes())?;
        let start = Instant::now();
        let uploaded = gpu.block_on(async {
            let method = Method::default();
            let mut uploaded = renderer.upload(&scene, &index, &tables, &method).await?;
            let bounces = DEFAULT_TRANSPORT.bounces;
            renderer.add_shadows(&mut uploaded, &scene, bounces).await?;
            gpu.finished().await?;
            Ok::<_, hairline_gpu::Error>(uploaded)
        })?;
        let upload_ms = milliseconds(start.elapsed());
        let moving = RenderOptions {
            without_shadows: true,
            ..RenderOptions::default()
        };
        let still = RenderOptions {
            samples: DEFAULT_SAMPLES,
            ..RenderOptions::default()
        };
        let mut times = |options| self.times(&mut renderer, &scene, &uploaded, options);
        Ok(Figures {
            scene: path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            upload_ms,
            moving: times(&moving)?,
            still: times(&still)?,
        })
    }

    fn times(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        uploaded: &GpuScene,
        options: &RenderOptions,
    ) -> Result<Times> {
        let gpu = renderer.gpu().clone();
        let display = Display {
            exposure_ev: scene.camera.exposure_ev,
            tone_map: scene.render.tone_map,
        };
        let size_px = scene.render.size_px;
        let mut canvas = gpu.block_on(renderer.canvas(size_px, SUBMISSION_PX))?;
        let mut walls_ms = Vec::new();
        let mut passes_ms: BTreeMap<&'static str, Vec<f64>> = BTreeMap::new();
        // The first picture makes room and is not counted.
        for repetition in 0..=self.repetitions {
            let start = Instant::now();
            let shown = gpu.block_on(async {
                for step in 0..steps(options.samples) {
                    for band in 0..canvas.bands() {
                        let drawn =
                            renderer.accumulate(scene, uploaded, &mut canvas, band, step, options);
                        drawn.await?;
                    }
                }
                renderer
                    .settle(scene, uploaded, &mut canvas, options)
                    .await?;
                renderer.read_shown(&canvas, &display).await
            })?;
            anyhow::ensure!(shown.iter().any(|value| !matches!(value, 0 | 255)), "black");
            let wall_ms = milliseconds(start.elapsed());
            let passes = gpu.block_on(renderer.pass_times())?.unwrap_or_default();
            if repetition > 0 {
                walls_ms.push(wall_ms);
                for pass in passes {
                    let times = passes_ms.entry(pass.name).or_default();
                    times.push(milliseconds(pass.time));
                }
            }
        }
        Ok(Times {
            wall_ms: median(walls_ms),
            passes_ms: passes_ms
                .into_iter()
                .map(|(name, times)| (name, median(times)))
                .collect(),
        })
    }
}

/// Reads a scene file, or a model in the scene that `hairline render` shows it in.
fn load(path: &Path) -> Result<Scene> {
    if !Description::is_model(path) {
        return Ok(hairline_document::load(path)?);
    }
    let description = Description::for_model(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    Ok(SceneBuilder::new().build(&Loader::default(), &description, folder)?)
}

fn print_table(title: &str, all: &[Figures], times: impl Fn(&Figures) -> &Times) {
    let names: Vec<&str> = all.iter().map(|figures| figures.scene.as_str()).collect();
    println!("\n| {title}, ms | {} |", names.join(" | "));
    println!("|---|{}", "---:|".repeat(all.len()));
    let mut passes: Vec<&'static str> = (all.iter())
        .flat_map(|figures| times(figures).passes_ms.keys().copied())
        .collect();
    passes.sort_unstable();
    passes.dedup();
    let line = |name: &str, value: &dyn Fn(&Times) -> Option<f64>| {
        let cells = all.iter().map(|figures| match value(times(figures)) {
            Some(ms) => format!(" {ms:.2} |"),
            None => " |".to_owned(),
        });
        println!("| {name} |{}", cells.collect::<String>());
    };
    for pass in passes {
        line(pass, &|times| times.passes_ms.get(pass).copied());
    }
    line("all passes", &|times| {
        Some(times.passes_ms.values().sum::<f64>() + 0.0)
    });
    line("by the clock", &|times| Some(times.wall_ms));
}

fn milliseconds(time: Duration) -> f64 {
    1000.0 * time.as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}

//! Renders for the measurements. References are kept as EXR files, so that a measurement which was stopped goes on.

use std::cell::LazyCell;
use std::fmt::{self, Write};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_image::{Display, Image, Layer, Output, exr_file};
use hairline_optics::mask::Mask;
use hairline_reference::{Integrator, Settings};
use hairline_scene::Scene;

use super::compared::uncertainty;

/// Paths whose contents a reference depends on besides the scene and the settings.
const SOURCES: [&str; 9] = [
    "crates/optics/data",
    "crates/optics/src",
    "crates/scene/src",
    "crates/sky/src",
    "crates/document/src",
    "crates/index/src",
    "crates/image/src/film.rs",
    "crates/reference/src",
    "crates/cpu/src/surface.rs",
];

/// Number of samples of a reference: twice as many each time, until the goal or the end is reached.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Number at the beginning.
    pub least: u32,
    /// Number at the end.
    pub most: u32,
    /// Enough, when the relative rms between closed form and reference is known in this layer to this standard error.
    pub goal: (Layer, f64),
}

/// Renderer of the pictures, and the folder where they are kept.
pub struct Renders {
    folder: PathBuf,
    sources: blake3::Hash,
    quick: bool,
}

impl Renders {
    /// `root` is the repository; `quick` limits every budget.
    pub fn new(root: &Path, quick: bool) -> Result<Self> {
        let folder = root.join("target/accuracy/renders");
        fs::create_dir_all(&folder).context("make target/accuracy/renders")?;
        let mut sources = blake3::Hasher::new();
        for source in SOURCES {
            hash_files(&root.join(source), &mut sources)?;
        }
        Ok(Self {
            folder,
            sources: sources.finalize(),
            quick,
        })
    }

    /// A size for figures that count, or one for a look alone.
    pub fn pick<T>(&self, thorough: T, quick: T) -> T {
        if self.quick { quick } else { thorough }
    }

    /// Renders a Monte Carlo picture, with more samples until the budget's goal against `closed` is met. `label`
    /// tells whoever waits.
    pub fn reference(
        &self,
        label: &str,
        scene: &Scene,
        settings: Settings,
        budget: &Budget,
        closed: &Image,
    ) -> Result<Image> {
        let (least, most) = self.pick((budget.least, budget.most), (128, 128));
        let file = self
            .folder
            .join(format!("{}.exr", self.key(scene, settings)));
        // Trees and tables take their time, and what is on file needs none.
        let integrator = LazyCell::new(|| Integrator::new(scene, settings));
        let mut image = if file.exists() {
            exr_file::read_image(&file)?
        } else {
            integrator.start()
        };
        let (layer, goal) = budget.goal;
        let start = Instant::now();
        let mut samples = least;
        loop {
            if image.noise.as_ref().map_or(0, |n| n.samples[0]) < samples {
                let _: ControlFlow<()> =
                    integrator.run(&mut image, samples, &|_| ControlFlow::Continue(()));
                Output::check(&file)?.write_image(&image, &Display::default())?;
            }
            let error = uncertainty(closed, &image, layer);
            if error <= goal || samples >= most {
                let seconds = start.elapsed().as_secs_f64();
                println!(
                    "{label}: {samples} spp, ± {:.2} %, {seconds:.1} s",
                    100.0 * error
                );
                return Ok(image);
            }
            samples *= 2;
        }
    }

    /// A reference's name.
    fn key(&self, scene: &Scene, settings: Settings) -> String {
        let mut digest = Digest(blake3::Hasher::new());
        digest.0.update(self.sources.as_bytes());
        // Every field of the scene, without a list of fields that could be incomplete.
        write!(digest, "{settings:?}{scene:?}").expect("a digest takes everything");
        digest.0.finalize().to_hex()[..24].to_owned()
    }
}

/// The closed form's picture.
pub fn closed_form(scene: &Scene, samples: u32, mask: Mask) -> Image {
    closed_form::render(
        scene,
        &RenderOptions {
            samples,
            mask,
            ..RenderOptions::default()
        },
        &|_| {},
    )
}

/// Hash of a text that is written to it.
struct Digest(blake3::Hasher);

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

/// A file, or all files below a folder in the order of their names.
fn hash_files(path: &Path, hasher: &mut blake3::Hasher) -> Result<()> {
    let failed = || format!("read {}", path.display());
    if path.is_dir() {
        let entries: Result<Vec<_>, _> = fs::read_dir(path).with_context(failed)?.collect();
        let mut paths: Vec<PathBuf> = entries
            .with_context(failed)?
            .iter()
            .map(|e| e.path())
            .collect();
        paths.sort();
        for path in paths {
            hash_files(&path, hasher)?;
        }
    } else {
        hasher.update(&fs::read(path).with_context(failed)?);
    }
    Ok(())
}

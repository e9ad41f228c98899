//! `cargo lab accuracy`: how far the closed forms are from their model, and the model from the waves. Measured with Hairline's
//! own tools and written to docs/accuracy.md, with plots.
//!
//! Each part measures into a file of figures; the document and the plots are made of these files alone. References are kept
//! beside them (`renders`), so a part that was stopped goes on where it was.

pub(crate) mod compared;
mod cost;
mod figure;
mod figures;
mod interference;
mod masks;
mod plots;
mod renders;
mod scenes;
pub(crate) mod stage;
mod sweeps;
mod text;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use figures::Figures;
use hairline_image::output::write_atomically;
use renders::Renders;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Options of `accuracy`.
#[derive(clap::Args)]
pub struct Accuracy {
    /// Few samples, to see in two minutes that all of it works: into target/accuracy/quick, and not into docs.
    #[arg(long)]
    quick: bool,

    /// Measure these parts alone, and take the others' figures from earlier runs. `text` measures nothing.
    #[arg(long, value_enum, value_delimiter = ',')]
    only: Vec<AccuracyPart>,
}

/// Parts that can be measured on their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum AccuracyPart {
    /// The scenes of scenes/ and the built-in one.
    Scenes,
    /// One knob of a plain scene at a time.
    Sweeps,
    /// The energy mask against the density mask.
    Masks,
    /// Parallel grooves with their phases and without.
    Interference,
    /// Time and noise of the Monte Carlo.
    Cost,
    /// No measurement: the document is written anew.
    Text,
}

impl Accuracy {
    /// Measures, draws and writes.
    pub fn run(self) -> Result<()> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let renders = Renders::new(&root, self.quick)?;
        let kept = KeptFigures {
            folder: root.join(if self.quick {
                "target/accuracy/quick"
            } else {
                "target/accuracy"
            }),
            only: &self.only,
        };
        fs::create_dir_all(&kept.folder).context("make target/accuracy")?;
        let figures = Figures {
            cost: kept.part(AccuracyPart::Cost, || cost::measure(self.quick))?,
            interference: kept.part(AccuracyPart::Interference, || {
                interference::measure(self.quick)
            })?,
            scenes: kept.part(AccuracyPart::Scenes, || scenes::measure(&renders, &root))?,
            sweeps: kept.part(AccuracyPart::Sweeps, || sweeps::measure(&renders))?,
            masks: kept.part(AccuracyPart::Masks, || masks::measure(&renders))?,
        };
        let docs = if self.quick {
            kept.folder.clone()
        } else {
            root.join("docs")
        };
        let folder = docs.join("accuracy");
        fs::create_dir_all(&folder).context("make the folder of the plots")?;
        plots::draw(&folder, &figures)?;
        let document = docs.join("accuracy.md");
        write_atomically(&document, text::document(&figures)?.as_bytes())?;
        println!("{}", document.display());
        Ok(())
    }
}

/// Figures of parts, in files.
struct KeptFigures<'a> {
    folder: PathBuf,
    only: &'a [AccuracyPart],
}

impl KeptFigures<'_> {
    /// Measures a part if it is selected, else reads its last results.
    fn part<T: Serialize + DeserializeOwned>(
        &self,
        part: AccuracyPart,
        measure: impl FnOnce() -> Result<T>,
    ) -> Result<Option<T>> {
        let file = self
            .folder
            .join(format!("{part:?}.json").to_ascii_lowercase());
        if self.only.is_empty() || self.only.contains(&part) {
            let measured = measure().with_context(|| format!("measure {part:?}"))?;
            write_atomically(&file, &serde_json::to_vec_pretty(&measured)?)?;
            return Ok(Some(measured));
        }
        if !file.exists() {
            println!("{part:?}: not measured yet; the document will lack it");
            return Ok(None);
        }
        let bytes = fs::read(&file).with_context(|| file.display().to_string())?;
        let figures = serde_json::from_slice(&bytes)
            .with_context(|| format!("{}: measure it again", file.display()))?;
        Ok(Some(figures))
    }
}

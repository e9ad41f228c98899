//! `cargo lab random`: scenes of one body that seeds make, judged against the reference, and a list of the worst.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use conformance::random::{LayerDifference, judge, scene_file};
use hairline_image::Layers;

/// Options of `random`.
#[derive(clap::Args)]
pub struct Random {
    /// The first seed.
    #[arg(long, default_value_t = 0)]
    from: u64,

    /// How many seeds.
    #[arg(long, default_value_t = 500)]
    seeds: u64,

    /// Samples of the reference for each pixel. References that are there already stay as they are.
    #[arg(long, default_value_t = 128)]
    samples: u32,

    /// How many of the worst are listed.
    #[arg(long, default_value_t = 20)]
    worst: usize,

    /// Renders on a graphics adapter, be it a software driver.
    #[arg(long)]
    gpu: bool,

    /// Takes references that are there alone, and leaves other seeds out.
    #[arg(long)]
    kept: bool,

    /// Folder for scenes, references and pictures.
    #[arg(long, default_value = "target/random")]
    folder: PathBuf,

    /// The program whose pictures are judged: `hairline`, of this version or another one.
    #[arg(long, default_value = "target/release/hairline")]
    program: PathBuf,
}

impl Random {
    /// Renders, judges and prints.
    pub fn run(self) -> Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        let mut all: Vec<(u64, LayerDifference)> = Vec::new();
        let (mut judged, mut off) = (0, 0);
        for seed in self.from..self.from + self.seeds {
            let Some(layers) = self.measure(seed)? else {
                continue;
            };
            judged += 1;
            off += usize::from(layers.iter().any(|layer| layer.severity() > 1.0));
            all.extend(layers.into_iter().map(|layer| (seed, layer)));
        }
        all.sort_by(|a, b| b.1.severity().total_cmp(&a.1.severity()));
        println!(
            "{off} of {judged} are off by more than 5 % in the mean or 10 % rms beyond noise. The worst:\n"
        );
        println!(
            "| seed | layer | share of the light | mean | rms beyond noise, % |\n|---|---|---|---|---|"
        );
        for (seed, it) in all.iter().take(self.worst) {
            println!(
                "| {seed} | {} | {:.2} | {:.3} ± {:.3} | {:.1} ± {:.1} |",
                it.layer.name(),
                it.share,
                it.mean[0],
                it.mean[1],
                100.0 * it.rms[0],
                100.0 * it.rms[1]
            );
        }
        Ok(())
    }

    /// Judges one seed's layers.
    fn measure(&self, seed: u64) -> Result<Option<Vec<LayerDifference>>> {
        let file = |name: &str| self.folder.join(format!("{seed}{name}"));
        let (scene, right, picture) = (file(".toml"), file("-ref.exr"), file(".exr"));
        std::fs::write(&scene, scene_file(seed, [96, 54]))?;
        let run = |command: &mut Command| {
            let output = command.output().context("the program does not start")?;
            let said = String::from_utf8_lossy(&output.stderr);
            ensure!(output.status.success(), "seed {seed}: {said}");
            Ok(())
        };
        if !right.exists() {
            if self.kept {
                return Ok(None);
            }
            let mut command = Command::new(&self.program);
            command.arg("reference").arg(&scene).arg("-o").arg(&right);
            run(command.args(["--spp", &self.samples.to_string()]))?;
        }
        let mut command = Command::new(&self.program);
        command.arg("render").arg(&scene).arg("-o").arg(&picture);
        let backend = if self.gpu { "gpu" } else { "cpu" };
        run(command.args(["--shadows", "off", "--backend", backend]))?;
        Ok(Some(judge(
            &Layers::read(&picture)?,
            &Layers::read(&right)?,
        )))
    }
}

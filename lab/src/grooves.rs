//! Wide grooves and grooves of each profile against both references: docs/accuracy/grooves.md.

use std::fmt::Write;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result};
use clap::Args;
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_image::{Display, Image};
use hairline_optics::section::Section;
use hairline_reference::{Integrator, Model, Settings};

use crate::accuracy::compared::{Compared, compared};
use crate::accuracy::stage::Stage;

#[derive(Args)]
pub(crate) struct Grooves {
    /// Print a few rows alone, with few samples.
    #[arg(long)]
    quick: bool,
}

/// Makes a section.
type MakeSection = fn() -> Section;

const SECTIONS: [(&str, MakeSection); 4] = [
    ("rectangle", || Section::Rectangle),
    ("v", || Section::V),
    ("round", || Section::Round),
    ("shoulders", || Section::Shoulders),
];

/// Coherence and width of the grooves whose cover varies.
const COVERED: [(f64, f64); 7] = [
    (20.0, 2.0),
    (20.0, 6.0),
    (20.0, 20.0),
    (20.0, 50.0),
    (5.0, 1.5),
    (5.0, 6.0),
    (5.0, 30.0),
];

/// Pixels at a side: for the separable model, and for the full one, which takes a hundred times as long.
const SIDES_PX: [u32; 2] = [32, 16];

impl Grooves {
    pub(crate) fn run(&self) -> Result<()> {
        let mut text = String::from(HEAD);
        let widths: &[f64] = match self.quick {
            true => &[4.0, 30.0, 100.0],
            false => &[4.0, 8.0, 10.0, 14.0, 20.0, 30.0, 50.0, 100.0],
        };
        let wide = |width_um: f64| Stage {
            width_um,
            // As many grooves, whatever their width, up to a half of the area.
            covered: (0.01 * width_um).clamp(0.05, 0.3),
            pixel_um: 60.0,
            ..Stage::default()
        };
        text.push_str("\n## Wide grooves\n");
        text.push_str(WIDE);
        text.push_str(COLUMNS);
        for &width_um in widths {
            self.row(&mut text, &format!("{width_um} µm"), wide(width_um))?;
        }
        for coherence_um in [5.0, 60.0] {
            for width_um in [10.0, 30.0, 100.0] {
                let stage = Stage {
                    coherence_um,
                    ..wide(width_um)
                };
                let name = format!("{width_um} µm, coherence {coherence_um} µm");
                self.row(&mut text, &name, stage)?;
            }
        }
        for roughness in [0.05, 0.2, 0.4] {
            let stage = Stage {
                roughness,
                ..wide(30.0)
            };
            self.row(&mut text, &format!("30 µm, roughness {roughness}"), stage)?;
        }
        text.push_str(COVER);
        for (coherence_um, width_um) in COVERED {
            self.cover_row(&mut text, coherence_um, width_um)?;
        }
        text.push_str(CROSSINGS);
        text.push_str("\n## Profiles\n");
        text.push_str(PROFILES);
        text.push_str(COLUMNS);
        for (name, section) in SECTIONS {
            for width_um in [2.0, 8.0, 30.0] {
                let stage = Stage {
                    section,
                    // The whole field has many strips to cross.
                    spread_rad: 0.05,
                    ..wide(width_um)
                };
                self.row(&mut text, &format!("{name}, {width_um} µm"), stage)?;
            }
        }
        text.push_str(TAIL);
        if !self.quick {
            let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
            fs::write(root.join("docs/accuracy/grooves.md"), text).context("write the page")?;
        }
        Ok(())
    }

    fn row(&self, text: &mut String, name: &str, stage: Stage) -> Result<()> {
        let [separable, full] = if self.quick { [128, 128] } else { [512, 128] };
        let [side, full_side] = SIDES_PX;
        let (closed, by_separable) = pictures(&stage, side, Model::Separable, separable)?;
        let (small, by_full) = pictures(&stage, full_side, Model::Full, full)?;
        let display = Display::default();
        let row = format!(
            "| {name} | {} | {} |\n",
            cells(&compared(&closed, &by_separable, &display)),
            cells(&compared(&small, &by_full, &display)),
        );
        print!("{row}");
        let _ = text.write_str(&row);
        Ok(())
    }

    /// Closed over full at two covers, each the mean of scenes with other random places.
    fn cover_row(&self, text: &mut String, coherence_um: f64, width_um: f64) -> Result<()> {
        let mut row = format!("| {coherence_um} µm | {width_um} µm |");
        for covered in [0.05, 0.3] {
            let mut ratios: [Vec<f64>; 3] = Default::default();
            for seed in 1..=if self.quick { 2 } else { 4 } {
                let stage = Stage {
                    seed,
                    coherence_um,
                    width_um,
                    covered,
                    pixel_um: 60.0,
                    ..Stage::default()
                };
                let (closed, full) = pictures(&stage, SIDES_PX[1], Model::Full, 96)?;
                let compared = compared(&closed, &full, &Display::default());
                for (layer, ratios) in ["scratches", "base", "beauty"].iter().zip(&mut ratios) {
                    ratios.extend(compared.layers.get(*layer).map(|it| it.mean_ratio.value));
                }
            }
            for ratios in ratios {
                // A layer without light in all but one of the scenes has no error.
                let _ = match mean_and_error(&ratios) {
                    [mean, error] if error.is_finite() => write!(row, " {mean:.3} ± {error:.3} |"),
                    _ => write!(row, " – |"),
                };
            }
        }
        println!("{row}");
        let _ = writeln!(text, "{row}");
        Ok(())
    }
}

/// Mean and its standard error.
fn mean_and_error(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    [mean, (square / (count * (count - 1.0))).sqrt()]
}

/// Closed form and reference.
fn pictures(stage: &Stage, size_px: u32, model: Model, samples: u32) -> Result<(Image, Image)> {
    let scene = Stage { size_px, ..*stage }.scene()?;
    let options = RenderOptions {
        samples: 1,
        ..RenderOptions::default()
    };
    let closed = closed_form::render(&scene, &options, &|_| {});
    let settings = Settings {
        model,
        ..Settings::default()
    };
    let integrator = Integrator::new(&scene, settings);
    let mut image = integrator.start();
    let _: ControlFlow<()> = integrator.run(&mut image, samples, &|_| ControlFlow::Continue(()));
    Ok((closed, image))
}

/// Mean and rms of scratches, and the mean of the base.
fn cells(compared: &Compared) -> String {
    let of = |layer: &str| compared.layers.get(layer);
    let scratches = of("scratches").map_or_else(String::new, |scratches| {
        format!(
            "{:.3} | {:.1} ± {:.1}",
            scratches.mean_ratio.value,
            100.0 * scratches.rms.value,
            100.0 * scratches.rms.error
        )
    });
    let base = of("base").map_or_else(String::new, |it| format!("{:.3}", it.mean_ratio.value));
    format!("{scratches} | {base}")
}

const HEAD: &str = "# Grooves: wide ones, and profiles

The closed form against the separable reference and against the whole field, on the plain scene of [accuracy.md](../accuracy.md): straight grooves at
random places within 20° of the plane of incidence, 150 nm deep and 1 mm long, on a mirror of roughness 0.1, a window of 20 µm, pixels of 60 µm, a light of 0.05 rad beside the mirror direction.
Made by `cargo lab grooves`. Ratios of means, and rms of the difference beyond noise over the rms of the reference, in percent.
";
const WIDE: &str = "
Rectangles. As many percent of the area are covered as a groove has micrometres, 5 at least and 30 at most.

";
const COVER: &str = "
## Cover

The same scene, widths and covers apart: closed form over whole field, four scenes of other random places each, 96 points a pixel, means with the standard error of the four.

| coherence | width | scratches at 5 % cover | base | both | scratches at 30 % cover | base | both |
|---|---|---|---|---|---|---|---|
";
const CROSSINGS: &str = "
Where grooves cross there is one floor, so random grooves whose shares add up to ρ cover p = 1 - exp(-ρ), 26 % in place of 30 %; (9) of [model.md](../model.md) goes by that. By ρ in its place narrow grooves of 2 µm at 30 % had 1.107 of their light and the base 0.701.
Parts of wide grooves count there by the floors that they belong to: without it 50 µm had 1.20 and 30 µm at a coherence of 5 µm 1.26. What is left is largest for grooves about as wide as the class of narrow ones ends, 0.3 of the window: many of them within one window would by (9) take more than there is, and its bound takes
17 % of their light. For these the two split the light in other ways: what a groove sends in the mirror's direction is of the base in the whole field, and of the scratches in the closed form. So the sum of both stands beside them.
Both follow from the statistics of random grooves, (9a) of [model.md](../model.md): the total of all directions is right, but crossings leave more of the light of edges, which goes far from the mirror's direction, than of the light near it. By theory the ratio of scratches at 30 % cover is 0.82
for 6 µm under 20 µm and 1.04 for 1.5 µm under 5 µm.
";
const PROFILES: &str = "
For the whole field a groove is 24 strips of one depth each, or four on a micrometre. Directions differ by 3° at most, so that few of them cross.

";
const COLUMNS: &str = "| grooves | closed / separable: scratches, mean | rms, % | base, mean | closed / full: scratches, mean | rms, % | base, mean |
|---|---|---|---|---|---|---|
";
const TAIL: &str = "
Alone on a mirror, seen in pixels of 40 µm under a light of 0.06 rad, the closed form against the whole field (test `profiles_and_wide_grooves_alone`): a V of 2 µm 1.1 % rms with a mean of 1.000, round of 3 µm 3.3 % and 1.007,
with shoulders of 4 µm 3.6 % and 0.993; floors of 30 and 100 µm 0.0 ± 1.2 and 0.0 ± 0.7 % with means of 1.004 and 1.000; shoulders of 30 µm 9.1 % and 1.008, where two halves stand for slopes all along.

## Alone

One groove of 1 mm and 150 nm in the middle of 12 x 12 pixels of 40 µm, 256 points a pixel: closed over full, the mean of its light and the rms beyond noise.

| groove | coherence 5 µm | coherence 20 µm | coherence 60 µm |
|---|---|---|---|
| rectangle, 10 µm | 1.013, 4.0 % | 1.001, 0.3 % | 1.000, 0.0 % |
| rectangle, 20 µm | 1.044, 5.2 % | 1.005, 1.9 % | 1.000, 2.0 % |
| rectangle, 50 µm | 1.008, 0.0 % | 1.001, 0.0 % | 1.000, 1.0 % |
| rectangle, 100 µm | 1.005, 0.0 % | 0.999, 1.1 % | 1.000, 0.0 % |
| v, 2 and 8 µm | | 1.002, 2.2 % and 1.001, 6.1 % | |
| v, 30 and 100 µm | | 1.001, 6.7 % and 0.957, 13.4 % | |
| round, 2, 8 and 30 µm | | 1.003, 2.1 %; 1.000, 8.6 % and 1.000, 29.1 % | |
| shoulders, 2, 8 and 30 µm | | 1.004, 2.2 %; 1.014, 3.5 % and 0.998, 9.3 % | |

Roughness of 0.05 and 0.4 in place of 0.1 changes none of these figures. Floors of all widths that a scene may have (`width_um` is 100 at most) are as near as narrow ones, and so are the means of slopes up to 30 µm. Where a pixel is about as large as a groove with slopes, it sees on which of them the light arises, where
the closed form has two or four places: round grooves show that most.
";

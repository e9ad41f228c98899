//! `cargo lab unbiased`: shadows and bounces of `render` against the path tracer, at four numbers of samples. Writes docs/accuracy/shadows.md.
//! The document is made of the rows in docs/accuracy/shadows.json: a run replaces those that it measures.

use std::fmt::Write;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};
use conformance::unbiased::{
    LAYERS, LayerError, SCENES, brighter, expected, interior_mask, layer_error, rendered, scene,
    without_objects,
};
use hairline_image::metrics::Verdict;
use hairline_image::output::write_atomically;
use hairline_render::Backend;
use hairline_scene::{Scene, Transport};
use serde::{Deserialize, Serialize};

/// Relative error of the light in a wrong picture, which the verdict must notice.
const BRIGHTER: f64 = 0.03;

/// Options of `unbiased`.
#[derive(clap::Args)]
pub struct Unbiased {
    /// Render on a graphics adapter, be it a software driver.
    #[arg(long)]
    gpu: bool,

    /// Bounces to measure; without any the document is written anew, and nothing measured.
    #[arg(long, value_delimiter = ',')]
    bounces: Vec<u32>,

    /// Samples of the pictures, from few to many.
    #[arg(long, value_delimiter = ',', default_values_t = [4, 16, 64, 256])]
    samples: Vec<u32>,

    /// Samples of the path tracer for each pixel.
    #[arg(long, default_value_t = 512)]
    reference: u32,

    /// Only these, by the names of the files in tests/shadows.
    names: Vec<String>,
}

/// Figures of a scene with a number of bounces.
#[derive(Serialize, Deserialize)]
struct Figures {
    scene: String,
    bounces: u32,
    is_on_gpu: bool,
    /// Samples of the path tracer.
    reference: u32,
    layers: Vec<LayerFigures>,
}

impl Figures {
    /// Key of a row, by which rows are replaced and sorted.
    fn row(&self) -> (bool, Option<usize>, u32) {
        let place = SCENES.iter().position(|(name, _)| *name == self.scene);
        (self.is_on_gpu, place, self.bounces)
    }
}

#[derive(Serialize, Deserialize)]
struct LayerFigures {
    name: String,
    /// Share of the light without shadows and bounces that is missing; below 0 where bounces add more.
    missing: f64,
    /// Figures for each number of samples.
    found: Vec<SampleFigures>,
    /// Verdicts on wrong pictures of the last number of samples but one: too bright, and without an object that hides light.
    brighter: String,
    without: Option<String>,
}

#[derive(Serialize, Deserialize)]
struct SampleFigures {
    samples: u32,
    off: f64,
    off_std: f64,
    rms: f64,
    picture_z: f64,
    verdict: String,
}

impl LayerFigures {
    /// Factor on the error for four times the samples, in the mean over all numbers of samples.
    fn fall(&self) -> Option<f64> {
        let told: Vec<_> = self.found.iter().filter(|f| f.rms > 0.0).collect();
        let [few, .., many] = &told[..] else {
            return None;
        };
        let times = f64::from(many.samples) / f64::from(few.samples);
        Some((many.rms / few.rms).powf(4f64.ln() / times.ln()))
    }
}

impl SampleFigures {
    fn new(samples: u32, found: &LayerError) -> Self {
        Self {
            samples,
            off: found.off,
            off_std: found.off_std,
            rms: found.rms,
            picture_z: found.z.picture_z,
            verdict: word(found).to_owned(),
        }
    }
}

fn word(found: &LayerError) -> &'static str {
    match found.z.verdict {
        Verdict::ExplainedByNoise => "noise",
        Verdict::MoreThanNoise => "**more**",
        Verdict::LessThanNoise => "less",
        Verdict::TooFewValues => "too few",
    }
}

impl Unbiased {
    /// Measures and writes.
    pub fn run(self) -> Result<()> {
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/accuracy");
        let [kept, document] = ["shadows.json", "shadows.md"].map(|name| docs.join(name));
        let mut all = read(&kept)?;
        let is_asked = |name: &str| self.names.is_empty() || self.names.iter().any(|n| n == name);
        for (name, occluders) in SCENES.iter().filter(|(name, _)| is_asked(name)) {
            for &bounces in &self.bounces {
                let start = Instant::now();
                let figures = self.measure(name, occluders, bounces)?;
                println!(
                    "{name}, {bounces} bounces: {:.0} s",
                    start.elapsed().as_secs_f64()
                );
                all.retain(|f| f.row() != figures.row());
                all.push(figures);
                all.sort_by_key(Figures::row);
                // After each row: the next one may take an hour.
                write_atomically(&kept, &serde_json::to_vec_pretty(&all)?)?;
            }
        }
        write_atomically(&document, text(&all).as_bytes())?;
        println!("{}", document.display());
        Ok(())
    }

    fn measure(&self, name: &str, occluders: &[&str], bounces: u32) -> Result<Figures> {
        let right = scene(name);
        let backend = if self.gpu { Backend::Gpu } else { Backend::Cpu };
        let samples = &self.samples;
        let shadows = Transport {
            shadows: true,
            bounces,
        };
        let picture = |scene: &Scene, samples, transport| {
            rendered(scene, backend, samples, transport).map_err(|error| anyhow!("{error}"))
        };
        let [.., wrong_samples, most] = samples[..] else {
            bail!("at least two numbers of samples");
        };
        let open = picture(&right, most, Transport::DIRECT)?;
        let expected = expected(&right, &open, bounces, self.reference);
        let images = samples
            .iter()
            .map(|&n| Ok((n, picture(&right, n, shadows)?)))
            .collect::<Result<Vec<_>>>()?;
        let inside = interior_mask(&right);
        let bright = picture(&brighter(name, BRIGHTER), wrong_samples, shadows)?;
        let bare = match occluders {
            [] => None,
            _ => Some(picture(
                &without_objects(right, occluders),
                wrong_samples,
                shadows,
            )?),
        };
        let layers = LAYERS.map(|layer| {
            let of = |image| layer_error(image, &expected, &open, layer, &inside);
            let sum = |values: Vec<[f32; 3]>| -> f64 {
                let seen = values.iter().zip(&inside).filter(|(_, inside)| **inside);
                seen.flat_map(|(rgb, _)| rgb).map(|c| f64::from(*c)).sum()
            };
            LayerFigures {
                name: layer.name().to_owned(),
                missing: 1.0 - sum(expected.layer(layer)) / sum(open.layer(layer)),
                found: images
                    .iter()
                    .map(|(n, image)| SampleFigures::new(*n, &of(image)))
                    .collect(),
                brighter: word(&of(&bright)).to_owned(),
                without: bare.as_ref().map(|image| word(&of(image)).to_owned()),
            }
        });
        Ok(Figures {
            scene: name.to_owned(),
            bounces,
            is_on_gpu: self.gpu,
            reference: self.reference,
            layers: layers.into(),
        })
    }
}

/// Reads the figures of earlier runs.
fn read(path: &Path) -> Result<Vec<Figures>> {
    let bytes = match fs::read(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        read => read.with_context(|| path.display().to_string())?,
    };
    serde_json::from_slice(&bytes).with_context(|| path.display().to_string())
}

/// The document.
fn text(all: &[Figures]) -> String {
    let mut text = String::from(HEAD);
    for (is_on_gpu, title) in [(false, "CPU"), (true, "A graphics adapter")] {
        let rows: Vec<_> = all.iter().filter(|f| f.is_on_gpu == is_on_gpu).collect();
        if rows.is_empty() {
            continue;
        }
        let _ = write!(
            text,
            "\n## {title}\n\n\
             | scene | bounces | samples | of the path tracer | layer | missing, % | rms of a pixel, % | for 4 times the samples | mean off, % | z of the picture | verdict | 3 % brighter | an object left out |\n\
             |---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        );
        for figures in rows {
            for layer in &figures.layers {
                let each = |of: &dyn Fn(&SampleFigures) -> String| {
                    let all: Vec<_> = layer.found.iter().map(of).collect();
                    all.join(", ")
                };
                let last = layer.found.last();
                let off = last.map_or_else(String::new, |f| {
                    format!("{:+.2} ± {:.2}", 100.0 * f.off, 100.0 * f.off_std)
                });
                let fall = layer
                    .fall()
                    .map_or_else(|| "–".into(), |fall| format!("x {fall:.2}"));
                let mut verdicts: Vec<_> = layer.found.iter().map(|f| f.verdict.as_str()).collect();
                verdicts.dedup();
                let _ = writeln!(
                    text,
                    "| {} | {} | {} | {} | {} | {:.0} | {} | {fall} | {off} | {} | {} | {} | {} |",
                    figures.scene,
                    figures.bounces,
                    each(&|f| f.samples.to_string()),
                    figures.reference,
                    layer.name,
                    100.0 * layer.missing,
                    each(&|f| format!("{:.1}", 100.0 * f.rms)),
                    each(&|f| format!("{:+.1}", f.picture_z)),
                    verdicts.join(", "),
                    layer.brighter,
                    layer.without.as_deref().unwrap_or("–"),
                );
            }
        }
    }
    text
}

const HEAD: &str = "# Shadows and bounces against the path tracer

Made by

    cargo lab unbiased --bounces 0,1,4          # the CPU renderer
    cargo lab unbiased --bounces 0,1 --gpu      # a graphics adapter, be it a software driver

from six scenes of 48 x 32 pixels in `tests/shadows`, with the linear mask. It is what these commands do, scene by scene:

    hairline render tests/shadows/edge.toml --shadows on --bounces 1 --samples 64 --mask linear --filter off -o a.exr
    hairline reference tests/shadows/edge.toml --shadows on --bounces 1 --spp 1024 --mask linear -o b.exr
    hairline compare a.exr b.exr

but for one thing. What is compared with is not the path tracer's picture b alone: rays tell which part of a closed form is seen, and a
closed form that is half a percent too bright is so in the shadow too. So the picture that rays must come to is b + s/f (F − f): F is the closed form and f the
path tracer's picture without shadows, s the path tracer's with shadows and without bounces. All three of the path tracer's pictures take the same samples, so where nothing is hidden
there is no noise in it. [accuracy.md](../accuracy.md) tells how far F is from f.

Columns of several figures are for as many samples as the row names.
*Missing*: the part of the light without shadows and bounces that is not there. *rms of a pixel*: the error over the mean of the picture without shadows, without the noise of
the path tracer. The column after it has by what that is multiplied for four times the samples, in the mean over the row's numbers of samples: independent samples have 0.5. *Mean off*: the error of the whole picture for the most samples over the same, ± one standard
deviation by how the errors of pixels scatter. *z* and *verdict* are those of the z-test of `hairline compare`, by the variances that the pictures hold: `noise` explains the
difference; it is `less` than the variances say, since samples avoid one another; or it is `more`. The last two columns are the verdicts on wrong pictures of as many samples as the last number but one of the row: with lights
3 % too bright, and without an object that hides light (where there is one outside of the picture).

Pixels within three of the outline of an object are left out: the path tracer averages over a pixel's filter there, the renderers over the pixel, so that two objects have
other parts of it. (With them, `corner` seemed to stop at 1.6 % with one bounce: nine tenths of the squared error lay along the box's outline. A sheet that begins 1.4 pixels above
the picture of `sheets` seemed to let light through where all is dark.)

Scratches of `edge` and `slit` are 0.05 to 0.12 % of the light without shadows too bright, beyond noise (z up to 4.4 at 1,024 samples). Three suspects do not explain it. More samples of the path tracer: with 2,048 `edge` has
+0.08 ± 0.03 % at 256 samples, z +3.2. Shares s/f from another half of the samples, and the groove's depth in the direction of each ray in place of one for a chord: either changes it by less than 0.02 %.

Variances come from the scatter of the rounds of a pixel. Rows that were measured before 27 November 2026 have those of batches of four samples.
On a graphics adapter the rows are of an estimator that could be negative, before the ratio of sums (41); only `sky` and `edge` without bounces were measured by the scatter of rounds. Verdicts of other rows that knew no variance are left out (–), and their z of four samples says nothing.
";

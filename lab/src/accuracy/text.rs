//! The document: a fixed text with figures in it.

use anyhow::{Context, Result};
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior, Value, context};
use serde::Serialize;

use super::compared::{Compared, LayerFigures};
use super::figure::Figure;
use super::figures::Figures;
use super::interference::Errors;
use super::sweeps::{SweepFigures, SweepPoint};

const TEMPLATE: &str = include_str!("accuracy.md.jinja");
/// Results that `tests/peers/peer.py` wrote: it needs Python and Mitsuba, and is not run here.
const PEERS: &str = include_str!("../../../tests/peers/results.md");

/// Figures that decide the wording of the text.
#[derive(Serialize)]
struct Facts {
    scenes: Option<SceneFacts>,
    sweeps: Option<SweepFacts>,
    interference: Option<InterferenceFacts>,
}

#[derive(Serialize)]
struct SceneFacts {
    count: usize,
    /// Largest rms of the scratches of a crop, closed form against separable.
    worst_linear: Figure,
    worst_energy: Figure,
    /// Crops whose scratches the z-test finds to differ by noise alone.
    noise_linear: usize,
    noise_energy: usize,
    /// Crops in whose beauty the energy mask is nearer to the full model than the density mask.
    energy_wins: usize,
}

#[derive(Serialize)]
struct SweepFacts {
    /// The largest rms of the scratches for lights of 0.05 rad and more, and for smaller ones.
    large_lights: Figure,
    small_lights: Figure,
    /// [`Self::large_lights`] with the linear mask.
    large_lights_linear: Figure,
    /// The largest rms of each sweep, closed form against separable.
    worst: Vec<(String, f64, Figure)>,
}

/// Rms errors of the incoherent sum for the smallest and the largest light, at the spacing in the figure.
#[derive(Serialize)]
struct InterferenceFacts {
    lights: [f64; 2],
    row: [f64; 2],
    random: [f64; 2],
    /// Smallest and largest pixel; the errors below are those of random grooves for the smallest light.
    pixels: [f64; 2],
    random_by_pixel: [f64; 2],
}

/// Fills the template.
pub fn document(figures: &Figures) -> Result<String> {
    let mut environment = Environment::new();
    // A name that is spelt wrong is a mistake and not a gap.
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let syntax = SyntaxConfig::builder()
        .trim_blocks(true)
        .lstrip_blocks(true)
        .build();
    environment.set_syntax(syntax.context("the template's syntax")?);
    environment.add_global("peers", PEERS.trim_end());
    environment.add_filter("percent", |f: Value| with_error(&f, 100.0, 2.0));
    environment.add_filter("ratio", |f: Value| with_error(&f, 1.0, 4.0));
    environment.add_filter("number", |v: f64| v.to_string());
    environment.add_filter("fixed", |v: f64, digits: usize| format!("{v:.digits$}"));
    let facts = Facts {
        scenes: figures.scenes.as_ref().map(|scenes| {
            let scratches = |c: &Compared| c.layers.get("scratches").cloned();
            let noise = |of: &dyn Fn(usize) -> Option<LayerFigures>| {
                (0..scenes.len())
                    .filter_map(of)
                    .filter(|layer| layer.verdict == "noise")
                    .count()
            };
            let worst = |of: &dyn Fn(usize) -> Option<LayerFigures>| {
                largest((0..scenes.len()).filter_map(of).map(|layer| layer.rms))
            };
            let linear = |i: usize| scratches(&scenes[i].linear);
            let energy = |i: usize| scratches(&scenes[i].energy);
            SceneFacts {
                count: scenes.len(),
                worst_linear: worst(&linear),
                worst_energy: worst(&energy),
                noise_linear: noise(&linear),
                noise_energy: noise(&energy),
                energy_wins: scenes.iter().filter(|s| s.energy_wins()).count(),
            }
        }),
        sweeps: figures.sweeps.as_deref().map(sweep_facts),
        interference: figures.interference.as_ref().map(|found| {
            let ends = |errors: &Errors| {
                let last = errors.by_light.len() - 1;
                [errors.by_light[0][1], errors.by_light[last][1]]
            };
            let shown = |random| {
                let at = |e: &&Errors| e.random == random && e.spacing_um == found.shown_um;
                found.by_spacing.iter().find(at)
            };
            let [first, last] = [found.by_pixel.first(), found.by_pixel.last()];
            let of = |e: Option<&Errors>| e.map_or([0.0; 2], ends);
            let lights = shown(false).map_or([0.0; 2], |e| {
                [e.by_light[0][0], e.by_light[e.by_light.len() - 1][0]]
            });
            InterferenceFacts {
                lights,
                row: of(shown(false)),
                random: of(shown(true)),
                pixels: [first, last].map(|e| e.map_or(0.0, |e| e.pixel_um)),
                random_by_pixel: [of(first)[0], of(last)[0]],
            }
        }),
    };
    let context = context! {
        version => env!("CARGO_PKG_VERSION"),
        figures => Serde(figures),
        facts => Serde(facts),
    };
    environment
        .render_named_str("accuracy.md.jinja", TEMPLATE, context)
        .context("fill the template of docs/accuracy.md")
}

fn sweep_facts(sweeps: &[SweepFigures]) -> SweepFacts {
    let rms = |point: &SweepPoint| {
        let layers = &point.closed.layers;
        Some(layers.get("scratches").or_else(|| layers.get("base"))?.rms)
    };
    let points = || {
        sweeps
            .iter()
            .filter(|s| s.key == "light")
            .flat_map(|s| &s.points)
    };
    let lights = |large: bool| largest(points().filter(|p| (p.x >= 0.05) == large).filter_map(rms));
    let linear = |p: &SweepPoint| Some(p.linear.as_ref()?.layers.get("scratches")?.rms);
    let worst = sweeps.iter().filter_map(|sweep| {
        let points = sweep.points.iter().filter_map(|p| Some((p.x, rms(p)?)));
        let (x, figure) = points.max_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
        Some((sweep.key.clone(), x, figure))
    });
    SweepFacts {
        large_lights: lights(true),
        small_lights: lights(false),
        large_lights_linear: largest(points().filter(|p| p.x >= 0.05).filter_map(linear)),
        worst: worst.collect(),
    }
}

fn largest(figures: impl Iterator<Item = Figure>) -> Figure {
    let none = Figure {
        value: 0.0,
        error: 0.0,
    };
    figures
        .max_by(|a, b| a.value.total_cmp(&b.value))
        .unwrap_or(none)
}

/// A [`Figure`] as the template has it; a dash where there is none.
fn with_error(figure: &Value, scale: f64, decimals: f64) -> Result<String, minijinja::Error> {
    if figure.is_none() || figure.is_undefined() {
        return Ok("–".to_owned());
    }
    let part = |name| f64::try_from(figure.get_attr(name)?);
    let figure = Figure {
        value: part("value")?,
        error: part("error")?,
    };
    Ok(figure.text(scale, decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_without_figures_says_so() {
        let figures = Figures {
            scenes: None,
            sweeps: None,
            masks: None,
            interference: None,
            cost: None,
        };
        let text = document(&figures).unwrap();
        assert!(text.contains("not measured"));
    }
}

//! Plots of the figures.

use std::path::Path;

use crate::plot::{Axis, Series};
use anyhow::{Context, Result};
use hairline_image::output::write_atomically;

use super::compared::{Compared, LayerFigures};
use super::cost::Cost;
use super::figure::Figure;
use super::figures::Figures;
use super::interference::{Errors, Interference};
use super::masks::{MaskErrors, MaskFigures, Rms};
use super::sweeps::{SweepFigures, SweepPoint};

const CLOSED: &str = "closed form against separable";
const FULL: &str = "separable against full";

fn log(name: &str) -> Axis<'_> {
    Axis { name, log: true }
}

fn linear(name: &str) -> Axis<'_> {
    Axis { name, log: false }
}

/// Draws whatever was measured into `folder`.
pub fn draw(folder: &Path, figures: &Figures) -> Result<()> {
    for sweep in figures.sweeps.iter().flatten() {
        if let Some((name, is_log)) = axis_of(&sweep.key) {
            draw_sweep(folder, sweep, || Axis { name, log: is_log })?;
        }
    }
    if let Some(sweeps) = &figures.sweeps {
        draw_roughness(folder, sweeps)?;
    }
    if let Some(masks) = &figures.masks {
        draw_masks(folder, masks)?;
    }
    if let Some(interference) = &figures.interference {
        draw_interference(folder, interference)?;
    }
    if let Some(cost) = &figures.cost {
        draw_cost(folder, cost)?;
    }
    Ok(())
}

/// Writes `folder/name.svg`.
fn plot(folder: &Path, name: &str, axes: [Axis; 2], series: &[Series]) -> Result<()> {
    let svg = crate::plot::plot(axes, series).with_context(|| name.to_owned())?;
    let path = folder.join(format!("{name}.svg"));
    write_atomically(&path, svg.as_bytes()).with_context(|| path.display().to_string())
}

/// Name of a sweep's axis, and whether it is logarithmic; None for the base's.
fn axis_of(key: &str) -> Option<(&'static str, bool)> {
    Some(match key {
        "light" => ("angular radius of the light, rad", true),
        "pixel" => ("pixel on the surface, µm", true),
        "covered" => ("covered by scratches, parts of the area", true),
        "depth" => ("depth, nm", true),
        "view" => ("view from the normal, degrees", false),
        "width" => ("width, µm", true),
        "length" => ("length, µm", true),
        _ => return None,
    })
}

fn draw_sweep<'a>(folder: &Path, sweep: &SweepFigures, x: impl Fn() -> Axis<'a>) -> Result<()> {
    let series = |name, color, compared: fn(&SweepPoint) -> Option<&Compared>, figure: Pick| {
        let points = sweep.points.iter().filter_map(move |point| {
            let layer = compared(point)?.layers.get("scratches")?;
            let figure = figure(layer);
            Some((point.x, figure))
        });
        Series::new(name, color, points.map(|(x, f)| [x, f.value, f.error]))
    };
    type Pick = fn(&LayerFigures) -> Figure;
    let both = |figure: Pick| {
        [
            series(CLOSED, 0, |p| Some(&p.closed), figure),
            series(FULL, 1, |p| p.full.as_ref(), figure),
        ]
    };
    let percent = both(|layer| Figure {
        value: 100.0 * layer.rms.value,
        error: 100.0 * layer.rms.error,
    });
    let name = format!("{}-rms", sweep.key);
    plot(
        folder,
        &name,
        [x(), log("rms of the scratches, %")],
        &percent,
    )?;
    let name = format!("{}-mean", sweep.key);
    let ratio = both(|layer| layer.mean_ratio);
    plot(folder, &name, [x(), linear("ratio of means")], &ratio)
}

fn draw_roughness(folder: &Path, sweeps: &[SweepFigures]) -> Result<()> {
    let series: Vec<Series> = [("sphere", 0), ("polygon", 1)]
        .into_iter()
        .filter_map(|(lamp, color)| {
            let key = format!("roughness_{lamp}");
            let sweep = sweeps.iter().find(|s| s.key == key)?;
            let points = sweep.points.iter().filter_map(|point| {
                let rms = point.closed.layers.get("base")?.rms;
                Some([point.x, 100.0 * rms.value, 100.0 * rms.error])
            });
            Some(Series::new(lamp, color, points))
        })
        .collect();
    let axes = [linear("roughness"), log("rms of the base, %")];
    plot(folder, "roughness", axes, &series)
}

fn draw_masks(folder: &Path, masks: &MaskFigures) -> Result<()> {
    let of = |name, under: fn(&Rms) -> &MaskErrors| {
        let series = |mask, color, error: fn(&MaskErrors) -> f64| {
            let points = masks.by_depth.iter().filter_map(move |rms| {
                let errors = under(rms);
                Some([
                    rms.depth_nm?,
                    100.0 * error(errors),
                    100.0 * errors.reflected.error,
                ])
            });
            Series::new(mask, color, points)
        };
        let axes = [log("depth, nm"), log("error of the reflected light, %")];
        let series = [
            series("energy mask", 0, |e| e.energy),
            series("density mask", 1, |e| e.density),
        ];
        plot(folder, name, axes, &series)
    };
    of("masks-peak", |rms| &rms.peak)?;
    of("masks-furnace", |rms| &rms.furnace)
}

fn draw_interference(folder: &Path, found: &Interference) -> Result<()> {
    for profile in &found.profiles {
        let series = |name, color, i: usize| {
            let points = profile.points.iter().map(move |p| [p[0], p[i], 0.0]);
            Series::new(name, color, points).plain()
        };
        let axes = [
            linear("direction across the grooves, direction cosines"),
            linear("response over its mean"),
        ];
        let name = if profile.random {
            "interference-random"
        } else {
            "interference-row"
        };
        let series = [series("all phases", 1, 1), series("incoherent sum", 0, 2)];
        plot(folder, name, axes, &series)?;
    }
    let lights = found.by_spacing.first().map_or(0, |e| e.by_light.len());
    let by_light = |errors: &[Errors], random: bool, x: fn(&Errors) -> f64| -> Vec<Series> {
        (0..lights)
            .filter_map(|i| {
                let some = errors.iter().filter(|e| e.random == random);
                let light = some.clone().next()?.by_light[i][0];
                let points = some.map(|e| [x(e), 100.0 * e.by_light[i][1], 0.0]);
                let kind = if random { "random" } else { "row" };
                let series = Series::new(&format!("{kind}, light of {light} rad"), i, points);
                Some(if random { series.dashed() } else { series })
            })
            .collect()
    };
    let y = "rms error of the incoherent sum, %";
    for random in [false, true] {
        let name = if random {
            "spacing-random"
        } else {
            "spacing-row"
        };
        let series = by_light(&found.by_spacing, random, |e| e.spacing_um);
        plot(folder, name, [log("mean spacing, µm"), log(y)], &series)?;
    }
    let series = by_light(&found.by_pixel, true, |e| e.pixel_um);
    let axes = [log("pixel on the surface, µm"), log(y)];
    plot(folder, "pixel-random", axes, &series)
}

fn draw_cost(folder: &Path, cost: &Cost) -> Result<()> {
    let series: Vec<Series> = cost
        .models
        .iter()
        .enumerate()
        .flat_map(|(i, model)| {
            let points = |column: usize| model.variance.iter().map(move |v| [v[0], v[column], 0.0]);
            [
                Series::new(&format!("{}, from batches", model.model), i, points(1)),
                Series::new(&format!("{}, two runs", model.model), i, points(2)).dashed(),
            ]
        })
        .collect();
    let axes = [log("samples a pixel"), log("variance of the mean")];
    plot(folder, "variance", axes, &series)
}

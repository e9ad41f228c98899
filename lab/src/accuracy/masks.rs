//! The energy mask against the density mask of the 2018 talk, judged by the full model on a smooth mirror.
//!
//! What counts is the light that leaves, base and scratches together, averaged over the picture: no model says which of the
//! two a photon belongs to. Twice: under a light about the mirror direction, which holds the specular peak and little of
//! what the scratches spread, and in a white furnace, where a mirror returns everything.

use anyhow::Result;
use hairline_image::{Image, Layer};
use hairline_optics::mask::Mask;
use hairline_reference::{Model, Settings};
use serde::{Deserialize, Serialize};

use super::figure::Figure;
use super::renders::{Budget, Renders, closed_form};
use super::stage::{ALL_AROUND, Lamp, Stage};

const DEPTHS_NM: [f64; 9] = [20.0, 50.0, 100.0, 150.0, 200.0, 300.0, 400.0, 600.0, 800.0];
const WIDTHS_UM: [f64; 4] = [1.0, 2.0, 4.0, 6.0];

/// The figures are averages over the picture: few samples do.
const BUDGET: Budget = Budget {
    least: 256,
    most: 256,
    goal: (Layer::Beauty, 0.0),
};

/// A mirror seen from a little to the side, with a tenth of it covered.
fn mirror() -> Stage {
    Stage {
        size_px: 8,
        pixel_um: 100.0,
        view_rad: 0.2,
        beside: 0.0,
        roughness: 0.0,
        covered: 0.1,
        spread_rad: ALL_AROUND,
        ..Stage::default()
    }
}

/// Errors of the reflected light, in parts of the bare mirror's light.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub struct MaskErrors {
    /// Light that the full model reflects, mean of the three channels.
    pub reflected: Figure,
    pub energy: f64,
    pub linear: f64,
    pub density: f64,
}

/// One groove.
#[derive(Clone, Serialize, Deserialize)]
struct GrooveErrors {
    depth_nm: f64,
    width_um: f64,
    peak: MaskErrors,
    furnace: MaskErrors,
}

/// Root mean squares over some grooves.
#[derive(Clone, Serialize, Deserialize)]
pub struct Rms {
    /// Depth, of [`DEPTHS_NM`]; None for all grooves.
    pub depth_nm: Option<f64>,
    pub peak: MaskErrors,
    pub furnace: MaskErrors,
}

/// Results of the measurement.
#[derive(Serialize, Deserialize)]
pub struct MaskFigures {
    /// The share of the mirror that is covered.
    covered: f64,
    /// Rms over widths, by depth.
    pub by_depth: Vec<Rms>,
    /// Rms over widths and depths.
    pub all: Rms,
}

/// Measures the grid of depths and widths.
pub fn measure(renders: &Renders) -> Result<MaskFigures> {
    let mut grooves = Vec::new();
    let step = renders.pick(1, 3);
    for depth_nm in DEPTHS_NM.into_iter().step_by(step) {
        for width_um in WIDTHS_UM.into_iter().step_by(step) {
            let stage = Stage {
                size_px: renders.pick(mirror().size_px, 4),
                depth_nm,
                width_um,
                ..mirror()
            };
            grooves.push(GrooveErrors {
                depth_nm,
                width_um,
                peak: errors(renders, stage)?,
                furnace: errors(
                    renders,
                    Stage {
                        lamp: Lamp::Furnace,
                        ..stage
                    },
                )?,
            });
        }
    }
    let of_depth = |depth_nm| {
        let some = grooves.iter().filter(move |g| g.depth_nm == depth_nm);
        rms(Some(depth_nm), some)
    };
    Ok(MaskFigures {
        covered: mirror().covered,
        by_depth: DEPTHS_NM.into_iter().step_by(step).map(of_depth).collect(),
        all: rms(None, grooves.iter()),
    })
}

fn errors(renders: &Renders, stage: Stage) -> Result<MaskErrors> {
    let scene = stage.scene()?;
    let settings = Settings {
        model: Model::Full,
        ..Settings::default()
    };
    let by_mask = |mask| closed_form(&scene, 1, mask);
    let energy = by_mask(Mask::Energy);
    let label = format!(
        "mask, {} nm, {} um, {:?}",
        stage.depth_nm, stage.width_um, stage.lamp
    );
    let full = renders.reference(&label, &scene, settings, &BUDGET, &energy)?;
    let truth = mean(&full);
    // Channel by channel: a mask may be right on average and wrong in colour.
    let error = |image: &Image| {
        let model = mean(image);
        (0..3).map(|c| (model[c] - truth[c]).powi(2)).sum::<f64>() / 3.0
    };
    Ok(MaskErrors {
        reflected: Figure {
            value: truth.iter().sum::<f64>() / 3.0,
            error: mean_error(&full),
        },
        energy: error(&energy).sqrt(),
        linear: error(&by_mask(Mask::Linear)).sqrt(),
        density: error(&by_mask(Mask::Density)).sqrt(),
    })
}

fn rms<'a>(depth_nm: Option<f64>, grooves: impl Iterator<Item = &'a GrooveErrors> + Clone) -> Rms {
    let over = |which: fn(&GrooveErrors) -> &MaskErrors| {
        let root = |value: fn(&MaskErrors) -> f64| {
            let squares = grooves.clone().map(|g| value(which(g)).powi(2));
            Figure::mean(squares).value.sqrt()
        };
        MaskErrors {
            reflected: Figure {
                value: Figure::mean(grooves.clone().map(|g| which(g).reflected.value)).value,
                error: root(|e| e.reflected.error),
            },
            energy: root(|e| e.energy),
            linear: root(|e| e.linear),
            density: root(|e| e.density),
        }
    };
    Rms {
        depth_nm,
        peak: over(|g| &g.peak),
        furnace: over(|g| &g.furnace),
    }
}

/// Mean of the beauty, by channel.
fn mean(image: &Image) -> [f64; 3] {
    let beauty = image.beauty().rgb;
    let sum = beauty.iter().fold([0.0; 3], |sum: [f64; 3], rgb| {
        std::array::from_fn(|c| sum[c] + f64::from(rgb[c]))
    });
    sum.map(|s| s / beauty.len() as f64)
}

/// The standard error of the mean of all channels, whose errors are taken to have one sign.
fn mean_error(image: &Image) -> f64 {
    let variance = image.variance(Layer::Beauty).unwrap_or_default();
    let sum: f64 = variance
        .iter()
        .map(|v| (v.iter().map(|v| f64::from(*v).sqrt()).sum::<f64>() / 3.0).powi(2))
        .sum();
    sum.sqrt() / variance.len().max(1) as f64
}

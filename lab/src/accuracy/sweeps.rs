//! One knob of the plain stage at a time: where the closed form leaves its model, and the model the waves.

use anyhow::{Context, Result};
use hairline_image::{Display, Layer};
use hairline_optics::mask::Mask;
use hairline_reference::{Model, Settings};
use hairline_scene::Scene;
use serde::{Deserialize, Serialize};

use super::compared::{Compared, compared};
use super::renders::{Budget, Renders, closed_form};
use super::stage::{ALL_AROUND, Lamp, Stage};

const BUDGET: Budget = Budget {
    least: 512,
    most: 4096,
    goal: (Layer::Scratches, 0.004),
};
const FULL_BUDGET: Budget = Budget {
    least: 128,
    most: 256,
    goal: (Layer::Scratches, 0.015),
};
/// Side of the picture for the full model, which takes a hundred times as long, and for a quick run.
const FULL_PX: u32 = 20;
const FULL_QUICK_PX: u32 = 6;
const BASE_BUDGET: Budget = Budget {
    least: 512,
    most: 4096,
    goal: (Layer::Base, 0.001),
};

/// A knob with the places that it is turned to.
struct Sweep {
    key: &'static str,
    values: &'static [f64],
    turn: fn(Stage, f64) -> Stage,
    /// Whether it is about the base, which both models share.
    base: bool,
}

const ROUGHNESS: [f64; 8] = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0];

const SWEEPS: [Sweep; 9] = [
    Sweep {
        key: "light",
        values: &[0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.6],
        turn: |stage, light_rad| Stage { light_rad, ..stage },
        base: false,
    },
    Sweep {
        key: "pixel",
        values: &[5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0],
        turn: |stage, pixel_um| Stage {
            pixel_um,
            length_um: f64::max(1000.0, 6.0 * pixel_um),
            ..stage
        },
        base: false,
    },
    Sweep {
        key: "roughness_sphere",
        values: &ROUGHNESS,
        turn: |stage, roughness| rough(stage, roughness, Lamp::Sphere),
        base: true,
    },
    Sweep {
        key: "roughness_polygon",
        values: &ROUGHNESS,
        turn: |stage, roughness| rough(stage, roughness, Lamp::Square),
        base: true,
    },
    Sweep {
        key: "covered",
        values: &[0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6],
        turn: |stage, covered| Stage {
            covered,
            spread_rad: ALL_AROUND,
            light_rad: 0.1,
            pixel_um: 100.0,
            ..stage
        },
        base: false,
    },
    Sweep {
        key: "depth",
        values: &[20.0, 50.0, 100.0, 150.0, 200.0, 400.0, 800.0, 1500.0],
        turn: |stage, depth_nm| Stage { depth_nm, ..stage },
        base: false,
    },
    Sweep {
        key: "view",
        values: &[0.0, 20.0, 40.0, 60.0, 70.0, 80.0],
        turn: |stage, view_deg| Stage {
            view_rad: view_deg.to_radians(),
            ..stage
        },
        base: false,
    },
    Sweep {
        key: "width",
        values: &[0.5, 1.0, 2.0, 4.0, 8.0],
        turn: |stage, width_um| Stage { width_um, ..stage },
        base: false,
    },
    Sweep {
        key: "length",
        values: &[10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0],
        turn: |stage, length_um| Stage { length_um, ..stage },
        base: false,
    },
];

/// A bare plate about the edge of a highlight. Pixels are as fine as the smoothest lobe, so that it is the lobe that is
/// judged and not the picture's sampling.
fn rough(stage: Stage, roughness: f64, lamp: Lamp) -> Stage {
    Stage {
        roughness,
        lamp,
        light_rad: 0.1,
        pixel_um: 500.0,
        covered: 0.0,
        ..stage
    }
}

/// Figures at one value of a knob.
#[derive(Clone, Serialize, Deserialize)]
pub struct SweepPoint {
    /// Value of the varied parameter, in the unit of its name.
    pub x: f64,
    /// Closed form against separable.
    pub closed: Compared,
    /// Comparison with the linear mask in both, except for the base's sweeps: without the effect of (9) on a pixel's mean
    /// shares.
    pub linear: Option<Compared>,
    /// Separable against full, but for the base's sweeps.
    pub full: Option<Compared>,
}

/// Figures of one knob.
#[derive(Clone, Serialize, Deserialize)]
pub struct SweepFigures {
    /// Name of the knob.
    pub key: String,
    /// Points in the order of x.
    pub points: Vec<SweepPoint>,
}

/// Turns all knobs.
pub fn measure(renders: &Renders) -> Result<Vec<SweepFigures>> {
    SWEEPS
        .iter()
        .map(|sweep| {
            let points: Result<_> = sweep
                .values
                .iter()
                .step_by(renders.pick(1, 2))
                .map(|x| measure_point(renders, sweep, *x))
                .collect();
            Ok(SweepFigures {
                key: sweep.key.to_owned(),
                points: points.with_context(|| format!("the sweep of {}", sweep.key))?,
            })
        })
        .collect()
}

fn measure_point(renders: &Renders, sweep: &Sweep, x: f64) -> Result<SweepPoint> {
    let stage = (sweep.turn)(Stage::default(), x);
    let budget = if sweep.base { &BASE_BUDGET } else { &BUDGET };
    let label = |model, side| format!("{} = {x}, {model}, {side} x {side}", sweep.key);
    let separable = |scene: &Scene, side, mask| {
        let closed = closed_form(scene, 1, mask);
        let label = label("separable", side);
        let settings = Settings {
            mask,
            ..Settings::default()
        };
        let separable = renders.reference(&label, scene, settings, budget, &closed)?;
        anyhow::Ok((closed, separable))
    };
    let scene = stage.scene()?;
    let large = separable(&scene, stage.size_px, Mask::Energy)?;
    let linear = match sweep.base {
        true => None,
        false => Some(separable(&scene, stage.size_px, Mask::Linear)?),
    };
    let full = if sweep.base {
        None
    } else {
        let size_px = renders.pick(FULL_PX, FULL_QUICK_PX);
        let scene = Stage { size_px, ..stage }.scene()?;
        let small = separable(&scene, size_px, Mask::Energy)?;
        let settings = Settings {
            model: Model::Full,
            // Other samples than the separable model's, so that the noises are independent.
            seed: 1,
            ..Settings::default()
        };
        let label = label("full", size_px);
        let full = renders.reference(&label, &scene, settings, &FULL_BUDGET, &small.0)?;
        Some(compared(&small.1, &full, &Display::default()))
    };
    Ok(SweepPoint {
        x,
        closed: compared(&large.0, &large.1, &Display::default()),
        linear: linear
            .map(|(closed, separable)| compared(&closed, &separable, &Display::default())),
        full,
    })
}

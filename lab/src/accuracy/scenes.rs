//! Every scene of scenes/ and the built-in one: closed form, separable model and full one.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use glam::DVec2;
use hairline_image::{Display, Image, Layer};
use hairline_optics::mask::Mask;
use hairline_reference::{Model, Settings};
use hairline_scene::Scene;
use serde::{Deserialize, Serialize};

use super::compared::{Compared, compared};
use super::renders::{Budget, Renders, closed_form};

/// A crop's size: few pixels, of which many samples can be had.
const CROP_PX: [u32; 2] = [32, 18];
/// Size of the crop for the full model, which takes a hundred times as long, and size for a quick run.
const FULL_PX: [u32; 2] = [16, 9];
const FULL_QUICK_PX: [u32; 2] = [8, 5];
/// A whole picture's size.
const WHOLE_PX: [u32; 2] = [64, 36];
/// Samples of a whole picture's pixels, as for `hairline render`; a crop's have one.
const WHOLE_SAMPLES: u32 = 8;

const CROP_BUDGET: Budget = Budget {
    least: 1024,
    most: 32768,
    goal: (Layer::Scratches, 0.004),
};
const WHOLE_BUDGET: Budget = Budget {
    least: 512,
    most: 1024,
    goal: (Layer::Scratches, 0.01),
};

/// A scene file and the part of its picture that is measured: where scratches are lit, but not in the
/// middle of a light's reflection.
struct View {
    name: &'static str,
    file: &'static str,
    /// The crop's middle, as parts of the picture's width and height.
    middle: DVec2,
    shows: &'static str,
    /// The most samples for the full model: its cost goes by the square of the scratches in the window.
    full_samples: u32,
}

const VIEWS: [View; 7] = [
    View {
        name: "hairline",
        file: "crates/console/src/built_in_scene.toml",
        middle: DVec2::new(0.62, 0.68),
        shows: "the fan of a turned pan",
        full_samples: 4096,
    },
    View {
        name: "plate",
        file: "scenes/plate.toml",
        middle: DVec2::new(0.24, 0.58),
        shows: "circles about a small lamp",
        full_samples: 1024,
    },
    View {
        name: "pan",
        file: "scenes/pan.toml",
        middle: DVec2::new(0.41, 0.525),
        shows: "where fan and glitter meet",
        full_samples: 2048,
    },
    View {
        name: "brushed",
        file: "scenes/brushed.toml",
        middle: DVec2::new(0.49, 0.42),
        shows: "parallel marks, densely",
        full_samples: 8192,
    },
    View {
        name: "spoon",
        file: "scenes/spoon.toml",
        middle: DVec2::new(0.33, 0.78),
        shows: "a curved mesh under tubes",
        full_samples: 4096,
    },
    View {
        name: "lights",
        file: "scenes/lights.toml",
        middle: DVec2::new(0.38, 0.50),
        shows: "spheres and polygons together",
        full_samples: 8192,
    },
    View {
        name: "closeup",
        file: "scenes/closeup.toml",
        middle: DVec2::new(0.5, 0.35),
        shows: "pixels finer than the coherence window",
        full_samples: 256,
    },
];

/// Figures of a scene.
#[derive(Serialize, Deserialize)]
pub struct SceneFigures {
    name: String,
    shows: String,
    /// Side of a pixel on the surface, across the view.
    pixel_um: f64,
    /// Closed form against separable, each with the energy mask.
    pub energy: Compared,
    /// Comparison with the linear mask in both.
    pub linear: Compared,
    /// Separable against full.
    full: Compared,
    /// Closed form against full, by the mask of the closed form.
    energy_full: Compared,
    density_full: Compared,
    /// The whole picture in enormous pixels, as `energy`.
    whole_pixel_um: f64,
    whole: Compared,
}

impl SceneFigures {
    /// Whether the beauty by the energy mask is nearer to the full model than that by the density mask.
    pub fn energy_wins(&self) -> bool {
        let rms = |of: &Compared| of.layers.get("beauty").map(|l| l.rms.value);
        match (rms(&self.energy_full), rms(&self.density_full)) {
            (Some(energy), Some(density)) => energy <= density,
            _ => false,
        }
    }
}

/// Measures all scenes.
pub fn measure(renders: &Renders, root: &Path) -> Result<Vec<SceneFigures>> {
    VIEWS
        .iter()
        .map(|view| measure_view(renders, root, view).with_context(|| view.file))
        .collect()
}

fn measure_view(renders: &Renders, root: &Path, view: &View) -> Result<SceneFigures> {
    let scene =
        hairline_document::load(root.join(view.file)).map_err(|error| anyhow!("{error}"))?;
    let large = crop(&scene, view.middle, CROP_PX);
    let small = crop(&scene, view.middle, renders.pick(FULL_PX, FULL_QUICK_PX));
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    let separable = |crop: &Scene, mask| {
        let closed = closed_form(crop, 1, mask);
        let settings = Settings {
            mask,
            ..Settings::default()
        };
        let [width, height] = crop.render.size_px;
        let label = format!("{}, separable, {mask:?}, {width} x {height}", view.name);
        let separable = renders.reference(&label, crop, settings, &CROP_BUDGET, &closed)?;
        anyhow::Ok((closed, separable))
    };
    let energy = separable(&large, Mask::Energy)?;
    let linear = separable(&large, Mask::Linear)?;
    let beside = separable(&small, Mask::Energy)?;
    let density = closed_form(&small, 1, Mask::Density);
    let settings = Settings {
        model: Model::Full,
        // Other samples than the separable model's, so that the noises are independent.
        seed: 1,
        ..Settings::default()
    };
    let budget = Budget {
        least: 128,
        most: view.full_samples,
        goal: (Layer::Scratches, 0.015),
    };
    let label = format!("{}, full", view.name);
    let full = renders.reference(&label, &small, settings, &budget, &beside.0)?;

    let mut whole = scene;
    whole.render.size_px = WHOLE_PX;
    let whole_closed = closed_form(&whole, WHOLE_SAMPLES, Mask::Energy);
    let label = format!("{}, whole", view.name);
    let settings = Settings::default();
    let whole_separable =
        renders.reference(&label, &whole, settings, &WHOLE_BUDGET, &whole_closed)?;
    Ok(SceneFigures {
        name: view.name.to_owned(),
        shows: view.shows.to_owned(),
        pixel_um: pixel_um(&large, &energy.0),
        energy: compared(&energy.0, &energy.1, &display),
        linear: compared(&linear.0, &linear.1, &display),
        full: compared(&beside.1, &full, &display),
        energy_full: compared(&beside.0, &full, &display),
        density_full: compared(&density, &full, &display),
        whole_pixel_um: pixel_um(&whole, &whole_closed),
        whole: compared(&whole_closed, &whole_separable, &display),
    })
}

/// The part of the picture about `middle`, in pixels as large as the picture's own.
fn crop(scene: &Scene, middle: DVec2, size_px: [u32; 2]) -> Scene {
    let mut crop = scene.clone();
    crop.camera = scene.camera.crop(scene.render.size_px, middle, size_px);
    crop.render.size_px = size_px;
    crop
}

/// Median side of a pixel at the depth of its surface, in micrometres.
fn pixel_um(scene: &Scene, image: &Image) -> f64 {
    let frame = scene.camera.frame(scene.render.size_px);
    let mut depths: Vec<f32> = image.depth_m.iter().copied().filter(|z| *z > 0.0).collect();
    depths.sort_by(f32::total_cmp);
    let depth_m = depths.get(depths.len() / 2).copied().unwrap_or(0.0);
    1e6 * f64::from(depth_m) * frame.per_px_y.length()
}

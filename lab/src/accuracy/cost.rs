//! Cost of the Monte Carlo: samples in a second, the gain from more cores, and the gain from more samples.

use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::{Context, Result};
use hairline_image::{Image, Layer};
use hairline_reference::{BATCH_SAMPLES, Integrator, Model, Settings};
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::{Deserialize, Serialize};

use super::stage::Stage;

/// The plain scene's pictures: small enough to be done soon, with enough pixels to keep many cores at work. The full model
/// takes a hundred times as long.
const SIZE_PX: u32 = 48;
const FULL_PX: u32 = 24;
const FULL_QUICK_PX: u32 = 12;
/// Rounds in which runs of one thread and of all take turns, so that other work of the machine affects both alike.
const ROUNDS: u32 = 3;

/// Results of the measurement.
#[derive(Serialize, Deserialize)]
pub struct Cost {
    /// Threads of the larger pool: all that the machine has.
    cores: usize,
    pub models: Vec<ModelCost>,
}

/// One model on one scene.
#[derive(Serialize, Deserialize)]
pub struct ModelCost {
    pub model: String,
    /// Samples in a second with one thread.
    samples_per_s: f64,
    /// Time of one thread over time of all, median of the rounds.
    pub speed_up: f64,
    /// The variance of the beauty by samples a pixel, mean over pixels and channels: by the scatter of batches, and by half
    /// the squared difference of two runs.
    pub variance: Vec<[f64; 3]>,
    /// Slope of the logarithms: -1 if twice the samples have half the variance.
    slope: f64,
    slope_of_difference: f64,
}

/// Measures both models.
pub fn measure(quick: bool) -> Result<Cost> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let full_px = if quick { FULL_QUICK_PX } else { FULL_PX };
    let models = [
        Run {
            name: "separable",
            model: Model::Separable,
            size_px: SIZE_PX,
            samples: if quick { 64 } else { 256 },
            doublings: if quick { 3 } else { 6 },
        },
        Run {
            name: "full",
            model: Model::Full,
            size_px: full_px,
            samples: 64,
            doublings: if quick { 2 } else { 4 },
        },
    ]
    .into_iter()
    .map(|run| measure_model(&run, cores))
    .collect::<Result<_>>()?;
    Ok(Cost { cores, models })
}

/// Settings of the run of a model.
struct Run {
    name: &'static str,
    model: Model,
    size_px: u32,
    /// Samples for the measurement of time.
    samples: u32,
    /// Doublings of the samples for the measurement of variance, by two batches.
    doublings: u32,
}

fn measure_model(how: &Run, cores: usize) -> Result<ModelCost> {
    let scene = Stage {
        size_px: how.size_px,
        ..Stage::default()
    }
    .scene()?;
    let integrator = |seed| {
        let settings = Settings {
            model: how.model,
            seed,
            ..Settings::default()
        };
        Integrator::new(&scene, settings)
    };
    let (one, all) = (pool(1)?, pool(cores)?);
    let first = integrator(0);
    let (mut alone, mut ratios) = (f64::INFINITY, Vec::new());
    for _ in 0..ROUNDS {
        let seconds = [&one, &all].map(|pool| {
            let mut image = first.start();
            let start = Instant::now();
            pool.install(|| run(&first, &mut image, how.samples));
            start.elapsed().as_secs_f64()
        });
        alone = alone.min(seconds[0]);
        ratios.push(seconds[0] / seconds[1]);
    }
    ratios.sort_by(f64::total_cmp);
    let speed_up = ratios[ratios.len() / 2];
    let pixels = how.size_px * how.size_px;
    let samples_per_s = f64::from(pixels * how.samples) / alone;

    let second = integrator(1);
    let mut images = [first.start(), second.start()];
    let variance: Vec<[f64; 3]> = (1..=how.doublings)
        .map(|doubling| {
            let samples = BATCH_SAMPLES << doubling;
            run(&first, &mut images[0], samples);
            run(&second, &mut images[1], samples);
            let [a, b] = &images;
            [
                f64::from(samples),
                mean_variance(a),
                0.5 * mean_squared_difference(a, b),
            ]
        })
        .collect();
    println!(
        "cost: {}, {samples_per_s:.0} samples/s, speed-up {speed_up:.2} of {cores}",
        how.name
    );
    Ok(ModelCost {
        model: how.name.to_owned(),
        samples_per_s,
        speed_up,
        slope: slope(variance.iter().map(|v| (v[0], v[1]))),
        slope_of_difference: slope(variance.iter().map(|v| (v[0], v[2]))),
        variance,
    })
}

fn pool(threads: usize) -> Result<ThreadPool> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.context("start threads")
}

fn run(integrator: &Integrator, image: &mut Image, samples: u32) {
    let _: ControlFlow<()> = integrator.run(image, samples, &|_| ControlFlow::Continue(()));
}

fn mean_variance(image: &Image) -> f64 {
    let values = image
        .variance(Layer::Beauty)
        .unwrap_or_default()
        .as_flattened();
    values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len().max(1) as f64
}

fn mean_squared_difference(a: &Image, b: &Image) -> f64 {
    let (a, b) = (a.beauty().rgb, b.beauty().rgb);
    let squares = a.as_flattened().iter().zip(b.as_flattened());
    let sum: f64 = squares.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    sum / (3 * a.len()).max(1) as f64
}

/// Slope of the line through the logarithms, by least squares.
fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let logs = points.map(|(x, y)| (x.ln(), y.ln()));
    let count = logs.clone().count() as f64;
    let (x, y) = logs.clone().fold((0.0, 0.0), |s, p| (s.0 + p.0, s.1 + p.1));
    let (x, y) = (x / count, y / count);
    let (xy, xx) = logs.fold((0.0, 0.0), |s, p| {
        let dx = p.0 - x;
        (s.0 + dx * (p.1 - y), s.1 + dx * dx)
    });
    xy / xx
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_the_variance_is_a_slope_of_minus_one() {
        let points = [(1.0, 8.0), (2.0, 4.0), (4.0, 2.0)].into_iter();
        assert!((slope(points) + 1.0).abs() < 1e-12);
    }
}

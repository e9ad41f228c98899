//! Pictures of a scene by each method, and how far apart they are once the noise is taken off.

use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_image::metrics::{BeyondNoise, ZTest};
use hairline_image::{Image, Layer, Layers, Noise};
use hairline_optics::mask::Mask;
use hairline_reference::{Integrator, Settings};
use hairline_scene::Scene;
use std::ops::ControlFlow;

/// The mask that is linear in the shares: the mask of a pixel's mean share is the mean of the masks of the points.
pub const LINEAR: Settings = Settings {
    model: hairline_reference::Model::Separable,
    mask: Mask::Linear,
    bounces: 0,
    shadows: false,
    seed: 1,
};

/// Samples a picture by Monte Carlo, `batches` of 64 samples a pixel.
pub fn sampled(scene: &Scene, settings: Settings, batches: u32) -> Image {
    let integrator = Integrator::new(scene, settings);
    let mut image = integrator.start();
    let samples = batches * hairline_reference::BATCH_SAMPLES;
    let _ = integrator.run(&mut image, samples, &|_| ControlFlow::Continue(()));
    image
}

/// Renders by the closed form, one ray a pixel, with the linear mask.
pub fn closed(scene: &Scene) -> Image {
    let options = RenderOptions {
        samples: 1,
        mask: Mask::Linear,
        ..RenderOptions::default()
    };
    closed_form::render(scene, &options, &|_| {})
}

/// One layer of two pictures.
#[derive(Clone, Copy, Debug)]
pub struct Compared {
    pub beyond: BeyondNoise,
    pub z: ZTest,
    /// Ratio of the image's mean to the reference's, all channels together, and its standard error by the noise.
    pub mean_ratio: f64,
    pub mean_ratio_error: f64,
}

impl Compared {
    /// The relative rms beyond the noise, and that plus two standard errors.
    pub fn rms(&self) -> (f64, f64) {
        (
            self.beyond.relative_rms(),
            self.beyond.relative_rms_within(2.0)[1],
        )
    }

    /// The noise alone, relative.
    pub fn noise(&self) -> f64 {
        self.beyond.noise_rms / self.beyond.reference_rms
    }
}

/// Compares a layer of `image` with that of `reference`, and prints it. One of them or both must be by Monte Carlo.
pub fn compared(name: &str, image: &Image, reference: &Image, layer: Layer) -> Compared {
    let (a, b) = (Layers::from(image), Layers::from(reference));
    let (a, b) = (a.estimate(layer).unwrap(), b.estimate(layer).unwrap());
    let beyond = BeyondNoise::between(&a, &b, None).expect("one of them has noise");
    let z = ZTest::between(image.size_px, &a, &b, None).expect("one of them has noise");
    let sum = |v: &[[f32; 3]]| v.iter().flatten().map(|c| f64::from(*c)).sum::<f64>();
    // The channels of a pixel are the same samples' light: their errors add up as they stand, not as independent ones.
    let error = |v: Option<&[[f32; 3]]>| -> f64 {
        v.unwrap_or_default()
            .iter()
            .map(|rgb| {
                rgb.iter()
                    .map(|c| f64::from(*c).sqrt())
                    .sum::<f64>()
                    .powi(2)
            })
            .sum()
    };
    let reference_sum = sum(b.values);
    let compared = Compared {
        beyond,
        z,
        mean_ratio: sum(a.values) / reference_sum,
        mean_ratio_error: (error(a.variance) + error(b.variance)).sqrt() / reference_sum,
    };
    let (rms, at_most) = compared.rms();
    println!(
        "{name}, {}: relative rms beyond the noise {:.2} % (below {:.2} %), noise {:.2} %, mean {:.4} +- {:.4}, {:?}",
        layer.name(),
        100.0 * rms,
        100.0 * at_most,
        100.0 * compared.noise(),
        compared.mean_ratio,
        compared.mean_ratio_error,
        z.verdict,
    );
    compared
}

/// The mean of a layer, channel by channel.
pub fn mean(values: &[[f32; 3]]) -> [f64; 3] {
    std::array::from_fn(|c| {
        values.iter().map(|v| f64::from(v[c])).sum::<f64>() / values.len() as f64
    })
}

/// A picture of some pixels of another: `from` gives each one's column and row there.
pub fn picked(image: &Image, size_px: [u32; 2], from: impl Fn(u32, u32) -> [u32; 2]) -> Image {
    let places: Vec<usize> = (0..size_px[1])
        .flat_map(|y| (0..size_px[0]).map(move |x| (x, y)))
        .map(|(x, y)| from(x, y))
        .map(|[x, y]| image.index(x, y))
        .collect();
    fn gather<T: Copy>(values: &[T], places: &[usize]) -> Vec<T> {
        places.iter().map(|i| values[*i]).collect()
    }
    Image {
        traced: None,
        size_px,
        base: gather(&image.base, &places),
        scratches: gather(&image.scratches, &places),
        density: gather(&image.density, &places),
        depth_m: gather(&image.depth_m, &places),
        normal: gather(&image.normal, &places),
        alpha: image.alpha.as_ref().map(|alpha| gather(alpha, &places)),
        noise: image.noise.as_ref().map(|noise| Noise {
            beauty: gather(&noise.beauty, &places),
            base: gather(&noise.base, &places),
            scratches: gather(&noise.scratches, &places),
            density: gather(&noise.density, &places),
            samples: gather(&noise.samples, &places),
            batch: noise.batch,
        }),
    }
}

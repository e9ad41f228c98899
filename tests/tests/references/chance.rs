//! Noise that the picture states: variances that hold, and fall as they should.

use super::pictures::{LINEAR, sampled};
use super::scenes::{View, plate, scratch, sphere};
use hairline_image::{Image, Layer};
use hairline_reference::Settings;
use hairline_scene::{Base, Scene};

const VIEW: View = View {
    angle_rad: 0.6,
    pixel_um: 30.0,
    size_px: 16,
};

fn scene() -> Scene {
    let mut scene = plate(Base::Mirror, VIEW);
    scene.lights = vec![sphere(VIEW, 0.1, 0.1, 0.1)];
    scratch(&mut scene, VIEW, 16);
    scene
}

/// The ratio of two sums, and its standard error by the scatter of their terms about that ratio.
fn ratio(over: &[f64], under: &[f64]) -> (f64, f64) {
    let under_sum: f64 = under.iter().sum();
    let ratio = over.iter().sum::<f64>() / under_sum;
    let scatter2: f64 = over
        .iter()
        .zip(under)
        .map(|(a, b)| (a - ratio * b).powi(2))
        .sum();
    (ratio, scatter2.sqrt() / under_sum)
}

fn green(values: &[[f32; 3]]) -> Vec<f64> {
    values.iter().map(|v| f64::from(v[1])).collect()
}

#[test]
fn twice_the_samples_half_the_variance() {
    let scene = scene();
    let variance = |seed, batches| {
        let image = sampled(&scene, Settings { seed, ..LINEAR }, batches);
        let noise = image.noise.unwrap();
        [noise.beauty, noise.base, noise.scratches].map(|v| green(&v))
    };
    let (once, twice) = (variance(1, 12), variance(2, 24));
    for (layer, (once, twice)) in ["beauty", "base", "scratches"]
        .iter()
        .zip(once.iter().zip(&twice))
    {
        let (ratio, error) = ratio(once, twice);
        println!("variance of n over that of 2n samples, {layer}: {ratio:.3} +- {error:.3}");
        // The ratio is 2: neither that of the standard deviations (1.41) nor that of the squared
        // variances (4).
        assert!(error < 0.14, "{layer}: too noisy to tell: {error}");
        assert!(
            (ratio - 2.0).abs() < 4.0 * error,
            "{layer}: {ratio} +- {error}"
        );
    }
}

/// Pictures of different seeds scatter as much as each of them predicts.
#[test]
fn pictures_scatter_by_their_variance() {
    let scene = scene();
    let runs = 12;
    let images: Vec<Image> = (0..runs)
        .map(|seed| sampled(&scene, Settings { seed, ..LINEAR }, 4))
        .collect();
    for layer in [Layer::Beauty, Layer::Base, Layer::Scratches] {
        let values: Vec<_> = images.iter().map(|i| green(&i.layer(layer))).collect();
        let variances: Vec<_> = images
            .iter()
            .map(|i| green(i.variance(layer).unwrap()))
            .collect();
        let mean = |v: &[Vec<f64>], pixel: usize| {
            v.iter().map(|run| run[pixel]).sum::<f64>() / v.len() as f64
        };
        // Variance of each pixel between the runs, and the predicted variance.
        let (found, predicted): (Vec<f64>, Vec<f64>) = (0..images[0].pixel_count())
            .map(|pixel| {
                let middle = mean(&values, pixel);
                let squares: f64 = values.iter().map(|v| (v[pixel] - middle).powi(2)).sum();
                (
                    squares / (values.len() as f64 - 1.0),
                    mean(&variances, pixel),
                )
            })
            .unzip();
        let (ratio, error) = ratio(&found, &predicted);
        println!(
            "variance between {runs} runs over what they predict, {}: {ratio:.3} +- {error:.3}",
            layer.name()
        );
        assert!(error < 0.1, "too noisy to tell: {error}");
        assert!((ratio - 1.0).abs() < 4.0 * error, "{ratio} +- {error}");
    }
}

//! Verdicts on differences by noise whose variance is known, or estimated from batches as an integrator does.

use hairline_image::metrics::{BeyondNoise, Estimate, Verdict, ZTest};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Size that is no multiple of a block's, on purpose.
const SIZE_PX: [u32; 2] = [134, 101];
const PIXELS: usize = 134 * 101;

/// Two normal numbers (Box and Muller 1958).
fn normal(random: &mut Pcg64) -> f64 {
    let (u, v): (f64, f64) = (random.random(), random.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// A picture with a range of a million to one, dark to the left, with a bright line across.
fn truth() -> Vec<[f32; 3]> {
    (0..PIXELS)
        .map(|i| {
            let (x, y) = (i % 134, i / 134);
            let level = 1e-4 * 10.0_f64.powf(4.0 * x as f64 / 134.0);
            let level = if x / 2 == y / 2 { 100.0 * level } else { level };
            [1.0, 0.7, 0.3].map(|c| (c * level) as f32)
        })
        .collect()
}

/// An estimate of a picture.
struct Noisy {
    values: Vec<[f32; 3]>,
    variance: Vec<[f32; 3]>,
    batches: Option<Vec<u32>>,
}

impl Noisy {
    fn estimate(&self) -> Estimate<'_> {
        Estimate {
            values: &self.values,
            variance: Some(&self.variance),
            batches: self.batches.as_deref(),
        }
    }
}

/// Normal noise of a known variance: a fifth of each value.
fn known_noise(truth: &[[f32; 3]], seed: u64) -> Noisy {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut noisy = Noisy {
        values: truth.to_vec(),
        variance: vec![[0.0; 3]; truth.len()],
        batches: None,
    };
    for (value, variance) in noisy.values.iter_mut().zip(&mut noisy.variance) {
        for c in 0..3 {
            let deviation = 0.2 * value[c];
            value[c] += deviation * normal(&mut random) as f32;
            variance[c] = deviation * deviation;
        }
    }
    noisy
}

/// The mean of batches and the variance of that mean, for batches drawn from `draw`, whose mean is 1. The channels share
/// the draws, as wavelengths share a path.
fn from_batches(
    truth: &[[f32; 3]],
    seed: u64,
    batches: u32,
    draw: impl Fn(&mut Pcg64) -> f64,
) -> Noisy {
    let mut random = Pcg64::seed_from_u64(seed);
    let n = f64::from(batches);
    let mut noisy = Noisy {
        values: Vec::new(),
        variance: Vec::new(),
        batches: Some(vec![batches; truth.len()]),
    };
    for value in truth {
        let draws: Vec<f64> = (0..batches).map(|_| draw(&mut random)).collect();
        let mean = draws.iter().sum::<f64>() / n;
        let spread = draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
        let variance = spread / (n - 1.0) / n;
        noisy
            .values
            .push(value.map(|v| (f64::from(v) * mean) as f32));
        noisy
            .variance
            .push(value.map(|v| (f64::from(v).powi(2) * variance) as f32));
    }
    noisy
}

fn test(a: &Estimate, b: &Estimate) -> ZTest {
    ZTest::compare(SIZE_PX, a, b, None).unwrap()
}

#[test]
fn noise_of_known_variance_is_explained() {
    let truth = truth();
    let exact = Estimate::exact(&truth);
    for seed in 0..20 {
        let noisy = known_noise(&truth, seed);
        let z = test(&noisy.estimate(), &exact);
        assert_eq!(z.verdict, Verdict::ExplainedByNoise, "{z:?}");
        assert_eq!((z.values, z.left_out), (3 * PIXELS, 0));
        // 40,602 values: standard errors of 0.005, 0.007 and 0.00026; blocks: 663, hence 0.055 and a channel more.
        assert!(z.mean_z.abs() < 0.02, "{z:?}");
        assert!((z.mean_z2 - 1.0).abs() < 0.03, "{z:?}");
        assert!((z.share_beyond_3 - 0.0027).abs() < 0.0011, "{z:?}");
        assert!(
            (z.variance_ratio - 1.0).abs() < 4.0 * z.variance_ratio_error,
            "{z:?}"
        );
        assert!((z.block_mean_z2 - 1.0).abs() < 0.25, "{z:?}");
        assert!(z.block_max_z < z.block_max_z_allowed(), "{z:?}");
        // Swapping the two images makes no difference.
        let back = test(&exact, &noisy.estimate());
        assert_eq!((back.mean_z2, back.verdict), (z.mean_z2, z.verdict));
        assert_eq!(back.picture_z, -z.picture_z);
    }
    // Two estimates: the variances add up.
    let (a, b) = (known_noise(&truth, 100), known_noise(&truth, 101));
    let z = test(&a.estimate(), &b.estimate());
    assert_eq!(z.verdict, Verdict::ExplainedByNoise, "{z:?}");
    assert!((z.mean_z2 - 1.0).abs() < 0.03, "{z:?}");
}

#[test]
fn a_common_error_of_a_third_of_the_noise_is_seen() {
    let truth = truth();
    let mut noisy = known_noise(&truth, 1);
    for (value, variance) in noisy.values.iter_mut().zip(&noisy.variance) {
        for c in 0..3 {
            value[c] += variance[c].sqrt() / 3.0;
        }
    }
    let z = test(&noisy.estimate(), &Estimate::exact(&truth));
    assert_eq!(z.verdict, Verdict::MoreThanNoise, "{z:?}");
    assert!((z.mean_z - 1.0 / 3.0).abs() < 0.02, "{z:?}");
    // A block of 64 sums it up to 8/3 of its noise where the noise is even; single values hardly show it.
    assert!(z.block_mean_z2 > 3.0 && z.mean_z2 < 1.2, "{z:?}");
}

#[test]
fn a_wrong_variance_is_seen() {
    let truth = truth();
    let exact = Estimate::exact(&truth);
    for (factor, verdict) in [
        (0.5, Verdict::MoreThanNoise),
        (2.0, Verdict::LessThanNoise),
        (1.1, Verdict::ExplainedByNoise),
    ] {
        let mut noisy = known_noise(&truth, 2);
        for variance in noisy.variance.iter_mut().flatten() {
            *variance *= factor;
        }
        let z = test(&noisy.estimate(), &exact);
        assert_eq!(z.verdict, verdict, "{factor}: {z:?}");
        assert!(
            (f64::from(factor) * z.variance_ratio - 1.0).abs() < 0.1,
            "{z:?}"
        );
    }
}

#[test]
fn a_wrong_spot_and_a_wrong_background_are_seen() {
    let truth = truth();
    let exact = Estimate::exact(&truth);
    // Two deviations in a spot of 16 x 16 pixels, 2 % of the picture.
    let mut noisy = known_noise(&truth, 3);
    for y in 40..56 {
        for x in 8..24 {
            let i = y * 134 + x;
            for c in 0..3 {
                noisy.values[i][c] += 2.0 * noisy.variance[i][c].sqrt();
            }
        }
    }
    let z = test(&noisy.estimate(), &exact);
    assert_eq!(z.verdict, Verdict::MoreThanNoise, "{z:?}");
    assert!(z.block_max_z > 10.0 && z.mean_z2 < 1.3, "{z:?}");

    // Half the picture has no noise: right by rounding, then 1 % off in a tenth of it.
    let mut noisy = known_noise(&truth, 4);
    for (i, exact) in truth.iter().enumerate().take(PIXELS / 2) {
        noisy.values[i] = exact.map(|c| c * (1.0 + 2e-7));
        noisy.variance[i] = [0.0; 3];
    }
    let z = test(&noisy.estimate(), &exact);
    assert_eq!(z.verdict, Verdict::ExplainedByNoise, "{z:?}");
    assert!(
        z.left_out >= 3 * (PIXELS / 2) && z.share_without_noise == 0.0,
        "{z:?}"
    );
    for (i, exact) in truth.iter().enumerate().take(PIXELS / 20) {
        noisy.values[i] = exact.map(|c| c * 1.01);
    }
    let z = test(&noisy.estimate(), &exact);
    assert_eq!(z.verdict, Verdict::MoreThanNoise, "{z:?}");
    assert!(z.share_without_noise > 0.01, "{z:?}");
}

#[test]
fn few_batches_have_heavy_tails_and_are_explained_all_the_same() {
    let truth = truth();
    let exact = Estimate::exact(&truth);
    for batches in [2, 3, 4, 8, 32] {
        for seed in 0..3 {
            let noisy = from_batches(&truth, seed, batches, |random| 1.0 + 0.3 * normal(random));
            let z = test(&noisy.estimate(), &exact);
            assert_eq!(z.verdict, Verdict::ExplainedByNoise, "{batches}: {z:?}");
            // The plain mean of t^2 is infinite for two and three batches. What remains is Wallace's approximation.
            let tolerance = if batches == 2 { 0.1 } else { 0.05 };
            assert!((z.mean_z2 - 1.0).abs() < tolerance, "{batches}: {z:?}");
            assert!(z.share_beyond_3 < 0.005, "{batches}: {z:?}");
        }
    }
}

#[test]
fn skewed_batches_are_explained() {
    let truth = truth();
    let exact = Estimate::exact(&truth);
    for seed in 0..5 {
        // Exponential batches: the variance is too small where the mean is, so that the mean of z leans down.
        let noisy = from_batches(&truth, seed, 16, |random| {
            -(1.0 - random.random::<f64>()).ln()
        });
        let z = test(&noisy.estimate(), &exact);
        assert_eq!(z.verdict, Verdict::ExplainedByNoise, "{z:?}");
        assert!(z.mean_z < -0.1, "{z:?}");
        // Light that one batch in ten finds: pixels where none of 16 did know no variance, and are wrong by all they have.
        let noisy = from_batches(&truth, seed, 16, |random| {
            if random.random::<f64>() < 0.1 {
                10.0
            } else {
                0.0
            }
        });
        let z = test(&noisy.estimate(), &exact);
        assert_eq!(z.verdict, Verdict::ExplainedByNoise, "{z:?}");
        assert!(z.left_out > 1000, "{z:?}");
        let beyond = BeyondNoise::compare(&noisy.estimate(), &exact, None).unwrap();
        assert!(
            beyond.mean_square.abs() < 4.0 * beyond.mean_square_error,
            "{beyond:?}"
        );
    }
}

#[test]
fn what_is_left_beyond_the_noise() {
    // The model is 5 % too bright under 20 % of noise in one, with 10 % in the other.
    let truth: Vec<[f32; 3]> = (0..PIXELS)
        .map(|i| [1.0, 2.0, 0.5].map(|c| c * (1.0 + (i % 7) as f32)))
        .collect();
    let mean_square = |values: &[[f32; 3]]| {
        let sum: f64 = values.iter().flatten().map(|c| f64::from(*c).powi(2)).sum();
        sum / (3 * PIXELS) as f64
    };
    let reference_rms = mean_square(&truth).sqrt();
    for bias in [0.0, 0.05_f32] {
        let mut within_one = 0;
        let mut errors = Vec::new();
        for seed in 0..20 {
            let mut image = from_batches(&truth, 2 * seed, 8, |random| 1.0 + 0.5 * normal(random));
            for (value, variance) in image
                .values
                .iter_mut()
                .flatten()
                .zip(image.variance.iter_mut().flatten())
            {
                *value *= 1.0 + bias;
                *variance *= (1.0 + bias).powi(2);
            }
            let reference =
                from_batches(&truth, 2 * seed + 1, 8, |random| 1.0 + 0.3 * normal(random));
            let b = BeyondNoise::compare(&image.estimate(), &reference.estimate(), None).unwrap();
            assert_eq!(b.values, 3 * PIXELS);
            let error = b.mean_square - (f64::from(bias) * reference_rms).powi(2);
            assert!(error.abs() < 4.0 * b.mean_square_error, "{b:?}");
            within_one += usize::from(error.abs() < b.mean_square_error);
            // The reference's own noise is not in its rms: it would add 0.56 %, and its standard error is 0.12 %.
            assert!(
                (b.reference_rms / reference_rms - 1.0).abs() < 0.0045,
                "{b:?}"
            );
            let [low, high] = b.relative_rms_within(4.0);
            assert!(low <= f64::from(bias) && f64::from(bias) <= high, "{b:?}");
            assert!(low <= b.relative_rms() && b.relative_rms() <= high);
            errors.push(error / b.mean_square_error);
        }
        // Twenty of them tell a bias of one standard error from none: at 4.5 of their own.
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(mean.abs() < 0.75, "{mean}");
        // 68 % of 20 is 13.7, with a standard deviation of 2.1: an error that is stated twice too large or too small
        // would hold 19 or 8 of them.
        assert!((9..=18).contains(&within_one), "{within_one}");
    }
}

#[test]
fn what_is_unknown_is_left_out() {
    let truth = truth();
    let exact = Estimate::exact(&truth);
    assert_eq!(ZTest::compare(SIZE_PX, &exact, &exact, None), None);
    assert_eq!(BeyondNoise::compare(&exact, &exact, None), None);

    let mut noisy = known_noise(&truth, 5);
    noisy.values[0] = [f32::NAN, f32::INFINITY, 1.0];
    noisy.variance[1] = [f32::NAN, f32::INFINITY, -1.0];
    let z = test(&noisy.estimate(), &exact);
    assert_eq!((z.values, z.left_out), (3 * PIXELS - 5, 5));
    let beyond = BeyondNoise::compare(&noisy.estimate(), &exact, None).unwrap();
    assert_eq!(beyond.values, z.values);

    // One batch is no estimate of a variance.
    let mut batches = vec![64; PIXELS];
    batches[7] = 1;
    batches[8] = 0;
    noisy.batches = Some(batches);
    let z = test(&noisy.estimate(), &exact);
    assert_eq!((z.values, z.left_out), (3 * PIXELS - 11, 11));
    noisy.batches = Some(vec![1; PIXELS]);
    let z = test(&noisy.estimate(), &exact);
    assert_eq!((z.values, z.verdict), (0, Verdict::TooFewValues));
    assert!(
        [
            z.mean_z,
            z.mean_z2,
            z.block_mean_z2,
            z.variance_ratio,
            z.picture_z
        ]
        .iter()
        .all(|figure| figure.is_finite())
    );
    assert_eq!(BeyondNoise::compare(&noisy.estimate(), &exact, None), None);

    // A mask leaves a wrong region out.
    let mut noisy = known_noise(&truth, 6);
    let mask: Vec<bool> = (0..PIXELS).map(|i| i >= PIXELS / 4).collect();
    for i in 0..PIXELS / 4 {
        noisy.values[i] = [0.0; 3];
    }
    assert_eq!(
        test(&noisy.estimate(), &exact).verdict,
        Verdict::MoreThanNoise
    );
    let z = ZTest::compare(SIZE_PX, &noisy.estimate(), &exact, Some(&mask)).unwrap();
    assert_eq!(z.verdict, Verdict::ExplainedByNoise, "{z:?}");
    assert_eq!(z.left_out, 0, "{z:?}");
}

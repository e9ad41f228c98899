use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use glam::{DVec2, DVec3};
use hairline_image::Picture;
use hairline_scene::Environment;
use hairline_scene::environment::lookup::{environment_dir, environment_uv};

use super::EnvironmentSampler;
use hairline_fixtures::statistics::{Draw, chi_square, jittered};

fn map(size_px: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 3]) -> Environment {
    let texels = (0..size_px[1]).flat_map(|y| (0..size_px[0]).map(move |x| (x, y)));
    let rgb = texels.map(|(x, y)| texel(x, y)).collect();
    hairline_sky::from_map(Picture { size_px, rgb }, 0.7, 2.5, true)
}

/// Maps with names. Made once: environments blur themselves for the closed form, which takes most of these tests' time.
fn maps() -> &'static [(&'static str, Environment)] {
    static MAPS: LazyLock<Vec<(&str, Environment)>> = LazyLock::new(|| {
        let mut draw = Draw::new(1);
        let noise: Vec<f32> = (0..64 * 32).map(|_| draw.one().powi(8) as f32).collect();
        vec![
            ("even", hairline_sky::uniform([1.0, 0.5, 0.25])),
            (
                "bright texels at the seam and the poles",
                map([37, 19], |x, y| {
                    let bright = [[36, 9], [5, 0], [31, 18]].contains(&[x, y]);
                    if bright { [7.0, 3.0, 1.0] } else { [0.0; 3] }
                }),
            ),
            (
                "sun and noise, lying on their side",
                map([64, 32], |x, y| {
                    let dim = noise[(y * 64 + x) as usize];
                    if [x, y] == [40, 10] {
                        [6e4; 3]
                    } else {
                        [dim, 0.5 * dim, y as f32 / 30.0]
                    }
                })
                .with_up(DVec3::new(1.0, 0.2, -0.3), 1.1),
            ),
        ]
    });
    &MAPS
}

/// Steps of a midpoint rule along half a texel: between texel centres and edges everything is smooth.
const STEPS: u32 = 6;

/// The centres of a grid over the map with their solid angles, in world space.
fn grid(environment: &Environment) -> impl Iterator<Item = (DVec2, DVec3, f64)> + '_ {
    let [width, height] = environment.background().size_px.map(|n| n * 2 * STEPS);
    let world_from_map = environment.map_from_world().transpose();
    (0..height).flat_map(move |y| {
        let (v, step) = (
            (f64::from(y) + 0.5) / f64::from(height),
            PI / f64::from(height),
        );
        let solid_angle = TAU / f64::from(width) * 2.0 * (PI * v).sin() * (0.5 * step).sin();
        (0..width).map(move |x| {
            let uv = DVec2::new((f64::from(x) + 0.5) / f64::from(width), v);
            (uv, world_from_map * environment_dir(uv), solid_angle)
        })
    })
}

#[test]
fn the_mean_of_radiance_over_density_is_the_integral() {
    for (name, environment) in maps() {
        let sampler = EnvironmentSampler::new(environment);
        // The radiance by itself, and times a kernel that is not the map's.
        let kernel = |d: DVec3| DVec3::new(1.0, (1.0 + d.x) * (2.0 - d.y), 1.0 + d.z * d.z);
        let mut expected = DVec3::ZERO;
        for (_, direction, solid_angle) in grid(environment) {
            expected += environment.radiance(direction) * kernel(direction) * solid_angle;
        }
        const SIDE: usize = 300;
        let mut mean = DVec3::ZERO;
        for u in jittered(SIDE, 2) {
            let (direction, pdf) = sampler.sample(u);
            mean += environment.radiance(direction) * kernel(direction) / pdf;
        }
        mean /= (SIDE * SIDE) as f64;
        let error = (mean / expected - DVec3::ONE).abs().max_element();
        println!("{name}: {mean} of {expected}, relative error {error:.1e}");
        // Error of the midpoint rule next to the poles, and on a map of two texels.
        assert!(error < 2e-3, "{name}");
    }
}

#[test]
fn the_density_follows_the_radiance() {
    for (name, environment) in maps() {
        let sampler = EnvironmentSampler::new(environment);
        let (mut low, mut high, mut whole) = (f64::INFINITY, 0.0_f64, 0.0);
        for (uv, direction, solid_angle) in grid(environment) {
            let radiance = environment.radiance(direction).element_sum();
            let pdf = sampler.pdf(direction);
            whole += pdf * solid_angle;
            assert_eq!(pdf > 0.0, radiance > 0.0, "{name} {uv}");
            if pdf > 0.0 {
                low = low.min(radiance / pdf);
                high = high.max(radiance / pdf);
            }
        }
        println!("{name}: density sums to {whole:.6}, radiance over it from {low:.4} to {high:.4}");
        assert!((whole - 1.0).abs() < 2e-3, "{name}: {whole}");
        // From a pole to the first texel the cosine goes as the angle's square from 0 to 1/4: a blend that ends at zero there has twice the slope of
        // the look-up. From there to the second texel it goes from 1/4 to 9/4: a blend that begins at zero has half of its slope. Elsewhere the two
        // are closer.
        assert!(high < 4.0 * low, "{name}: {low} {high}");
    }
}

#[test]
fn samples_are_spread_as_the_density_says() {
    const SAMPLES: usize = 200_000;
    const BINS: [usize; 2] = [48, 24];
    for (name, environment) in maps() {
        let sampler = EnvironmentSampler::new(environment);
        let bin = |uv: DVec2| {
            let x = ((uv.x * BINS[0] as f64) as usize).min(BINS[0] - 1);
            let y = ((uv.y * BINS[1] as f64) as usize).min(BINS[1] - 1);
            y * BINS[0] + x
        };
        let mut expected = vec![0.0; BINS[0] * BINS[1]];
        // Fine enough for bins that cut the grid's cells.
        const FINE: usize = 1152;
        let world_from_map = environment.map_from_world().transpose();
        for i in 0..FINE * FINE / 2 {
            let uv = DVec2::new((i % FINE) as f64 + 0.5, (i / FINE) as f64 + 0.5)
                / DVec2::new(FINE as f64, 0.5 * FINE as f64);
            let solid_angle = 4.0 * PI * PI / (FINE * FINE) as f64 * (PI * uv.y).sin();
            let pdf = sampler.pdf(world_from_map * environment_dir(uv));
            expected[bin(uv)] += SAMPLES as f64 * pdf * solid_angle;
        }
        let mut draw = Draw::new(3);
        let mut counts = vec![0.0; BINS[0] * BINS[1]];
        for _ in 0..SAMPLES {
            let (direction, pdf) = sampler.sample(draw.two());
            assert!((direction.length() - 1.0).abs() < 1e-12);
            let again = sampler.pdf(direction);
            // Rounding is relatively large where the blend goes to zero.
            assert!(
                (pdf - again).abs() < 1e-6 * pdf + 1e-9,
                "{name}: {pdf} {again}"
            );
            counts[bin(environment_uv(environment.map_from_world() * direction))] += 1.0;
        }
        let z = chi_square(&counts, &expected);
        println!("{name}: chi-square {z:.2}");
        assert!(z < 5.0, "{name}: {z}");
    }
}

#[test]
fn a_map_turned_the_wrong_way_would_be_noticed() {
    let (_, environment) = &maps()[1];
    let turned = environment.clone().with_up(DVec3::Y, 0.9);
    let sampler = EnvironmentSampler::new(environment);
    let (direction, _) = sampler.sample(DVec2::splat(0.5));
    assert!(environment.radiance(direction).x > 0.0);
    assert_eq!(turned.radiance(direction), DVec3::ZERO);
}

#[test]
fn a_black_map_is_sampled_evenly() {
    let sampler = EnvironmentSampler::new(&hairline_sky::uniform([0.0; 3]));
    let mut mean = DVec3::ZERO;
    for u in jittered(100, 4) {
        let (direction, pdf) = sampler.sample(u);
        assert!((pdf - 0.25 / PI).abs() < 1e-15 && direction.is_normalized());
        assert_eq!(sampler.pdf(direction), pdf);
        mean += direction * 1e-4;
    }
    assert!(mean.length() < 1e-3, "{mean}");
}

#[test]
fn no_nan_at_poles_seams_and_ends_of_the_random_numbers() {
    let last = 1.0 - f64::EPSILON / 2.0;
    for (name, environment) in maps() {
        let sampler = EnvironmentSampler::new(environment);
        for u in [(0.0, 0.0), (last, last), (0.0, last), (last, 0.0)] {
            let (direction, pdf) = sampler.sample(u.into());
            assert!(direction.is_normalized(), "{name} {direction}");
            // Also at the very edge of the lit part.
            assert!(pdf > 0.0 && pdf.is_finite(), "{name} {pdf}");
        }
        let world_from_map = environment.map_from_world().transpose();
        for direction in [DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z, DVec3::X] {
            let pdf = sampler.pdf((world_from_map * direction).normalize());
            assert!(pdf >= 0.0 && pdf.is_finite(), "{name} {pdf}");
        }
    }
}

/// Prints nanoseconds per call: `cargo test --release -p hairline-reference -- --ignored --nocapture environment_timings`.
#[test]
#[ignore = "prints figures"]
fn environment_timings() {
    let mut draw = Draw::new(5);
    let us: Vec<_> = (0..1024).map(|_| draw.two()).collect();
    let noise: Vec<f32> = (0..65536).map(|_| draw.one() as f32).collect();
    let environment = map([2048, 1024], |x, y| {
        [noise[(y as usize * 2048 + x as usize) % 65521]; 3]
    });
    let start = std::time::Instant::now();
    let sampler = EnvironmentSampler::new(&environment);
    println!("2048 x 1024 texels: made in {:?}", start.elapsed());
    const CALLS: usize = 1_000_000;
    let start = std::time::Instant::now();
    let mut sum = DVec3::ZERO;
    for i in 0..CALLS {
        sum += sampler.sample(us[i % us.len()]).0;
    }
    println!(
        "sample {:.0} ns",
        start.elapsed().as_nanos() as f64 / CALLS as f64
    );
    let directions: Vec<_> = us.iter().map(|u| sampler.sample(*u).0).collect();
    let start = std::time::Instant::now();
    for i in 0..CALLS {
        sum.x += sampler.pdf(directions[i % us.len()]);
    }
    println!(
        "pdf {:.0} ns",
        start.elapsed().as_nanos() as f64 / CALLS as f64
    );
    std::hint::black_box(sum);
}

//! The lobe of a pixel whose normals differ, against the mean of the sharp lobe over the normals.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use hairline_optics::environment_lobe::{ENVIRONMENT_TAPS, environment_lobe};
use hairline_optics::filtered_lobe::{
    FilteredLobe, SlopeSpread, filtered_lobe, filtered_lobe_around,
};
use hairline_optics::fresnel::{FresnelCurve, FresnelRgb};
use hairline_optics::ggx::{ggx_alpha, ggx_eval};
use hairline_optics::ltc::{
    LobeFresnel, LtcLobe, ltc_lobe, ltc_reflected, ltc_sphere_vector, ltc_vector, sphere_light,
};

/// A lobe over a pixel, and the sharp one.
type Blurred<'a> = (&'a FilteredLobe, &'a LtcLobe);

/// Light that a lobe reflects of a light, given its vector irradiance in the cosine space of a part.
fn light_of_parts(
    (filtered, sharp): Blurred,
    of: &LobeFresnel,
    vector: impl Fn(&LtcLobe) -> DVec3,
) -> f64 {
    let parts = filtered.parts(sharp);
    let far = filtered.far(vector(&parts[0].lobe));
    let reflected = parts
        .iter()
        .map(|part| part.weight(far) * ltc_reflected(&part.lobe, of, vector(&part.lobe))[0]);
    reflected.sum()
}

/// Light that a lobe reflects of a sphere.
fn sphere_of_parts(blurred: Blurred, of: &LobeFresnel, axis: DVec3, sin2: f64) -> f64 {
    light_of_parts(blurred, of, |lobe| ltc_sphere_vector(lobe, axis, sin2))
}

/// The density of slopes of GGX.
fn ggx_slopes(slope: DVec2, alphas: DVec2) -> f64 {
    let q = 1.0 + (slope / alphas).length_squared();
    1.0 / (PI * alphas.x * alphas.y * q * q)
}

/// Slopes that spread in the plane of view and normal and across it.
fn even(variance: DVec2) -> SlopeSpread {
    SlopeSpread {
        variance,
        covariance: 0.0,
    }
}

/// Slopes that spread at an angle to the plane of view and normal alone.
fn one_way(variance: f64, angle: f64) -> SlopeSpread {
    let axis = DVec2::from_angle(angle);
    SlopeSpread {
        variance: variance * axis * axis,
        covariance: variance * axis.x * axis.y,
    }
}

/// Mean of f over a disk of directions and radii of equal shares, `radius` being the inverse of the share within.
fn mean_over(radius: impl Fn(f64) -> f64, f: impl Fn(DVec2) -> f64) -> f64 {
    const RADII: usize = 400;
    const ANGLES: usize = 64;
    let mut sum = 0.0;
    for i in 0..RADII {
        let r = radius((i as f64 + 0.5) / RADII as f64);
        for k in 0..ANGLES {
            sum += f(r * DVec2::from_angle((k as f64 + 0.5) / ANGLES as f64 * TAU));
        }
    }
    sum / (RADII * ANGLES) as f64
}

/// GGX slopes of alpha 1 over normals of variance `t`, at a slope `m`: the average is over the narrower of the two.
fn blurred(m: f64, t: f64) -> f64 {
    let at = DVec2::new(m, 0.0);
    if t < 1.0 {
        mean_over(
            |share| (-2.0 * t * (1.0 - share).ln()).sqrt(),
            |s| ggx_slopes(at - s, DVec2::ONE),
        )
    } else {
        mean_over(
            |share| (share / (1.0 - share)).sqrt(),
            |s| (-(at - s).length_squared() / (2.0 * t)).exp() / (TAU * t),
        )
    }
}

#[test]
fn pixels_blur_the_core_and_not_the_tails() {
    for (t, most, most_of_one) in [
        (0.1, 0.03, 0.07),
        (1.0, 0.12, 0.22),
        (10.0, 0.20, 0.34),
        (100.0, 0.22, 0.39),
    ] {
        // Small angles, so that slopes are as if on a plane.
        let alpha = 0.002;
        let filtered = filtered_lobe_around(alpha, even(DVec2::splat(t * alpha * alpha)), 1.0);
        let narrow = filtered.alphas / alpha;
        let ours = |m: f64| {
            let [first, second] =
                [1.0, 2f64.sqrt()].map(|k| ggx_slopes(DVec2::new(m, 0.0), k * narrow));
            (1.0 + filtered.excess) * first - filtered.excess * second
        };
        let one = |m: f64| ggx_slopes(DVec2::new(m, 0.0), DVec2::splat((1.0 + 2.0 * t).sqrt()));
        let width = (1.0 + 2.0 * t).sqrt();
        let (mut error, mut error_of_one) = (0.0, 0.0);
        let step = 0.05 * width;
        for i in 0..120 {
            let m = (f64::from(i) + 0.5) * step;
            let exact = blurred(m, t);
            error += (ours(m) - exact).abs() * TAU * m * step;
            error_of_one += (one(m) - exact).abs() * TAU * m * step;
        }
        let tail = ours(1000.0 * width) / ggx_slopes(DVec2::new(1000.0 * width, 0.0), DVec2::ONE);
        println!(
            "variance {t} alpha^2: {error:.3} misplaced, {error_of_one:.3} by one GGX; far tail {tail:.3}"
        );
        assert!(error < most && error_of_one > 1.5 * error, "{t}: {error}");
        assert!(error_of_one < most_of_one, "{t}: {error_of_one}");
        assert!((tail - 1.0).abs() < 0.02, "{t}: {tail}");
    }
}

fn white() -> FresnelRgb<'static> {
    FresnelRgb {
        f0: [1.0; 3],
        f90: 1.0,
        curve: FresnelCurve::schlick(),
    }
}

/// Light that a pixel reflects of a lamp on which a facet of slope `m` mirrors the viewer, over what it reflects from all around. The lamp has the angular
/// radius `2 radius`.
fn lamp_at(m: DVec2, radius: f64, wo: DVec3, blurred: Blurred, of: &LobeFresnel) -> f64 {
    let half = m.extend(1.0).normalize();
    let axis = 2.0 * half.dot(wo) * half - wo;
    let sin2 = (2.0 * radius).sin().powi(2);
    sphere_of_parts(blurred, of, axis, sin2) / of.albedo[0]
}

/// The mean over all places of what a lobe reflects of a lamp, over what it reflects from all around: 1 if no light is lost. `scale` is about as wide as
/// the lobe, in slopes.
fn kept_light(blurred: Blurred, of: &LobeFresnel, wo: DVec3, scale: DVec2, radius: f64) -> f64 {
    const RINGS: i32 = 130;
    const TURNS: u32 = 32;
    // Each ring is further than the one before.
    const GROWTH: f64 = 1.08;
    let solid_angle = TAU * (1.0 - (2.0 * radius).cos());
    let (mut sum, mut ring) = (0.0, 0.02);
    for _ in 0..RINGS {
        let next = ring * GROWTH;
        let area = PI * (next * next - ring * ring) * scale.x * scale.y / f64::from(TURNS);
        for turn in 0..TURNS {
            let turn = TAU * (f64::from(turn) + 0.5) / f64::from(TURNS);
            let m = (ring * next).sqrt() * DVec2::from_angle(turn) * scale;
            let half = m.extend(1.0).normalize();
            // Solid angle of the directions that facets of these slopes reflect to.
            let around = 4.0 * area * half.dot(wo) * half.z.powi(3);
            sum += lamp_at(m, radius, wo, blurred, of) * around / solid_angle;
        }
        ring = next;
    }
    sum
}

#[test]
fn lamps_of_all_sizes_keep_their_light() {
    let alpha = 0.0021;
    for (along, across, correlation) in [
        (0.1, 0.1, 0.0),
        (1.0, 1.0, 0.0),
        (1.0, 0.1, 0.5),
        (10.0, 10.0, 0.0),
        (10.0, 1.0, -0.5),
        (100.0, 100.0, 0.0),
        (100.0, 10.0, 0.0),
        (10.0, 100.0, 0.0),
    ] {
        for angle_deg in [0.0f64, 50.0] {
            let variance = alpha * alpha * DVec2::new(along, across);
            let spread = SlopeSpread {
                variance,
                covariance: correlation * (variance.x * variance.y).sqrt(),
            };
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            let wo = DVec3::new(sin, 0.0, cos);
            let sharp = ltc_lobe(wo, alpha.sqrt());
            let of = LobeFresnel::new(white(), wo, alpha.sqrt());
            let filtered = filtered_lobe(alpha, spread, cos);
            let scale = (DVec2::splat(alpha * alpha) + variance).map(f64::sqrt);
            for size in [1e-3, 1.0, 2.0, 4.0] {
                let kept = kept_light((&filtered, &sharp), &of, wo, scale, size * scale.y);
                println!(
                    "variances {along} and {across} alpha^2, {angle_deg} degrees, radius {size}: {kept:.3}"
                );
                assert!((kept - 1.0).abs() < 0.02, "{along} {across} {size}: {kept}");
            }
        }
    }
}

#[test]
fn lamps_as_wide_as_the_lobe_are_right() {
    let alpha = 0.0021;
    for t in [0.3f64, 1.0, 10.0, 100.0] {
        let spread = even(DVec2::splat(t * alpha * alpha));
        let sharp = ltc_lobe(DVec3::Z, alpha.sqrt());
        let of = LobeFresnel::new(white(), DVec3::Z, alpha.sqrt());
        let filtered = filtered_lobe(alpha, spread, 1.0);
        let width = (1.0 + t).sqrt();
        let step = 0.02 * width;
        let mut exact = 0.0;
        for i in 0..200 {
            let m = (f64::from(i) + 0.5) * step;
            exact += blurred(m, t) * TAU * m * step;
            if i % 25 == 24 {
                let radius = f64::from(i + 1) * step;
                let ours = lamp_at(
                    DVec2::ZERO,
                    radius * alpha,
                    DVec3::Z,
                    (&filtered, &sharp),
                    &of,
                );
                println!("variance {t} alpha^2, radius {radius:.2} alpha: {ours:.3}, {exact:.3}");
                assert!((ours - exact).abs() < 0.05, "{t} {radius}: {ours} {exact}");
            }
        }
    }
}

/// The mean over normals that differ one way of what the sharp lobe reflects of a lamp.
fn lamp_over_normals(to_lamp: DVec3, radius: f64, wo: DVec3, roughness: f64, std: DVec2) -> f64 {
    const STEPS: i32 = 400;
    let (mut sum, mut weights) = (0.0, 0.0);
    for i in -STEPS..=STEPS {
        let t = 4.0 * f64::from(i) / f64::from(STEPS);
        let weight = (-0.5 * t * t).exp();
        let normal = (t * std).extend(1.0).normalize();
        let (x, y) = normal.any_orthonormal_pair();
        let [wo, to_lamp] = [wo, to_lamp].map(|w| DVec3::new(w.dot(x), w.dot(y), w.dot(normal)));
        let sin2 = radius.sin().powi(2);
        sum += weight * sphere_light(wo, roughness, white(), to_lamp, sin2)[0];
        weights += weight;
    }
    sum / weights
}

/// The rim of a can: normals that differ one way by twenty alphas, and a lamp that is many alphas wide. Beside the rim's highlight the lamp was reflected
/// with up to twice its radiance.
#[test]
fn wide_lamps_beside_a_thin_spread_stay_dark() {
    const ROUGHNESS: f64 = 0.08;
    const RADIUS_RAD: f64 = 0.138;
    let (sin, cos) = 34f64.to_radians().sin_cos();
    let wo = DVec3::new(sin, 0.0, cos);
    let sharp = ltc_lobe(wo, ROUGHNESS);
    let of = LobeFresnel::new(white(), wo, ROUGHNESS);
    for angle in [0.0, 1.0, 1.57, 2.2] {
        let std = 0.13 * DVec2::from_angle(angle);
        let filtered = filtered_lobe(sharp.alpha, one_way(0.13 * 0.13, angle), cos);
        for beside in [0.0, 0.03, 0.06, 0.075, 0.085, 0.095] {
            for along in [-0.1, -0.05, -0.02, 0.0, 0.02, 0.05, 0.1] {
                let m = DVec2::from_angle(angle).rotate(DVec2::new(along, beside));
                let half = m.extend(1.0).normalize();
                let to_lamp = 2.0 * half.dot(wo) * half - wo;
                let sin2 = RADIUS_RAD.sin().powi(2);
                let ours = sphere_of_parts((&filtered, &sharp), &of, to_lamp, sin2);
                let exact = lamp_over_normals(to_lamp, RADIUS_RAD, wo, ROUGHNESS, std);
                assert!(
                    (ours - exact).abs() < 0.08,
                    "{angle} {beside} {along}: {ours} {exact}"
                );
            }
        }
    }
}

#[test]
fn curved_surfaces_keep_their_energy() {
    for roughness in [0.02, 0.1, 0.3, 0.6, 1.0] {
        for angle_deg in [0.0f64, 40.0, 80.0] {
            for spread in [
                even(DVec2::new(1e-5, 1e-3)),
                even(DVec2::splat(0.01)),
                even(DVec2::new(0.1, 0.02)),
                one_way(0.01, 0.8),
            ] {
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                let wo = DVec3::new(sin, 0.0, cos);
                let sharp = ltc_lobe(wo, roughness);
                let of = LobeFresnel::new(white(), wo, roughness);
                let filtered = filtered_lobe(ggx_alpha(roughness), spread, cos);
                // A sphere around the point, and one that leaves a hundredth of a degree at the horizon.
                for sin2 in [1.0, 0.999_999_97] {
                    let reflected = sphere_of_parts((&filtered, &sharp), &of, DVec3::Z, sin2);
                    let error = reflected / of.albedo[0] - 1.0;
                    assert!(
                        error.abs() < 0.01,
                        "{roughness} {angle_deg} {spread:?}: {error}"
                    );
                }
            }
        }
    }
}

/// GGX slopes of alpha 1 over normals of variance `t` along x alone.
fn blurred_along_x(m: DVec2, t: f64) -> f64 {
    const STEPS: usize = 2000;
    let reach = 5.0 * t.sqrt();
    let step = 2.0 * reach / STEPS as f64;
    (0..STEPS)
        .map(|i| (i as f64 + 0.5) * step - reach)
        .map(|s| {
            let weight = (-s * s / (2.0 * t)).exp() / (TAU * t).sqrt();
            weight * step * ggx_slopes(m - DVec2::new(s, 0.0), DVec2::ONE)
        })
        .sum()
}

#[test]
fn pixels_blur_the_way_that_they_bend() {
    let alpha = 0.002;
    for (t, most) in [(1.0, 0.24), (10.0, 0.34), (100.0, 0.35)] {
        for angle in [0.0, 0.6, 1.2, 2.2] {
            let axis = DVec2::from_angle(angle);
            let filtered = filtered_lobe_around(alpha, one_way(t * alpha * alpha, angle), 1.0);
            let narrow = filtered.alphas / alpha;
            // At m, x being the way of the spread.
            let ours = |m: DVec2| {
                let m = axis.rotate(m);
                let m = DVec2::new(m.x, m.y - filtered.shear * narrow.y * m.x / narrow.x);
                let [first, second] = [1.0, 2f64.sqrt()].map(|k| ggx_slopes(m, k * narrow));
                (1.0 + filtered.excess) * first - filtered.excess * second
            };
            let width = DVec2::new((1.0 + 2.0 * t).sqrt(), 1.0);
            let step = 0.1 * width;
            let mut error = 0.0;
            for i in 0..80 {
                for k in 0..80 {
                    let m = (DVec2::new(f64::from(i), f64::from(k)) - 39.5) * step;
                    error += (ours(m) - blurred_along_x(m, t)).abs() * step.x * step.y;
                }
            }
            println!("variance {t} alpha^2 along {angle}: {error:.3} misplaced");
            assert!(error < most, "{t} {angle}: {error}");
        }
    }
}

#[test]
fn look_ups_lie_along_the_spread() {
    let roughness = 0.06;
    for angle_deg in [0.0f64, 40.0, 60.0] {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let sharp = ltc_lobe(DVec3::new(sin, 0.0, cos), roughness);
        for angle in [0.4, 1.5, 2.5] {
            let filtered = filtered_lobe_around(sharp.alpha, one_way(0.002, angle), cos);
            let lobe = filtered.parts(&sharp)[0].lobe;
            let looked_up = environment_lobe(&lobe);
            // Slopes of half vectors over their mean: in the plane, towards the viewer, and across it.
            let slopes: Vec<DVec2> = (0..ENVIRONMENT_TAPS)
                .map(|i| looked_up.environment_tap(i).direction)
                .map(|wi| wi + lobe.wo)
                .map(|h| DVec2::new(h.x, h.y) / h.z)
                .collect();
            let longest = slopes[1..]
                .iter()
                .map(|slope| *slope - slopes[0])
                .max_by(|a, b| a.length().total_cmp(&b.length()))
                .unwrap_or_default();
            let across = longest.perp_dot(DVec2::from_angle(angle)) / longest.length();
            assert!(across.abs() < 0.15, "{angle_deg} {angle}: {slopes:?}");
            assert!(longest.length() > 0.05, "{angle_deg} {angle}: {slopes:?}");
        }
    }
}

#[test]
fn tubes_keep_their_light() {
    for variance in [1e-4, 1e-3, 1e-2] {
        for (angle_deg, angle) in [(20.0f64, 1.57), (50.0, 1.57), (50.0, 0.8), (70.0, 0.8)] {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            let wo = DVec3::new(sin, 0.0, cos);
            let sharp = ltc_lobe(wo, 0.06);
            let of = LobeFresnel::new(white(), wo, 0.06);
            let filtered = filtered_lobe(sharp.alpha, one_way(variance, angle), cos);
            // Light from a tube across the plane of view and normal, summed over its places.
            let sum = |filtered: &FilteredLobe| -> f64 {
                let at = |x: f64, y: f64| {
                    DVec3::new(-sin, 0.0, cos) + x * DVec3::new(cos, 0.0, sin) + y * DVec3::Y
                };
                let tube = |x: f64| {
                    [(-0.01, -1.0), (0.01, -1.0), (0.01, 1.0), (-0.01, 1.0)]
                        .map(|(dx, y)| at(x + dx, y))
                };
                let reflected = |vertices: [DVec3; 4]| {
                    light_of_parts((filtered, &sharp), &of, |lobe| ltc_vector(lobe, &vertices))
                };
                (-200..=200)
                    .map(|i| reflected(tube(f64::from(i) * 0.01)))
                    .sum()
            };
            let kept =
                sum(&filtered) / sum(&filtered_lobe(sharp.alpha, SlopeSpread::default(), cos));
            println!("{angle_deg} degrees, variance {variance} at {angle}: {kept:.3}");
            assert!((kept - 1.0).abs() < 0.08, "{angle_deg} {angle}: {kept}");
        }
    }
}

/// GGX towards a direction, averaged over normals whose slopes spread.
fn mean_of_normals(wo: DVec3, alpha: f64, spread: SlopeSpread, wi: DVec3) -> f64 {
    const STEPS: i32 = 32;
    let x = spread.variance.x.sqrt();
    let shared = spread.covariance / x;
    let y = (spread.variance.y - shared * shared).max(0.0).sqrt();
    let (mut sum, mut weights) = (0.0, 0.0);
    for i in 0..STEPS * STEPS {
        let [a, b] = [i % STEPS, i / STEPS].map(|k| (f64::from(k) + 0.5) * 8.0 / 32.0 - 4.0);
        let weight = (-0.5 * (a * a + b * b)).exp();
        let normal = DVec3::new(x * a, shared * a + y * b, 1.0).normalize();
        let axis_x = (DVec3::X - normal * normal.x).normalize();
        let axes = glam::DMat3::from_cols(axis_x, normal.cross(axis_x), normal).transpose();
        sum += weight * ggx_eval(axes * wi, axes * wo, alpha);
        weights += weight;
    }
    sum / weights
}

#[test]
fn small_lamps_have_the_tails_of_a_sharp_lobe() {
    let roughness = 0.055;
    let alpha = ggx_alpha(roughness);
    // Errors of the lobes in use, and of the difference of two alone.
    let mut worst = [1.0f64; 2];
    // Of the lobes in use, from ten alphas on; of the sharp one alone, whose tails a blur lifts.
    let mut off_in_tails = [0.0f64; 2];
    for (t, across, correlation) in [
        (0.3, 1.0, 0.0),
        (0.3, 0.2, 0.8),
        (1.0, 0.2, 0.0),
        (3.0, 0.2, 0.0),
        (3.0, 0.5, -0.8),
    ] {
        let variance = t * alpha * alpha * DVec2::new(1.0, across);
        let spread = SlopeSpread {
            variance,
            covariance: correlation * (variance.x * variance.y).sqrt(),
        };
        for angle_deg in [0.0f64, 50.0] {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            let wo = DVec3::new(sin, 0.0, cos);
            let sharp = ltc_lobe(wo, roughness);
            let of = LobeFresnel::new(white(), wo, roughness);
            let filtered = filtered_lobe(alpha, spread, cos);
            for k in [0.0, 2.0, 5.0, 10.0, 20.0] {
                for turn in [0.0f64, 0.8, 1.57, 2.4] {
                    let tilt: f64 = k * alpha;
                    let half = (DVec2::from_angle(turn) * tilt.sin()).extend(tilt.cos());
                    let wi = half * (2.0 * half.dot(wo)) - wo;
                    let sin2 = 1e-8;
                    let exact = mean_of_normals(wo, alpha, spread, wi) * PI * sin2;
                    let ours = sphere_of_parts((&filtered, &sharp), &of, wi, sin2);
                    let by_two: f64 = filtered.parts(&sharp)[..2]
                        .iter()
                        .map(|part| {
                            let vector = ltc_sphere_vector(&part.lobe, wi, sin2);
                            part.core * ltc_reflected(&part.lobe, &of, vector)[0]
                        })
                        .sum();
                    for (worst, value) in worst.iter_mut().zip([ours, by_two]) {
                        let ratio = value / exact;
                        *worst = worst.max(ratio).max(1.0 / ratio.max(1e-3));
                    }
                    if k >= 10.0 {
                        let sharp =
                            ltc_reflected(&sharp, &of, ltc_sphere_vector(&sharp, wi, sin2))[0];
                        for (off, value) in off_in_tails.iter_mut().zip([ours, sharp]) {
                            *off = off.max((value / exact - 1.0).abs());
                        }
                    }
                }
            }
        }
    }
    println!(
        "off by a factor of {:.2}, by two lobes {:.2}",
        worst[0], worst[1]
    );
    println!("from ten alphas on: {off_in_tails:?}");
    assert!(off_in_tails[0] < 0.16, "{off_in_tails:?}");
    assert!(off_in_tails[1] > 0.3, "{off_in_tails:?}");
    assert!(worst[0] < 2.0, "{worst:?}");
    assert!(worst[1] > 4.0, "{worst:?}");
}

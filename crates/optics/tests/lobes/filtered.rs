//! The lobe of a pixel whose normals differ, against the mean of the sharp lobe over the normals.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use hairline_optics::environment_lobe::{ENVIRONMENT_TAPS, environment_lobe};
use hairline_optics::filtered_lobe::{SlopeSpread, filtered_lobe};
use hairline_optics::ggx::ggx_alpha;
use hairline_optics::ltc::{
    LobeFresnel, LtcLobe, ltc_begin, ltc_edge, ltc_end, ltc_lobe, ltc_sphere,
};

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

/// GGX slopes of alpha 1 over normals of variance `t`, at a slope `m`: the narrower of the two is what is averaged over.
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
        let filtered = filtered_lobe(alpha, even(DVec2::splat(t * alpha * alpha)), 1.0);
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

#[test]
fn curved_surfaces_keep_their_energy() {
    let white = hairline_optics::fresnel::FresnelRgb {
        f0: [1.0; 3],
        curve: hairline_optics::fresnel::FresnelCurve::schlick(),
    };
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
                let of = LobeFresnel::new(white, wo, roughness);
                let filtered = filtered_lobe(ggx_alpha(roughness), spread, cos);
                // A sphere around the point, and one that leaves a hundredth of a degree at the horizon.
                for sin2 in [1.0, 0.999_999_97] {
                    let reflected: f64 = filtered
                        .parts(&sharp)
                        .iter()
                        .map(|(weight, lobe)| weight * ltc_sphere(lobe, &of, DVec3::Z, sin2)[0])
                        .sum();
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
            let filtered = filtered_lobe(alpha, one_way(t * alpha * alpha, angle), 1.0);
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
            let filtered = filtered_lobe(sharp.alpha, one_way(0.002, angle), cos);
            let [(_, lobe), _] = filtered.parts(&sharp);
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
    let white = hairline_optics::fresnel::FresnelRgb {
        f0: [1.0; 3],
        curve: hairline_optics::fresnel::FresnelCurve::schlick(),
    };
    for (variance, most_off) in [(1e-4, 0.02), (1e-3, 0.2), (1e-2, 0.4)] {
        for (angle_deg, angle) in [(20.0f64, 1.57), (50.0, 1.57), (50.0, 0.8), (70.0, 0.8)] {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            let wo = DVec3::new(sin, 0.0, cos);
            let sharp = ltc_lobe(wo, 0.06);
            let of = LobeFresnel::new(white, wo, 0.06);
            let filtered = filtered_lobe(sharp.alpha, one_way(variance, angle), cos);
            // Light from a tube across the plane of view and normal, summed over its places.
            let sum = |parts: &[(f64, LtcLobe)]| -> f64 {
                let at = |x: f64, y: f64| {
                    DVec3::new(-sin, 0.0, cos) + x * DVec3::new(cos, 0.0, sin) + y * DVec3::Y
                };
                let tube = |x: f64| {
                    [(-0.01, -1.0), (0.01, -1.0), (0.01, 1.0), (-0.01, 1.0)]
                        .map(|(dx, y)| at(x + dx, y))
                };
                let reflected = |lobe: &LtcLobe, vertices: [DVec3; 4]| {
                    let mut state = ltc_begin();
                    for k in 0..4 {
                        ltc_edge(&mut state, lobe, vertices[k], vertices[(k + 1) % 4]);
                    }
                    ltc_end(&state, lobe, &of)[0]
                };
                (-200..=200)
                    .map(|i| tube(f64::from(i) * 0.01))
                    .flat_map(|tube| parts.iter().map(move |(w, l)| w * reflected(l, tube)))
                    .sum()
            };
            let kept = sum(&filtered.parts(&sharp)) / sum(&[(1.0, sharp)]);
            println!("{angle_deg} degrees, variance {variance} at {angle}: {kept:.3}");
            assert!((kept - 1.0).abs() < most_off, "{angle_deg} {angle}: {kept}");
        }
    }
}

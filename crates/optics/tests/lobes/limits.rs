//! Properties of the lobes and the light integrals for any input: furnace, energy, reciprocity, horizon, degenerate
//! input.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::{DVec2, DVec3};
use hairline_optics::fresnel::{FresnelCurve, FresnelRgb};
use hairline_optics::ggx::{
    ggx_albedo, ggx_alpha, ggx_d, ggx_eval, ggx_g1, ggx_multiple_scattering, ggx_pdf, ggx_sample,
};
use hairline_optics::irradiance::{lambert_polygon, lambert_sphere};
use hairline_optics::lobe_table::albedo_lookup;
use hairline_optics::ltc::{ltc_lobe, polygon_light, sphere_light};
use hairline_published::sptd::{
    SphericalCap, sptd_cap_intersection, sptd_lobe, sptd_sphere_published, sptd_transform_cap,
};

use super::cubature::{Cap, Peak, integrate, integrate_polygon};

const FLAT: Peak = Peak {
    direction: DVec3::Z,
    width_rad: 0.5,
};
const HEMISPHERE: Cap = Cap {
    axis: DVec3::Z,
    radius_rad: 0.5 * PI,
};

fn viewer(angle_deg: f64, turn_deg: f64) -> DVec3 {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let (sin_t, cos_t) = turn_deg.to_radians().sin_cos();
    DVec3::new(sin * cos_t, sin * sin_t, cos)
}

/// Low-discrepancy points (R2 sequence), as good as random ones and the same everywhere.
fn points(count: usize) -> impl Iterator<Item = [f64; 6]> {
    // The generalised golden ratio of six dimensions: x^7 = x + 1.
    const PHI: f64 = 1.112_775_684_278_705_6;
    (1..=count).map(|i| std::array::from_fn(|k| (0.5 + i as f64 / PHI.powi(k as i32 + 1)).fract()))
}

/// Functions that change much over the angle, and 1.
fn term_values(cos_h: f64) -> [f64; 3] {
    let m = 1.0 - cos_h;
    [1.0, m.powi(5), cos_h * m.powi(6)]
}

/// Reflectances of these values, a channel each.
fn terms() -> FresnelRgb<'static> {
    static CURVE: LazyLock<FresnelCurve> = LazyLock::new(|| FresnelCurve::new(term_values));
    FresnelRgb {
        f0: [0.0; 3],
        f90: 1.0,
        curve: &CURVE,
    }
}

/// (roughness, viewer) off the nodes of the tables, up to 89 degrees.
fn surfaces(count: usize) -> impl Iterator<Item = (f64, DVec3)> {
    points(count).map(|p| (p[0], viewer(89.0 * p[1], 360.0 * p[2])))
}

#[test]
fn a_light_all_around_returns_the_albedo() {
    let mut worst = [0.0_f64; 4];
    for (roughness, wo) in surfaces(400) {
        let exact = ggx_albedo(wo.z, ggx_alpha(roughness), 256);
        let wide = 1e5;
        let ceiling = [(wide, wide), (-wide, wide), (-wide, -wide), (wide, -wide)]
            .map(|(x, y)| DVec3::new(x, y, 1.0));
        let values = [
            polygon_light(wo, roughness, terms(), &ceiling)[0],
            sphere_light(wo, roughness, terms(), DVec3::Z, 1.0 - 1e-9)[0],
            sphere_light(wo, roughness, terms(), DVec3::X, 1.0)[0],
            sptd_sphere_published(&sptd_lobe(wo, roughness), DVec3::Z, 1.0 - 1e-9),
        ];
        for (worst, value) in worst.iter_mut().zip(values) {
            *worst = worst.max((value / exact - 1.0).abs());
        }
    }
    println!(
        "relative error of the furnace: polygon {:.4}, sphere {:.4}, inside {:.4}, pivot {:.4}",
        worst[0], worst[1], worst[2], worst[3]
    );
    for (w, tolerance) in worst.into_iter().zip([0.01, 0.01, 0.01, 0.01]) {
        assert!(w < tolerance, "{w}");
    }
}

#[test]
fn compensated_ggx_reflects_everything() {
    // Sampled GGX, times the factor made from the table, against 1: a lossless metal in a furnace.
    let (mut worst, mut lossiest) = (0.0_f64, 1.0_f64);
    for (roughness, wo) in surfaces(200) {
        let alpha = ggx_alpha(roughness);
        let count = 4096;
        let single: f64 = points(count)
            .map(|p| {
                let wi = ggx_sample(wo, alpha, DVec2::new(p[3], p[4]));
                let pdf = ggx_pdf(wi, wo, alpha);
                if pdf > 0.0 {
                    ggx_eval(wi, wo, alpha) / pdf
                } else {
                    0.0
                }
            })
            .sum::<f64>()
            / count as f64;
        let e0 = albedo_lookup(roughness, wo.z);
        let compensated = single * ggx_multiple_scattering(1.0, e0);
        worst = worst.max((compensated - 1.0).abs());
        lossiest = lossiest.min(single);
    }
    println!(
        "compensated albedo within {worst:.4} of 1; without compensation down to {lossiest:.3}"
    );
    assert!(worst < 0.01, "{worst}");
    // Single scattering of a partly absorbing metal grows by less.
    assert!(ggx_multiple_scattering(0.5, 0.5) == 1.5);
}

#[test]
fn albedo_table_matches_quadrature_over_directions() {
    let mut worst = [0.0_f64; 3];
    for (roughness, wo) in surfaces(60) {
        let alpha = ggx_alpha(roughness);
        let peak = Peak {
            direction: DVec3::new(-wo.x, -wo.y, wo.z),
            width_rad: 0.5 * alpha * wo.z.max(0.05),
        };
        let cos_h = |wi: DVec3| wo.dot((wi + wo).normalize());
        let exact = [
            integrate(HEMISPHERE, peak, &|wi| ggx_eval(wi, wo, alpha)),
            integrate(HEMISPHERE, peak, &|wi| {
                ggx_eval(wi, wo, alpha) * (1.0 - cos_h(wi)).powi(5)
            }),
            integrate(HEMISPHERE, peak, &|wi| {
                ggx_eval(wi, wo, alpha) * cos_h(wi) * (1.0 - cos_h(wi)).powi(6)
            }),
        ];
        let table = terms().albedo(roughness, wo.z);
        for k in 0..3 {
            worst[k] = worst[k].max((table[k] - exact[k]).abs());
        }
    }
    println!(
        "albedo table: largest absolute errors E0 {:.4}, E1 {:.4}, E2 {:.5}",
        worst[0], worst[1], worst[2]
    );
    assert!(
        worst[0] < 0.006 && worst[1] < 0.006 && worst[2] < 0.001,
        "{worst:?}"
    );
}

#[test]
fn ggx_is_normalised_reciprocal_and_bounded() {
    for (roughness, wo) in surfaces(40) {
        let alpha = ggx_alpha(roughness);
        let narrow = Peak {
            direction: DVec3::Z,
            width_rad: 0.5 * alpha,
        };
        let normals = integrate(HEMISPHERE, narrow, &|h| ggx_d(h, alpha) * h.z);
        assert!((normals - 1.0).abs() < 1e-3, "{roughness}: {normals}");
        let visible = integrate(HEMISPHERE, narrow, &|h| {
            ggx_d(h, alpha) * ggx_g1(wo.z, alpha) * wo.dot(h).max(0.0)
        });
        assert!(
            (visible / wo.z - 1.0).abs() < 2e-3,
            "{roughness} {wo}: {visible}"
        );
        let e = ggx_albedo(wo.z, alpha, 128);
        assert!((0.0..=1.0 + 1e-9).contains(&e), "{e}");
        for p in points(50) {
            let wi = viewer(90.0 * p[3], 360.0 * p[4]);
            let forth = ggx_eval(wi, wo, alpha) * wo.z;
            let back = ggx_eval(wo, wi, alpha) * wi.z;
            assert!((forth - back).abs() <= 1e-9 * forth.abs().max(1e-12));
        }
    }
}

#[test]
fn sampled_directions_follow_the_pdf() {
    // The mean of an arbitrary smooth function under the samples, against its integral over the density.
    for (roughness, angle_deg) in [(0.1, 30.0), (0.4, 70.0), (1.0, 10.0), (0.7, 85.0)] {
        let (wo, alpha) = (viewer(angle_deg, 200.0), ggx_alpha(roughness));
        let test = |w: DVec3| w.z * (1.3 + w.x * w.x + 0.4 * w.y);
        let count = 20_000;
        let sampled = points(count)
            .map(|p| ggx_sample(wo, alpha, DVec2::new(p[0], p[1])))
            .filter(|wi| wi.z > 0.0)
            .map(test)
            .sum::<f64>()
            / count as f64;
        let peak = Peak {
            direction: DVec3::new(-wo.x, -wo.y, wo.z),
            width_rad: 0.5 * alpha * wo.z.max(0.1),
        };
        let exact = integrate(HEMISPHERE, peak, &|wi| ggx_pdf(wi, wo, alpha) * test(wi));
        // The sequence errs by about log(n)/n times the integrand's variation.
        assert!(
            (sampled - exact).abs() < 2e-3,
            "{roughness} {angle_deg}: {sampled} {exact}"
        );
    }
}

/// A polygon in a random plane at distance 1: stars, so most are not convex.
fn star(p: [f64; 6], corners: usize) -> Vec<DVec3> {
    let z = 1.0 - 2.0 * p[0];
    let (sin, cos) = (2.0 * PI * p[1]).sin_cos();
    let r = (1.0_f64 - z * z).sqrt();
    let centre = DVec3::new(r * cos, r * sin, z);
    let (x, y) = centre.any_orthonormal_pair();
    let tilt = 1.5 * (p[2] - 0.5);
    let size = 3.0 * p[3] * p[3] + 0.01;
    (0..corners)
        .map(|i| {
            let (s, c) = (2.0 * PI * i as f64 / corners as f64 + p[4]).sin_cos();
            let radius = size * if i % 2 == 0 { 1.0 } else { 0.2 + 0.7 * p[5] };
            centre + radius * (c * (x + tilt * centre) + s * y)
        })
        .collect()
}

#[test]
fn lambert_polygons_match_cubature() {
    let mut worst = 0.0_f64;
    for (i, p) in points(600).enumerate() {
        let mut polygon = star(p, 4 + 2 * (i % 4));
        let exact = integrate_polygon(&polygon, FLAT, &|w| w.z / PI).abs();
        let value = lambert_polygon(&polygon);
        polygon.reverse();
        let reversed = lambert_polygon(&polygon);
        assert!((value - reversed).abs() < 1e-12);
        worst = worst.max((value - exact).abs() / exact.max(0.01));
    }
    // The remaining error is that of the cubature at the horizon's kink.
    println!("Lambert polygons: largest error {worst:.2e} (relative, above a form factor of 0.01)");
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn lambert_spheres_match_cubature_and_the_closed_form() {
    let mut worst = 0.0_f64;
    for p in points(300) {
        let axis = viewer(160.0 * p[0], 360.0 * p[1]);
        let radius_rad = 1.5 * p[2] + 1e-3;
        let value = lambert_sphere(axis, radius_rad.sin().powi(2));
        let exact = integrate(Cap { axis, radius_rad }, FLAT, &|w| w.z / PI);
        worst = worst.max((value - exact).abs() / exact.max(0.01));
        if axis.z > radius_rad.sin() {
            assert!((value / (radius_rad.sin().powi(2) * axis.z) - 1.0).abs() < 1e-12);
        }
    }
    println!("Lambert spheres: largest error {worst:.2e}");
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn spheres_and_fine_polygons_agree() {
    // The same light through two integrals: an elliptic cone cut by the horizon, and 720 edges.
    let mut worst = 0.0_f64;
    for ((roughness, wo), p) in surfaces(400).zip(points(400)) {
        let axis = viewer(100.0 * p[4], 360.0 * p[5]);
        let radius_rad = 1.2 * p[3] * p[3] + 1e-3;
        let (x, y) = axis.any_orthonormal_pair();
        let rim: Vec<DVec3> = (0..720)
            .map(|i| {
                let (s, c) = (2.0 * PI * f64::from(i) / 720.0).sin_cos();
                axis + radius_rad.tan() * (c * x + s * y)
            })
            .collect();
        let sphere = sphere_light(wo, roughness, terms(), axis, radius_rad.sin().powi(2));
        let polygon = polygon_light(wo, roughness, terms(), &rim);
        for k in 0..3 {
            worst = worst.max((sphere[k] - polygon[k]).abs() / polygon[0].max(0.01));
        }
    }
    // Small polygons are off by the square of their size in the lobe, see SMALL_PERIMETER.
    println!("sphere against 720-gon: largest difference {worst:.2e}");
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn small_lights_are_ggx_times_solid_angle() {
    for (roughness, wo) in surfaces(300) {
        let alpha = ggx_alpha(roughness);
        let axis = DVec3::new(-wo.x, -wo.y, wo.z + 0.5 * alpha).normalize();
        for radius_rad in [1e-3, 1e-5, 1e-8] {
            let radius_rad = radius_rad * alpha * wo.z;
            let cos_h = axis.dot((axis + wo).normalize());
            let exact = ggx_eval(axis, wo, alpha) * PI * radius_rad * radius_rad;
            let sphere = sphere_light(wo, roughness, terms(), axis, radius_rad * radius_rad);
            let (x, y) = axis.any_orthonormal_pair();
            let side = radius_rad * PI.sqrt() / 2.0;
            let square = [(-side, -side), (side, -side), (side, side), (-side, side)]
                .map(|(u, v)| axis + u * x + v * y);
            let polygon = polygon_light(wo, roughness, terms(), &square);
            for value in [sphere, polygon] {
                assert!(
                    (value[0] / exact - 1.0).abs() < 1e-3,
                    "{roughness} {wo}: {value:?} {exact}"
                );
                // The Fresnel that the light really uses, and not the lobe's average.
                for (part, weight) in value.into_iter().zip(term_values(cos_h)) {
                    assert!(
                        (part / value[0] - weight).abs() < 1e-3,
                        "{roughness} {wo}: {value:?} {cos_h}"
                    );
                }
            }
        }
    }
}

#[test]
fn growing_lights_show_no_seam() {
    // Lights from a point to the hemisphere in steps of 1 %: the flux grows, and its rate of growth changes slowly.
    // Beyond 80 degrees GGX rises so steeply at the horizon that a point of the correction's ring shows as a bend.
    for (roughness, wo) in surfaces(150).filter(|s| s.1.z > 0.17) {
        let axis = DVec3::new(-wo.x, -wo.y, wo.z);
        let (mut last, mut last_growth) = (0.0, 1.0201);
        let mut radius_rad = 1e-4_f64;
        while radius_rad < 1.5 {
            let value = sphere_light(wo, roughness, terms(), axis, radius_rad.sin().powi(2))[0];
            if last > 0.0 {
                let growth = value / last;
                let change = growth - last_growth;
                assert!(
                    growth > 0.998 && change.abs() < 0.01,
                    "{roughness} {wo} {radius_rad}: {growth} {change}"
                );
                last_growth = growth;
            }
            last = value;
            radius_rad *= 1.01;
        }
    }
}

#[test]
fn setting_lights_fade_to_nothing() {
    for (roughness, wo) in surfaces(100) {
        for sin2 in [1e-10, 1e-4, 0.04_f64] {
            let under = DVec3::new(-1.0, 0.3, -1.1 * 1.05 * sin2.sqrt()).normalize();
            assert_eq!(sphere_light(wo, roughness, terms(), under, sin2), [0.0; 3]);
            assert_eq!(lambert_sphere(under, sin2), 0.0);
        }
        let floor = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
            .map(|(x, y)| DVec3::new(x, y, -0.1));
        assert!(polygon_light(wo, roughness, terms(), &floor)[0] < 1e-12);
        assert!(lambert_polygon(&floor) < 1e-12);
    }
}

#[test]
fn awkward_input_gives_finite_light() {
    let directions = [
        DVec3::Z,
        -DVec3::Z,
        DVec3::X,
        -DVec3::Y,
        DVec3::ZERO,
        viewer(89.9999, 10.0),
        viewer(90.0001, 10.0),
        viewer(150.0, 10.0),
        DVec3::new(1e-12, 0.0, 1.0),
    ];
    let square = |scale: f64, z: f64| -> Vec<DVec3> {
        [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
            .map(|(x, y)| scale * DVec3::new(x, y, z))
            .to_vec()
    };
    let polygons = [
        square(1.0, 1.0),
        square(1.0, 0.0),
        square(1.0, -1.0),
        square(1e-12, 1.0),
        square(1e6, 1e-9),
        vec![DVec3::ZERO; 4],
        vec![DVec3::X; 3],
        vec![DVec3::X, -DVec3::X, DVec3::Z],
        vec![DVec3::ZERO, DVec3::X, DVec3::Z],
        vec![],
        vec![DVec3::Z],
    ];
    for wo in directions {
        for roughness in [0.0, 1e-3, 0.3, 1.0, 2.0, -1.0, f64::NAN] {
            let check =
                |value: f64| assert!((0.0..=1.01).contains(&value), "{wo} {roughness}: {value}");
            for axis in directions {
                for sin2 in [-1.0, 0.0, 1e-30, 1e-12, 1e-4, 0.3, 1.0 - 1e-12, 1.0, 2.0] {
                    sphere_light(wo, roughness, terms(), axis, sin2)
                        .into_iter()
                        .for_each(check);
                    check(sptd_sphere_published(&sptd_lobe(wo, roughness), axis, sin2));
                    check(lambert_sphere(axis, sin2));
                }
                let alpha = ggx_alpha(roughness);
                assert!(ggx_eval(axis, wo, alpha).is_finite());
                assert!(ggx_pdf(axis, wo, alpha).is_finite());
                assert!(ggx_sample(wo, alpha, DVec2::new(0.3, 1.0 - 1e-16)).is_finite());
            }
            for polygon in &polygons {
                polygon_light(wo, roughness, terms(), polygon)
                    .into_iter()
                    .for_each(check);
                check(lambert_polygon(polygon));
            }
        }
    }
}

#[test]
fn densities_hold_the_albedo() {
    for (roughness, wo) in surfaces(30) {
        let lobe = ltc_lobe(wo, roughness);
        let peak = Peak {
            direction: DVec3::new(-wo.x, -wo.y, wo.z),
            width_rad: 0.3 * lobe.alpha * wo.z.max(0.05),
        };
        let cosine = integrate(HEMISPHERE, peak, &|wi| lobe.eval(wi));
        assert!(
            (cosine / lobe.albedo - 1.0).abs() < 5e-3,
            "{roughness} {wo}: {cosine}"
        );
        let pivot = sptd_lobe(wo, roughness);
        let peak = Peak {
            direction: pivot.pivot.normalize(),
            width_rad: 0.3 * pivot.gap,
        };
        let uniform = integrate(HEMISPHERE, peak, &|wi| pivot.eval(wi));
        assert!(
            (uniform / pivot.albedo - 1.0).abs() < 5e-3,
            "{roughness} {wo}: {uniform}"
        );
    }
}

#[test]
fn pivots_map_caps_to_caps() {
    for ((roughness, wo), p) in surfaces(100).zip(points(100)) {
        let lobe = sptd_lobe(wo, roughness.max(0.1));
        let radius_rad = 3.0 * p[3] + 1e-3;
        let cap = SphericalCap {
            axis: viewer(180.0 * p[4], 360.0 * p[5]),
            cosine: radius_rad.cos(),
            sine: radius_rad.sin(),
        };
        let image = sptd_transform_cap(&lobe, cap);
        // `sample` is the inverse map: rim goes to rim, inside to inside.
        let (x, y) = image.axis.any_orthonormal_pair();
        for i in 0..8 {
            let (s, c) = (f64::from(i) * PI / 4.0).sin_cos();
            let rim = image.axis * image.cosine + image.sine * (c * x + s * y);
            let distance = lobe.sample(rim).dot(cap.axis) - cap.cosine;
            assert!(distance.abs() < 1e-9, "{distance}");
        }
        assert!(lobe.sample(image.axis).dot(cap.axis) > cap.cosine);
    }
}

#[test]
fn cap_intersections_match_cubature() {
    for p in points(300) {
        let cap = |angle: f64, radius: f64| SphericalCap {
            axis: viewer(180.0 * angle, 360.0 * p[5]),
            cosine: (PI * radius).cos(),
            sine: (PI * radius).sin(),
        };
        let (a, b) = (cap(p[0], p[1]), cap(p[2], p[3]));
        // Rings around a: the part of each inside b is an arc.
        let (cos_d, sin_d) = (a.axis.dot(b.axis), a.axis.cross(b.axis).length());
        let steps = 4000;
        let step = (1.0 - a.cosine) / f64::from(steps);
        let mut area = 0.0;
        for i in 0..steps {
            let z = a.cosine + step * (f64::from(i) + 0.5);
            let r = (1.0 - z * z).sqrt();
            let half = ((b.cosine - z * cos_d) / (r * sin_d))
                .clamp(-1.0, 1.0)
                .acos();
            area += 2.0 * half * step;
        }
        let region = sptd_cap_intersection(a, b);
        // Midpoints err by the square root at an arc's ends: (2 / 4000)^1.5 times 2 pi, times a few for thin rings.
        assert!((region - area).abs() < 2e-3, "{a:?} {b:?}: {region} {area}");
    }
}

#[test]
fn edges_through_the_nadir_cast_no_light() {
    // Vertices at multiples of one unit: edges and corners exactly under the point, along either axis.
    for x in -2..=1 {
        for y in -2..=1 {
            for (w, h) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
                let at = |i: i32, j: i32| DVec3::new(f64::from(x + i), f64::from(y + j), -1.0);
                let mut floor = vec![at(0, 0), at(w, 0), at(w, h), at(0, h)];
                assert!(lambert_polygon(&floor) < 1e-12, "{floor:?}");
                floor.reverse();
                assert!(lambert_polygon(&floor) < 1e-12, "{floor:?}");
            }
        }
    }
}

//! Lights on brushed metal against cubature of elliptic GGX. Errors are those of `accuracy`.

use glam::{DVec2, DVec3};
use hairline_optics::brushed_lobe::BrushedLobe;
use hairline_optics::facets::{FacetAxes, Facets, anisotropic_alpha};
use hairline_optics::filtered_lobe::SlopeSpread;
use hairline_optics::fresnel::FresnelRgb;
use hairline_optics::ltc::{ltc_lobe, polygon_light};
use rayon::prelude::*;

use super::cubature::{Cap, Cell, Patch, Triangle, integrate_by};

const ROUGHNESS: [f64; 3] = [0.15, 0.3, 0.5];
const STRENGTH: [f64; 3] = [0.4, 0.7, 0.9];
const ANGLE_DEG: [f64; 3] = [0.0, 40.0, 70.0];
const TURN_DEG: [f64; 3] = [0.0, 45.0, 90.0];
const RADIUS_RAD: [f64; 4] = [0.02, 0.08, 0.25, 0.8];

fn surface(roughness: f64, strength: f64, turn_deg: f64) -> FacetAxes {
    let alpha = roughness * roughness;
    FacetAxes {
        along: DVec2::from_angle(turn_deg.to_radians()),
        alphas: DVec2::new(anisotropic_alpha(alpha, strength), alpha),
    }
}

fn viewer(angle_deg: f64) -> DVec3 {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

fn reflected(wo: DVec3, axes: FacetAxes, along: f64, across: f64) -> DVec3 {
    let slope = axes.along * along * axes.alphas.x + axes.along.perp() * across * axes.alphas.y;
    let h = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
    2.0 * wo.dot(h) * h - wo
}

/// Integral over a patch, by cells that shrink towards the lobe's arc.
fn integrate(patch: impl Patch, wo: DVec3, axes: FacetAxes) -> f64 {
    let facets = Facets::new(axes);
    let arc: Vec<DVec3> = (-40..=40)
        .map(|i| {
            let place = f64::from(i) / 41.0;
            reflected(wo, axes, place / (1.0 - place * place).sqrt(), 0.0)
        })
        .collect();
    let width = 0.5 * axes.alphas.y * wo.z.max(0.15);
    let distance = |w: DVec3| {
        let to = |ends: &[DVec3]| {
            let d = ends[1] - ends[0];
            let t = (w - ends[0]).dot(d) / d.length_squared().max(1e-30);
            (w - ends[0] - t.clamp(0.0, 1.0) * d).length()
        };
        arc.windows(2).map(to).fold(f64::INFINITY, f64::min)
    };
    const GAUSS: [(f64, f64); 3] = [
        (-0.774_596_669_241_483, 0.555_555_555_555_556),
        (0.0, 0.888_888_888_888_889),
        (0.774_596_669_241_483, 0.555_555_555_555_556),
    ];
    let is_coarse = |cell: Cell| {
        let scale = distance(cell.centre) + width;
        let crosses = cell.crosses_horizon() && cell.reach > 0.03 && cell.depth < 10;
        let is_wide = cell.reach > 0.35 * (scale - cell.reach).max(0.25 * scale);
        cell.depth < 24 && (is_wide || crosses)
    };
    integrate_by(patch, &GAUSS, is_coarse, &|direction| {
        facets.eval(direction, wo)
    })
}

/// (approximate, by one transformed cosine, exact).
type Case = [f64; 3];

/// Errors over the brightest place of each surface, view and size: means of the slices' and of one transformed cosine's, and the slices' largest.
fn errors(evaluate: impl Fn(DVec3, FacetAxes, DVec3, f64) -> Case + Sync) -> [f64; 3] {
    let mut groups = Vec::new();
    for roughness in ROUGHNESS {
        for strength in STRENGTH {
            for turn_deg in TURN_DEG {
                for angle_deg in ANGLE_DEG {
                    for radius_rad in RADIUS_RAD {
                        let axes = surface(roughness, strength, turn_deg);
                        groups.push((viewer(angle_deg), axes, radius_rad));
                    }
                }
            }
        }
    }
    let found: Vec<[f64; 2]> = groups
        .into_par_iter()
        .flat_map_iter(|(wo, axes, radius_rad)| {
            let along = [-1.5, -0.5, 0.0, 0.5, 1.5].into_iter();
            let places = along.flat_map(|u| [-1.5, 0.0, 1.0].map(|v| reflected(wo, axes, u, v)));
            let cases: Vec<Case> = places
                .filter(|place| place.z > -0.5 * radius_rad.sin())
                .map(|place| evaluate(wo, axes, place, radius_rad))
                .collect();
            let brightest = cases.iter().map(|case| case[2]).fold(0.0, f64::max);
            let off = move |[slices, chord, exact]: Case| {
                [slices, chord].map(|it| 100.0 * (it - exact).abs() / brightest)
            };
            cases.into_iter().map(off)
        })
        .collect();
    let mean = |k: usize| found.iter().map(|off| off[k]).sum::<f64>() / found.len() as f64;
    let mut slices: Vec<f64> = found.iter().map(|off| off[0]).collect();
    slices.sort_by(f64::total_cmp);
    let worst = slices[slices.len() - 1];
    println!(
        "{} cases: mean {:.2} %, 95th percentile {:.2} %, worst {worst:.1} %",
        slices.len(),
        mean(0),
        slices[slices.len() * 95 / 100],
    );
    [mean(0), mean(1), worst]
}

fn white() -> FresnelRgb<'static> {
    FresnelRgb::schlick([1.0; 3])
}

#[test]
fn spheres_match_elliptic_ggx() {
    let [mean, chord, worst] = errors(|wo, axes, axis, radius_rad| {
        let lobe = BrushedLobe::new(wo, axes, SlopeSpread::default());
        let sin2 = radius_rad.sin().powi(2);
        let chord = lobe.chord(wo);
        let of = hairline_optics::ltc::LobeFresnel {
            fresnel: white(),
            albedo: [chord.albedo; 3],
        };
        [
            lobe.sphere(axis, sin2, &white())[0],
            hairline_optics::ltc::ltc_sphere(&chord, &of, axis, sin2)[0],
            integrate(Cap { axis, radius_rad }, wo, axes),
        ]
    });
    println!("one transformed cosine: mean {chord:.2} %");
    assert!(mean < 0.25, "mean {mean} %");
    assert!(worst < 12.0, "worst {worst} %");
    assert!(chord > 5.0 * mean, "one transformed cosine: {chord} %");
}

/// An oblong, and one with a notch.
#[test]
#[ignore = "long: cargo long"]
fn polygons_match_elliptic_ggx() {
    const OUTLINES: [(f64, &str); 2] = [(1.0, "oblong"), (0.3, "notched")];
    for (notch, name) in OUTLINES {
        println!("{name}");
        let [mean, _, worst] = errors(|wo, axes, axis, radius_rad| {
            let (x, y) = axis.any_orthonormal_pair();
            let outline = [
                (-1.0, -0.6),
                (1.0, -0.6),
                (notch, 0.0),
                (1.0, 0.6),
                (-1.0, 0.6),
            ];
            let vertices = outline.map(|(u, v)| axis + radius_rad.tan() * (u * x + v * y));
            let lobe = BrushedLobe::new(wo, axes, SlopeSpread::default());
            let [a, b, c, d, e] = vertices;
            let exact: f64 = [[a, b, c], [a, c, d], [a, d, e]]
                .map(|part| integrate(Triangle(part), wo, axes))
                .iter()
                .sum();
            [lobe.polygon(&vertices, &white())[0], 0.0, exact.abs()]
        });
        assert!(mean < 0.5, "mean {mean} %");
        assert!(worst < 12.0, "worst {worst} %");
    }
}

#[test]
fn albedos_match_quadrature() {
    let mut worst = [0.0_f64; 2];
    for roughness in ROUGHNESS {
        for strength in [0.0, 0.4, 0.7, 0.9] {
            for angle_deg in [0.0, 40.0, 70.0, 80.0] {
                for turn_deg in TURN_DEG {
                    let axes = surface(roughness, strength, turn_deg);
                    let wo = viewer(angle_deg);
                    let lobe = BrushedLobe::new(wo, axes, SlopeSpread::default());
                    let [exact] = Facets::new(axes).mean(wo, 96, |_| [1.0]);
                    let off = (lobe.albedo(&white())[0] - exact).abs();
                    let round = (ltc_lobe(wo, roughness).albedo - exact).abs();
                    worst = [worst[0].max(off), worst[1].max(round)];
                }
            }
        }
    }
    println!(
        "albedos off by {:.4}; of round facets {:.4}",
        worst[0], worst[1]
    );
    assert!(worst[0] < 0.015, "{}", worst[0]);
    assert!(worst[1] > 0.2, "{}", worst[1]);
}

/// Strips of all lengths and directions across the lobe, however narrow that is: each by itself, and not over the brightest.
#[test]
fn strips_match_elliptic_ggx() {
    let mut cases = Vec::new();
    for (roughness, strength) in [(0.055, 0.6), (0.1, 0.3), (0.15, 0.9)] {
        for (angle_deg, turn_deg) in [(0.0, 20.0), (40.0, 45.0), (60.0, 0.0), (60.0, 90.0)] {
            for (length, width) in [(0.1, 0.01), (1.5, 0.02)] {
                for strip_deg in [0.0, 8.0, 50.0, 90.0] {
                    let axes = surface(roughness, strength, turn_deg);
                    cases.push((axes, angle_deg, length, width, strip_deg, 0.3));
                }
            }
        }
    }
    let mut off: Vec<f64> = cases
        .into_par_iter()
        .filter_map(|(axes, angle_deg, length, width, strip_deg, place)| {
            let wo = viewer(angle_deg);
            let middle = reflected(wo, axes, place, place);
            let side = DVec2::from_angle(f64::to_radians(strip_deg)).rotate(axes.along);
            let u = (side.extend(0.0) - middle * side.dot(middle.truncate())).normalize();
            let (u, v) = (0.5 * length * u, 0.5 * width * middle.cross(u));
            let [a, b, c, d] = [-u - v, u - v, u + v, v - u].map(|corner| middle + corner);
            let is_up = [a, b, c, d].iter().all(|corner| corner.z > 0.0);
            is_up.then(|| {
                let lobe = BrushedLobe::new(wo, axes, SlopeSpread::default());
                let found = lobe.polygon(&[a, b, c, d], &white())[0];
                let exact: f64 = [[a, b, c], [a, c, d]]
                    .map(|part| integrate(Triangle(part), wo, axes))
                    .iter()
                    .sum();
                (found / exact.abs() - 1.0).abs()
            })
        })
        .collect();
    off.sort_by(f64::total_cmp);
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let worst = off[off.len() - 1];
    println!("{} strips: mean {mean:.5}, worst {worst:.4}", off.len());
    assert!(off.len() > 80, "{}", off.len());
    assert!(mean < 0.005, "mean {mean}");
    assert!(worst < 0.05, "worst {worst}");
}

/// A pixel's normals hardly change the tails of a brushed lobe, neither along its arc nor across it, where a small spread is many times its alpha.
#[test]
fn a_pixel_leaves_the_tails_of_a_brushed_lobe() {
    let axes = surface(0.05, 0.6, 30.0);
    let variance = DVec2::new(1e-5, 4e-6);
    let spread = SlopeSpread {
        variance,
        covariance: 0.0,
    };
    let mut worst = [1.0_f64; 2];
    for angle_deg in [0.0, 40.0] {
        let wo = viewer(angle_deg);
        let sharp = BrushedLobe::new(wo, axes, SlopeSpread::default());
        let lobe = BrushedLobe::new(wo, axes, spread);
        for (along, across) in [
            (0.0, 20.0),
            (0.3, -30.0),
            (0.0, 60.0),
            (-0.3, 100.0),
            (0.5, 30.0),
        ] {
            let axis = reflected(wo, axes, along, across);
            assert!(axis.z > 0.1);
            let [sharp, found] = [sharp, lobe].map(|lobe| lobe.sphere(axis, 1e-5, &white())[0]);
            let ratio = found / sharp;
            println!("{angle_deg} {along} {across}: {ratio:.3}");
            worst = [worst[0].min(ratio), worst[1].max(ratio)];
        }
    }
    assert!(worst[0] > 0.9 && worst[1] < 1.15, "{worst:?}");
}

/// Lights far from the mirror direction: each by itself, in the tails of a lobe that is hardly there.
#[test]
fn tails_match_ggx() {
    let mut off = Vec::new();
    for roughness in [0.09, 0.25] {
        let axes = surface(roughness, 0.0, 0.0);
        for angle_deg in [0.0, 40.0, 60.0] {
            let wo = viewer(angle_deg);
            for widths in [3.0, 8.0, 20.0] {
                for turn in [0.0, 1.0, 2.2, 3.1, 4.5] {
                    let place = widths * DVec2::from_angle(turn);
                    let middle = reflected(wo, axes, place.x, place.y);
                    for (length, width) in [(1.2, 0.01), (0.3, 0.01), (0.4, 0.3)] {
                        for strip_deg in [0.0, 50.0, 90.0] {
                            let side = DVec2::from_angle(f64::to_radians(strip_deg)).extend(0.0);
                            let u = (side - middle * side.dot(middle)).normalize();
                            let (u, v) = (0.5 * length * u, 0.5 * width * middle.cross(u));
                            let [a, b, c, d] = [-u - v, u - v, u + v, v - u].map(|to| middle + to);
                            if [a, b, c, d].iter().any(|corner| corner.z < 0.05) {
                                continue;
                            }
                            let found = polygon_light(wo, roughness, white(), &[a, b, c, d])[0];
                            let exact: f64 = [[a, b, c], [a, c, d]]
                                .map(|part| integrate(Triangle(part), wo, axes))
                                .iter()
                                .sum();
                            off.push((found / exact.abs() - 1.0).abs());
                        }
                    }
                }
            }
        }
    }
    off.sort_by(f64::total_cmp);
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let most = off[off.len() * 95 / 100];
    println!(
        "{} lights: mean {mean:.5}, 95th percentile {most:.4}",
        off.len()
    );
    assert!(off.len() > 400, "{}", off.len());
    assert!(mean < 0.02, "mean {mean}");
    assert!(most < 0.11, "95th percentile {most}");
}

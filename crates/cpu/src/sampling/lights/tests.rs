use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hairline_scene::{Light, LightShape};

use super::AreaLights;
use hairline_fixtures::statistics::{Draw, chi_square_of_two, jittered};

impl AreaLights {
    fn from_lights<'l>(lights: impl IntoIterator<Item = &'l Light>) -> Self {
        Self::with_textures(lights, &Arc::default())
    }
}

fn sphere(center_m: [f64; 3], radius_m: f64) -> Light {
    Light::sphere(center_m.into(), radius_m, [1.0, 2.0, 3.0])
}

/// A polygon in the plane z = `height_m` that shines down, to where the tests' points are.
fn ceiling(outline_m: &[[f64; 2]], height_m: f64) -> Light {
    // Given counter-clockwise seen from above.
    let vertices_m = outline_m
        .iter()
        .rev()
        .map(|v| DVec3::new(v[0], v[1], height_m))
        .collect();
    Light::polygon(vertices_m, [1.0, 2.0, 3.0], false)
}

/// Turned and moved: nothing may depend on the axes.
fn askew(mut light: Light) -> Light {
    let turn = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1);
    if let LightShape::Polygon { vertices_m, .. } = &mut light.shape {
        vertices_m.iter_mut().for_each(|v| *v = turn * *v);
    }
    light
}

const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
const L_SHAPE: [[f64; 2]; 6] = [
    [0.2, 0.2],
    [2.0, 0.2],
    [2.0, 0.6],
    [0.7, 0.6],
    [0.7, 2.0],
    [0.2, 2.0],
];

fn star() -> Vec<[f64; 2]> {
    (0..14)
        .map(|i| {
            let radius = if i % 2 == 0 { 1.0 } else { 0.35 };
            let (sin, cos) = (2.0 * PI * f64::from(i) / 14.0).sin_cos();
            [0.4 + radius * cos, radius * sin]
        })
        .collect()
}

fn moved(outline: &[[f64; 2]], scale: f64, by: [f64; 2]) -> Vec<[f64; 2]> {
    outline
        .iter()
        .map(|v| [scale * v[0] + by[0], scale * v[1] + by[1]])
        .collect()
}

/// Lights that a point at the origin sees, with names.
fn seen() -> Vec<(&'static str, Light)> {
    vec![
        ("square", ceiling(&SQUARE, 1.3)),
        ("turned square", askew(ceiling(&SQUARE, 1.3))),
        ("square 1e-3 away, overhead", ceiling(&SQUARE, 1e-3)),
        (
            "corner overhead",
            ceiling(&moved(&SQUARE, 1.0, [1.0, 1.0]), 0.5),
        ),
        ("L", ceiling(&L_SHAPE, 0.8)),
        ("star", askew(ceiling(&star(), 0.6))),
        (
            "star of 1e-4 rad",
            ceiling(&moved(&star(), 1e-4, [0.3, 0.0]), 1.0),
        ),
        (
            "square of 1e-6 rad",
            askew(ceiling(&moved(&SQUARE, 1e-6, [0.3, 0.0]), 1.0)),
        ),
        (
            "L nearly edge-on",
            ceiling(&moved(&L_SHAPE, 1.0, [3.0, 0.0]), 1e-3),
        ),
        (
            "sliver",
            ceiling(&[[-3.0, 0.1], [4.0, 0.1], [4.0, 0.1001]], 1.0),
        ),
        (
            "across the horizon",
            ceiling(&[[-1.0, 1.0], [1.0, 1.0], [1.0, 1.001], [-1.0, 3.0]], 0.2),
        ),
        ("sphere", sphere([1.0, 2.0, 2.0], 1.5)),
        ("sphere of 1e-4 rad", sphere([100.0, 200.0, 200.0], 0.03)),
        ("sphere of 1e-7 rad", sphere([0.0, 0.0, 3e5], 0.03)),
        (
            "sphere that nearly touches",
            sphere([0.0, 1.0, 0.0], 1.0 - 1e-7),
        ),
        ("inside a sphere", sphere([0.3, 0.1, 0.2], 0.5)),
        ("at a sphere's centre", sphere([0.0; 3], 0.5)),
    ]
}

/// The solid angle of a spherical polygon by Girard: its angles against those of a flat one.
fn girard(vertices: &[DVec3]) -> f64 {
    let n = vertices.len();
    let angles: f64 = (0..n)
        .map(|i| {
            let [before, at, after] = [i + n - 1, i, i + 1].map(|k| vertices[k % n].normalize());
            let (a, b) = (at.cross(before), at.cross(after));
            // Inner angle, from the outgoing edge counter-clockwise: the way that a lit polygon goes about its inside.
            a.cross(b).dot(at).atan2(a.dot(b)).rem_euclid(2.0 * PI)
        })
        .sum();
    angles - (n as f64 - 2.0) * PI
}

/// Lambert's formula for the irradiance of a polygon on the plane with a unit normal, cut at its horizon.
fn lambert(vertices: &[DVec3], normal: DVec3) -> f64 {
    let mut cut = Vec::new();
    for (i, &a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        let (za, zb) = (a.dot(normal), b.dot(normal));
        if za >= 0.0 {
            cut.push(a);
        }
        if (za < 0.0) != (zb < 0.0) {
            cut.push(a + (b - a) * (za / (za - zb)));
        }
    }
    let edges = cut.iter().enumerate().map(|(i, a)| {
        let cross = a.cross(cut[(i + 1) % cut.len()]);
        let sin = cross.length();
        let angle = sin.atan2(a.dot(cut[(i + 1) % cut.len()]));
        if sin > 0.0 {
            cross.dot(normal) / sin * angle
        } else {
            0.0
        }
    });
    (0.5 * edges.sum::<f64>()).abs()
}

fn vertices(light: &Light) -> Option<&[DVec3]> {
    match &light.shape {
        LightShape::Polygon { vertices_m, .. } => Some(vertices_m),
        _ => None,
    }
}

#[test]
fn every_sample_hits_and_lies_within_the_bounds() {
    let mut draw = Draw::new(1);
    for (name, light) in seen() {
        let lights = AreaLights::from_lights(&[light]);
        let from = DVec3::ZERO;
        let bound = lights.bound(0, from);
        assert!(
            (bound.cos.hypot(bound.sin) - 1.0).abs() < 2e-6,
            "{name}: {bound:?}"
        );
        let axes: Vec<_> = (0..20)
            .map(|i| {
                // Some near the light: there ends of the interval lie on arcs and at +-1.
                let near = lights.sample(0, from, draw.two()).unwrap().direction;
                let axis = match i % 4 {
                    0 => draw.direction(),
                    1 => near,
                    2 => -near,
                    _ => near.cross(draw.direction()).normalize(),
                };
                (axis, lights.extent(0, from, axis))
            })
            .collect();
        let mut reached = vec![(1.0_f64, -1.0_f64); axes.len()];
        for _ in 0..100_000 {
            let sample = lights.sample(0, from, draw.two()).expect(name);
            assert!((sample.direction.length() - 1.0).abs() < 1e-14, "{name}");
            let hit = lights.hit(0, from, sample.direction);
            let hit = hit.unwrap_or_else(|| panic!("{name}: {sample:?} misses"));
            assert!(
                (hit.distance_m / sample.distance_m - 1.0).abs() < 1e-9,
                "{name}"
            );
            assert_eq!(hit.radiance, sample.radiance);
            assert_eq!(lights.pdf(0, from, sample.direction), sample.pdf);
            assert!(sample.direction.dot(bound.axis) >= bound.cos, "{name}");
            assert!(
                bound.cos < 0.0 || sample.direction.cross(bound.axis).length() <= bound.sin,
                "{name}"
            );
            for ((axis, (low, high)), reached) in axes.iter().zip(&mut reached) {
                let component = sample.direction.dot(*axis).clamp(-1.0, 1.0);
                assert!(
                    (*low..=*high).contains(&component),
                    "{name}: {component} not in [{low}, {high}]"
                );
                *reached = (reached.0.min(component), reached.1.max(component));
            }
        }
        // Bounds that hold everything are of no use: samples come near them. (A sliver's tips are hardly ever met.)
        for ((axis, (low, high)), reached) in axes.iter().zip(&reached) {
            let loose = (reached.0 - low).max(high - reached.1);
            let allowed = if name == "sliver" { 0.3 } else { 0.06 };
            assert!(
                loose <= allowed * (high - low) + 1e-11,
                "{name}: {axis} reaches {reached:?} of [{low}, {high}]"
            );
        }
    }
}

#[test]
fn the_density_is_one_over_the_solid_angle() {
    for (name, light) in seen() {
        let lights = AreaLights::from_lights(std::slice::from_ref(&light));
        let measured = 1.0 / lights.pdf(0, DVec3::ZERO, DVec3::Z);
        let (expected, tolerance) = match (&light.shape, vertices(&light)) {
            // Girard subtracts angles of order one.
            (_, Some(vertices)) if name != "square of 1e-6 rad" => {
                (girard(vertices), 1e-13 / measured + 1e-9)
            }
            // Flat: area, cosine, distance. The light is 1e-6 across, so the next term is 1e-12 of it.
            (_, Some(_)) => (4e-12 * (1.0 / 1.09_f64.sqrt()) / 1.09, 1e-6),
            (LightShape::Sphere { center_m, radius_m }, _) => {
                let sin2 = (radius_m / center_m.length()).powi(2);
                let versine = if sin2 < 1e-6 {
                    0.5 * sin2
                } else {
                    1.0 - (1.0 - sin2).sqrt()
                };
                (
                    if sin2 < 1.0 {
                        2.0 * PI * versine
                    } else {
                        4.0 * PI
                    },
                    1e-6,
                )
            }
            _ => unreachable!(),
        };
        println!(
            "{name}: {measured:.9e} sr, relative error {:.1e}",
            measured / expected - 1.0
        );
        assert!(
            (measured / expected - 1.0).abs() < tolerance,
            "{name}: {measured} {expected}"
        );
    }
}

/// No part is lost or counted twice where a polygon is cut into triangles.
#[test]
fn polygons_of_every_outline_keep_their_solid_angle() {
    let mut draw = Draw::new(6);
    for round in 0..300 {
        let n = 3 + (draw.one() * 60.0) as usize;
        let outline: Vec<_> = if round % 3 == 0 {
            // A comb: upright teeth on a back, many vertices on two lines.
            let teeth = (0..n).rev().flat_map(|i| {
                let x = i as f64 / n as f64;
                let step = 1.0 / n as f64;
                [
                    [x + 0.6 * step, 0.2],
                    [x + 0.6 * step, 1.0],
                    [x, 1.0],
                    [x, 0.2],
                ]
            });
            [[0.0, 0.0], [1.0, 0.0]].into_iter().chain(teeth).collect()
        } else {
            // Spikes of any length about a centre.
            (0..n)
                .map(|i| {
                    let (sin, cos) =
                        (2.0 * PI * (i as f64 + 0.9 * draw.one()) / n as f64).sin_cos();
                    let radius = 0.02 + draw.one();
                    [0.3 + radius * cos, radius * sin]
                })
                .collect()
        };
        let light = askew(ceiling(&outline, 0.1 + draw.one()));
        let expected = girard(vertices(&light).unwrap());
        let measured = 1.0 / AreaLights::from_lights(&[light]).pdf(0, DVec3::ZERO, DVec3::Z);
        assert!(
            (measured - expected).abs() < 1e-11,
            "{round}: {measured} {expected} {outline:?}"
        );
    }
}

/// The mean of cosine over density, cut at the horizon, and its standard error.
fn irradiance(lights: &AreaLights, from: DVec3, normal: DVec3) -> (f64, f64) {
    const SIDE: usize = 100;
    const SEEDS: u64 = 12;
    let means = (0..SEEDS).map(|seed| {
        let sum: f64 = jittered(SIDE, seed)
            .filter_map(|u| lights.sample(0, from, u))
            .map(|sample| sample.direction.dot(normal).max(0.0) / sample.pdf)
            .sum();
        sum / (SIDE * SIDE) as f64
    });
    let means: Vec<_> = means.collect();
    let mean = means.iter().sum::<f64>() / SEEDS as f64;
    let squares: f64 = means.iter().map(|m| (m - mean).powi(2)).sum();
    (mean, (squares / (SEEDS * (SEEDS - 1)) as f64).sqrt())
}

#[test]
fn the_mean_of_cosine_over_density_is_the_irradiance() {
    let mut draw = Draw::new(2);
    for (name, light) in seen() {
        let lights = AreaLights::from_lights(std::slice::from_ref(&light));
        for turn in 0..4 {
            // Upwards, where all but one light stand, and across them.
            let normal = if turn == 0 {
                DVec3::Z
            } else {
                draw.direction()
            };
            let expected = match &light.shape {
                LightShape::Tube { .. } => unreachable!(),
                LightShape::Polygon { vertices_m, .. } => lambert(vertices_m, normal),
                LightShape::Sphere { center_m, radius_m } => {
                    let sin = radius_m / center_m.length();
                    if sin >= 1.0 {
                        PI
                    } else {
                        let cos = center_m.normalize().dot(normal);
                        // A cap that the horizon cuts has another formula.
                        if cos.asin().abs() < sin.asin() {
                            continue;
                        }
                        PI * sin * sin * cos.max(0.0)
                    }
                }
            };
            let (measured, error) = irradiance(&lights, DVec3::ZERO, normal);
            // Light that mostly lies below the horizon comes with few samples: judge the error by the whole light's.
            let scale = 1.0 / lights.pdf(0, DVec3::ZERO, normal);
            assert!(error < 1e-3 * scale, "{name}: {error}");
            // Lambert's edges cancel: 1e-16 is what is left of rounding for the smallest light.
            // Twelve seeds do not know their error well: six of them are like four and a half of a known one.
            assert!(
                (measured - expected).abs() < 6.0 * error + 1e-9 * scale + 1e-16,
                "{name}: {measured} {expected} {error}"
            );
        }
    }
}

/// Counts over a grid across the directions of a cone.
fn histogram(directions: &[DVec3], axis: DVec3, reach: f64) -> Vec<f64> {
    const SIDE: usize = 40;
    let (x, y) = axis.any_orthonormal_pair();
    let mut counts = vec![0.0; SIDE * SIDE];
    for d in directions {
        let cell = |t: f64| (((t / reach + 1.0) * 0.5 * SIDE as f64) as usize).min(SIDE - 1);
        counts[cell(d.dot(x)) * SIDE + cell(d.dot(y))] += 1.0;
    }
    counts
}

#[test]
fn samples_are_spread_as_the_hits_of_even_directions_are() {
    let mut draw = Draw::new(3);
    for (name, light) in seen() {
        let lights = AreaLights::from_lights(std::slice::from_ref(&light));
        let from = DVec3::ZERO;
        let bound = lights.bound(0, from);
        // Even directions in the bound, by the textbook's formula.
        let (x, y) = bound.axis.any_orthonormal_pair();
        let versine = if bound.cos > 0.0 {
            bound.sin * bound.sin / (1.0 + bound.cos)
        } else {
            1.0 - bound.cos
        };
        const TRIES: usize = 400_000;
        let hits: Vec<_> = (0..TRIES)
            .map(|_| {
                let (v, phi) = (versine * draw.one(), 2.0 * PI * draw.one());
                let sin = (v * (2.0 - v)).sqrt();
                bound.axis * (1.0 - v) + (x * phi.cos() + y * phi.sin()) * sin
            })
            .filter(|d| lights.hit(0, from, *d).is_some())
            .collect();
        if hits.len() < 2000 {
            // Too thin for its cone.
            assert!(["L nearly edge-on", "sliver"].contains(&name), "{name}");
            continue;
        }
        let samples: Vec<_> = (0..200_000)
            .map(|_| lights.sample(0, from, draw.two()).unwrap().direction)
            .collect();
        let reach = if bound.cos < 0.0 { 1.0 } else { bound.sin };
        let z = chi_square_of_two(
            &histogram(&samples, bound.axis, reach),
            &histogram(&hits, bound.axis, reach),
        );
        // The share of directions that hit is proportional to the solid angle.
        let share = hits.len() as f64 / TRIES as f64;
        let expected = 1.0 / (lights.pdf(0, from, DVec3::Z) * 2.0 * PI * versine);
        let deviation = (expected * (1.0 - expected).max(1e-12) / TRIES as f64).sqrt();
        println!("{name}: chi-square {z:.2}, hits {share:.5}, expected {expected:.5}");
        assert!(z < 5.0, "{name}: {z}");
        assert!(
            (share - expected).abs() < 5.0 * deviation + 1e-5,
            "{name}: {share} {expected}"
        );
    }
}

#[test]
fn points_even_in_area_would_be_noticed() {
    let mut draw = Draw::new(4);
    let light = ceiling(&SQUARE, 0.8);
    let lights = AreaLights::from_lights(&[light]);
    let bound = lights.bound(0, DVec3::ZERO);
    let mut by_area = Vec::new();
    let mut by_angle = Vec::new();
    for _ in 0..20_000 {
        let u = draw.two();
        by_area.push(DVec3::new(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 0.8).normalize());
        by_angle.push(lights.sample(0, DVec3::ZERO, draw.two()).unwrap().direction);
    }
    let z = chi_square_of_two(
        &histogram(&by_area, bound.axis, 1.0),
        &histogram(&by_angle, bound.axis, 1.0),
    );
    assert!(z > 50.0, "{z}");
}

#[test]
fn polygons_shine_to_the_side_that_sees_them_counter_clockwise() {
    let one_sided = ceiling(&L_SHAPE, 0.8);
    let corners_m = vertices(&one_sided).unwrap().to_vec();
    let two_sided = Light::polygon(corners_m, one_sided.radiance, true);
    let lights = AreaLights::from_lights(&[one_sided, two_sided]);
    let (below, above) = (DVec3::ZERO, DVec3::new(0.0, 0.0, 1.6));
    let u = DVec2::new(0.3, 0.6);
    let up = lights.sample(0, below, u).unwrap();
    assert_eq!(up.radiance, DVec3::new(1.0, 2.0, 3.0));
    let mirrored = up.direction * DVec3::new(1.0, 1.0, -1.0);
    assert!(lights.sample(0, above, u).is_none());
    assert!(lights.hit(0, above, mirrored).is_none());
    assert_eq!(lights.pdf(0, above, mirrored), 0.0);
    let down = lights.sample(1, above, u).unwrap();
    assert!((down.direction - mirrored).length() < 1e-12);
    assert!((lights.pdf(1, above, mirrored) / up.pdf - 1.0).abs() < 1e-12);
    assert!(lights.hit(1, above, mirrored).is_some());
    // In the notch of the L there is nothing, nor behind the point.
    assert!(
        lights
            .hit(0, below, DVec3::new(1.5, 1.5, 0.8).normalize())
            .is_none()
    );
    assert!(lights.hit(0, below, -up.direction).is_none());
}

#[test]
fn no_nan_at_awkward_points() {
    let far = 1e7;
    let points = [
        DVec3::ZERO,
        // On a vertex, an edge, the face, its plane, beside it by a rounding.
        DVec3::new(1.0, 1.0, 1.3),
        DVec3::new(1.0, 0.2, 1.3),
        DVec3::new(0.3, 0.2, 1.3),
        DVec3::new(5.0, 0.2, 1.3),
        DVec3::new(0.3, 0.2, 1.3 - 1e-15),
        DVec3::new(0.3, 0.2, 1.3 - 1e-9),
        DVec3::new(5.0, 0.2, 1.3 - 1e-9),
        DVec3::new(far, far, -far),
        // The sphere's centre, its surface, beside it by a rounding.
        DVec3::new(1.0, 2.0, 2.0),
        DVec3::new(1.0, 2.0, 0.5),
        DVec3::new(1.0, 2.0, 0.5 - 1e-15),
        DVec3::new(1.0, 2.0, 0.5 + 1e-15),
    ];
    let last = 1.0 - f64::EPSILON / 2.0;
    let lights = AreaLights::from_lights(&[
        ceiling(&SQUARE, 1.3),
        sphere([1.0, 2.0, 2.0], 1.5),
        askew(ceiling(&L_SHAPE, 1.3)),
    ]);
    for i in 0..lights.len() {
        for from in points {
            let bound = lights.bound(i, from);
            assert!(bound.axis.is_normalized() && bound.cos.is_finite() && bound.sin.is_finite());
            for axis in [DVec3::X, DVec3::Z, -DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] {
                let (low, high) = lights.extent(i, from, axis);
                assert!(-1.0 <= low && low <= high && high <= 1.0, "{low} {high}");
                let hit = lights.hit(i, from, axis);
                assert!(hit.is_none_or(|hit| hit.distance_m >= 0.0 && hit.distance_m.is_finite()));
            }
            for u in [
                (0.0, 0.0),
                (last, last),
                (0.0, last),
                (last, 0.0),
                (0.5, 0.5),
            ] {
                let Some(sample) = lights.sample(i, from, u.into()) else {
                    continue;
                };
                assert!(sample.direction.is_normalized(), "{sample:?}");
                assert!(sample.pdf > 0.0 && sample.pdf.is_finite(), "{sample:?}");
                assert!(
                    sample.distance_m >= 0.0 && sample.distance_m.is_finite(),
                    "{sample:?}"
                );
                assert!(
                    sample.direction.dot(bound.axis) >= bound.cos - 1e-9,
                    "{from} {sample:?}"
                );
            }
        }
    }
}

/// Prints nanoseconds per call: `cargo test --release -p hairline-reference -- --ignored --nocapture light_timings`.
#[test]
#[ignore = "prints figures"]
fn light_timings() {
    const CALLS: usize = 1_000_000;
    let mut draw = Draw::new(5);
    let us: Vec<_> = (0..1024).map(|_| draw.two()).collect();
    for (name, light) in seen() {
        if !["square", "L", "star", "sphere"].contains(&name) {
            continue;
        }
        let lights = AreaLights::from_lights(&[light]);
        let direction = lights.sample(0, DVec3::ZERO, us[0]).unwrap().direction;
        let time = |call: &dyn Fn(DVec3, DVec2) -> f64| {
            let start = std::time::Instant::now();
            let mut sum = 0.0;
            for i in 0..CALLS {
                let u = us[i % us.len()];
                sum += call(DVec3::new(1e-3 * u.x, 1e-3 * u.y, 0.0), u);
            }
            std::hint::black_box(sum);
            start.elapsed().as_nanos() as f64 / CALLS as f64
        };
        println!(
            "{name}: sample {:.0} ns, hit {:.0}, pdf {:.0}, bound {:.0}, extent {:.0}",
            time(&|from, u| lights.sample(0, from, u).map_or(0.0, |s| s.direction.x)),
            time(&|from, _| lights.hit(0, from, direction).map_or(0.0, |h| h.distance_m)),
            time(&|from, _| lights.pdf(0, from, direction)),
            time(&|from, _| lights.bound(0, from).cos),
            time(&|from, _| lights.extent(0, from, DVec3::X).0),
        );
    }
}

/// Least distance of a ray from the origin to a line between two points, by bisection.
fn nearest_to_line(w: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let beside = |s: f64| {
        let p = a.lerp(b, s);
        p.distance(w * p.dot(w).max(0.0))
    };
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > 1e-9 {
        let third = (high - low) / 3.0;
        if beside(low + third) < beside(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    beside(low)
}

#[test]
fn a_tube_is_sampled_as_it_is_seen() {
    let mut draw = Draw::new(8);
    for (a, b, radius_m) in [
        ([-1.0, 0.2, 1.0], [1.0, 0.1, 1.2], 0.1),
        ([0.5, 0.2, 0.4], [0.9, 0.1, 3.0], 0.2),
        ([-1.0, 0.0, 0.31], [2.0, 0.3, 0.4], 0.3),
        // Seen from beyond its end, and along its axis.
        ([0.05, 0.0, 0.6], [0.0, 0.1, 2.0], 0.2),
        ([0.0, 0.0, 1.0], [0.0, 0.0, 2.0], 0.3),
        ([-1.0, 0.3, -0.2], [1.0, 0.4, 0.5], 0.15),
    ] {
        let ends_m = [a, b].map(DVec3::from);
        let lights = AreaLights::from_lights(&[Light::tube(ends_m, radius_m, [1.0; 3])]);
        let bound = lights.bound(0, DVec3::ZERO);
        let axes = [(); 6].map(|()| draw.direction());
        let extents = axes.map(|axis| lights.extent(0, DVec3::ZERO, axis));
        for _ in 0..20_000 {
            let sample = lights.sample(0, DVec3::ZERO, draw.two()).unwrap();
            let w = sample.direction;
            assert!(nearest_to_line(w, ends_m) < radius_m + 1e-9);
            let hit = lights.hit(0, DVec3::ZERO, w).unwrap();
            let to_line = nearest_to_line(w, ends_m.map(|end| end - hit.distance_m * w));
            assert!(to_line < radius_m + 1e-9, "{to_line}");
            assert!(w.dot(bound.axis) >= bound.cos);
            for (axis, (low, high)) in axes.iter().zip(extents) {
                assert!((low..=high).contains(&w.dot(*axis)));
            }
        }
        const STEPS: u32 = 400;
        let mut seen = 0;
        // Equal parts of the projected hemisphere.
        for u in jittered(STEPS as usize, 1) {
            let (sin, cos) = (2.0 * PI * u.y).sin_cos();
            let w = DVec3::new(u.x.sqrt() * cos, u.x.sqrt() * sin, (1.0 - u.x).sqrt());
            let meets = nearest_to_line(w, ends_m) < radius_m;
            assert_eq!(meets, lights.hit(0, DVec3::ZERO, w).is_some());
            seen += u32::from(meets);
        }
        let exact = PI * f64::from(seen) / f64::from(STEPS * STEPS);
        let (mean, error) = irradiance(&lights, DVec3::ZERO, DVec3::Z);
        println!("{exact:.5}, {mean:.5} +- {error:.5}");
        assert!((mean / exact - 1.0).abs() < 3e-3 + 4.0 * error / exact);
        assert!((1.02 * mean / exact - 1.0).abs() > 3e-3 + 4.0 * error / exact);
    }
    let within = Light::tube([DVec3::NEG_X, DVec3::X], 0.2, [1.0; 3]);
    let lights = AreaLights::from_lights(&[within]);
    assert!(lights.sample(0, DVec3::ZERO, DVec2::splat(0.5)).is_none());
}

//! The method of 2018: lights, spectrum and footprint.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::call::Call;
use hairline_gpu::headless;
use hairline_optics::band::Cap;
use hairline_optics::diffraction;
use hairline_published::footprint::{PixelFootprint, PublishedShare, published_share};
use hairline_published::polygon::{bitonic_sort, clip_triangle, triangle_segments};
use hairline_published::segments::BandSegments;
use hairline_published::shaders;
use hairline_published::sine_integral::{SineIntegral, sine_integral_fast};
use hairline_published::spectrum::{
    PublishedWavelength, published_chord_integral, published_radiance,
};
use hairline_published::sphere::sphere_segments;

fn si(fast: f64) -> SineIntegral {
    if fast > 0.5 {
        SineIntegral::Fast
    } else {
        SineIntegral::Exact
    }
}

#[test]
fn sine_integrals() {
    let mut random = Sequence(1);
    let mut rows = vec![[0.0], [1.0], [-1.0], [0.999_999], [1e-30], [1e9], [-1e9]];
    for _ in 0..5000 {
        rows.push([random.uniform(-1.0, 1.0) * 10f32.powf(random.uniform(-5.0, 4.0))]);
    }
    let twin = Twin {
        name: "sine_integral and sine_integral_fast",
        modules: &[&shaders::PUBLISHED_SINE_INTEGRAL],
        snippet: "y[0] = sine_integral(x[0]); y[1] = sine_integral_fast(x[0]);",
        tables: &[],
        expected: &|[x]: [f64; 1]| [diffraction::sine_integral(x), sine_integral_fast(x)],
        // 8e-7 is the rational functions' own, the rest rounding.
        tolerance: Tolerance {
            absolute: 1.5e-6,
            relative: 0.0,
        },
    };
    twin.check(&rows, 0);
    // One taken for the other.
    let swapped = Twin {
        snippet: "y[0] = sine_integral_fast(x[0]); y[1] = sine_integral(x[0]);",
        ..twin
    };
    if let Some(failures) = swapped.failures(&rows) {
        assert!(failures.len() > rows.len() / 4, "{}", failures.len());
    }
}

#[test]
fn chord_integrals() {
    let mut random = Sequence(2);
    let mut rows = vec![
        [0.0, 2.0, 0.5, 0.0],
        [0.7, 0.0, 0.5, 1.0],
        [-2.0, 20.0, 0.38, 1.0],
    ];
    for _ in 0..5000 {
        rows.push([
            random.uniform(-1.0, 1.0) * 10f32.powf(random.uniform(-4.0, 0.3)),
            10f32.powf(random.uniform(-1.0, 1.3)),
            random.uniform(0.38, 0.78),
            random.next().round(),
        ]);
    }
    Twin {
        name: "published_chord_integral",
        modules: &[&shaders::PUBLISHED_SPECTRUM],
        // Times W/lambda it runs from -1/2 to 1/2.
        snippet: "y[0] = x[1] / x[2] * published_chord_integral(x[0], x[1], x[2], x[3] > 0.5);",
        tables: &[],
        expected: &|[q, width, lambda, fast]: [f64; 4]| {
            [width / lambda * published_chord_integral(q, width, lambda, si(fast))]
        },
        tolerance: Tolerance {
            absolute: 1e-6,
            relative: 1e-6,
        },
    }
    .check(&rows, 0);
}

#[test]
fn radiances() {
    let mut random = Sequence(3);
    let rows: Vec<[f32; 8]> = (0..3000)
        .map(|_| {
            let mut q = || random.uniform(-1.5, 1.5);
            let mut ends = [q(), q(), q(), q()];
            ends.sort_by(f32::total_cmp);
            let [a, b, c, d] = ends;
            let width = 10f32.powf(random.uniform(-0.5, 1.0));
            let depth = random.uniform(0.0, 2000.0);
            [
                a,
                b,
                c,
                d,
                width,
                depth,
                random.uniform(0.4, 0.7),
                random.next().round(),
            ]
        })
        .collect();
    let twin = Twin {
        name: "published_radiance",
        modules: &[&shaders::PUBLISHED_SPECTRUM],
        snippet: "var segments: BandSegments;
            push_segment(&segments, x[0], x[1]);
            push_segment(&segments, x[2], x[3]);
            let wavelength = PublishedWavelength(vec3f(0.3, 1.0, -0.1), x[6]);
            let rgb = published_radiance(wavelength, segments, x[4], x[5], x[7] > 0.5);
            y[0] = rgb.x; y[1] = rgb.y; y[2] = rgb.z;",
        tables: &[],
        expected: &|[a, b, c, d, width, depth, wavelength_um, fast]: [f64; 8]| {
            let mut segments = BandSegments::default();
            segments.push_segment(a, b);
            segments.push_segment(c, d);
            let wavelength = PublishedWavelength {
                weight: [0.3, 1.0, -0.1],
                wavelength_um,
            };
            published_radiance(wavelength, &segments, width, depth, si(fast))
        },
        // |D|^2 reaches 4, and its phase, up to 30 rad, is rounded by 2e-6.
        tolerance: Tolerance {
            absolute: 3e-5,
            relative: 1e-5,
        },
    };
    twin.check(&rows, 0);
    // A nanometre of depth is seen.
    let deeper: Vec<[f32; 8]> = rows
        .iter()
        .map(|row| {
            let mut row = *row;
            row[5] += 1.0;
            row
        })
        .collect();
    let wrong = Twin {
        expected: &|mut row: [f64; 8]| {
            row[5] -= 1.0;
            (twin.expected)(row)
        },
        ..twin
    };
    if let Some(failures) = wrong.failures(&deeper) {
        assert!(failures.len() > rows.len() / 2, "{}", failures.len());
    }
}

/// Total length and light integral of the segments, whatever their number: one that shrinks to nothing may be missing.
const SUMS: &str = "
    for (var i = 0u; i < segments.count; i += 1u) {
        let ends = segments.ends[i];
        y[0] += ends.y - ends.x;
        y[1] += published_chord_integral(ends.y, 2.0, 0.555, false) - published_chord_integral(ends.x, 2.0, 0.555, false);
    }";

fn sums(segments: &BandSegments) -> [f64; 2] {
    [
        segments.integral(|q| q),
        segments.integral(|q| published_chord_integral(q, 2.0, 0.555, SineIntegral::Exact)),
    ]
}

fn v(x: &[f64]) -> DVec3 {
    DVec3::new(x[0], x[1], x[2])
}

#[test]
fn spheres() {
    let mut random = Sequence(4);
    let rows: Vec<[f32; 8]> = (0..20_000)
        .map(|i| {
            let wo = random.direction(0.0);
            let mut axis = random.direction(-1.0);
            let radius = 10f32.powf(random.uniform(-3.0, 0.45));
            if i % 4 > 0 {
                // Turned to the line.
                let along = (-wo[0] + radius * random.uniform(-1.2, 1.2)).clamp(-1.0, 1.0);
                let rest = (1.0 - along * along).sqrt() / axis[1].hypot(axis[2]).max(1e-6);
                axis = [along, axis[1] * rest, axis[2] * rest];
            }
            let [sin, cos] = if radius < 1.5 {
                [radius.sin(), radius.cos()]
            } else {
                // Within the sphere.
                [0.0, -1.0]
            };
            [wo[0], wo[1], wo[2], axis[0], axis[1], axis[2], sin, cos]
        })
        .collect();
    let snippet = format!(
        "let cap = Cap(vec3f(x[3], x[4], x[5]), x[6], x[7]);
        let segments = sphere_segments(vec3f(x[0], x[1], x[2]), cap);{SUMS}"
    );
    let twin = Twin {
        name: "sphere_segments",
        modules: &[&shaders::PUBLISHED_SPHERE, &shaders::PUBLISHED_SPECTRUM],
        snippet: &snippet,
        tables: &[],
        expected: &|x: [f64; 8]| {
            let cap = Cap {
                axis: v(&x[3..6]),
                sin_radius: x[6],
                cos_radius: x[7],
            };
            sums(&sphere_segments(v(&x[..3]), cap))
        },
        // Near the rim a segment's length is the square root of a rounded difference.
        tolerance: Tolerance {
            absolute: 1e-3,
            relative: 1e-3,
        },
    };
    twin.check(&rows, 0);
    let wrong = Twin {
        expected: &|mut x: [f64; 8]| {
            x[4] = -x[4];
            (twin.expected)(x)
        },
        ..twin
    };
    if let Some(failures) = wrong.failures(&rows) {
        assert!(failures.len() > rows.len() / 20, "{}", failures.len());
    }
}

/// A triangle in any place, seen from a point above whose horizon it may stand or not: wo and three corners.
fn triangles(count: usize) -> Vec<[f32; 12]> {
    let mut random = Sequence(5);
    (0..count)
        .map(|_| {
            let wo = random.direction(0.0);
            let size = 10f32.powf(random.uniform(-2.5, 0.5));
            let along = (-wo[0] + size * random.uniform(-0.7, 0.7)).clamp(-1.0, 1.0);
            let (sin, cos) = random.uniform(-0.4, 3.5).sin_cos();
            let rest = (1.0 - along * along).sqrt();
            let center = glam::Vec3::new(along, rest * cos, rest * sin);
            let (u, w) = glam::Vec3::from(random.direction(-1.0)).any_orthonormal_pair();
            let turn = random.uniform(0.0, std::f32::consts::TAU);
            let scale = 10f32.powf(random.uniform(-2.0, 2.0));
            let corner = |k: f32| {
                let (sin, cos) = (turn + k).sin_cos();
                scale * (center + size * (u * cos + w * sin))
            };
            let [a, b, c] = [corner(0.0), corner(1.7), corner(3.9)];
            [
                wo[0], wo[1], wo[2], a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z,
            ]
        })
        .collect()
}

const CLIP: &str = "let clipped = clip_triangle(array<vec3f, 3>(
        vec3f(x[3], x[4], x[5]), vec3f(x[6], x[7], x[8]), vec3f(x[9], x[10], x[11])));
    var corners = clipped.corners;";

#[test]
fn clipped_triangles() {
    let rows = triangles(5000);
    let snippet = format!(
        "{CLIP}
        y[0] = f32(clipped.count);
        for (var i = 0u; i < 4u; i += 1u) {{
            y[1] += corners[i].x * f32(i + 1u); y[2] += corners[i].y * f32(i + 1u); y[3] += corners[i].z * f32(i + 1u);
        }}"
    );
    Twin {
        name: "clip_triangle",
        modules: &[&shaders::PUBLISHED_POLYGON],
        snippet: &snippet,
        tables: &[],
        expected: &|x: [f64; 12]| {
            let clipped = clip_triangle([v(&x[3..6]), v(&x[6..9]), v(&x[9..12])]);
            let sum: DVec3 = (0..4).map(|i| clipped.corners[i] * (i + 1) as f64).sum();
            [clipped.count as f64, sum.x, sum.y, sum.z]
        },
        tolerance: Tolerance {
            absolute: 1e-5,
            relative: 1e-5,
        },
    }
    // A corner within rounding of the point or of the horizon.
    .check(&rows, 5);
}

#[test]
fn triangle_lights() {
    let rows = triangles(20_000);
    let snippet = format!(
        "{CLIP}
        for (var k = 2u; k < clipped.count; k += 1u) {{
            let segments = triangle_segments(vec3f(x[0], x[1], x[2]), corners[0], corners[k - 1u], corners[k]);{SUMS}
        }}"
    );
    let twin = Twin {
        name: "triangle_segments",
        modules: &[&shaders::PUBLISHED_POLYGON, &shaders::PUBLISHED_SPECTRUM],
        snippet: &snippet,
        tables: &[],
        expected: &|x: [f64; 12]| {
            let clipped = clip_triangle([v(&x[3..6]), v(&x[6..9]), v(&x[9..12])]);
            clipped.triangles().fold([0.0; 2], |sum, triangle| {
                let part = sums(&triangle_segments(v(&x[..3]), triangle));
                std::array::from_fn(|i| sum[i] + part[i])
            })
        },
        tolerance: Tolerance {
            absolute: 1e-3,
            relative: 1e-3,
        },
    };
    // An edge that touches the line within rounding touches it or does not: one row does, seen along the scratch itself.
    twin.check(&rows, 2);
    let wrong = Twin {
        expected: &|mut x: [f64; 12]| {
            x[7] += 0.02 * x[6].hypot(x[8]);
            (twin.expected)(x)
        },
        ..twin
    };
    if let Some(failures) = wrong.failures(&rows) {
        assert!(failures.len() > rows.len() / 20, "{}", failures.len());
    }
}

#[test]
fn sorting() {
    let mut random = Sequence(6);
    let rows: Vec<[f32; 8]> = (0..2000)
        .map(|_| {
            std::array::from_fn(|_| {
                if random.next() < 0.3 {
                    2.0
                } else {
                    random.uniform(-1.0, 1.0)
                }
            })
        })
        .collect();
    Twin {
        name: "bitonic_sort",
        modules: &[&shaders::PUBLISHED_POLYGON],
        snippet:
            "let s = bitonic_sort(vec4f(x[0], x[1], x[2], x[3]), vec4f(x[4], x[5], x[6], x[7]));
            y[0] = s.low.x; y[1] = s.low.y; y[2] = s.low.z; y[3] = s.low.w;
            y[4] = s.high.x; y[5] = s.high.y; y[6] = s.high.z; y[7] = s.high.w;",
        tables: &[],
        expected: &|x: [f64; 8]| {
            let mut sorted = x;
            sorted.sort_by(f64::total_cmp);
            assert_eq!(bitonic_sort(x), sorted);
            sorted
        },
        tolerance: Tolerance {
            absolute: 0.0,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}

fn share(x: &[f64]) -> PublishedShare {
    let pixel = PixelFootprint {
        right_um: DVec2::new(x[5], x[6]),
        down_um: DVec2::new(x[7], x[8]),
    };
    published_share(x[0], x[1], x[2], x[3], x[4], pixel, 20.0)
}

#[test]
fn footprints() {
    let mut random = Sequence(7);
    // Along the axes; no pixel; a pixel seen edge-on; a scratch of no width.
    let mut rows = vec![
        [2.0, 3.0, -50.0, 50.0, 16.0, 40.0, 0.0, 0.0, 40.0],
        [2.0, 3.0, -50.0, 50.0, 16.0, 0.0, 40.0, -40.0, 0.0],
        [2.0, 3.0, -50.0, 50.0, 16.0, 0.0, 0.0, 0.0, 0.0],
        [2.0, 3.0, -50.0, 50.0, 16.0, 30.0, 0.0, 60.0, 0.0],
        [0.0, 3.0, -50.0, 50.0, 16.0, 40.0, 0.0, 0.0, 40.0],
    ];
    for _ in 0..5000 {
        let size = 10f32.powf(random.uniform(-1.0, 3.0));
        let (sin, cos) = random.uniform(0.0, std::f32::consts::TAU).sin_cos();
        let (stretch, slant) = (random.uniform(0.3, 3.0), random.uniform(-0.5, 0.5));
        let reach = size + 40.0;
        let center = random.uniform(-1.0, 1.0) * reach;
        let half = 10f32.powf(random.uniform(0.0, 3.5));
        rows.push([
            random.uniform(0.1, 20.0),
            random.uniform(-1.0, 1.0) * reach,
            center - half,
            center + half,
            random.uniform(14.0, 16.5),
            size * cos,
            size * sin,
            size * (slant * cos - stretch * sin),
            size * (slant * sin + stretch * cos),
        ]);
    }
    let twin = Twin {
        name: "published_share",
        modules: &[&shaders::PUBLISHED_FOOTPRINT],
        snippet: "let pixel = PixelFootprint(vec2f(x[5], x[6]), vec2f(x[7], x[8]));
            let s = published_share(x[0], x[1], x[2], x[3], x[4], pixel, 20.0);
            y[0] = s.share; y[1] = s.density;",
        tables: &[],
        expected: &|x: [f64; 9]| {
            let share = share(&x);
            [share.share, share.density]
        },
        // A side nearly along the scratch cuts it at a place that rounding moves.
        tolerance: Tolerance {
            absolute: 1e-5,
            relative: 1e-4,
        },
    };
    twin.check(&rows, 0);
    let wrong = Twin {
        expected: &|mut x: [f64; 9]| {
            x[6] = -x[6];
            (twin.expected)(x)
        },
        ..twin
    };
    if let Some(failures) = wrong.failures(&rows) {
        assert!(failures.len() > rows.len() / 4, "{}", failures.len());
    }
}

/// wo, three corners, a cap's sine, width, depth, offset, ends, blur, the pixel's sides.
const AWKWARD: usize = 23;

/// Rows of numbers, many of them degenerate on purpose.
fn awkward(count: usize) -> Vec<[f32; AWKWARD]> {
    let mut random = Sequence(8);
    let numbers = [0.0, -0.0, 1.0, -1.0, 1e-30, 1e-7, 1e9, -1e9];
    (0..count)
        .map(|_| {
            let mut row: [f32; AWKWARD] = std::array::from_fn(|_| {
                if random.next() < 0.15 {
                    numbers[(random.next() * 8.0) as usize]
                } else {
                    random.uniform(-1.0, 1.0) * 10f32.powf(random.uniform(-6.0, 4.0))
                }
            });
            row[..3].copy_from_slice(&random.direction(0.0));
            if random.next() < 0.5 {
                row[3..6].copy_from_slice(&random.direction(-1.0));
            }
            row[12] = row[12].abs().min(1.0);
            for at in [13, 14, 18] {
                row[at] = row[at].abs();
            }
            (row[16], row[17]) = (row[16].min(row[17]), row[16].max(row[17]));
            row
        })
        .collect()
}

#[test]
fn never_nan_in_the_shader() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let snippet = format!(
        "let wavelength = PublishedWavelength(vec3f(0.3, 1.0, -0.1), 0.555);
        {CLIP}
        for (var k = 2u; k < clipped.count; k += 1u) {{
            let segments = triangle_segments(vec3f(x[0], x[1], x[2]), corners[0], corners[k - 1u], corners[k]);
            y[0] += published_radiance(wavelength, segments, x[13], x[14], k == 2u).y;
        }}
        let cap = Cap(published_unit(vec3f(x[3], x[4], x[5])), x[12], sqrt(1.0 - x[12] * x[12]));
        let segments = sphere_segments(vec3f(x[0], x[1], x[2]), cap);
        y[1] = published_radiance(wavelength, segments, x[13], x[14], x[15] > 0.0).y;
        let pixel = PixelFootprint(vec2f(x[19], x[20]), vec2f(x[21], x[22]));
        let s = published_share(x[13], x[15], x[16], x[17], x[18], pixel, 20.0);
        y[2] = s.share; y[3] = s.density;
        y[4] = sine_integral(x[15]) + sine_integral_fast(x[15]);"
    );
    let call = Call {
        modules: &[
            &shaders::PUBLISHED_POLYGON,
            &shaders::PUBLISHED_SPHERE,
            &shaders::PUBLISHED_SPECTRUM,
            &shaders::PUBLISHED_FOOTPRINT,
        ],
        snippet: &snippet,
        tables: &[],
    };
    let rows = awkward(100_000);
    let results: Vec<[f32; 5]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, result) in rows.iter().zip(&results) {
        assert!(result.iter().all(|v| v.is_finite()), "{row:?}: {result:?}");
        assert!(result[2] >= 0.0 && result[3] >= 0.0, "{row:?}: {result:?}");
    }
}

#[test]
fn never_nan_in_the_optics() {
    let wavelength = PublishedWavelength {
        weight: [0.3, 1.0, -0.1],
        wavelength_um: 0.555,
    };
    for row in awkward(100_000) {
        let x = row.map(f64::from);
        let wo = v(&x[..3]);
        let clipped = clip_triangle([v(&x[3..6]), v(&x[6..9]), v(&x[9..12])]);
        let cap = Cap {
            axis: v(&x[3..6]).normalize_or_zero(),
            sin_radius: x[12],
            cos_radius: (1.0 - x[12] * x[12]).sqrt(),
        };
        let segments = clipped
            .triangles()
            .map(|triangle| triangle_segments(wo, triangle))
            .chain([sphere_segments(wo, cap)]);
        for segments in segments {
            for si in [SineIntegral::Exact, SineIntegral::Fast] {
                let radiance = published_radiance(wavelength, &segments, x[13], x[14], si);
                assert!(
                    radiance.iter().all(|v| v.is_finite()),
                    "{row:?}: {radiance:?}"
                );
            }
        }
        let mut numbers = [0.0; 9];
        numbers[0] = x[13];
        numbers[1..].copy_from_slice(&x[15..23]);
        let share = share(&numbers);
        assert!(
            share.share.is_finite() && share.share >= 0.0 && share.density.is_finite(),
            "{row:?}: {share:?}"
        );
    }
}

//! Facets that lean further one way than across it, and their lobe over lights.

use std::sync::LazyLock;

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::call::{Table, Texels};
use hairline_gpu::shaders;
use hairline_optics::brushed_lobe::{BRUSHED_TAPS, BrushedLobe};
use hairline_optics::facets::{FacetAxes, Facets, anisotropic_alpha};
use hairline_optics::filtered_lobe::SlopeSpread;
use hairline_optics::fresnel::{FRESNEL_NODES, FresnelCurve, FresnelRgb};
use hairline_optics::metal::Metal;

/// `table_0` of the snippets.
fn curves() -> [Table<'static>; 1] {
    static CURVE: LazyLock<Vec<[f32; 4]>> =
        LazyLock::new(|| [gold().curve.nodes(), gold().curve.albedo_table().texels()].concat());
    [Table {
        size: [FRESNEL_NODES as u32, (CURVE.len() / FRESNEL_NODES) as u32],
        layers: None,
        texels: Texels::Floats(&CURVE),
    }]
}

fn gold() -> FresnelRgb<'static> {
    static GOLD: LazyLock<FresnelCurve> = LazyLock::new(|| Metal::Gold.fresnel_curve());
    FresnelRgb {
        f0: [0.0; 3],
        f90: 1.0,
        curve: &GOLD,
    }
}

/// (viewer's cosine, alpha across, strength, turn) of surfaces.
fn surface(random: &mut Sequence) -> [f32; 4] {
    let roughness = random.uniform(0.1, 0.7);
    [
        random.uniform(0.05, 1.0),
        roughness * roughness,
        random.next(),
        random.uniform(-3.2, 3.2),
    ]
}

const SURFACE: &str = "let wo = vec3f(sqrt(1.0 - x[0] * x[0]), 0.0, x[0]);
    let axes = FacetAxes(vec2f(cos(x[3]), sin(x[3])), vec2f(anisotropic_alpha(x[1], x[2]), x[1]));";

fn made([cos, alpha, strength, turn]: [f64; 4]) -> (DVec3, FacetAxes) {
    let axes = FacetAxes {
        along: DVec2::from_angle(turn),
        alphas: DVec2::new(anisotropic_alpha(alpha, strength), alpha),
    };
    (DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos), axes)
}

#[test]
fn facets() {
    let mut random = Sequence(31);
    let rows: Vec<[f32; 6]> = (0..10_000)
        .map(|_| {
            let [a, b, c, d] = surface(&mut random);
            [a, b, c, d, random.next(), random.next()]
        })
        .collect();
    Twin {
        name: "facets",
        modules: &[&shaders::FACETS],
        snippet: &format!(
            "{SURFACE}
            let facets = facets_of(facet_axes_spread_by(axes, 0.01));
            let wi = facets_sample(facets, wo, vec2f(x[4], x[5]));
            let peak = facets.alphas.x * facets.alphas.y;
            y[0] = wi.x; y[1] = wi.y; y[2] = wi.z;
            y[3] = facets_eval(facets, wi, wo) * peak;
            y[4] = facets_pdf(facets, wi, wo) * peak;"
        ),
        tables: &[],
        expected: &|[a, b, c, d, u, v]: [f64; 6]| {
            let (wo, axes) = made([a, b, c, d]);
            let facets = Facets::new(axes.spread_by(0.01));
            let wi = facets.sample(wo, DVec2::new(u, v));
            let peak = facets.alphas.x * facets.alphas.y;
            let [value, density] = [facets.eval(wi, wo), facets.pdf(wi, wo)];
            [wi.x, wi.y, wi.z, value * peak, density * peak]
        },
        // Sine and cosine of the draw are good to 5e-4 at worst.
        tolerance: Tolerance {
            absolute: 2e-3,
            relative: 2e-3,
        },
    }
    .check(&rows, 0);
}

/// A light near the lobe or anywhere, and how slopes spread.
fn light(random: &mut Sequence, surface: [f32; 4]) -> [f32; 7] {
    let (wo, axes) = made(surface.map(f64::from));
    let facets = Facets::new(axes);
    let u = DVec2::new(random.next().into(), random.next().into());
    let mut axis = facets.sample(wo, u);
    if random.next() < 0.2 {
        axis = DVec3::from(random.direction(-1.0).map(f64::from));
    }
    let spread = if random.next() < 0.5 { 0.0 } else { 0.02 };
    let [x, y, z] = axis.as_vec3().to_array();
    [
        x,
        y,
        z,
        10f32.powf(random.uniform(-2.5, -0.1)),
        spread * random.next(),
        spread * random.next(),
        random.uniform(-1.0, 1.0),
    ]
}

const SPREAD: &str =
    "let lobe = brushed_lobe(wo, axes, vec3f(x[8], x[9], 0.7 * x[10] * sqrt(x[8] * x[9])));
    let gold = FresnelRgb(vec3f(0.0), 1.0, 0u);";

fn lobe(surface: [f64; 4], spread: [f64; 3]) -> BrushedLobe {
    let (wo, axes) = made(surface);
    let [x, y, correlation] = spread;
    let spread = SlopeSpread {
        variance: DVec2::new(x, y),
        covariance: 0.7 * correlation * (x * y).sqrt(),
    };
    BrushedLobe::new(wo, axes, spread)
}

fn rows(seed: u64) -> Vec<[f32; 11]> {
    let mut random = Sequence(seed);
    (0..4000)
        .map(|_| {
            let surface = surface(&mut random);
            let [a, b, c, d] = surface;
            let [x, y, z, size, p, q, r] = light(&mut random, surface);
            [a, b, c, d, x, y, z, size, p, q, r]
        })
        .collect()
}

/// Greatest light of this size: its solid angle times the peak, and no more than all.
const BRIGHTEST: &str = "let peak = 1.0 / (3.14159 * axes.alphas.x * axes.alphas.y * wo.z);
    let brightest = 1.0 / min(peak * x[7] * x[7], 1.0);";

fn per_brightest(surface: [f64; 4], size: f64) -> f64 {
    let (wo, axes) = made(surface);
    let peak = 1.0 / (std::f64::consts::PI * axes.alphas.x * axes.alphas.y * wo.z);
    1.0 / (peak * size * size).min(1.0)
}

#[test]
fn spheres_on_brushed_lobes() {
    Twin {
        name: "brushed_sphere",
        modules: &[&shaders::BRUSHED_LOBE],
        snippet: &format!(
            "{SURFACE} {SPREAD} {BRIGHTEST}
            let r = brightest * brushed_sphere(lobe, vec3f(x[4], x[5], x[6]), x[7] * x[7], gold, table_0);
            y[0] = r.x; y[1] = r.y; y[2] = r.z;"
        ),
        tables: &curves(),
        expected: &|[a, b, c, d, x, y, z, size, p, q, r]: [f64; 11]| {
            let surface = [a, b, c, d];
            let lobe = lobe(surface, [p, q, r]);
            let reflected = lobe.sphere(DVec3::new(x, y, z), size * size, &gold());
            reflected.map(|channel| channel * per_brightest(surface, size))
        },
        // Sums of sixteen slices, each a difference; a small light spans few digits of one.
        tolerance: Tolerance {
            absolute: 2e-3,
            relative: 4e-3,
        },
    }
    .check(&rows(32), 8);
}

#[test]
fn polygons_on_brushed_lobes() {
    Twin {
        name: "brushed_crossings",
        modules: &[&shaders::BRUSHED_LOBE, &shaders::IRRADIANCE],
        snippet: &format!(
            "{SURFACE} {SPREAD} {BRIGHTEST}
            let axis = vec3f(x[4], x[5], x[6]);
            let sides = irradiance_basis(axis);
            var corners: array<vec3f, 4>;
            // Every other one is thin.
            let thin = select(0.6, 0.02, x[10] < 0.0);
            corners[0] = axis - x[7] * sides.u - thin * x[7] * sides.v;
            corners[1] = axis + x[7] * sides.u - thin * x[7] * sides.v;
            corners[2] = axis + x[7] * sides.u + thin * x[7] * sides.v;
            corners[3] = axis - 0.5 * x[7] * sides.u + thin * x[7] * sides.v;
            var outline = brushed_outline_axis();
            var area = vec3f(0.0);
            var highest = 0.0;
            for (var i = 0u; i < 4u; i += 1u) {{
                let a = brushed_from_local(lobe, corners[i]);
                let b = brushed_from_local(lobe, corners[(i + 1u) % 4u]);
                area += cross(a, b);
                highest = max(highest, b.z);
                brushed_add_to_axis(&outline, lobe, brushed_edge(a, b, false));
                brushed_add_to_axis(&outline, lobe, brushed_edge(a, b, true));
            }}
            let sliced = brushed_sliced(lobe, outline);
            var range = vec2f(1.0, -1.0);
            for (var i = 0u; i < 8u; i += 1u) {{
                let a = brushed_from_local(sliced, corners[i / 2u]);
                let b = brushed_from_local(sliced, corners[(i / 2u + 1u) % 4u]);
                range = brushed_range(sliced, range, brushed_edge(a, b, (i & 1u) == 1u));
            }}
            let visible = brushed_visible(sliced, range);
            var r = vec3f(0.0);
            let orientation = select(1.0, -1.0, dot(area, brushed_from_local(lobe, corners[0])) < 0.0);
            if highest > 0.0 && visible.y > visible.x {{
                for (var n = 0u; n < BRUSHED_NODES; n += 1u) {{
                    let node = brushed_node(n, visible);
                    let slice = brushed_slice(sliced, node.x);
                    if !slice.is_seen {{ continue; }}
                    for (var k = 0u; k < brushed_parts(sliced); k += 1u) {{
                        let part = brushed_part(sliced, slice, k);
                        var moments = brushed_none();
                        for (var i = 0u; i < 8u; i += 1u) {{
                            let a = brushed_from_local(sliced, corners[i / 2u]);
                            let b = brushed_from_local(sliced, corners[(i / 2u + 1u) % 4u]);
                            let edge = brushed_edge(a, b, (i & 1u) == 1u);
                            brushed_add_crossings(&moments, part, brushed_crossings(sliced, slice.slope, edge), orientation);
                        }}
                        r += node.y * brushed_reflected(sliced, slice, k, moments, gold, table_0);
                    }}
                }}
            }}
            r = brightest * max(r, vec3f(0.0));
            y[0] = r.x; y[1] = r.y; y[2] = r.z;"
        ),
        tables: &curves(),
        expected: &|[a, b, c, d, x, y, z, size, p, q, r]: [f64; 11]| {
            let surface = [a, b, c, d];
            let lobe = lobe(surface, [p, q, r]);
            let axis = DVec3::new(x, y, z);
            let (u, v) = hairline_optics::irradiance::irradiance_basis(axis);
            let thin = if r < 0.0 { 0.02 } else { 0.6 };
            let corners = [(-1.0, -thin), (1.0, -thin), (1.0, thin), (-0.5, thin)]
                .map(|(right, up)| axis + size * (right * u + up * v));
            let reflected = lobe.polygon(&corners, &gold());
            reflected.map(|channel| channel * per_brightest(surface, size))
        },
        tolerance: Tolerance {
            absolute: 3e-3,
            relative: 5e-3,
        },
    }
    .check(&rows(33), 16);
}

#[test]
fn all_around_brushed_lobes() {
    Twin {
        name: "brushed_albedo and brushed_tap",
        modules: &[&shaders::BRUSHED_LOBE],
        snippet: &format!(
            "{SURFACE} {SPREAD}
            let e = brushed_albedo(lobe, gold, table_0);
            let tap = brushed_tap(lobe, u32(x[7] * 1e3) % BRUSHED_TAPS, gold, table_0);
            y[0] = e.x; y[1] = e.y; y[2] = e.z; y[3] = e.w;
            y[4] = tap.direction.x; y[5] = tap.direction.y; y[6] = tap.direction.z;
            y[7] = tap.roughness; y[8] = tap.reflected.x;
            // A tap without light may lie anywhere.
            let counts = min(10.0 * tap.reflected.x, 1.0);
            y[4] *= counts; y[5] *= counts; y[6] *= counts; y[7] *= counts;"
        ),
        tables: &curves(),
        expected: &|[a, b, c, d, _, _, _, size, p, q, r]: [f64; 11]| {
            let lobe = lobe([a, b, c, d], [p, q, r]);
            let [red, green, blue] = lobe.albedo(&gold());
            let [white, ..] = lobe.albedo(&FresnelRgb::schlick([1.0; 3]));
            let tap = lobe.around(&gold())[(size * 1e3) as usize % BRUSHED_TAPS];
            let counts = (10.0 * tap.reflected[0]).min(1.0);
            let DVec3 { x, y, z } = counts * tap.direction;
            [
                red,
                green,
                blue,
                white,
                x,
                y,
                z,
                counts * tap.roughness,
                tap.reflected[0],
            ]
        },
        // A slice's mean is a quotient of small differences.
        tolerance: Tolerance {
            absolute: 4e-3,
            relative: 4e-3,
        },
    }
    .check(&rows(34), 8);
}

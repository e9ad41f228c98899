//! The base's lobes, and their integrals over lights.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec3, Vec3};
use hairline_gpu::call::{Call, Table, Texels};
use hairline_gpu::{headless, shaders};
use hairline_optics::environment_lobe::{ENVIRONMENT_TAPS, environment_lobe};
use hairline_optics::filtered_lobe::{SlopeSpread, filtered_lobe, filtered_lobe_around};
use hairline_optics::fresnel::{FRESNEL_NODES, FresnelCurve, FresnelRgb, half_vector_cos};
use hairline_optics::ggx::*;
use hairline_optics::irradiance::*;
use hairline_optics::lobe_table::*;
use hairline_optics::ltc::*;
use hairline_optics::metal::Metal;
use hairline_published::sptd::*;

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// `table_0` to `table_3` of the snippets.
fn tables() -> [Table<'static>; 4] {
    let lobes = [
        shape_texels(),
        albedo_table().texels(),
        sptd_table().texels(),
    ]
    .map(|texels| Table {
        size: [LOBE_TABLE_SIZE, texels.len() / LOBE_TABLE_SIZE].map(|n| n as u32),
        layers: None,
        texels: Texels::Floats(texels),
    });
    static TEXELS: LazyLock<Vec<[f32; 4]>> = LazyLock::new(|| {
        let curves = CURVES.iter();
        curves
            .flat_map(|curve| [curve.nodes(), curve.albedo_table().texels()].concat())
            .collect()
    });
    let curves = Table {
        size: [FRESNEL_NODES as u32, (TEXELS.len() / FRESNEL_NODES) as u32],
        layers: None,
        texels: Texels::Floats(&TEXELS),
    };
    let [ltc, albedo, sptd] = lobes;
    [ltc, albedo, sptd, curves]
}

/// Schlick's, gold's and glass'.
static CURVES: LazyLock<[FresnelCurve; 3]> = LazyLock::new(|| {
    [
        FresnelCurve::schlick().clone(),
        Metal::Gold.fresnel_curve(),
        FresnelCurve::dielectric(1.5),
    ]
});

/// Reflectances of dielectrics, half metals and perfect mirrors.
fn schlick() -> FresnelRgb<'static> {
    fresnel_of([0.04, 0.5, 1.0], 0)
}

/// The reflectance of a curve that snippets number.
fn fresnel_of(f0: [f64; 3], curve: usize) -> FresnelRgb<'static> {
    FresnelRgb {
        f0,
        f90: 1.0,
        curve: &CURVES[curve],
    }
}

/// Roughness: the ends of the scale, a mirror, and anything between.
fn roughness(random: &mut Sequence) -> f32 {
    let awkward = [0.0, 1.0, 1e-3, 0.0447];
    if random.next() < 0.15 {
        return awkward[(random.next() * 4.0) as usize];
    }
    random.next()
}

/// A viewer: as [`Sequence::direction`], and one in eight below the horizon.
fn viewer(random: &mut Sequence) -> [f32; 3] {
    let lowest = if random.next() < 0.125 { -1.0 } else { 0.0 };
    random.direction(lowest)
}

/// A direction to a light: within a few lobe widths of the mirror direction, near the horizon, or anywhere.
fn towards_light(random: &mut Sequence, wo: [f32; 3], roughness: f32) -> Vec3 {
    let choice = random.next();
    if choice < 0.2 {
        return random.direction(-1.0).into();
    }
    let offset = Vec3::from_array(std::array::from_fn(|_| random.uniform(-1.0, 1.0)));
    let mirror = Vec3::new(-wo[0], -wo[1], wo[2].abs());
    let alpha = ggx_alpha(f64::from(roughness)) as f32;
    let near = mirror + 4.0 * alpha * offset;
    if choice < 0.4 {
        return near.with_z(0.1 * offset.z).normalize();
    }
    near.normalize()
}

#[test]
fn fresnel() {
    let mut random = Sequence(1);
    let mut rows = Vec::new();
    for c in [-1.0, 0.0, -0.0, 1e-30, 1e-6, 0.5, 1.0 - 6e-8, 1.0, 2.0] {
        for curve in [0.0, 1.0, 2.0] {
            rows.push([c, 0.04, curve, 0.5, 1.0]);
        }
    }
    for _ in 0..4000 {
        rows.push([
            random.next() * random.next(),
            random.next(),
            (2.0 * random.next()).round(),
            random.next(),
            random.next(),
        ]);
    }
    let tables = tables();
    Twin {
        name: "fresnel",
        modules: &[&shaders::LOBE_FRESNEL],
        snippet: "let f = FresnelRgb(vec3f(x[1], 0.5, 1.0), x[4], u32(x[2]));
            let r = fresnel_eval(table_3, f, x[0]);
            let e = lobe_fresnel(f, vec3f(0.0, 0.0, x[0]), x[3], table_3).albedo;
            y[0] = r.x; y[1] = r.y; y[2] = r.z;
            y[3] = e.x; y[4] = e.y; y[5] = e.z;",
        tables: &tables,
        expected: &|[c, f0, curve, roughness, f90]: [f64; 5]| {
            let f = FresnelRgb {
                f90,
                ..fresnel_of([f0, 0.5, 1.0], curve as usize)
            };
            let [r, e] = [f.eval(c), f.albedo(roughness, c.max(LOBE_MIN_COS))];
            [r[0], r[1], r[2], e[0], e[1], e[2]]
        },
        // Positions are rounded at 8e-6 of a node (127 is the largest); a node's step is at most about 0.1.
        tolerance: Tolerance {
            absolute: 4e-6,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}

#[test]
fn ggx() {
    let mut random = Sequence(2);
    let mut rows = Vec::new();
    for _ in 0..20_000 {
        let roughness = roughness(&mut random);
        let wo = viewer(&mut random);
        let wi = towards_light(&mut random, wo, roughness);
        rows.push([
            wo[0],
            wo[1],
            wo[2],
            roughness,
            wi.x,
            wi.y,
            wi.z,
            random.next(),
        ]);
    }
    rows.push([0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 1.0, 0.0]);
    rows.push([0.0, 0.0, 1.0, 2.0, 1e-20, 0.0, 1.0, 1.0]);
    Twin {
        name: "ggx",
        modules: &[&shaders::GGX, &shaders::FRESNEL],
        // The peak of D, 1 / (pi alpha^2), is divided out: what is left is compared on one scale.
        snippet: "let wo = vec3f(x[0], x[1], x[2]);
            let wi = vec3f(x[4], x[5], x[6]);
            let alpha = ggx_alpha(x[3]);
            let r = ggx_area_reflectance(0.7 * vec3f(1.0, 0.1 * x[7], 0.02), vec3f(x[7], 0.5, 1.0), 0.1 + 0.9 * x[7]);
            y[0] = alpha;
            y[1] = ggx_d(wo + wi, alpha) * alpha * alpha;
            y[2] = ggx_g1(wi.z, alpha);
            y[3] = ggx_visibility(abs(wi.z), abs(wo.z), alpha) * alpha * (abs(wi.z) + abs(wo.z));
            y[4] = ggx_eval(wi, wo, alpha) * alpha * alpha * alpha;
            y[5] = ggx_multiple_scattering(x[7], x[3]) * max(x[3], 1e-3);
            y[6] = r.x; y[7] = r.y; y[8] = r.z;
            y[9] = half_vector_cos(wi, wo);",
        tables: &[],
        expected: &|[ox, oy, oz, roughness, ix, iy, iz, f0]: [f64; 8]| {
            let (wo, wi) = (v(ox, oy, oz), v(ix, iy, iz));
            let alpha = ggx_alpha(roughness);
            let f0s = [f0, 0.5, 1.0];
            let r = ggx_area_reflectance([0.7, 0.07 * f0, 0.014], f0s, 0.1 + 0.9 * f0);
            [
                alpha,
                ggx_d(wo + wi, alpha) * alpha * alpha,
                ggx_g1(iz, alpha),
                ggx_visibility(iz.abs(), oz.abs(), alpha) * alpha * (iz.abs() + oz.abs()),
                ggx_eval(wi, wo, alpha) * alpha * alpha * alpha,
                ggx_multiple_scattering(f0, roughness) * roughness.max(1e-3),
                r[0],
                r[1],
                r[2],
                half_vector_cos(wi, wo),
            ]
        },
        // The half vector's tangential part is rounded at 6e-8, which is 3e-5 of the narrowest lobe's width; D goes with its
        // fourth power.
        tolerance: Tolerance {
            absolute: 1e-6,
            relative: 2e-4,
        },
    }
    .check(&rows, 0);
}

#[test]
fn tables_of_lobes() {
    let mut random = Sequence(3);
    let mut rows = vec![
        [0.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [1.0, 0.0],
        [-1.0, -1.0],
        [2.0, 2.0],
        [1.0 - 6e-8, 1e-30],
    ];
    for row in 0..LOBE_TABLE_SIZE {
        let (roughness, cos_o) = lobe_table_node(row, LOBE_TABLE_SIZE - 1 - row);
        rows.push([roughness as f32, cos_o as f32]);
    }
    for _ in 0..4000 {
        rows.push([random.next(), random.next() * random.next()]);
    }
    let tables = tables();
    Twin {
        name: "lobe_table_lookup",
        modules: &[&shaders::LOBE_TABLE],
        snippet: "let l = lobe_table_lookup(table_0, x[0], x[1]);
            let e = lobe_albedo_lookup(table_1, x[0], x[1]);
            let p = lobe_table_lookup(table_2, x[0], x[1]);
            y[0] = l.x; y[1] = l.y; y[2] = l.z; y[3] = e; y[4] = p.x; y[5] = p.y;",
        tables: &tables,
        expected: &|[roughness, cos_o]: [f64; 2]| {
            let l = ltc_table().lookup(roughness, cos_o);
            let e = albedo_lookup(roughness, cos_o);
            let p = sptd_table().lookup(roughness, cos_o);
            [l[0], l[1], l[2], e, p[0], p[1]]
        },
        // Positions are rounded at 2e-6 of a node (31 is the largest); a node's step is at most about 1.
        tolerance: Tolerance {
            absolute: 5e-6,
            relative: 1e-6,
        },
    }
    .check(&rows, 0);
}

#[test]
fn angles_and_frames() {
    let mut random = Sequence(4);
    let mut rows = vec![
        [0.0, 0.0, 0.0, 0.0, 1.0],
        [1e-30, -1.0, 0.0, 0.0, -1.0],
        [1.0, 0.0, 1e-7, 0.0, 1.0],
        [1.0, -1e-30, 1e-3, 0.0, 1.0],
        [1e-6, 1e6, 1.0, 0.0, 0.0],
    ];
    for _ in 0..4000 {
        let [x, y, z] = random.direction(-1.0);
        let scale = 10f32.powf(random.uniform(-8.0, 8.0));
        rows.push([
            random.next() * scale,
            random.uniform(-1.0, 1.0) * 10f32.powf(random.uniform(-8.0, 0.0)) * scale,
            x,
            y,
            z,
        ]);
    }
    Twin {
        name: "irradiance_angle and irradiance_basis",
        modules: &[&shaders::IRRADIANCE],
        snippet: "y[0] = irradiance_angle(x[0], x[1]);
            let sides = irradiance_basis(vec3f(x[2], x[3], x[4]));
            y[1] = sides.u.x; y[2] = sides.u.y; y[3] = sides.u.z;
            y[4] = sides.v.x; y[5] = sides.v.y; y[6] = sides.v.z;",
        tables: &[],
        expected: &|[sine, cosine, x, y, z]: [f64; 5]| {
            let (a, b) = irradiance_basis(v(x, y, z));
            [irradiance_angle(sine, cosine), a.x, a.y, a.z, b.x, b.y, b.z]
        },
        // Single precision, a few operations deep.
        tolerance: Tolerance {
            absolute: 5e-7,
            relative: 5e-7,
        },
    }
    .check(&rows, 0);
}

#[test]
fn elliptic_cones() {
    let mut random = Sequence(5);
    let mut rows = Vec::new();
    for _ in 0..20_000 {
        let [x, y, z] = random.direction(-1.0);
        let t1 = 10f32.powf(random.uniform(-4.0, 2.0));
        let t2 = t1 * 10f32.powf(random.uniform(0.0, 2.0) * random.next());
        // The horizon cuts one cone in four.
        let z = if random.next() < 0.25 {
            random.uniform(-1.0, 1.0) * (t2 / (1.0 + t2))
        } else {
            z
        };
        let [x, y, z] = Vec3::new(x, y, z).normalize_or(Vec3::X).to_array();
        rows.push([x, y, z, t1, t2, random.uniform(0.0, std::f32::consts::TAU)]);
    }
    Twin {
        name: "irradiance_cone",
        modules: &[&shaders::IRRADIANCE],
        // Over the cone's solid angle, or thereabouts.
        snippet: "let axis = vec3f(x[0], x[1], x[2]);
            let sides = irradiance_basis(axis);
            let side1 = sides.u * cos(x[5]) + sides.v * sin(x[5]);
            let scale = sqrt(1.0 + x[3] * x[3]) * sqrt(1.0 + x[4] * x[4]) / (x[3] * x[4]);
            let e = scale * irradiance_cone(EllipticCone(axis, x[3], side1, x[4], cross(axis, side1)));
            y[0] = e.x; y[1] = e.y; y[2] = e.z;",
        tables: &[],
        expected: &|[x, y, z, t1, t2, turn]: [f64; 6]| {
            let axis = v(x, y, z);
            let (a, b) = irradiance_basis(axis);
            let side1 = a * turn.cos() + b * turn.sin();
            let cone = EllipticCone {
                axis,
                side1,
                side2: axis.cross(side1),
                t1,
                t2,
            };
            let scale = (1.0 + t1 * t1).sqrt() * (1.0 + t2 * t2).sqrt() / (t1 * t2);
            (irradiance_cone(&cone) * scale).to_array()
        },
        // The arc above the horizon of the smallest cones, of 1e-4, ends within 6e-8 of its true end.
        tolerance: Tolerance { absolute: 3e-3, relative: 0.0 },
    }
    .check(&rows, 0);
}

/// Rows of two kinds.
#[derive(Default)]
struct Rows<const N: usize> {
    /// Lights clear of the horizon, seen from above 3 degrees.
    clear: Vec<[f32; N]>,
    /// Rows at the horizon.
    horizon: Vec<[f32; N]>,
}

impl<const N: usize> Rows<N> {
    /// Adds a row whose last column is the brightest that such a light gets; results are divided by it.
    ///
    /// A light of angular size s that the horizon cuts, or a lobe whose peak lies on it, leaves s^2 as a difference of terms
    /// in s that are rounded one by one: below 0.01 the tolerance grows with 1 / s.
    fn push(&mut self, mut row: [f32; N], elevation: f32, size: f32) {
        if row[2] > 0.05 && elevation > 2.0 * size {
            self.clear.push(row);
        } else {
            row[N - 1] *= (0.01 / size.max(1e-6)).max(1.0);
            self.horizon.push(row);
        }
    }
}

/// Single precision, some fifty operations deep, on lobes whose narrowest is 0.002 wide: 6e-8 is 3e-5 of that.
const CLEAR: Tolerance = Tolerance {
    absolute: 1e-3,
    relative: 1e-3,
};

/// See [`Rows::push`]. One row in a thousand may differ by more: a lobe that lies on the horizon sees a light narrower still.
const HORIZON: Tolerance = Tolerance {
    absolute: 5e-3,
    relative: 1e-2,
};

/// Viewer, roughness, direction and squared sine of a light, and the brightest that such a light gets.
fn sphere_rows(count: usize) -> Rows<9> {
    let mut random = Sequence(6);
    let mut rows = Rows::default();
    for _ in 0..count {
        let roughness = roughness(&mut random);
        let wo = viewer(&mut random);
        let mut axis = towards_light(&mut random, wo, roughness);
        let radius = 10f32.powf(random.uniform(-4.0, 0.19));
        if random.next() < 0.2 {
            // Cut by the horizon, or just not.
            axis = axis.with_z(1.1 * random.uniform(-1.0, 1.0) * radius.sin());
            axis = axis.normalize_or(Vec3::X);
        }
        let awkward = [0.0, 1.0, 2.0, 1.0 - 6e-8];
        let sin2 = if random.next() < 0.05 {
            awkward[(random.next() * 4.0) as usize]
        } else {
            radius.sin() * radius.sin()
        };
        let mut row = [0.0; 9];
        row[..3].copy_from_slice(&wo);
        row[3] = roughness;
        row[4..7].copy_from_slice(&axis.to_array());
        row[7] = sin2;
        let x = row.map(f64::from);
        let mirror = v(-x[0], -x[1], x[2].max(LOBE_MIN_COS)).normalize();
        let brightest = sphere_light(v(x[0], x[1], x[2]), x[3], schlick(), mirror, x[7])[2];
        row[8] = brightest.max(1e-12) as f32;
        rows.push(row, axis.z, sin2.sqrt());
    }
    rows
}

fn sphere_row(x: [f64; 9]) -> (DVec3, f64, DVec3, f64, f64) {
    (v(x[0], x[1], x[2]), x[3], v(x[4], x[5], x[6]), x[7], x[8])
}

#[test]
fn spheres() {
    let tables = tables();
    let mut twin = Twin {
        name: "sphere_light and lambert_sphere",
        modules: &[&shaders::LTC],
        snippet: "let axis = vec3f(x[4], x[5], x[6]);
            let lobe = ltc_lobe(vec3f(x[0], x[1], x[2]), x[3], table_0, table_1);
            let reflecting = lobe_fresnel(FresnelRgb(vec3f(0.04, 0.5, 1.0), 1.0, 0u), vec3f(x[0], x[1], x[2]), x[3], table_3);
            let i = ltc_sphere(lobe, reflecting, table_3, axis, x[7]) / x[8];
            y[0] = i.x; y[1] = i.y; y[2] = i.z;
            y[3] = lambert_sphere(axis, x[7]) / max(x[7], 1e-12);",
        tables: &tables,
        expected: &|row| {
            let (wo, roughness, axis, sin2, brightest) = sphere_row(row);
            let [i0, i1, i2] =
                sphere_light(wo, roughness, schlick(), axis, sin2).map(|i| i / brightest);
            [
                i0,
                i1,
                i2,
                lambert_sphere(axis, sin2) / sin2.max(1e-12),
            ]
        },
        tolerance: CLEAR,
    };
    let rows = sphere_rows(20_000);
    twin.check(&rows.clear, 0);
    twin.tolerance = HORIZON;
    twin.check(&rows.horizon, rows.horizon.len() / 1000);
}

/// Spreads of slopes of all sizes and shapes, from a direction.
fn slope_spread(axis: DVec3) -> SlopeSpread {
    let variance = 0.08 * axis.truncate().powf(4.0);
    SlopeSpread {
        variance,
        covariance: axis.z * (variance.x * variance.y).sqrt(),
    }
}

#[test]
fn filtered_lobes() {
    let tables = tables();
    let mut twin = Twin {
        name: "filtered_lobe and its parts under a sphere",
        modules: &[&shaders::FILTERED_LOBE, &shaders::ENVIRONMENT_LOBE],
        snippet: "let axis = vec3f(x[4], x[5], x[6]);
            let wo = vec3f(x[0], x[1], x[2]);
            let sharp = ltc_lobe(wo, x[3], table_0, table_1);
            let reflecting = lobe_fresnel(FresnelRgb(vec3f(0.04, 0.5, 1.0), 1.0, 0u), wo, x[3], table_3);
            let variance = 0.08 * axis.xy * axis.xy * axis.xy * axis.xy;
            let spread = vec3f(variance, axis.z * sqrt(variance.x * variance.y));
            let filtered = filtered_lobe(sharp.alpha, spread, wo.z);
            for (var p = 0u; p < 2u; p += 1u) {
                let part = filtered_lobe_part(sharp, filtered, p);
                y[p] = ltc_sphere(part.lobe, reflecting, table_3, axis, x[7]).y / x[8];
                y[2u + p] = part.core;
                y[4u + p] = part.lobe.alphas[p];
                let around = filtered_lobe_part(sharp, filtered_lobe_around(sharp.alpha, spread, wo.z), p);
                let tap = environment_tap(environment_lobe(around.lobe, table_0), table_0, 2u);
                y[6u + p] = tap.roughness;
                y[8u + p] = tap.direction.y;
                y[10u + p] = tap.weight;
            }
            for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
                y[12u + p] = filtered_lobe_weight(filtered_lobe_part(sharp, filtered, p), filtered_lobe_far(filtered, axis));
            }",
        tables: &tables,
        expected: &|row| {
            let (wo, roughness, axis, sin2, brightest) = sphere_row(row);
            let sharp = ltc_lobe(wo, roughness);
            let of = LobeFresnel::new(schlick(), wo, roughness);
            let filtered = filtered_lobe(sharp.alpha, slope_spread(axis), wo.z);
            let parts = filtered.parts(&sharp);
            let [first, second] = [0, 1].map(|p| parts[p].lobe);
            let weights = parts.map(|part| part.weight(filtered.far(axis)));
            let [i0, i1] =
                [first, second].map(|lobe| ltc_sphere(&lobe, &of, axis, sin2)[1] / brightest);
            let around = filtered_lobe_around(sharp.alpha, slope_spread(axis), wo.z).parts(&sharp);
            let [t0, t1] = [0, 1].map(|p| environment_lobe(&around[p].lobe).environment_tap(2));
            let alphas = [first.alphas.x, second.alphas.y];
            let directions = [t0.direction.y, t1.direction.y];
            [
                i0,
                i1,
                parts[0].core,
                parts[1].core,
                alphas[0],
                alphas[1],
                t0.roughness,
                t1.roughness,
                directions[0],
                directions[1],
                t0.weight,
                t1.weight,
                weights[0],
                weights[1],
                weights[2],
            ]
        },
        tolerance: CLEAR,
    };
    let rows = sphere_rows(20_000);
    twin.check(&rows.clear, 0);
    twin.tolerance = HORIZON;
    twin.check(&rows.horizon, rows.horizon.len() / 1000);
}

#[test]
fn pivots() {
    let tables = tables();
    let mut twin = Twin {
        name: "sptd_sphere_published",
        modules: &[&hairline_published::shaders::SPTD],
        snippet: "let axis = vec3f(x[4], x[5], x[6]);
            let lobe = sptd_lobe(vec3f(x[0], x[1], x[2]), x[3], table_2, table_1);
            y[0] = sptd_sphere_published(lobe, axis, x[7]) / x[8];",
        tables: &tables,
        expected: &|row| {
            let (wo, roughness, axis, sin2, brightest) = sphere_row(row);
            let lobe = sptd_lobe(wo, roughness);
            [sptd_sphere_published(&lobe, axis, sin2) / brightest]
        },
        tolerance: CLEAR,
    };
    let rows = sphere_rows(20_000);
    twin.check(&rows.clear, 0);
    twin.tolerance = HORIZON;
    twin.check(&rows.horizon, rows.horizon.len() / 1000);
}

/// Viewer, roughness, four vertices (an arrow head, so not convex, or a kite), and the brightest that such a light gets.
fn polygon_rows(count: usize) -> Rows<17> {
    let mut random = Sequence(7);
    let mut rows = Rows::default();
    for _ in 0..count {
        let roughness = roughness(&mut random);
        let wo = viewer(&mut random);
        let mut centre = towards_light(&mut random, wo, roughness);
        let size = 10f32.powf(random.uniform(-4.0, 0.5));
        if random.next() < 0.2 {
            centre = centre.with_z(random.uniform(-1.0, 1.0) * size.min(1.0));
            centre = centre.normalize_or(Vec3::X);
        }
        let (a, b) = centre.any_orthonormal_pair();
        // Seen obliquely up to 63 degrees, stretched up to 20 times, at any distance.
        let a = a + random.uniform(-2.0, 2.0) * centre;
        let (thin, start) = (
            random.uniform(0.05, 1.0),
            random.uniform(0.0, std::f32::consts::TAU),
        );
        let distance = 10f32.powf(random.uniform(-2.0, 2.0));
        let notch = random.uniform(-0.3, 1.0);
        let mut row = [0.0; 17];
        row[..3].copy_from_slice(&wo);
        row[3] = roughness;
        for i in 0..4 {
            let (s, c) = (start + i as f32 * std::f32::consts::FRAC_PI_2).sin_cos();
            let reach = if i == 0 { notch } else { 1.0 };
            let corner = distance * (centre + reach * size * (c * a + thin * s * b));
            row[4 + 3 * i..7 + 3 * i].copy_from_slice(&corner.to_array());
        }
        let (wo, roughness, corners, _) = polygon_row(row.map(f64::from));
        let middle = corners.iter().sum::<DVec3>() / 4.0;
        let diagonals = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
        let solid_angle = 0.5 * diagonals.length() / middle.length_squared();
        let mirror = v(-wo.x, -wo.y, wo.z.max(LOBE_MIN_COS)).normalize();
        let sin2 = (solid_angle / PI).min(1.0 - 1e-9);
        row[16] = sphere_light(wo, roughness, schlick(), mirror, sin2)[2].max(1e-12) as f32;
        // The longest half diagonal, seen on, is sqrt(5) times `size`.
        let narrow = size * thin;
        rows.push(row, centre.z - 2.3 * size, narrow);
    }
    rows
}

fn polygon_row(x: [f64; 17]) -> (DVec3, f64, [DVec3; 4], f64) {
    let corners = std::array::from_fn(|i| v(x[4 + 3 * i], x[5 + 3 * i], x[6 + 3 * i]));
    (v(x[0], x[1], x[2]), x[3], corners, x[16])
}

#[test]
fn polygons() {
    let tables = tables();
    let mut twin = Twin {
        name: "ltc_begin, ltc_edge, ltc_end and lambert's",
        modules: &[&shaders::LTC],
        snippet: "let lobe = ltc_lobe(vec3f(x[0], x[1], x[2]), x[3], table_0, table_1);
            var ltc = ltc_begin();
            var lambert = lambert_begin();
            for (var i = 0; i < 4; i += 1) {
                let j = (i + 1) % 4;
                let a = vec3f(x[4 + 3 * i], x[5 + 3 * i], x[6 + 3 * i]);
                let b = vec3f(x[4 + 3 * j], x[5 + 3 * j], x[6 + 3 * j]);
                ltc_edge(&ltc, lobe, a, b);
                lambert_edge(&lambert, a, b);
            }
            let reflecting = lobe_fresnel(FresnelRgb(vec3f(0.04, 0.5, 1.0), 1.0, 0u), vec3f(x[0], x[1], x[2]), x[3], table_3);
            let i = ltc_end(ltc, lobe, reflecting, table_3) / x[16];
            y[0] = i.x; y[1] = i.y; y[2] = i.z;
            y[3] = lambert_end(lambert);",
        tables: &tables,
        expected: &|row| {
            let (wo, roughness, corners, brightest) = polygon_row(row);
            let [i0, i1, i2] =
                polygon_light(wo, roughness, schlick(), &corners).map(|i| i / brightest);
            [i0, i1, i2, lambert_polygon(&corners)]
        },
        tolerance: CLEAR,
    };
    let rows = polygon_rows(20_000);
    twin.check(&rows.clear, 0);
    twin.tolerance = HORIZON;
    twin.check(&rows.horizon, rows.horizon.len() / 1000);
}

#[test]
fn small_lights() {
    let tables = tables();
    let rows = polygon_rows(20_000);
    Twin {
        name: "ltc_small_light",
        modules: &[&shaders::LTC],
        snippet: "let lobe = ltc_lobe(vec3f(x[0], x[1], x[2]), x[3], table_0, table_1);
            let reflecting = lobe_fresnel(FresnelRgb(vec3f(0.04, 0.5, 1.0), 1.0, 0u), vec3f(x[0], x[1], x[2]), x[3], table_3);
            // Above the horizon of the cosine's space.
            let i = ltc_small_light(lobe, reflecting, table_3, normalize(vec3f(x[4], x[5], abs(x[6]) + 0.05)));
            y[0] = i.x; y[1] = i.y; y[2] = i.z;",
        tables: &tables,
        expected: &|row| {
            let (wo, roughness, ..) = polygon_row(row);
            let of = LobeFresnel::new(schlick(), wo, roughness);
            let vector = v(row[4], row[5], row[6].abs() + 0.05).normalize();
            ltc_small_light(&ltc_lobe(wo, roughness), &of, vector)
        },
        tolerance: CLEAR,
    }
    .check(&rows.clear, 0);
}

/// A look-up of whatever viewer is somewhere, no wider than any lobe, the first one counts, and the last one takes away.
fn is_tap(i: usize, [x, y, z, roughness, weight, grazing_weight]: [f64; 6]) -> bool {
    let length = (x * x + y * y + z * z).sqrt();
    (length - 1.0).abs() < 1e-4
        && (0.0..=1.0).contains(&roughness)
        && [weight, grazing_weight].into_iter().all(|w| match i {
            0 => (1e-3..=1.5).contains(&w),
            _ if i + 1 == ENVIRONMENT_TAPS => (-0.5..=0.0).contains(&w),
            _ => (0.0..=1.5).contains(&w),
        })
}

#[test]
fn environments() {
    let tables = tables();
    let mut random = Sequence(12);
    let mut rows = Vec::new();
    for _ in 0..20_000 {
        let [x, y, z] = viewer(&mut random);
        let roughness = roughness(&mut random);
        rows.extend((0..ENVIRONMENT_TAPS).map(|i| [x, y, z, roughness, i as f32]));
    }
    let mut twin = Twin {
        name: "environment_tap",
        modules: &[&shaders::ENVIRONMENT_LOBE],
        snippet: "let lobe = ltc_lobe(vec3f(x[0], x[1], x[2]), x[3], table_0, table_1);
            let tap = environment_tap(environment_lobe(lobe, table_0), table_0, u32(x[4]));
            y[0] = tap.direction.x; y[1] = tap.direction.y; y[2] = tap.direction.z;
            y[3] = tap.roughness; y[4] = tap.weight; y[5] = tap.grazing_weight;",
        tables: &tables,
        expected: &|[x, y, z, roughness, i]: [f64; 5]| {
            let lobe = environment_lobe(&ltc_lobe(v(x, y, z), roughness));
            let tap = lobe.environment_tap(i as usize);
            let d = tap.direction;
            let values = [d.x, d.y, d.z, tap.roughness, tap.weight, tap.grazing_weight];
            assert!(
                is_tap(i as usize, values),
                "{x} {y} {z} {roughness}: {tap:?}"
            );
            values
        },
        // Directions to a tenth of the narrowest lobe.
        tolerance: Tolerance {
            absolute: 2e-4,
            relative: 1e-3,
        },
    };
    let (smooth, rough): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row[3] < 0.7);
    twin.check(&smooth, 0);
    // A lobe that is as good as round is drawn out by the root of a rounding.
    twin.tolerance.absolute = 4e-3;
    twin.check(&rough, 0);
    // Nothing like a viewer.
    let wild: Vec<[f32; 5]> = wild_rows(100_000)
        .iter()
        .zip(0..)
        .map(|(row, i)| {
            [
                row[0],
                row[1],
                row[2],
                row[3],
                (i % ENVIRONMENT_TAPS) as f32,
            ]
        })
        .collect();
    twin.name = "environment_tap of anything";
    twin.check(&wild, 0);
}

/// A viewer, a roughness, a light's direction and squared sine, three more vertices, two half-axes' tangents; many
/// degenerate on purpose.
fn wild_rows(count: usize) -> Vec<[f32; 19]> {
    let mut random = Sequence(8);
    let awkward = [0.0, -0.0, 1.0, -1.0, 1e-30, 1e-12, 1e-6, 1e6];
    let mut rows = Vec::new();
    for _ in 0..count {
        let mut row: [f32; 19] = std::array::from_fn(|_| {
            if random.next() < 0.25 {
                awkward[(random.next() * 8.0) as usize]
            } else {
                random.uniform(-1.0, 1.0) * 10f32.powf(random.uniform(-6.0, 3.0))
            }
        });
        row[..3].copy_from_slice(&random.direction(-1.0));
        row[4..7].copy_from_slice(&random.direction(-1.0));
        (row[17], row[18]) = (row[17].abs().max(1e-6), row[18].abs().max(1e-6));
        rows.push(row);
    }
    rows
}

#[test]
fn never_nan_in_the_shader() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let tables = tables();
    let call = Call {
        modules: &[&hairline_published::shaders::SPTD],
        snippet: "let wo = vec3f(x[0], x[1], x[2]);
            let lobe = ltc_lobe(wo, x[3], table_0, table_1);
            let pivot = sptd_lobe(wo, x[3], table_2, table_1);
            var corners = array<vec3f, 4>(vec3f(x[4], x[5], x[6]), vec3f(x[8], x[9], x[10]), vec3f(x[11], x[12], x[13]), vec3f(x[14], x[15], x[16]));
            var ltc = ltc_begin();
            var lambert = lambert_begin();
            for (var i = 0; i < 4; i += 1) {
                ltc_edge(&ltc, lobe, corners[i], corners[(i + 1) % 4]);
                lambert_edge(&lambert, corners[i], corners[(i + 1) % 4]);
            }
            let axis = corners[0];
            let sides = irradiance_basis(axis);
            let cone = EllipticCone(axis, min(x[17], x[18]), sides.u, max(x[17], x[18]), sides.v);
            let reflecting = lobe_fresnel(FresnelRgb(vec3f(0.04, 0.5, 1.0), 1.0, 0u), vec3f(x[0], x[1], x[2]), x[3], table_3);
            let of_polygon = ltc_end(ltc, lobe, reflecting, table_3);
            let of_sphere = ltc_sphere(lobe, reflecting, table_3, axis, x[7]);
            y[0] = of_polygon.x;
            y[1] = lambert_end(lambert);
            y[2] = of_sphere.x;
            y[3] = lambert_sphere(axis, x[7]);
            y[4] = sptd_sphere_published(pivot, axis, x[7]);
            y[5] = length(irradiance_cone(cone)) / 3.1416;
            y[6] = min(ggx_eval(axis, wo, lobe.alpha), 1.0);
            y[7] = of_polygon.y; y[8] = of_polygon.z; y[9] = of_sphere.y; y[10] = of_sphere.z;",
        tables: &tables,
    };
    let rows = wild_rows(1_000_000);
    let results: Vec<[f32; 11]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, result) in rows.iter().zip(&results) {
        // No light returns more than the whole hemisphere's; the albedo table is good to 0.005.
        let good = result.iter().all(|v| (0.0..=1.01).contains(v));
        assert!(good, "{row:?}: {result:?}");
    }
}

#[test]
fn never_nan_in_the_optics() {
    for row in wild_rows(1_000_000) {
        let x = row.map(f64::from);
        let at = |i: usize| v(x[i], x[i + 1], x[i + 2]);
        let (wo, axis) = (at(0), at(4).normalize());
        let corners = [at(4), at(8), at(11), at(14)];
        let (side1, side2) = irradiance_basis(axis);
        let cone = EllipticCone {
            axis,
            side1,
            side2,
            t1: x[17].min(x[18]),
            t2: x[17].max(x[18]),
        };
        let (lobe, pivot) = (ltc_lobe(wo, x[3]), sptd_lobe(wo, x[3]));
        let of_polygon = polygon_light(wo, x[3], schlick(), &corners);
        let reflecting = LobeFresnel::new(schlick(), wo, x[3]);
        let of_sphere = ltc_sphere(&lobe, &reflecting, axis, x[7]);
        let results = [
            of_polygon[0],
            of_polygon[1],
            of_polygon[2],
            lambert_polygon(&corners),
            of_sphere[0],
            of_sphere[1],
            of_sphere[2],
            lambert_sphere(axis, x[7]),
            sptd_sphere_published(&pivot, axis, x[7]),
            irradiance_cone(&cone).length() / PI,
            ggx_eval(axis, wo, lobe.alpha).min(1.0),
        ];
        let good = results.iter().all(|v| (0.0..=1.01).contains(v));
        assert!(good, "{row:?}: {results:?}");
    }
}

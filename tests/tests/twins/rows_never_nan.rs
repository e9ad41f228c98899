//! A million random rows of grooves, views and lights, many of them at an end of their range: every result is a number, and no light is negative.

use super::twin::Sequence;
use glam::{DVec2, DVec3};
use hairline_gpu::call::{Call, Table, Texels};
use hairline_gpu::{headless, shaders};
use hairline_optics::band::*;
use hairline_optics::grating::{GRATING_DEPTH_NM, GRATING_WIDTH_UM, Grating as Row};
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::table::{COLUMNS, ROWS, ScratchTable};
use std::sync::LazyLock;

const CONFIGURATIONS: usize = 250_000;

/// A random number in a range of scene files, often at one of its ends.
fn random_in_range(random: &mut Sequence, low: f64, high: f64) -> f64 {
    match random.next() {
        r if r < 0.1 => low,
        r if r < 0.2 => high,
        // As many small numbers as large ones.
        r if low > 0.0 && r < 0.6 => low * (high / low).powf(f64::from(random.next())),
        _ => f64::from(random.uniform(low as f32, high as f32)).clamp(low, high),
    }
}

fn row(random: &mut Sequence) -> Row {
    let pitch_um = random_in_range(random, 0.3, 50.0);
    Row {
        pitch_um,
        width_um: random_in_range(random, 1e-3 * pitch_um, pitch_um),
        depth_nm: random_in_range(random, 0.0, 2000.0),
        depth_spread: random_in_range(random, 0.0, 1.0),
        jitter_um: random_in_range(random, 0.0, pitch_um),
    }
}

fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[test]
fn formulas_of_rows() {
    let mut random = Sequence(21);
    for _ in 0..CONFIGURATIONS {
        let row = row(&mut random);
        let q = random_in_range(&mut random, -2.0, 2.0);
        let share = random_in_range(&mut random, 0.0, 1.0);
        let wavelength_nm = random_in_range(&mut random, 380.0, 780.0);
        let band_std = random_in_range(&mut random, 1e-3, 0.05);
        let density = row.density(q, share, wavelength_nm, band_std);
        assert!(
            density.is_finite() && density > -1e-9,
            "{row:?} {q} {share} {wavelength_nm} {band_std}: {density}"
        );
        for order in [-3, 0, 1] {
            let energy = row.order_energy(order, share, wavelength_nm);
            assert!(
                (0.0..4.0 + 1e-9).contains(&energy),
                "{row:?} {order}: {energy}"
            );
        }
    }
}

/// Rows at the ends of their ranges and between.
static TABLES: LazyLock<Vec<ScratchTable>> = LazyLock::new(|| {
    let mut random = Sequence(22);
    let edges = [
        [0.3, 0.3, 2000.0, 0.0, 0.0],
        [50.0, 0.05, 2000.0, 1.0, 50.0],
        [1.6, 0.6, 0.0, 0.0, 0.0],
    ];
    let rows = edges.map(
        |[pitch_um, width_um, depth_nm, depth_spread, jitter_um]| Row {
            pitch_um,
            width_um,
            depth_nm,
            depth_spread,
            jitter_um,
        },
    );
    let drawn = [(); 5].map(|()| row(&mut random));
    let all = rows.into_iter().chain(drawn);
    all.map(|row| row.table(20.0, |_| 1.0)).collect()
});

/// Unit directions to viewer and light, the sine of the light's radius, across the band, table, turns of the grooves and their scatter, angle of the grooves.
const INPUTS: usize = 13;

/// Views and lights: grazing, straight above, behind the surface, touching its horizon.
fn views(count: usize) -> Vec<[f32; INPUTS]> {
    let mut random = Sequence(23);
    let direction = |random: &mut Sequence, lowest: f32| match random.next() {
        r if r < 0.05 => [0.0, 0.0, 1.0],
        r if r < 0.2 => {
            let angle = random.uniform(0.0, std::f32::consts::TAU);
            let z = random.uniform(0.0, 1.0).powi(4) * 0.01;
            let side = (1.0 - z * z).sqrt();
            [side * angle.cos(), side * angle.sin(), z.max(0.01)]
        }
        _ => random.direction(lowest),
    };
    (0..count)
        .map(|_| {
            let mut row = [0.0; INPUTS];
            row[..3].copy_from_slice(&direction(&mut random, 0.01));
            row[3..6].copy_from_slice(&direction(&mut random, -1.0));
            row[6] = match random.next() {
                // Touching the horizon.
                r if r < 0.1 => row[5].abs().min(0.999),
                r if r < 0.2 => 1e-6,
                _ => random.next().powi(3) * 0.999,
            };
            row[7] = random_in_range(&mut random, -0.1, 0.1) as f32;
            row[8] = (random.next() * TABLES.len() as f32).floor();
            row[9] = random_in_range(&mut random, -3.0, 3.0) as f32;
            row[10] = random.uniform(-1e-3, 1e-3);
            row[11] = random_in_range(&mut random, 0.0, 1.6) as f32;
            row[12] = random.uniform(0.0, 6.3);
            row
        })
        .collect()
}

#[test]
fn light_of_rows() {
    for row in views(CONFIGURATIONS) {
        let x = row.map(f64::from);
        let v = |at: usize| DVec3::new(x[at], x[at + 1], x[at + 2]);
        let frame = BandFrame {
            tangent: DVec2::from_angle(x[12]),
        };
        let cap = Cap {
            axis: v(3),
            sin_radius: x[6],
            cos_radius: (1.0 - x[6] * x[6]).sqrt(),
        };
        let line = BandLine::new(frame.band_from_surface(v(0)), x[7]);
        let chord = sphere_chord(line, cap.turned(frame));
        let (low, high) = chord.range(line);
        let cos_i = chord_cos(line, low, high, 0.0);
        let table = TABLES[x[8] as usize].at_depth(oblique_depth_nm(GRATING_DEPTH_NM, cos_i, x[2]));
        let sent = chord.integral(line, |q| table.at(GRATING_WIDTH_UM * q));
        let all = sent;
        // Columns hold T in single precision.
        assert!(
            all.iter().all(|v| v.is_finite()) && luminance(all) > -1e-4,
            "{row:?}: {all:?}"
        );
    }
}

#[test]
fn light_of_rows_in_the_shader() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let texels: Vec<[u32; 4]> = TABLES
        .iter()
        .flat_map(|table| table.texels.clone())
        .collect();
    let tables = [Table {
        size: [COLUMNS as u32, ROWS as u32],
        layers: Some(TABLES.len() as u32),
        texels: Texels::Integers(&texels),
    }];
    let call = Call {
        modules: &[&shaders::GRATING, &shaders::SINGLE_GROOVES],
        snippet: "let wo = vec3f(x[0], x[1], x[2]);
            let towards = vec3f(x[3], x[4], x[5]);
            let point = LitPoint(wo, 0.3, vec2f(100.0, 0.0), vec2f(0.0, 1e3), vec2f(0.0), vec2f(0.01), 20.0, u32(x[8]));
            let tangent = vec2f(cos(x[12]), sin(x[12]));
            let seen = row_seen(tangent, 0.5, vec2f(x[9], x[10]), x[11], false);
            let sphere = scratch_sphere(table_0, point, seen, towards, x[6]);
            let right = vec3f(tangent, 0.0) * x[6];
            let up = cross(towards, right);
            let quad = QuadLight(towards - right - up, towards - right + up, towards + right + up, towards + right - up, 4u, -towards, towards, 2.0 * x[6], true);
            let flat = scratch_quad(table_0, point, seen, quad);
            let line = band_line_at(band_from_surface(tangent, wo), 0.0);
            let cell = row_cell(u32(x[12] * 7.0), line);
            let around = scratch_chord(table_0, point, seen, cell.q_high, cell.q_low, cell.direction.z);
            let tangent_3d = vec3f(tangent, 0.0);
            let grating = Grating(towards, u32(x[8]) % 4u, vec3f(0.0), 20.0, vec2f(0.0, x[6]), 1.0, x[11], 0u, 0u, u32(x[8]), 1e3 * x[6], 400.0 * x[6], abs(x[10]), 4.0, 0u, vec4f(0.0), vec4f(0.0), vec4f(0.0), vec2u(0u), vec2u(0u), tangent_3d, select(0.0, x[6], (u32(x[8]) & 4u) != 0u));
            let course = groove_course_straight(grating);
            let arm = groove_arm(grating, wo * x[6]);
            let place = groove_place(grating, course, wo * x[6], wo, towards * x[7], cross(towards, wo) * x[10]);
            let density = groove_density(grating, course, arm, wo, place.tangent, towards * x[7], cross(towards, wo) * x[10], 20.0);
            y[0] = dot(sphere, vec3f(0.2126, 0.7152, 0.0722));
            y[1] = dot(flat, vec3f(0.2126, 0.7152, 0.0722));
            y[2] = dot(around, vec3f(0.2126, 0.7152, 0.0722));
            y[3] = density + place.share + abs(place.turns_rad.x) + abs(place.turns_rad.y) + dot(place.tangent, place.tangent);",
        tables: &tables,
    };
    let rows = views(CONFIGURATIONS);
    let results: Vec<[f32; 4]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, result) in rows.iter().zip(&results) {
        let all = result.iter().all(|v| v.is_finite() && *v > -1e-3);
        assert!(all, "{row:?}: {result:?}");
    }
}

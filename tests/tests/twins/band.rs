//! Lights on the band of a scratch.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::shaders;
use hairline_optics::band::*;
use hairline_optics::band_environment::{ENVIRONMENT_CELLS, environment_cell};

const STD_XI: f64 = 0.0031;
const STDS: BandStds = BandStds {
    mean: STD_XI,
    channels: [0.0036, 0.003, 0.0025],
};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

#[test]
fn lines() {
    let mut random = Sequence(1);
    let s = STD_XI as f32;
    let mut rows = vec![
        [-1.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.3],
        [0.1, 0.2, 0.0, 0.3],
        [-3.9 * s, -3.8 * s, 2.0, 0.3],
        [s, 0.5 * s, 0.0, 0.3],
        [-0.01, 2.0, 4.0, 1.0],
    ];
    for _ in 0..1000 {
        let (low, extent) = (
            random.uniform(-5.0, 5.0) * s,
            10f32.powf(random.uniform(-2.0, 2.0)) * s,
        );
        // Well away from the extents at which the number of lines changes.
        let half = 0.5 * extent / s;
        if (half - 3.0).abs() > 0.01 && (half - 16.0).abs() > 0.01 {
            let i = (random.next() * 5.0).floor();
            rows.push([low, low + extent, i, random.uniform(-0.9, 0.9)]);
        }
    }
    Twin {
        name: "band_lines and band_line",
        modules: &[&shaders::BAND],
        snippet: "let lines = band_lines(x[3], x[0], x[1], vec4f(0.0036, 0.003, 0.0025, 0.0031));
            y[0] = f32(lines.count); y[4] = lines.channel_shares.x; y[5] = lines.channel_shares.z;
            if u32(x[2]) < lines.count {
                let line = band_line(lines, u32(x[2]));
                y[1] = line.w; y[2] = line.x; y[3] = line.z;
            }",
        tables: &[],
        expected: &|[low, high, i, wo_t]: [f64; 4]| {
            let lines = band_lines(wo_t, low, high, STDS);
            let (xi_t, weight) = if (i as usize) < lines.count {
                lines.band_line(i as usize)
            } else {
                (0.0, DVec3::ZERO)
            };
            let [red, _, blue] = lines.channel_shares;
            [lines.count as f64, xi_t, weight.x, weight.z, red, blue]
        },
        // A share is right to 1.5e-7 and rounded by 6e-8, which in the tail at 4 standard deviations moves a line by 1.5e-3 of
        // one, and its weights by 3e-3 of theirs.
        tolerance: Tolerance {
            absolute: 1e-5,
            relative: 3e-3,
        },
    }
    .check(&rows, 0);
}

#[test]
fn spheres() {
    let mut random = Sequence(2);
    let mut rows = Vec::new();
    for _ in 0..20_000 {
        let (wo, axis) = (random.direction(0.0), random.direction(-1.0));
        let sine = if random.next() < 0.1 {
            0.0
        } else {
            10f32.powf(random.uniform(-3.0, 0.0))
        };
        let xi_t = if random.next() < 0.3 {
            0.0
        } else {
            random.uniform(-0.01, 0.01)
        };
        rows.push([wo[0], wo[1], wo[2], axis[0], axis[1], axis[2], sine, xi_t]);
    }
    // Lights on the band, so that chords are met: the axis is turned to the line.
    for row in &mut rows[..10_000] {
        let along = (row[7] - row[0] + 0.5 * row[6] * (row[5] - 0.3)).clamp(-1.0, 1.0);
        let rest = (1.0 - along * along).sqrt() / row[4].hypot(row[5]).max(1e-6);
        (row[3], row[4], row[5]) = (along, row[4] * rest, row[5] * rest);
    }
    let call = |[ox, oy, oz, ax, ay, az, sine, xi_t]: [f64; 8]| {
        let cap = Cap {
            axis: v(ax, ay, az),
            sin_radius: sine,
            cos_radius: (1.0 - sine * sine).max(0.0).sqrt(),
        };
        (cap, BandLine::new(v(ox, oy, oz), xi_t), v(ox, oy, oz))
    };
    Twin {
        name: "sphere_chord",
        modules: &[&shaders::BAND],
        // Chords are compared by what they add up to, with the identity for antiderivative: roots may legitimately trade
        // places with the arc's ends.
        snippet: "let cap = Cap(vec3f(x[3], x[4], x[5]), x[6], sqrt(max(1.0 - x[6] * x[6], 0.0)));
            let line = band_line_at(vec3f(x[0], x[1], x[2]), x[7]);
            let chord = sphere_chord(line, cap);
            y[0] = chord.enter - chord.leave + chord.wraps * (band_q_start(line) - band_q_end(line));
            let extent = sphere_band_extent(vec3f(x[0], x[1], x[2]), cap);
            y[1] = extent.x; y[2] = extent.y;",
        tables: &[],
        expected: &|row| {
            let (cap, line, wo) = call(row);
            let extent = sphere_band_extent(wo, cap);
            [sphere_chord(line, cap).integral(line, |q| [q])[0], extent.0, extent.1]
        },
        // Near the cap's rim the chord is the square root of a rounded difference.
        tolerance: Tolerance { absolute: 1e-3, relative: 1e-3 },
    }
    // Directions within rounding of the tangent's pole or of the rim of a cap that holds it may fall on either side.
    .check(&rows, rows.len() / 2000);
}

#[test]
fn band_widths() {
    Twin {
        name: "band_stds",
        modules: &[&shaders::BAND],
        snippet: "let stds = band_stds(x[0]); y[0] = stds.x; y[1] = stds.y; y[2] = stds.z; y[3] = stds.w;",
        tables: &[],
        expected: &|[sigma]: [f64; 1]| {
            let BandStds { mean, channels: [red, green, blue] } = band_stds(sigma);
            [red, green, blue, mean]
        },
        tolerance: Tolerance { absolute: 0.0, relative: 1e-6 },
    }
    .check(&[[20.0], [5.0], [100.0]], 0);
}

#[test]
fn band_integrals() {
    let mut random = Sequence(8);
    let mut rows = Vec::new();
    for _ in 0..1000 {
        let low = random.uniform(-3.0, 3.0) * STD_XI as f32;
        let extent = 10f32.powf(random.uniform(-1.5, 2.0)) * STD_XI as f32;
        rows.push([low, low + extent]);
    }
    // Well away from the extents at which the number of lines changes.
    rows.retain(|[low, high]| {
        let half = 0.5 * (high - low) / STD_XI as f32;
        (half - 3.0).abs() > 0.01 && (half - 16.0).abs() > 0.01
    });
    Twin {
        name: "band_integral",
        modules: &[&shaders::BAND],
        snippet: "let lines = band_lines(0.3, x[0], x[1], vec4f(0.0036, 0.003, 0.0025, 0.0031));
            var sum = vec3f(0.0);
            var weights = vec3f(0.0);
            for (var i = 0u; i < lines.count; i += 1u) {
                let line = band_line(lines, i);
                sum += line.xyz * vec3f(1.0, 2.0, 1.0 + 50.0 * line.w);
                weights += line.xyz;
            }
            let integral = band_integral(lines, sum, weights);
            y[0] = integral.x; y[1] = integral.y; y[2] = integral.z;",
        tables: &[],
        expected: &|[low, high]: [f64; 2]| {
            let wo = v(0.3, 0.0, 0.9);
            let integral = band_lines(wo.x, low, high, STDS)
                .integral(wo, |line| [1.0, 2.0, 1.0 + 50.0 * (line.along + wo.x)]);
            integral.to_array()
        },
        // A share is right to 1.5e-7.
        tolerance: Tolerance {
            absolute: 2e-6,
            relative: 1e-4,
        },
    }
    .check(&rows, 0);
}

#[test]
fn moving_bands() {
    let mut random = Sequence(5);
    // Everything still; a turn beyond all bounds; a footprint of no size.
    let mut rows = vec![
        [0.003, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        [0.003, 1e6, 1.0, 100.0, 3.0, 50.0, 1.0, 0.0, 5.0],
        [0.003, 0.1, 0.2, 0.0, 0.0, 40.0, 1.0, 0.0, 5.0],
    ];
    for _ in 0..5000 {
        let scale = 10f32.powf(random.uniform(-5.0, 0.0));
        let wide = 10f32.powf(random.uniform(0.0, 3.5));
        let mut pick = |to: f32| random.uniform(-to, to);
        let (x, y) = (pick(scale), pick(scale));
        let (along, across, offset) = (pick(wide), pick(wide), pick(2.0 * wide));
        let std = random.uniform(0.001, 0.02);
        let wi = random.direction(0.0);
        rows.push([std, x, y, along, across, offset, wi[0], wi[1], wi[2]]);
    }
    Twin {
        name: "band_moves and moved_band",
        modules: &[&shaders::BAND],
        snippet: "let wi = vec3f(x[6], x[7], x[8]);
            let wo = vec3f(0.6, 0.0, 0.8);
            let moves = vec2f(
                band_moves(vec2f(x[1], 0.0), vec3f(x[3], x[4], 0.0), wo, 2e-6, wi, 1e-5).x,
                band_moves(vec2f(x[2], 0.0), vec3f(-x[4], x[3], 0.0), wo, 2e-6, wi, 1e-5).x,
            );
            let across = vec2f(x[4], x[3]);
            let band = moved_band(x[0] * vec4f(1.1, 1.0, 0.8, 1.05), moves, across, x[5], dot(across, across) + 200.0);
            y[0] = band.shift; y[1] = band.stds.x; y[2] = band.stds.z; y[3] = band.stds.w;",
        tables: &[],
        expected: &|[std, turn_x, turn_y, along, across, offset, wx, wy, wz]: [f64; 9]| {
            let (wi, wo) = (v(wx, wy, wz), v(0.6, 0.0, 0.8));
            let stds = BandStds { mean: 1.05 * std, channels: [1.1, 1.0, 0.8].map(|c| c * std) };
            let moves = [
                band_moves(DVec2::new(turn_x, 0.0), v(along, across, 0.0), wo, 2e-6, wi, 1e-5).x,
                band_moves(DVec2::new(turn_y, 0.0), v(-across, along, 0.0), wo, 2e-6, wi, 1e-5).x,
            ];
            let variance = along * along + across * across + 200.0;
            let band = moved_band(stds, moves, [across, along], offset, variance);
            let [red, _, blue] = band.stds.channels;
            [band.shift, red, blue, band.stds.mean]
        },
        tolerance: Tolerance { absolute: 1e-6, relative: 1e-4 },
    }
    .check(&rows, 0);
}

/// The movement of every band at once, along each tangent, is the movement of that band.
#[test]
fn bands_of_all_scratches_move_at_once() {
    let mut random = Sequence(13);
    // Everything still; grazing on both sides, where nothing turns.
    let mut rows = vec![
        [
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0,
        ],
        [
            1e6, 1.0, 3.0, 4.0, 5.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.6, 0.8,
        ],
    ];
    for _ in 0..5000 {
        let scale = 10f32.powf(random.uniform(-5.0, 0.0));
        let wide = 10f32.powf(random.uniform(0.0, 3.5));
        let mut pick = |to: f32| random.uniform(-to, to);
        let (x, y) = (pick(scale), pick(scale));
        let axis = [pick(wide), pick(wide), pick(wide)];
        let (wo, wi) = (random.direction(0.0), random.direction(-1.0));
        let (sin, cos) = random.uniform(0.0, std::f32::consts::TAU).sin_cos();
        rows.push([
            x, y, axis[0], axis[1], axis[2], wo[0], wo[1], wo[2], wi[0], wi[1], wi[2], cos, sin,
        ]);
    }
    Twin {
        name: "band_moves and cap_turned",
        modules: &[&shaders::BAND],
        snippet: "let wo = vec3f(x[5], x[6], x[7]);
            let wi = vec3f(x[8], x[9], x[10]);
            let tangent = vec2f(x[11], x[12]);
            y[0] = dot(band_moves(vec2f(x[0], x[1]), vec3f(x[2], x[3], x[4]), wo, 2e-6, wi, 1e-5), tangent);
            let cap = cap_turned(tangent, Cap(wi, 0.6, 0.8));
            y[1] = cap.axis.x; y[2] = cap.axis.y; y[3] = cap.axis.z; y[4] = cap.sin_radius; y[5] = cap.cos_radius;",
        tables: &[],
        expected: &|x: [f64; 13]| {
            let frame = BandFrame { tangent: DVec2::new(x[11], x[12]) };
            let turned = |at: usize| frame.band_from_surface(v(x[at], x[at + 1], x[at + 2]));
            let turn_t = frame.tangent.dot(DVec2::new(x[0], x[1]));
            let moved = band_moves(DVec2::new(turn_t, 0.0), turned(2), turned(5), 2e-6, turned(8), 1e-5).x;
            let cap = Cap { axis: v(x[8], x[9], x[10]), sin_radius: 0.6, cos_radius: 0.8 }.turned(frame);
            [moved, cap.axis.x, cap.axis.y, cap.axis.z, cap.sin_radius, cap.cos_radius]
        },
        // Sum of terms that may cancel: each is up to 0.1, or as large as the turn.
        tolerance: Tolerance { absolute: 1e-6, relative: 1e-4 },
    }
    .check(&rows, 0);
}

#[test]
fn cosines_over_chords() {
    let mut random = Sequence(6);
    // Straight down the tangent; a chord of no length; the whole arc of a scratch of no width.
    let mut rows = vec![
        [1.0, 0.0, 0.0, 0.0, 1.0, 2.0],
        [0.0, 0.0, 1.0, 0.5, 0.5, 2.0],
        [0.0, 0.0, 1.0, 0.0, 1.0, 0.0],
    ];
    for _ in 0..5000 {
        let wo = random.direction(0.0);
        let (a, b) = (random.next(), random.next());
        let width = 10f32.powf(random.uniform(-1.0, 1.5));
        rows.push([wo[0], wo[1], wo[2], a.min(b), a.max(b), width]);
    }
    Twin {
        name: "chord_cos",
        modules: &[&shaders::BAND],
        snippet: "let line = band_line_at(vec3f(x[0], x[1], x[2]), 0.0);
            let arc = band_q_start(line) - band_q_end(line);
            y[0] = chord_cos(line, band_q_end(line) + arc * x[3], band_q_end(line) + arc * x[4], x[5]);",
        tables: &[],
        expected: &|[ox, oy, oz, low, high, width]: [f64; 6]| {
            let line = BandLine::new(v(ox, oy, oz), 0.0);
            let arc = line.q_start() - line.q_end();
            [chord_cos(line, line.q_end() + arc * low, line.q_end() + arc * high, width)]
        },
        // The height above the horizon is the square root of a rounded difference.
        tolerance: Tolerance { absolute: 1e-3, relative: 1e-4 },
    }
    .check(&rows, 0);
}

#[test]
fn environment_cells() {
    let mut random = Sequence(4);
    let mut rows = vec![
        [0.0, 0.0, 1.0, 0.0, 3.0],
        [1.0, 0.0, 0.0, 2.0, 5.0],
        [0.0, 1.0, 0.0, 2.0, 9.0],
    ];
    for _ in 0..2000 {
        let wo = random.direction(0.0);
        rows.push([
            wo[0],
            wo[1],
            wo[2],
            random.uniform(0.05, 30.0),
            (random.next() * ENVIRONMENT_CELLS as f32).floor(),
        ]);
    }
    Twin {
        name: "environment_cell",
        modules: &[&shaders::BAND_ENVIRONMENT],
        snippet: "let cell = environment_cell(u32(x[4]), band_line_at(vec3f(x[0], x[1], x[2]), 0.0), x[3]);
            y[0] = cell.q_low; y[1] = cell.q_high; y[2] = cell.direction.y; y[3] = cell.direction.z;
            y[4] = environment_cell_roughness(cell);",
        tables: &[],
        expected: &|[ox, oy, oz, width, i]: [f64; 5]| {
            let cell = environment_cell(i as usize, BandLine::new(v(ox, oy, oz), 0.0), width);
            [cell.q_low, cell.q_high, cell.direction.y, cell.direction.z, cell.environment_cell_roughness()]
        },
        // The height above the horizon is the square root of a rounded difference.
        tolerance: Tolerance { absolute: 2e-3, relative: 1e-3 },
    }
    .check(&rows, 0);
}

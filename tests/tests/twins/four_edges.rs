//! Polygons of three and four vertices on the band of a scratch: edges made ready once and all roots of a line at once.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3, Vec2, Vec3};
use hairline_gpu::shaders;
use hairline_optics::band::*;

/// wo, xi_t; four unit directions; away; facing.
const INPUTS: usize = 20;
type Row = [f32; INPUTS];

fn v(x: &[f64], at: usize) -> DVec3 {
    DVec3::new(x[at], x[at + 1], x[at + 2])
}

/// A polygon of the plane across `center`, tilted; corners relative to the center, `size` its largest half extent.
fn on_a_plane(random: &mut Sequence, center: Vec3, corners: [Vec2; 4]) -> Option<Row> {
    let size = 10f32.powf(random.uniform(-2.5, 0.7));
    let tilt = Vec3::from(random.direction(-1.0)) * random.uniform(0.0, 0.9);
    let normal = (center + tilt).normalize();
    let (u, w) = normal.any_orthonormal_pair();
    let turn = random.uniform(0.0, std::f32::consts::TAU);
    let at = corners.map(|c| {
        let c = Vec2::from_angle(turn).rotate(c) * size;
        center + u * c.x + w * c.y
    });
    row(random, at)
}

/// Draws a row; none where the point lies so near to the polygon's plane that single precision has no side for it.
fn row(random: &mut Sequence, corners: [Vec3; 4]) -> Option<Row> {
    let (away, facing) = polygon_facing(corners.iter().map(|c| c.as_dvec3()), true);
    let away = away.normalize_or_zero().as_vec3();
    let far = corners.iter().fold(0.0, |far: f32, c| far.max(c.length()));
    if facing == 0.0 || away.dot(corners[0]).abs() < 1e-3 * far {
        return None;
    }
    let wo = Vec3::from(random.direction(0.0));
    let directions = corners.map(Vec3::normalize);
    // Half of the lines run through the light or close by it.
    let low = directions.iter().fold(1.0, |low: f32, d| low.min(d.x));
    let high = directions.iter().fold(-1.0, |high: f32, d| high.max(d.x));
    let along = if random.next() < 0.5 {
        random.uniform(low - 0.1 * (high - low), high + 0.1 * (high - low))
    } else {
        random.uniform(-1.0, 1.0)
    };
    let along = along.clamp(-1.0, 1.0);
    let mut row = [0.0; INPUTS];
    row[..3].copy_from_slice(&wo.to_array());
    row[3] = along + wo.x;
    for (i, direction) in directions.into_iter().enumerate() {
        row[4 + 3 * i..7 + 3 * i].copy_from_slice(&direction.to_array());
    }
    row[16..19].copy_from_slice(&away.to_array());
    row[19] = facing as f32;
    Some(row)
}

/// Triangles and quads, convex and darts, of either sense; around the tangent, straight down, anywhere.
fn rows(count: usize) -> Vec<Row> {
    let mut random = Sequence(11);
    let mut rows = Vec::new();
    while rows.len() < count {
        let around = (random.next() * 4.0) as usize;
        let near = Vec3::from(random.direction(-1.0)) * random.uniform(0.0, 0.5);
        let center = match around {
            0 => Vec3::X + near,
            1 => -Vec3::X + near,
            2 => -Vec3::Z + near,
            _ => Vec3::from(random.direction(-1.0)),
        };
        // Counter-clockwise around the middle.
        let mut quarter = |i: f32| {
            let angle = std::f32::consts::FRAC_PI_2 * (i + random.uniform(-0.45, 0.45));
            Vec2::from_angle(angle) * random.uniform(0.3, 1.0)
        };
        let mut corners = [quarter(0.0), quarter(1.0), quarter(2.0), quarter(3.0)];
        match (random.next() * 6.0) as usize {
            // The fourth corner is the first: a triangle as shaders see it.
            0 | 1 => corners[3] = corners[0],
            // A dart.
            2 => corners[1] *= -0.2,
            // Vertices that repeat, and nearly so.
            3 => corners[2] = corners[1],
            4 => corners[2] = corners[1] + Vec2::new(1e-6, -2e-6),
            _ => {}
        }
        if random.next() < 0.5 {
            corners[1..].reverse();
        }
        rows.extend(on_a_plane(&mut random, center.normalize(), corners));
    }
    rows
}

fn view(x: &[f64; INPUTS], on: impl FnOnce(&PolygonView) -> [f64; 5]) -> [f64; 5] {
    let directions = [v(x, 4), v(x, 7), v(x, 10), v(x, 13)];
    on(&PolygonView {
        directions: &directions,
        away: v(x, 16),
        facing: x[19],
    })
}

fn expected(x: [f64; INPUTS]) -> [f64; 5] {
    let frame = BandFrame { tangent: DVec2::X };
    let (wo, line) = (v(&x, 0), BandLine::new(v(&x, 0), x[3]));
    view(&x, |view| {
        // Odd, as the scratch table is.
        let sum = view.integral(frame, line, |q| [q * q * q + q])[0];
        let (low, high) = view.band_extent(frame, wo);
        let range = view.range(frame, line);
        let below = view.directions.iter().all(|d| d.z <= 0.0);
        // No part of the light is seen: any order that says so is right.
        let (low, high) = if below {
            (9.0, -9.0)
        } else {
            (low - wo.x, high - wo.x)
        };
        [sum, low, high, range.0, range.1]
    })
}

static MODULES: &[&shaders::Module] = &[&shaders::FOUR_EDGES];
const SNIPPET: &str = "let line = band_line_at(vec3f(x[0], x[1], x[2]), x[3]);
    let a = vec3f(x[4], x[5], x[6]);
    let d = vec3f(x[13], x[14], x[15]);
    let away = vec3f(x[16], x[17], x[18]);
    let edges = FourEdges(a, vec3f(x[7], x[8], x[9]), vec3f(x[10], x[11], x[12]), d, select(4u, 3u, all(d == a)));
    var roots = four_edges_roots(edges, line, away);
    let range = roots.range;
    for (var i = 0u; i < roots.count + u32(roots.wraps); i += 1u) {
        var ends = next_roots(&roots);
        ends = select(ends, x[19] * vec2f(band_q_start(line), band_q_end(line)), i == roots.count);
        y[0] += x[19] * (ends.x * ends.x * ends.x + ends.x - ends.y * ends.y * ends.y - ends.y);
    }
    let extent = four_edges_extent(edges, away);
    y[1] = extent.x; y[2] = extent.y;
    y[3] = range.x; y[4] = range.y;";

fn twin(expected: &dyn Fn([f64; INPUTS]) -> [f64; 5]) -> Twin<'_, INPUTS, 5> {
    Twin {
        name: "four edges",
        modules: MODULES,
        snippet: SNIPPET,
        tables: &[],
        expected,
        // At a line that touches an edge, the root is the square root of a difference that is rounded to 1e-7, and the
        // antiderivative is up to 13 times as steep as q.
        tolerance: Tolerance {
            absolute: 4e-3,
            relative: 1e-3,
        },
    }
}

/// The signed sum over roots, the light's extent, and the range of the roots.
#[test]
fn roots_and_extents() {
    let rows = rows(40_000);
    // The rows include lights that wrap, that are below the horizon and that hold the tangent, and darts that a line
    // crosses twice.
    let count = |is: fn(&[f64; 5]) -> bool| {
        let all = rows.iter().map(|row| expected(row.map(f64::from)));
        all.filter(is).count() as f64 / rows.len() as f64
    };
    let lit = count(|y| y[0].abs() > 0.01);
    let around = count(|y| y[1] < -0.999_999 || (0.999_999..2.0).contains(&y[2]));
    let below = count(|y| y[2] == -9.0);
    assert!(
        lit > 0.1 && around > 0.05 && below > 0.05,
        "{lit} {around} {below}"
    );
    // A vertex within rounding of the line falls on either side of it, and roots that were the only ones may come or go;
    // the tangent within rounding of an edge is in the light or not.
    twin(&expected).check(&rows, rows.len() / 2000);
}

/// A corner that is off by a hundredth is seen, and nothing else.
#[test]
fn a_moved_corner_is_found() {
    let mut rows = rows(200);
    let Some(before) = twin(&expected).failures(&rows) else {
        return;
    };
    assert!(before.is_empty(), "{before:?}");
    // A square on the horizon's far side of the band, its middle on the line.
    let corner = |x: f32, z: f32| Vec3::new(x, 1.0, z).normalize();
    let corners = [
        corner(-0.3, 0.2),
        corner(-0.3, 0.8),
        corner(0.3, 0.8),
        corner(0.3, 0.2),
    ];
    let mut square = row(&mut Sequence(1), corners).unwrap();
    square[..4].copy_from_slice(&[0.0, 0.0, 1.0, 0.05]);
    rows.push(square);
    let moved = |mut x: [f64; INPUTS]| {
        if x == square.map(f64::from) {
            let d = (v(&x, 10) + DVec3::new(0.0, 0.0, 0.02)).normalize();
            x[10..13].copy_from_slice(&d.to_array());
        }
        expected(x)
    };
    let failures = twin(&moved).failures(&rows).unwrap();
    assert_eq!(failures.len(), 1, "{failures:?}");
}

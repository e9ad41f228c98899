//! A box whose edges and corners are parts of cylinders and spheres: all points within the rounding's radius of a smaller box.

use glam::{DVec3, Vec2};
use hairline_model::surface::{Surface, Vertex};

use super::profile::ROUNDING_FACETS;

/// Each side's directions of u and of up in its texture; their cross product is its outward normal.
const SIDES: [[DVec3; 2]; 6] = [
    [DVec3::Y, DVec3::Z],
    [DVec3::NEG_Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::Z],
    [DVec3::X, DVec3::Z],
    [DVec3::X, DVec3::Y],
    [DVec3::X, DVec3::NEG_Y],
];

/// Number of facets of an edge for one of its two sides: sides meet in the middle of edges.
const EDGE_FACETS: u32 = ROUNDING_FACETS / 2;

/// A place along one edge of a side: on the smaller box, and from there to the box without roundings, in radii.
type EdgePlace = (f64, f64);

fn places(inner_m: f64, rounding_m: f64) -> Vec<EdgePlace> {
    if rounding_m == 0.0 {
        return vec![(-inner_m, -1.0), (inner_m, 1.0)];
    }
    // Even angles; the last exactly at the edge's middle, where the next side begins.
    let slope = |i: u32| match i == EDGE_FACETS {
        true => 1.0,
        false => libm::tan(std::f64::consts::FRAC_PI_4 * f64::from(i) / f64::from(EDGE_FACETS)),
    };
    let upper = (0..=EDGE_FACETS).map(|i| (inner_m, slope(i)));
    let lower = (0..=EDGE_FACETS).rev().map(|i| (-inner_m, -slope(i)));
    lower.chain(upper).collect()
}

pub(super) fn surface(size_m: DVec3, rounding_m: f64) -> Surface {
    let half_m = 0.5 * size_m;
    let inner_m = half_m - rounding_m;
    let mut surface = Surface::default();
    for [right, up] in SIDES {
        let out = right.cross(up);
        let along = |axis: DVec3, size_m: DVec3| axis.abs().dot(size_m);
        let [columns, rows] = [right, up].map(|axis| places(along(axis, inner_m), rounding_m));
        // Coordinate from 0 to 1 over the box without roundings.
        let part = |(at, slope): EdgePlace, axis: DVec3| {
            0.5 * (1.0 + (at + rounding_m * slope) / along(axis, half_m))
        };
        let first = surface.vertices.len() as u32;
        for &row in &rows {
            for &column in &columns {
                let on_inner_m = right * column.0 + up * row.0 + out * along(out, inner_m);
                let normal = match rounding_m == 0.0 {
                    true => out,
                    false => (right * column.1 + up * row.1 + out).normalize(),
                };
                surface.vertices.push(Vertex {
                    position_m: on_inner_m + rounding_m * normal,
                    normal,
                    tangent: right,
                    uv: Vec2::new(part(column, right) as f32, 1.0 - part(row, up) as f32),
                    ..Vertex::default()
                });
            }
        }
        let across = columns.len() as u32;
        for row in 0..rows.len() as u32 - 1 {
            for column in 0..across - 1 {
                let a = first + row * across + column;
                let [b, c, d] = [a + 1, a + across + 1, a + across];
                surface.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    surface
}

/// Numbers of triangles and vertices.
pub(super) fn size(rounding_m: f64) -> [f64; 2] {
    let places = places(1.0, rounding_m).len() as f64;
    [12.0 * (places - 1.0).powi(2), 6.0 * places * places]
}

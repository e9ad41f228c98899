//! Directions from the vertices of grids under a footprint.

use super::{Directions, Many};
use crate::scratches::Work;
use glam::{DMat2, DVec2};
use hairline_index::bundles::{HEIGHT_CELLS, Side, Vertex};
use hairline_index::scratch_index::FACING_MIN_COS;
use std::f64::consts::PI;

/// A footprint reads vertices up to this many standard deviations away; what lies beyond is made up for.
const FOOTPRINT_REACH: f64 = 3.0;
/// How far a side may lean away from a footprint's normal and still have scratches under it.
const LEAN_MIN: f32 = 0.4;

/// What one side's grids of a level have under the footprint, if anything.
pub(super) fn read(many: &Many, level: usize, side: Side, work: &mut Work) -> Option<Directions> {
    let pixel = many.pixel;
    let cell_m = f64::from(many.grids.classes[0].levels[level].cell_m);
    let point = pixel.point;
    let normal = point.normal.as_vec3();
    if side.lean(normal) < LEAN_MIN {
        return None;
    }
    let [u, v, w] = side.axes();
    let n = point.normal.to_array();
    let cell_um = cell_m * 1e6;
    // One cell along each of the grid's axes, on the tangent plane.
    let axes = [point.axis_x.to_array(), point.axis_y.to_array()];
    let step = |i: usize| {
        let rise = -n[i] / n[w];
        DVec2::from_array(axes.map(|axis| (axis[i] + rise * axis[w]) * cell_um))
    };
    let steps = DMat2::from_cols(step(u), step(v));
    // The tents' own variance is part of what the footprint blurs by.
    let tents = steps * steps.transpose() * (1.0 / 6.0);
    let c = pixel.frame.covariance_um2;
    let blur = DMat2::from_cols(
        DVec2::new(c.x + pixel.frame.window_um2, c.y),
        DVec2::new(c.y, c.z + pixel.frame.window_um2),
    ) - tents;
    let density = 1.0 / (2.0 * PI * blur.determinant().max(1e-12).sqrt());
    let per_blur = blur.inverse();
    let form = steps.transpose() * per_blur * steps;
    let [m00, m01, m11] = [form.x_axis.x, form.x_axis.y, form.y_axis.y];
    let determinant = m00 * m11 - m01 * m01;
    if !(m00 > 0.0 && determinant > 0.0) {
        return None;
    }
    let position = point.position_m.to_array();
    let (x, y) = (position[u] / cell_m, position[v] / cell_m);
    let reach2 = FOOTPRINT_REACH * FOOTPRINT_REACH;
    let density = density / (1.0 - (-0.5 * reach2).exp());
    let rows = FOOTPRINT_REACH * (m00 / determinant).sqrt();
    let [rise_u, rise_v] = [-n[u] / n[w], -n[v] / n[w]];
    let height = position[w] / cell_m;
    let margin = 0.5 + rise_u.abs() + rise_v.abs();

    let mut directions = Directions::new(side);
    for row in (y - rows).ceil() as i32..=(y + rows).floor() as i32 {
        let dy = f64::from(row) - y;
        let half = (reach2 * m00 - determinant * dy * dy).max(0.0).sqrt() / m00;
        let middle = x - m01 * dy / m00;
        for column in (middle - half).ceil() as i32..=(middle + half).floor() as i32 {
            let dx = f64::from(column) - x;
            let at_height = height + rise_u * dx + rise_v * dy;
            let [low, high] = [-margin, margin]
                .map(|m| ((at_height + m) / f64::from(HEIGHT_CELLS) + 0.5).floor() as i32);
            for height in low..=high {
                let vertex = Vertex {
                    side: side.0,
                    at: [column, row],
                    height,
                };
                for (i, class) in many.grids.classes.iter().enumerate() {
                    work.counts.nodes += 1;
                    let Some(bundle) = class.levels[level].find(vertex) else {
                        continue;
                    };
                    if bundle.normal.dot(normal) < FACING_MIN_COS {
                        continue;
                    }
                    work.counts.clusters += 1;
                    // As single scratches are, seen along the normal: a curved surface leaves its tangent plane.
                    let v = bundle.place_m.as_dvec3() - point.position_m;
                    let v = DVec2::new(v.dot(point.axis_x), v.dot(point.axis_y)) * 1e6;
                    let q = v.dot(per_blur * v);
                    let weight = f64::from(bundle.weight_um2) * density * (-0.5 * q).exp();
                    directions.classes[i].add_bundle(weight as f32, bundle);
                }
            }
        }
    }
    directions.is_any().then_some(directions)
}

//! The scratches under a footprint as sums over directions (docs/model.md, section 7): where a footprint covers many, it reads
//! how much scratch lies around it in which direction from a grid that is fine against it, and lights one scratch for each
//! direction.
//!
//! The number of vertices under a footprint and of directions is bounded, whatever the number of scratches. From single
//! scratches to the finest grid and from each grid to the next one, weights go over smoothly with the footprint's size.

use crate::closed_form::Prepared;
use crate::light_view::{LightView, LightViews};
use crate::scratches::{Pixel, SegmentView, Work, gather_scratches};
use crate::surface::SurfacePoint;
use glam::{DMat2, DVec2, DVec3};
use hairline_index::bundles::{BUNDLE_BINS, BundleLevel, HEIGHT_CELLS, Side, Vertex};
use hairline_index::scratch_index::FACING_MIN_COS;
use hairline_optics::mask::ScratchSums;
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::table::ScratchTable;
use hairline_scene::Environment;
use std::f64::consts::PI;

/// A footprint's least standard deviation is at least so many cells of the grids that it reads: from here on their sum over its
/// Gaussian is an integral to 1e-3, the tents' variance taken off.
const LEAST_CELLS: f64 = 0.9;
/// A footprint reads vertices up to this many standard deviations away; what lies beyond is made up for.
const FOOTPRINT_REACH: f64 = 3.0;
/// Directions are at most this share of the angle apart over which a light shines alike.
const TURN_SHARE: f64 = 1.0;
/// Most bins between one direction and the next.
const STRIDE_MAX: usize = 8;
/// Bins between directions that light an environment.
const ENVIRONMENT_STRIDE: usize = 4;
/// Variance by which a band is smeared over the step between two directions, as a share of the step's square: a tent has 1/6, of which
/// the splat to directions has taken its part.
const SMEAR: f64 = 0.1;
/// How far a side may lean away from a footprint's normal and still have scratches under it.
const LEAN_MIN: f32 = 0.4;

/// The footprint's size goes up by this factor while one grid takes over from another, as a power of two.
const HAND_OVER: f64 = 0.35;

/// Adds up all scratches of an object under the point's footprint.
pub(crate) fn gather_bundles(
    prepared: &Prepared,
    point: &SurfacePoint,
    object: usize,
    list: Option<&[u32]>,
    views: &LightViews,
    work: &mut Work,
) -> ScratchSums {
    let environment = prepared.scene.environment.as_ref();
    let pixel = Pixel::new(point);
    let found = prepared.bundles();
    let bundles = &found.index.objects[object];
    let cell_um = bundles.cell_m as f64 * 1e6;
    let octave = (least_std_um(&pixel) / (LEAST_CELLS * cell_um)).log2();
    if !(octave > 0.0) || bundles.classes.is_empty() {
        return gather_scratches(prepared, point, object, list, views, work);
    }
    let level = (octave as usize).min(bundles.level_count - 1);
    let over = ((octave - level as f64) / HAND_OVER).min(1.0);
    let over = over * over * (3.0 - 2.0 * over);
    let mut sums = ScratchSums::default();
    let mut add_level = |level: usize, weight: f64| {
        for (i, class) in bundles.classes.iter().enumerate() {
            let table = found.table(object, i, point.table);
            for side in Side::ALL {
                if let Some(directions) =
                    Directions::under(&pixel, &class.levels[level], side, work)
                {
                    directions.add(
                        environment,
                        table,
                        &pixel,
                        side,
                        views,
                        weight,
                        work,
                        &mut sums,
                    );
                }
            }
        }
    };
    add_level(level, over);
    if over < 1.0 {
        if level > 0 {
            add_level(level - 1, 1.0 - over);
        } else {
            let single = gather_scratches(prepared, point, object, list, views, work);
            add_scaled(&mut sums, &single, 1.0 - over);
        }
    }
    sums
}

fn add_scaled(sums: &mut ScratchSums, more: &ScratchSums, weight: f64) {
    sums.share += weight * more.share;
    sums.share_by_line += weight * more.share_by_line;
    for c in 0..3 {
        sums.radiance[c] += weight * more.radiance[c];
        sums.energy[c] += weight * more.energy[c];
    }
}

/// The least standard deviation of footprint and window together in any direction.
fn least_std_um(pixel: &Pixel) -> f64 {
    let c = pixel.covariance_um2;
    let (mean, half) = (0.5 * (c.x + c.z), 0.5 * (c.x - c.z));
    ((mean - half.hypot(c.y)).max(0.0) + pixel.window_um2).sqrt()
}

/// How much scratch lies under a footprint in which direction.
struct Directions {
    /// Shares, by the angle from the side's reference.
    bins: [f32; BUNDLE_BINS],
    share: f64,
    /// Means.
    width_um: f64,
    depth_nm: f64,
}

impl Directions {
    /// Reads the vertices of one side under the footprint.
    fn under(pixel: &Pixel, level: &BundleLevel, side: Side, work: &mut Work) -> Option<Self> {
        let point = pixel.point;
        let normal = point.normal.as_vec3();
        if side.lean(normal) < LEAN_MIN {
            return None;
        }
        let [u, v, w] = side.axes();
        let n = point.normal.to_array();
        let cell_m = level.cell_m as f64;
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
        let c = pixel.covariance_um2;
        let blur = DMat2::from_cols(
            DVec2::new(c.x + pixel.window_um2, c.y),
            DVec2::new(c.y, c.z + pixel.window_um2),
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

        let mut bins = [0f32; BUNDLE_BINS];
        let (mut share, mut width, mut depth) = (0.0, 0.0, 0.0);
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
                    work.counts.nodes += 1;
                    let vertex = Vertex {
                        side: side.0,
                        at: [column, row],
                        height,
                    };
                    let Some(bundle) = level.find(vertex) else {
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
                    share += weight;
                    width += weight * f64::from(bundle.width_um);
                    depth += weight * f64::from(bundle.depth_nm);
                    let scale = weight as f32 * bundle.bin_scale / 255.0;
                    for (sum, bin) in bins.iter_mut().zip(&bundle.bins) {
                        *sum += scale * f32::from(*bin);
                    }
                }
            }
        }
        (share > 0.0).then(|| Self {
            bins,
            share,
            width_um: width / share,
            depth_nm: depth / share,
        })
    }

    /// Directions `stride` bins apart.
    fn coarser(&self, stride: usize) -> impl Iterator<Item = (usize, f64)> {
        (0..BUNDLE_BINS / stride).map(move |i| {
            let at = i * stride;
            let mut sum = 0.0;
            for away in 0..stride {
                let tent = (stride - away) as f32 / stride as f32;
                sum += tent * self.bins[(at + away) % BUNDLE_BINS];
                if away > 0 {
                    sum += tent * self.bins[(at + BUNDLE_BINS - away) % BUNDLE_BINS];
                }
            }
            (at, f64::from(sum))
        })
    }

    /// Lights the directions and adds them to the sums.
    #[expect(clippy::too_many_arguments)]
    fn add(
        &self,
        environment: Option<&Environment>,
        table: &ScratchTable,
        pixel: &Pixel,
        side: Side,
        views: &LightViews,
        weight: f64,
        work: &mut Work,
        sums: &mut ScratchSums,
    ) {
        let point = pixel.point;
        let reference = side.reference(point.normal.as_vec3()).as_dvec3();
        let across = point.normal.cross(reference);
        let in_surface = |v: DVec3| DVec2::new(v.dot(point.axis_x), v.dot(point.axis_y));
        let (reference, across) = (in_surface(reference), in_surface(across));
        let view = |at: usize, stride: usize| {
            let (sin, cos) = (PI * at as f64 / BUNDLE_BINS as f64).sin_cos();
            let turn = PI * stride as f64 / BUNDLE_BINS as f64;
            SegmentView::of_many(
                pixel,
                (reference * cos + across * sin).normalize(),
                self.width_um,
                self.depth_nm,
                SMEAR * turn * turn,
            )
        };
        let mut radiance = DVec3::ZERO;
        for light in 0..views.views.len() {
            let stride = stride(pixel, views, light);
            for (at, share) in self.coarser(stride) {
                if share > 0.0 {
                    radiance += share * view(at, stride).light(pixel, table, views, light, work);
                }
            }
        }
        if let Some(environment) = environment {
            for (at, share) in self.coarser(ENVIRONMENT_STRIDE) {
                if share > 0.0 {
                    radiance +=
                        share * view(at, ENVIRONMENT_STRIDE).environment(pixel, table, environment);
                }
            }
        }
        for c in 0..3 {
            sums.radiance[c] += weight * radiance[c];
        }
        sums.share += weight * self.share;
        // The mean of a Gaussian over itself is 1/sqrt2 of its peak.
        for (at, share) in self.coarser(STRIDE_MAX) {
            let variance = view(at, STRIDE_MAX).variance_um2();
            let line = self.width_um / (4.0 * PI * variance).sqrt();
            sums.share_by_line += weight * share * line;
        }
        let depth = oblique_depth_nm(self.depth_nm, point.wo.z, point.wo.z);
        let energy = table.scratch_table_total(depth);
        for (sum, energy) in sums.energy.iter_mut().zip(energy) {
            *sum += weight * self.share * energy;
        }
    }
}

/// Into which steps of directions a light is resolved.
fn stride(pixel: &Pixel, views: &LightViews, light: usize) -> usize {
    let view = &views.views[light];
    let (LightView::Sphere { cap, .. } | LightView::Polygon { bound: cap, .. }) = view;
    let sum = (pixel.point.wo + cap.cos_radius * cap.axis).truncate();
    let [x, y] = views.moves[light].map(|m| m.length_squared());
    let std = (pixel.stds.mean * pixel.stds.mean + x + y).sqrt();
    let half = match view {
        LightView::Sphere { cap, .. } => cap.sin_radius,
        LightView::Polygon { away, .. } => {
            // Half the width of a long one.
            let distance = views.distances_m[light];
            let solid_angle = 0.5 * away.length() / (distance * distance);
            (solid_angle / (4.0 * cap.sin_radius.max(1e-6))).min(cap.sin_radius)
        }
    };
    let turn = (half + std) / sum.length().max(0.1);
    let bin = PI / BUNDLE_BINS as f64;
    let mut stride = 1;
    while stride < STRIDE_MAX && 2.0 * stride as f64 * bin < TURN_SHARE * turn {
        stride *= 2;
    }
    stride
}

#[cfg(test)]
mod tests;

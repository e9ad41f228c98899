//! Stage 3, project: segments to the picture, and how far each of them reaches there. Twin: project.wgsl.
//!
//! What lies outside the rows in hand is dropped: whole nodes of the BVH first, then segment by segment. So only what is in the
//! picture has a record, whatever the number of segments in the scene.

use crate::prepared::Prepared;
use glam::{DVec2, DVec3};
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::REACH_STD;
use hairline_scene::CameraFrame;
use rayon::prelude::*;
use std::ops::Range;

/// Factor on reaches in the picture over those on a plane that the viewer sees without perspective: for shading normals that are not
/// those of the surface, and for perspective and curvature within a footprint.
///
/// By a look at all segments of an object (`margins_of_scenes`), the farthest pair with a share needs 1.57 in the built-in scene at
/// 1280 x 720, 1.20 in the spoon, 1.23 in the pan, 1.44 in the dish of the tests, 1.00 on the flat plate. A factor of 1.25 loses
/// 4e-5 of the built-in scene's shares. At 160 x 90, where footprints go around limbs, 1.6 loses 2e-4 there and 2e-3 in the spoon.
pub(crate) const REACH_MARGIN: f64 = 1.6;

/// Bound of the blurs of a scratch besides the pixel's, in coherence lengths: the window's 0.7071 across and the 0.825 of its ends
/// ([`hairline_optics::footprint::ends`]).
const WINDOW_STD: f64 = 0.84;

/// A segment whose normal turns away from the viewer by more than this cosine at both ends is not seen: no shading normal that faces
/// the viewer is within reach of it.
const AWAY_COS: f64 = -0.3;

/// Coordinates in records are rounded to single precision; the picture's largest is 16384.
pub(crate) const ROUNDING_PX: f64 = 0.01;

/// A segment in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Projected {
    /// Index into the segments of the scene.
    pub segment: u32,
    pub object: u32,
    /// Pixels. For a segment too near the camera both ends are the same and the reach is infinite.
    pub start_px: [f32; 2],
    pub end_px: [f32; 2],
    /// Distance in pixels from the segment beyond which no pixel has a share of it.
    pub reach_px: f32,
}

/// All segments of the rows in hand, in their order, and how many were looked at.
pub(crate) struct Projection {
    pub segments: Vec<Projected>,
    pub looked_at: u64,
}

/// The rows of a picture, to which segments are projected.
pub(crate) struct Rows {
    camera: CameraFrame,
    /// The planes that bound the picture's rows from the camera, pointing inwards.
    planes: [DVec3; 4],
    /// Reach of the pixel's filter alone.
    filter_px: f64,
    jitter_px: f64,
    /// Per unit of slope.
    px: f64,
}

/// Segments of one task.
const TASK: usize = 4096;

/// Projects the segments of all objects to some rows of the picture, all cores at work; the same for any number of them. Fewer if it was
/// cancelled.
pub(crate) fn project(
    prepared: &Prepared,
    camera: &CameraFrame,
    rows: &Range<u32>,
    samples: u32,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Projection {
    let to = Rows::new(prepared, camera, rows, samples);
    let index = &prepared.scratches;
    let (segments, _) = prepared.segments();
    let mut projection = Projection {
        segments: Vec::new(),
        looked_at: 0,
    };
    for (object, &coherence_um) in index.coherence_max_um().iter().enumerate() {
        let coherence_m = f64::from(coherence_um) * 1e-6;
        let ranges = match &prepared.draft {
            Some(draft) => vec![draft.objects[object].clone()],
            None => to.in_sight(prepared, object, margin_m(coherence_m)),
        };
        projection.looked_at += ranges.iter().map(|r| r.len() as u64).sum::<u64>();
        let tasks: Vec<Range<usize>> = ranges
            .into_iter()
            .flat_map(|range| {
                let end = range.end;
                range.step_by(TASK).map(move |i| i..end.min(i + TASK))
            })
            .collect();
        let parts: Vec<Vec<Projected>> = tasks
            .into_par_iter()
            .map(|range| {
                if cancelled() {
                    return Vec::new();
                }
                let segments = range.clone().zip(&segments[range]);
                segments
                    .filter_map(|(i, segment)| {
                        let projected = to.project(segment, coherence_m)?;
                        Some(Projected {
                            segment: i as u32,
                            object: object as u32,
                            ..projected
                        })
                    })
                    .collect()
            })
            .collect();
        projection
            .segments
            .reserve(parts.iter().map(Vec::len).sum());
        for part in parts {
            projection.segments.extend(part);
        }
    }
    projection
}

/// Largest distance by which a segment reaches beyond the pixel's filter on a surface of this coherence length.
fn margin_m(coherence_m: f64) -> f64 {
    REACH_MARGIN * f64::from(REACH_STD) * WINDOW_STD * coherence_m
}

impl Rows {
    pub fn new(prepared: &Prepared, camera: &CameraFrame, rows: &Range<u32>, samples: u32) -> Self {
        let std_px = prepared.scene.render.footprint_std_px(1);
        let filter_px = REACH_MARGIN * f64::from(REACH_STD) * std_px;
        let jitter_px = match samples > 1 {
            true => prepared.scene.render.jitter_max_px(),
            false => 0.0,
        };
        let px = 1.0 / camera.per_px_x.length();
        let margin = DVec2::splat(filter_px + jitter_px + ROUNDING_PX);
        let low = DVec2::new(0.0, rows.start.into()) - camera.middle_px - margin;
        let high = DVec2::new(camera.size_px.x, rows.end.into()) - camera.middle_px + margin;
        let (x, y) = (camera.per_px_x * px * px, camera.per_px_y * px * px);
        let planes = [
            x - camera.forward * low.x,
            camera.forward * high.x - x,
            y - camera.forward * low.y,
            camera.forward * high.y - y,
        ];
        Self {
            camera: *camera,
            planes: planes.map(DVec3::normalize),
            filter_px,
            jitter_px,
            px,
        }
    }

    /// Ranges of the segments of an object in those nodes of its tree which the rows may see, in their order.
    fn in_sight(&self, prepared: &Prepared, object: usize, margin_m: f64) -> Vec<Range<usize>> {
        let tree = &prepared.scratches.tree;
        let mut ranges: Vec<Range<usize>> = Vec::new();
        let Range { start, end } = tree.objects[object];
        let mut at = start;
        while at < end {
            let node = &tree.nodes[at as usize];
            let (low, high) = (node.min_m.as_dvec3(), node.max_m.as_dvec3());
            let middle = 0.5 * (low + high) - self.camera.position_m;
            let half = 0.5 * (high - low);
            let is_beyond = |plane: &DVec3| plane.dot(middle) + plane.abs().dot(half) < -margin_m;
            if self.planes.iter().any(is_beyond) || is_beyond(&self.camera.forward) {
                at = node.skip;
                continue;
            }
            at += 1;
            let segments = node.segments();
            match ranges.last_mut() {
                Some(last) if last.end == segments.start => last.end = segments.end,
                _ if segments.is_empty() => {}
                _ => ranges.push(segments),
            }
        }
        ranges
    }

    /// The place in the picture, and nothing of the numbers. `coherence_m` is the largest of the object.
    pub fn project(&self, segment: &IndexedSegment, coherence_m: f64) -> Option<Projected> {
        let margin_m = margin_m(coherence_m);
        let forward = self.camera.forward;
        let start = segment.start_m.as_dvec3() - self.camera.position_m;
        let end = segment.end_m.as_dvec3() - self.camera.position_m;
        let normal = segment.normal.as_dvec3();
        let is_away = |v: DVec3| -normal.dot(v) < AWAY_COS * v.length();
        if is_away(start) && is_away(end) {
            return None;
        }
        // The part that is within the planes, each moved outwards by what the segment reaches beyond the pixel's filter.
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for plane in self.planes.iter().chain([&forward]) {
            let (a, b) = (plane.dot(start) + margin_m, plane.dot(end) + margin_m);
            if a < 0.0 && b < 0.0 {
                return None;
            }
            if a < 0.0 {
                from = from.max(a / (a - b));
            } else if b < 0.0 {
                to = to.min(a / (a - b));
            }
        }
        if from > to {
            return None;
        }
        let (a, b) = (start.lerp(end, from), start.lerp(end, to));
        let nearest_m = a.dot(forward).min(b.dot(forward));
        if nearest_m <= margin_m {
            // The camera is within the window around it: any pixel may see it.
            return Some(Projected {
                reach_px: f32::INFINITY,
                ..Projected::default()
            });
        }
        let slope = |v: DVec3| v / v.dot(forward);
        let rays = [slope(a), slope(b)];
        let ray = rays[0].length().max(rays[1].length());
        let window_m = (0.5f64.sqrt() * coherence_m).max(f64::from(segment.blur_um) * 1e-6);
        let window_px = REACH_MARGIN * f64::from(REACH_STD) * window_m * self.px * ray / nearest_m;
        let pixel = |ray: DVec3| {
            let at = DVec2::new(ray.dot(self.camera.per_px_x), ray.dot(self.camera.per_px_y));
            let pixel = at * (self.px * self.px) + self.camera.middle_px;
            pixel.as_vec2().to_array()
        };
        let reach_px = self.filter_px.hypot(window_px) + self.jitter_px + ROUNDING_PX;
        Some(Projected {
            start_px: pixel(rays[0]),
            end_px: pixel(rays[1]),
            reach_px: reach_px as f32,
            ..Projected::default()
        })
    }
}

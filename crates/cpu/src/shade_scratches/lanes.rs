//! Eight points at once: whether they see a segment, and where it lies under their footprints. Loops over lanes have no branches and
//! no calls, so that compilers turn them into vector instructions.

use super::point::{Frame, ScratchPoint};
use super::segment_view::{LANES, Lanes, SegmentView};
use crate::project::Projected;
use glam::DVec2;
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::{FACING_MIN_COS, REACH_STD};

/// Groups of a batch.
pub(super) const GROUPS: usize = 8;

/// The root of 0.7, the variance that bounds the coherence window's and that of the ends' blur, in coherence lengths.
const WINDOW_STD: f64 = 0.8367;

/// The number of standard deviations that a footprint reaches, squared.
const REACH2: f64 = (REACH_STD * REACH_STD) as f64;

/// Points of a group, in the form for the tests of segments. Lanes without a point see nothing.
pub(super) struct Group {
    object: [u32; LANES],
    /// Axes of the surface in world space, times a million: from metres to micrometres.
    axis_x_um: [Lanes; 3],
    axis_y_um: [Lanes; 3],
    normal: [Lanes; 3],
    /// The point along these axes, and along the normal in metres.
    at_x_um: Lanes,
    at_y_um: Lanes,
    at_z_m: Lanes,
    /// Covariance of the footprint: xx, xy, yy.
    covariance_um2: [Lanes; 3],
    /// Variance of the coherence window.
    window_um2: Lanes,
    /// Largest distance of a segment from the plane of shading.
    off_m: Lanes,
    /// The box of the points in the picture: its middle and half its size.
    middle_px: [f32; 2],
    half_px: [f32; 2],
}

/// Largest distance of a segment from the plane of shading at which it counts for a point, metres.
fn off_plane_m(point: &crate::surface::SurfacePoint) -> f64 {
    let sigma_m = point.coherence_um * 1e-6;
    let [ax, ay] = point.footprint_axes_m.map(|axis| axis.length_squared());
    f64::from(REACH_STD)
        * (WINDOW_STD * sigma_m + point.leaves() * (ax + ay + 2.1 * sigma_m * sigma_m).sqrt())
}

impl Group {
    /// A group of at most [`LANES`] points.
    pub fn new(points: &[ScratchPoint], frames: &[Frame]) -> Self {
        let mut group = Self {
            object: [u32::MAX; LANES],
            axis_x_um: [[0.0; LANES]; 3],
            axis_y_um: [[0.0; LANES]; 3],
            normal: [[0.0; LANES]; 3],
            at_x_um: [0.0; LANES],
            at_y_um: [0.0; LANES],
            at_z_m: [0.0; LANES],
            covariance_um2: [[0.0; LANES]; 3],
            window_um2: [1.0; LANES],
            off_m: [0.0; LANES],
            middle_px: [0.0; 2],
            half_px: [0.0; 2],
        };
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (i, (p, frame)) in points.iter().zip(frames).enumerate() {
            let point = p.point;
            let (x, y) = (point.axis_x * 1e6, point.axis_y * 1e6);
            let [right, down] = frame.steps_um;
            let covariance = [
                right.x * right.x + down.x * down.x,
                right.x * right.y + down.x * down.y,
                right.y * right.y + down.y * down.y,
            ];
            group.object[i] = p.object;
            for axis in 0..3 {
                group.axis_x_um[axis][i] = x[axis];
                group.axis_y_um[axis][i] = y[axis];
                group.normal[axis][i] = point.normal[axis];
                group.covariance_um2[axis][i] = covariance[axis];
            }
            group.at_x_um[i] = point.position_m.dot(x);
            group.at_y_um[i] = point.position_m.dot(y);
            group.at_z_m[i] = point.position_m.dot(point.normal);
            group.window_um2[i] = frame.window_um2;
            group.off_m[i] = off_plane_m(point);
            (low, high) = (low.min(p.at_px), high.max(p.at_px));
        }
        group.middle_px = (0.5 * (low + high)).as_vec2().to_array();
        // Rounded to single precision.
        group.half_px = (0.5 * (high - low) + 0.01).as_vec2().to_array();
        group
    }

    /// Whether a segment may reach any of the points.
    #[inline(always)]
    pub fn is_near(&self, line: &Line) -> bool {
        let x = self.middle_px[0] - line.start_px[0];
        let y = self.middle_px[1] - line.start_px[1];
        let [tx, ty] = line.tangent;
        let (wide, high) = (self.half_px[0], self.half_px[1]);
        let across = (x * ty - y * tx).abs() - wide * ty.abs() - high * tx.abs();
        let half = 0.5 * line.length_px;
        let along = (x * tx + y * ty - half).abs() - wide * tx.abs() - high * ty.abs();
        across <= line.reach_px && along <= half + line.reach_px
    }

    /// Finds the position of a segment of an object under the footprints; false if no point sees it.
    #[inline(always)]
    pub fn see(&self, segment: &IndexedSegment, object: u32, seen: &mut SegmentView) -> bool {
        let near = self.near_line(segment, object);
        near.is_near.iter().sum::<u64>() != 0 && self.place(segment, &near, seen)
    }

    /// Finds the points near to the line of a segment.
    #[inline(always)]
    fn near_line(&self, segment: &IndexedSegment, object: u32) -> NearLine {
        let (s, e) = (segment.start_m.as_dvec3(), segment.end_m.as_dvec3());
        let n = segment.normal.as_dvec3();
        let (x, y, z) = (&self.axis_x_um, &self.axis_y_um, &self.normal);
        let c = &self.covariance_um2;
        let facing_min = f64::from(FACING_MIN_COS);
        let mut start = [[0.0; LANES]; 2];
        let mut along = [[0.0; LANES]; 2];
        let mut area = [0.0; LANES];
        let mut length2 = [0.0; LANES];
        let mut variance = [0.0; LANES];
        let mut is_near = [0u64; LANES];
        for i in 0..LANES {
            let start_x = s.x * x[0][i] + s.y * x[1][i] + s.z * x[2][i] - self.at_x_um[i];
            let start_y = s.x * y[0][i] + s.y * y[1][i] + s.z * y[2][i] - self.at_y_um[i];
            let end_x = e.x * x[0][i] + e.y * x[1][i] + e.z * x[2][i] - self.at_x_um[i];
            let end_y = e.x * y[0][i] + e.y * y[1][i] + e.z * y[2][i] - self.at_y_um[i];
            let facing = n.x * z[0][i] + n.y * z[1][i] + n.z * z[2][i];
            let (along_x, along_y) = (end_x - start_x, end_y - start_y);
            length2[i] = along_x * along_x + along_y * along_y;
            area[i] = end_x * start_y - end_y * start_x;
            let (xx, xy, yy) = (along_x * along_x, along_x * along_y, along_y * along_y);
            let across = (c[0][i] * yy - 2.0 * c[1][i] * xy + c[2][i] * xx).max(0.0);
            variance[i] = across + self.window_um2[i] * length2[i];
            start[0][i] = start_x;
            start[1][i] = start_y;
            along[0][i] = along_x;
            along[1][i] = along_y;
            let near = (facing >= facing_min)
                & (length2[i] > 0.0)
                & (area[i] * area[i] <= REACH2 * variance[i])
                & (self.object[i] == object);
            is_near[i] = u64::from(near);
        }
        NearLine {
            start,
            along,
            area,
            length2,
            variance,
            is_near,
        }
    }

    /// Finds the position of a segment under the footprints of the points near to its line; false if none sees it.
    #[inline(always)]
    fn place(&self, segment: &IndexedSegment, near: &NearLine, seen: &mut SegmentView) -> bool {
        let (s, e) = (segment.start_m.as_dvec3(), segment.end_m.as_dvec3());
        let (z, c) = (&self.normal, &self.covariance_um2);
        let blur_um = f64::from(segment.blur_um);
        let half_turn = 0.5 * f64::from(segment.turn_rad);
        let mut count = 0;
        for i in 0..LANES {
            let per_length2 = 1.0 / near.length2[i];
            let per_length = per_length2.sqrt();
            let (tx, ty) = (near.along[0][i] * per_length, near.along[1][i] * per_length);
            let (xx, xy, yy) = (tx * tx, tx * ty, ty * ty);
            let along_um2 = (c[0][i] * xx + 2.0 * c[1][i] * xy + c[2][i] * yy).max(0.0);
            let cross_um2 = (c[2][i] - c[0][i]) * xy + c[1][i] * (xx - yy);
            let at = near.start[0][i] * tx + near.start[1][i] * ty;
            let end = at + near.length2[i] * per_length;
            // An arc lies to the right of its chord where it turns to the left.
            let offset = (near.area[i] + half_turn * (at * end).min(0.0)) * per_length;
            let variance = near.variance[i] * per_length2;
            let per_variance = 1.0 / variance;
            let far2 = offset * offset * per_variance;
            // A slanted footprint: its part on the scratch is displaced along the scratch.
            let slant = cross_um2 * per_variance;
            let shift = offset * slant;
            let left = (along_um2 - cross_um2 * slant + blur_um * blur_um).max(1e-12);
            let per_std = 1.0 / left.sqrt();
            let low = (at - shift) * per_std;
            let high = (end - shift) * per_std;
            let beyond = low.max(-high).max(0.0);
            // The segment's point that is nearest to the point, off the plane of shading.
            let nearest = (-at * per_length).clamp(0.0, 1.0);
            let start_z = s.x * z[0][i] + s.y * z[1][i] + s.z * z[2][i] - self.at_z_m[i];
            let end_z = e.x * z[0][i] + e.y * z[1][i] + e.z * z[2][i] - self.at_z_m[i];
            let off_m = (start_z + nearest * (end_z - start_z)).abs();
            let sees = (near.is_near[i] != 0)
                & (far2 + beyond * beyond <= REACH2)
                & (off_m <= self.off_m[i]);
            seen.sees[i] = u64::from(sees);
            count += u64::from(sees);
            seen.tangent[0][i] = tx;
            seen.tangent[1][i] = ty;
            seen.offset_um[i] = offset;
            seen.variance_um2[i] = variance;
            seen.far2[i] = far2;
            seen.low[i] = low;
            seen.high[i] = high;
            seen.std_um[i] = left.sqrt();
            seen.shift_um[i] = shift;
        }
        count > 0
    }
}

/// The line of a segment under the footprints of a group.
struct NearLine {
    /// Start of the segment, and the way to its end.
    start: [Lanes; 2],
    along: [Lanes; 2],
    /// Distance from the line times the length, and the variance across it times the length's square.
    area: Lanes,
    variance: Lanes,
    length2: Lanes,
    /// 1 for lanes that are near.
    is_near: [u64; LANES],
}

/// A segment in the picture, for the test of groups.
pub(super) struct Line {
    start_px: [f32; 2],
    tangent: [f32; 2],
    length_px: f32,
    reach_px: f32,
}

impl Line {
    pub fn new(segment: &Projected) -> Self {
        let ([x0, y0], [x1, y1]) = (segment.start_px, segment.end_px);
        let (x, y) = (x1 - x0, y1 - y0);
        let length_px = x.hypot(y);
        // A point has no direction: any will do.
        let tangent = if length_px > 1e-3 {
            [x / length_px, y / length_px]
        } else {
            [1.0, 0.0]
        };
        Self {
            start_px: segment.start_px,
            tangent,
            length_px,
            reach_px: segment.reach_px,
        }
    }

    /// Its direction in the picture.
    pub fn direction(&self) -> DVec2 {
        self.tangent.map(f64::from).into()
    }
}

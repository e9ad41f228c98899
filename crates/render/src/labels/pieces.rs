//! Pieces of scratches in pixels.

use glam::{DVec2, DVec3, Vec3};
use hairline_index::segment_tree::Straight;
use hairline_optics::footprint::{Footprint, scratch_share};
use hairline_optics::gaussian::gaussian;
use hairline_scene::{CameraFrame, Object};

/// A straight piece of a scratch.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub start_m: Vec3,
    pub end_m: Vec3,
    pub normal: Vec3,
    pub width_um: f32,
    /// Scratch, counted over all objects.
    pub scratch: u32,
}

impl Straight for Piece {
    fn ends_m(&self) -> [Vec3; 2] {
        [self.start_m, self.end_m]
    }
}

/// The pieces of an object whose first scratch has the number `first`.
pub(super) fn pieces(object: &Object, first: u32) -> Vec<Piece> {
    let scratches = object.scratches.iter().zip(first..);
    let pieces = scratches.flat_map(|(scratch, number)| {
        let own = scratch.segments.start as usize..scratch.segments.end as usize;
        object.segments[own].iter().map(move |piece| Piece {
            start_m: piece.start_m,
            end_m: piece.end_m,
            normal: piece.normal,
            width_um: scratch.profile.width_um,
            scratch: number,
        })
    });
    pieces
        .filter(|piece| piece.start_m != piece.end_m)
        .collect()
}

/// A piece in a pixel.
pub(super) struct PieceInPixel {
    pub coverage: f64,
    pub direction_rad: f64,
    pub is_touched: bool,
}

impl PieceInPixel {
    pub(super) fn new(
        piece: &Piece,
        frame: &CameraFrame,
        corner_px: DVec2,
        position_m: DVec3,
        axes: [DVec3; 2],
        normal: DVec3,
    ) -> Option<Self> {
        let [start, end] = [piece.start_m, piece.end_m].map(|p| 1e6 * (p.as_dvec3() - position_m));
        let along = end - start;
        let flat = along - normal * along.dot(normal);
        let tangent = flat.try_normalize()?;
        let across = normal.cross(tangent);
        let variance = |a: DVec3, b: DVec3| {
            let each = axes.map(|axis| 1e12 * axis.dot(a) * axis.dot(b));
            each[0] + each[1]
        };
        let footprint = Footprint {
            across_um2: variance(across, across),
            along_um2: variance(tangent, tangent),
            cross_um2: variance(across, tangent),
        };
        // No coherence: what is asked for is an area.
        let width_um = f64::from(piece.width_um);
        let offset_um = 0.5 * (start + end).dot(across);
        let ends = [start, end].map(|p| p.dot(tangent));
        let per_std = 1.0 / footprint.across_um2.sqrt().max(1e-9);
        let across = gaussian().integral(
            (offset_um - 0.5 * width_um) * per_std,
            (offset_um + 0.5 * width_um) * per_std,
        );
        // Share along the scratch, on the line of it that is nearest to the pixel's middle.
        let nearest_um = offset_um.signum() * (offset_um.abs() - 0.5 * width_um).max(0.0);
        let line = scratch_share(1.0, nearest_um, ends[0], ends[1], 0.0, footprint, 0.0);
        let coverage = across * line.segment / line.line.max(1e-300);
        let (from, to) = in_picture(frame, piece, position_m)?;
        let way = to - from;
        // The picture's y runs down.
        let direction = (-way.y).atan2(way.x);
        let half_turn = std::f64::consts::FRAC_PI_2;
        let direction_rad = match direction {
            d if d > half_turn => d - 2.0 * half_turn,
            d if d <= -half_turn => d + 2.0 * half_turn,
            d => d,
        };
        let px_um =
            1e6 * (frame.per_px_x.length() * (position_m - frame.position_m).dot(frame.forward));
        let is_wide =
            width_um > px_um && distance(corner_px + 0.5, from, to) <= 0.5 * width_um / px_um;
        Some(Self {
            coverage,
            direction_rad,
            is_touched: is_wide || crosses(corner_px, from, to),
        })
    }
}

/// Ends of a piece in the picture. What of it lies behind the camera or beside it is cut off.
fn in_picture(frame: &CameraFrame, piece: &Piece, seen_m: DVec3) -> Option<(DVec2, DVec2)> {
    let depth_m = |p: DVec3| (p - frame.position_m).dot(frame.forward);
    let (mut from, mut to) = (piece.start_m.as_dvec3(), piece.end_m.as_dvec3());
    let (first_m, last_m, nearest_m) = (depth_m(from), depth_m(to), 1e-3 * depth_m(seen_m));
    let cut = || from.lerp(to, (nearest_m - first_m) / (last_m - first_m));
    match [first_m < nearest_m, last_m < nearest_m] {
        [true, true] => return None,
        [true, false] => from = cut(),
        [false, true] => to = cut(),
        [false, false] => {}
    }
    Some((frame.pixel_of(from)?, frame.pixel_of(to)?))
}

/// Whether a line crosses the square of one pixel: that of Y.-D. Liang and B. Barsky (1984).
fn crosses(corner: DVec2, from: DVec2, to: DVec2) -> bool {
    let (way, low, high) = (to - from, corner - from, corner + 1.0 - from);
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        if way[axis] == 0.0 {
            if low[axis] > 0.0 || high[axis] <= 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low[axis] / way[axis], high[axis] / way[axis]);
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    first < last
}

fn distance(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let way = to - from;
    let share = ((point - from).dot(way) / way.length_squared().max(1e-300)).clamp(0.0, 1.0);
    point.distance(from + way * share)
}

//! View of a segment from a pixel, with anti-aliasing or without.

use crate::footprint::{PixelFootprint, published_share};
use glam::{DVec2, DVec3};
use hairline_cpu::surface::SurfacePoint;
use hairline_index::scratch_index::{FACING_MIN_COS, REACH_STD};
use hairline_index::{IndexedProfile, IndexedSegment};
use hairline_optics::band::BandFrame;
use hairline_optics::footprint::{Footprint, ScratchShare, scratch_share};

/// A segment as seen from a point.
pub(super) struct SegmentView {
    pub frame: BandFrame,
    /// `wo` in the frame of the scratch.
    pub wo: DVec3,
    pub share: ScratchShare,
    /// Share of the base that the scratch masks by the talk's mask.
    pub density: f64,
    pub profile: IndexedProfile,
}

/// Length that stands for an endless scratch: far beyond any pixel, yet small enough for sums of it to
/// keep their digits.
const ENDLESS_UM: f64 = 1e9;

impl SegmentView {
    /// Makes the view of a segment; none where it lies on another side of the surface or out of the
    /// footprint's reach.
    pub(super) fn new(
        point: &SurfacePoint,
        segment: &IndexedSegment,
        anti_aliasing: bool,
    ) -> Option<Self> {
        if segment.normal.as_dvec3().dot(point.normal) < FACING_MIN_COS as f64 {
            return None;
        }
        let local_um =
            |v: glam::Vec3| point.surface_from_world(v.as_dvec3() - point.position_m) * 1e6;
        let (start, end) = (local_um(segment.start_m), local_um(segment.end_m));
        let along = DVec2::new(end.x - start.x, end.y - start.y);
        let frame = BandFrame {
            tangent: along.try_normalize()?,
        };
        let (start, end) = (frame.band_from_surface(start), frame.band_from_surface(end));
        let offset_um = 0.5 * (start.y + end.y);
        let axes_um = point
            .footprint_axes_m
            .map(|a| frame.band_from_surface(point.surface_from_world(a)) * 1e6);
        let [ax, ay] = axes_um;
        let sigma = point.coherence_um;
        let across_um2 = ax.y * ax.y + ay.y * ay.y;
        let variance_um2 = across_um2 + 0.5 * sigma * sigma;
        if offset_um * offset_um > (REACH_STD * REACH_STD) as f64 * variance_um2 {
            return None;
        }
        let (width_um, blur_um) = (segment.profile.width_um as f64, segment.blur_um as f64);
        let (share, density) = if anti_aliasing {
            let ends_um = [start.x, end.x];
            box_share(segment, offset_um, ends_um, axes_um, sigma)
        } else {
            let footprint = Footprint {
                across_um2,
                along_um2: ax.x * ax.x + ay.x * ay.x,
                cross_um2: ax.x * ax.y + ay.x * ay.y,
            };
            let share = scratch_share(
                width_um, offset_um, start.x, end.x, blur_um, footprint, sigma,
            );
            (share, 2.0 * share.segment)
        };
        (share.segment > 0.0).then(|| Self {
            frame,
            wo: frame.band_from_surface(point.wo),
            share,
            density,
            profile: segment.profile,
        })
    }
}

/// The share of a box about a pixel that a segment covers, and the share of the base that it masks there.
fn box_share(
    segment: &IndexedSegment,
    offset_um: f64,
    [start_um, end_um]: [f64; 2],
    axes_um: [DVec3; 2],
    sigma: f64,
) -> (ScratchShare, f64) {
    // The box that has the Gaussian's variance.
    let [right_um, down_um] = axes_um.map(|axis| 12f64.sqrt() * axis.truncate());
    let pixel = PixelFootprint { right_um, down_um };
    let (width_um, blur_um) = (segment.profile.width_um as f64, segment.blur_um as f64);
    let seen = |start_um: f64, end_um: f64| {
        published_share(width_um, offset_um, start_um, end_um, blur_um, pixel, sigma)
    };
    let segment = seen(start_um, end_um);
    let share = ScratchShare {
        segment: segment.share,
        line: seen(-ENDLESS_UM, ENDLESS_UM).share,
        cover: 1.0,
    };
    (share, segment.density)
}

//! A point that is shaded, and its relation to a scratch.

use crate::light_view::LightViews;
use crate::surface::SurfacePoint;
use glam::DVec2;
use hairline_optics::band::{BandStds, band_stds_seen_by};
use hairline_optics::footprint::ScratchShare;

/// A point of a surface with scratches, in the picture.
pub(crate) struct ScratchPoint<'a> {
    pub point: &'a SurfacePoint<'a>,
    pub object: u32,
    pub at_px: DVec2,
    /// The lights from there, ready for scratches.
    pub views: &'a LightViews<'a>,
    /// Index into the sums.
    pub index: usize,
}

impl<'a> ScratchPoint<'a> {
    /// One that a ray met, by itself: it has no place in the picture.
    pub fn of_ray(point: &'a SurfacePoint<'a>, object: u32, views: &'a LightViews<'a>) -> Self {
        Self {
            point,
            object,
            at_px: DVec2::ZERO,
            views,
            index: 0,
        }
    }
}

/// Values of a point that are the same for all scratches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// Movements of the point by one standard deviation of the pixel's filter to the right and down, in the surface's
    /// frame.
    pub steps_um: [DVec2; 2],
    /// The coherence window's variance.
    pub window_um2: f64,
    /// Standard deviations of the band that a pixel without perspective sees.
    pub stds: BandStds,
}

impl Frame {
    pub fn new(point: &SurfacePoint) -> Self {
        Self {
            steps_um: point
                .footprint_axes_m
                .map(|step| (point.surface_from_world(step) * 1e6).truncate()),
            window_um2: 0.5 * point.coherence_um * point.coherence_um,
            stds: band_stds_seen_by(point.observer, point.coherence_um),
        }
    }
}

/// Share of a segment from its place under a footprint: [`hairline_optics::footprint::scratch_share`].
#[inline]
pub(super) fn share(
    width_um: f64,
    far2: f64,
    variance_um2: f64,
    [low, high]: [f64; 2],
) -> ScratchShare {
    use hairline_optics::gaussian::gaussian;
    let line = width_um
        * (-0.5 * far2).exp()
        * (1.0 / (variance_um2 * (2.0 * std::f64::consts::PI))).sqrt();
    ScratchShare {
        segment: line * gaussian().integral(low, high),
        line,
        cover: 1.0,
    }
}

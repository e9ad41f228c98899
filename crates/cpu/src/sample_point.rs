//! A sample point: the hit of one sample's ray, and the origin of its own rays.

use crate::light_view::LightViews;
use crate::shadows::{PixelFilter, Rounds, ShadowPoint};
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_index::Hit;
use hairline_scene::CameraFrame;

/// One sample of a pixel.
pub(crate) struct SamplePoint<'a> {
    /// Index of the pixel in the tile.
    pub pixel: usize,
    /// Middle of the pixel, and place of the sample.
    pub middle_px: DVec2,
    pub at_px: DVec2,
    /// Standard deviation of the sample's filter.
    pub std_px: f64,
    /// Whether its pixel has no edge.
    pub is_smooth: bool,
    /// Rays to each light.
    pub rounds: Rounds,
    pub seen: SampleView<'a>,
    pub scratches: Shared,
    /// Surface for the sample's scratches, where they are seen through another filter.
    pub wide: Option<Wide<'a>>,
}

/// A sample's surface through the pixel's whole filter.
pub(crate) struct Wide<'a> {
    pub point: SurfacePoint<'a>,
    pub std_px: f64,
}

/// Samples of a pixel that share one sample's scratches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shared {
    /// The sample shades the scratches for this number of samples, itself among them.
    Among(u32),
    /// Another sample of the batch has the scratches.
    With(usize),
}

impl<'a> SamplePoint<'a> {
    /// Origin of the sample's rays, if it sees a surface.
    pub(crate) fn shadow_point<'p>(
        &'p self,
        camera: &'p CameraFrame,
        views: &'p LightViews<'a>,
    ) -> Option<ShadowPoint<'p, 'a>> {
        let SampleView::Surface { hit, point, .. } = &self.seen else {
            return None;
        };
        Some(ShadowPoint {
            point,
            object: hit.object,
            pixel: Some(PixelFilter {
                camera,
                at_px: self.at_px,
                std_px: self.std_px,
                is_smooth: self.is_smooth,
            }),
            views,
            rounds: self.rounds,
            seed: self.seed(),
            depth: 0,
        })
    }

    /// Surface point for the sample's scratches, given its own.
    pub fn scratched<'p>(&'p self, own: &'p SurfacePoint<'a>) -> &'p SurfacePoint<'a> {
        self.wide.as_ref().map_or(own, |wide| &wide.point)
    }

    /// Origin of the rays off the sample's scratches; none if another sample shades them.
    pub(crate) fn scratched_point<'p>(
        &'p self,
        camera: &'p CameraFrame,
        views: &'p LightViews<'a>,
    ) -> Option<ShadowPoint<'p, 'a>> {
        let Shared::Among(samples) = self.scratches else {
            return None;
        };
        let mut at = self.shadow_point(camera, views)?;
        at.rounds.now.count *= samples;
        at.rounds.all *= samples;
        if let Some(wide) = &self.wide {
            at.point = &wide.point;
            at.pixel = Some(PixelFilter {
                camera,
                at_px: self.at_px,
                std_px: wide.std_px,
                is_smooth: self.is_smooth,
            });
        }
        Some(at)
    }

    /// Seed of random numbers, another one for each pixel: its samples on an edge are rounds of one sequence.
    fn seed(&self) -> u32 {
        let mixed = |a: u32, b: f64| {
            let a = (a ^ (b as f32).to_bits()).wrapping_mul(0x85eb_ca6b);
            a ^ (a >> 15)
        };
        mixed(mixed(1, self.middle_px.x), self.middle_px.y).wrapping_mul(0xc2b2_ae35)
    }
}

/// Result of the ray of a sample.
#[expect(
    clippy::large_enum_variant,
    reason = "there are few at a time, and most are surfaces"
)]
pub(crate) enum SampleView<'a> {
    /// No surface: radiance of the environment.
    Background(DVec3),
    Surface {
        hit: Hit,
        point: SurfacePoint<'a>,
        /// Parts of the sample's filter that its base is a mean over, with their weights; none for the point alone.
        parts: Vec<(f64, SurfacePoint<'a>)>,
        /// Depth along the view axis.
        depth_m: f64,
    },
}

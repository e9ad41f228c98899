//! Lights that can reach a segment from any point of a batch. Most segments are dark to most lights, so this decides once for the
//! whole batch what each pair of a point and a segment would have to ask for itself.
//!
//! A light reaches a scratch where xi_t = t . (wo + wi) lies within the band. With d, a segment's unit direction, and h = wo + wi
//! without its part along the normal, t . h is (d . h) / |d_t|, and d_t, the part of d in the plane of shading, is no longer than d:
//! so what lies outside of the band with d in the place of t lies outside with t too. The tangent of an arc turns from its chord by half of
//! its turn at most.

use super::point::{Frame, ScratchPoint};
use glam::DVec3;
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::REACH_STD;
use hairline_optics::band::{BAND_REACH_STD, BAND_STD_MAX};

/// The lights that any point of a batch sees.
#[derive(Default)]
pub(super) struct LightBounds {
    /// Bounds by the number of the light in the scene.
    bounds: Vec<Bound>,
}

/// A light from all points of a batch.
#[derive(Clone, Copy)]
struct Bound {
    light: u32,
    /// The box of h, world space.
    low: DVec3,
    high: DVec3,
    /// Largest distance of d . h from zero.
    reach: f64,
    /// The greatest length of h.
    length: f64,
}

impl LightBounds {
    pub fn gather(&mut self, points: &[ScratchPoint], frames: &[Frame]) {
        self.bounds.clear();
        let lights = points.first().map_or(0, |point| point.views.light_count());
        for light in 0..lights as u32 {
            let mut bound = Bound {
                light,
                low: DVec3::INFINITY,
                high: DVec3::NEG_INFINITY,
                reach: f64::NEG_INFINITY,
                length: 0.0,
            };
            for (p, frame) in points.iter().zip(frames) {
                let Some(view) = p.views.view_of(light) else {
                    continue;
                };
                let cap = p.views.views[view].bound();
                let moves = p.views.moves[view];
                let moved = (moves[0].length_squared() + moves[1].length_squared()).sqrt();
                let h = (p.point.wo + cap.cos_radius * cap.axis).with_z(0.0);
                bound.length = bound.length.max(h.length());
                let h = p.point.world_from_surface(h);
                (bound.low, bound.high) = (bound.low.min(h), bound.high.max(h));
                // A cap around the direction of a scratch reaches further than its middle tells.
                let reach = if cap.axis.truncate().length() >= cap.cos_radius {
                    f64::INFINITY
                } else {
                    let shift = (f64::from(REACH_STD) * moved).min(BAND_STD_MAX);
                    let std = frame.stds.mean.hypot(moved).min(BAND_STD_MAX);
                    cap.sin_radius + shift + BAND_REACH_STD * std
                };
                bound.reach = bound.reach.max(reach);
            }
            if bound.reach > 0.0 {
                // Against rounding.
                bound.reach += 1e-9;
                self.bounds.push(bound);
            }
        }
    }

    /// Finds the lights that can reach a segment, in their order.
    pub fn find(&self, segment: &IndexedSegment, lit: &mut Vec<u32>) {
        lit.clear();
        let d = (segment.end_m.as_dvec3() - segment.start_m.as_dvec3()).normalize_or_zero();
        let turn = 0.5 * f64::from(segment.turn_rad).abs();
        let (positive, negative) = (d.max(DVec3::ZERO), d.min(DVec3::ZERO));
        for bound in &self.bounds {
            let low = positive.dot(bound.low) + negative.dot(bound.high);
            let high = positive.dot(bound.high) + negative.dot(bound.low);
            let reach = bound.reach + turn * bound.length;
            if low <= reach && high >= -reach {
                lit.push(bound.light);
            }
        }
    }
}

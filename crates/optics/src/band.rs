//! Intersects an area light with the band of a scratch (docs/model.md, section 4; after Velinov, Werner, Hullin, *Real-Time Rendering of
//! Wave-Optical Effects on Scratched Surfaces*, 2018; the signed boundary sum is Hairline's own).
//!
//! A scratch lights the directions with xi_t = 0, a Gaussian band around them in truth. Directions of one line of the band
//! form a cone about the tangent: w(phi) = w_t t + r (cos phi n + sin phi N), phi in [0, pi] above the horizon. A light
//! cuts chords out of it, bounded by roots; the integral over the chords is a SIGNED SUM over roots, each alone: where phi
//! enters the light the antiderivative at q = wo_n + w_n counts plus, where it leaves minus. No clip, no sort, no pairing.
//!
//! Below the horizon nothing is lit, so the antiderivative is constant there: a root under the horizon counts with the q
//! of the nearer end of the arc. That moves its jump to the direction straight down, and a light that covers that
//! direction adds the whole arc once ([`Chord::wraps`]). Crossing the horizon is continuous by construction.
//!
//! All vectors are in the scratch's frame: x along the tangent t, y across it along n, z along the surface normal N.

mod drawn;
mod lines;
mod motion;
mod outline;
mod polygon;
mod sphere;
mod tube;

pub use drawn::DrawnChord;
pub use lines::{
    BAND_REACH_STD, BAND_STD_MAX, BandLines, BandStds, band_is_whole, band_lines, band_stds,
    band_stds_seen_by,
};
pub use motion::{Along, BandMotion, BandPlace, MovedBand, band_moves, moved_band};
pub use outline::{Outline, OutlineEdge, OutlineRoots};
pub use polygon::{PolygonView, polygon_facing};
pub use sphere::{Cap, sphere_band_extent, sphere_cap, sphere_chord};
pub use tube::{TUBE_CORNERS, TubeOutline, tube_outline};

use glam::{DVec2, DVec3};

/// One line of the band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandLine {
    /// Component along the tangent of all directions on the line, xi_t - wo_t.
    pub along: f64,
    /// Radius of the cone's circle, sqrt(1 - along^2).
    pub radius: f64,
    /// wo_n: q = wo_n + w_n.
    pub offset: f64,
}

impl BandLine {
    /// The line at `xi_t` seen from `wo`.
    #[inline]
    pub fn new(wo: DVec3, xi_t: f64) -> Self {
        let along = xi_t - wo.x;
        Self {
            along,
            radius: (1.0 - along * along).max(0.0).sqrt(),
            offset: wo.y,
        }
    }

    /// q at phi = 0.
    #[inline]
    pub fn q_start(self) -> f64 {
        self.offset + self.radius
    }

    /// q at phi = pi.
    #[inline]
    pub fn q_end(self) -> f64 {
        self.offset - self.radius
    }

    /// The direction above the horizon at `q`.
    #[inline]
    pub fn direction_at(self, q: f64) -> DVec3 {
        DVec3::new(self.along, q - self.offset, self.cos_at(q))
    }

    /// Cosine to the normal of the direction above the horizon at `q`.
    #[inline]
    pub(crate) fn cos_at(self, q: f64) -> f64 {
        let across = q - self.offset;
        ((self.radius - across) * (self.radius + across))
            .max(0.0)
            .sqrt()
    }

    /// q of a direction on the line with components (across, up); roots below the horizon move to the nearer end.
    #[inline]
    fn q(self, across: f64, up: f64) -> f64 {
        let inside = across.clamp(-self.radius, self.radius);
        self.offset
            + if up >= 0.0 {
                inside
            } else {
                self.radius.copysign(across)
            }
    }
}

/// Scale of the weight that stands for sinc^2 in [`chord_cos`], as u = W q. From 0.15 to 0.25 um the errors change little.
const CHORD_WEIGHT_UM: f64 = 0.2;

/// Cosine to the normal of the directions of a line from `low` to `high` in q, as a scratch of width `width_um` weighs them:
/// the mean at two Gauss nodes in x = q / (|q| + h), that is with the density h / (|q| + h)^2 in the place of sinc^2.
#[inline]
pub fn chord_cos(line: BandLine, low: f64, high: f64, width_um: f64) -> f64 {
    let h = CHORD_WEIGHT_UM / width_um.max(1e-3);
    let (x_low, x_high) = (low / (low.abs() + h), high / (high.abs() + h));
    let cos_at = |node: f64| {
        let x = x_low + (x_high - x_low) * node;
        line.cos_at((h * x / (1.0 - x.abs()).max(1e-9)).clamp(low, high))
    };
    0.5 * (cos_at(0.211_324_865_405_187) + cos_at(0.788_675_134_594_813))
}

/// A light's chord on one line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// q where phi enters the light.
    pub enter: f64,
    /// q where phi leaves it.
    pub leave: f64,
    /// Whether the light covers the direction straight down, so that the whole arc counts once more.
    pub wraps: bool,
}

impl Chord {
    /// Least and greatest q that the light covers; the whole arc where it goes around the nadir.
    #[inline]
    pub fn range(&self, line: BandLine) -> (f64, f64) {
        if self.wraps {
            (line.q_end(), line.q_start())
        } else {
            (self.leave, self.enter)
        }
    }

    /// The sign with which the antiderivative counts at each root, and q; those of the whole arc where the light covers the direction straight down.
    pub fn signed(&self, line: BandLine) -> impl Iterator<Item = (f64, f64)> {
        let arc = [(1.0, line.q_start()), (-1.0, line.q_end())];
        let wraps = arc.into_iter().take(if self.wraps { 2 } else { 0 });
        [(1.0, self.enter), (-1.0, self.leave)]
            .into_iter()
            .chain(wraps)
    }

    /// The light integral, given the antiderivative over q.
    pub fn integral<const C: usize>(
        &self,
        line: BandLine,
        antiderivative: impl Fn(f64) -> [f64; C],
    ) -> [f64; C] {
        let mut sum = [0.0; C];
        let mut add = |high: f64, low: f64| {
            let (high, low) = (antiderivative(high), antiderivative(low));
            (0..C).for_each(|c| sum[c] += high[c] - low[c]);
        };
        add(self.enter, self.leave);
        if self.wraps {
            add(line.q_start(), line.q_end());
        }
        sum
    }
}

/// The axes of a scratch within the frame of the surface: vectors with z along N turn about it until x lies along t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandFrame {
    /// The unit tangent t in the surface's x and y.
    pub tangent: DVec2,
}

impl BandFrame {
    /// A vector of the surface's frame in the frame of the scratch.
    #[inline]
    pub fn band_from_surface(self, v: DVec3) -> DVec3 {
        let t = self.tangent;
        DVec3::new(v.x * t.x + v.y * t.y, v.y * t.x - v.x * t.y, v.z)
    }

    /// The inverse of [`Self::band_from_surface`].
    #[inline]
    pub fn surface_from_band(self, v: DVec3) -> DVec3 {
        let t = self.tangent;
        DVec3::new(v.x * t.x - v.y * t.y, v.x * t.y + v.y * t.x, v.z)
    }
}

#[cfg(test)]
mod tests;

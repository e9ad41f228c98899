//! An environment along the band of a scratch: a 1-D integral, cut into cells (docs/model.md, section 8).
//!
//! Within a cell the environment is taken as one blurred value and the scratch's response as the exact difference of its
//! antiderivative, so the cells' responses sum to the whole whatever the environment. Cells are narrow where the response
//! is: at u = W q near zero. Where even those are wider than a light, the map's own lobes blur it: across the band too, where
//! the scratch would not. So the blur is kept narrower than the cell; narrower still, and a small light would show once a cell.

use crate::band::{BandLine, chord_cos};
use glam::{DVec2, DVec3};

/// Cells along the band. Those beyond the arc's ends, many on narrow scratches, are empty.
pub const ENVIRONMENT_CELLS: usize = 24;

/// Alpha of the lobe that blurs a cell over the angle that it spans. Against quadrature 0.06 to 0.12 do equally well for lights
/// of 0.1 rad, less for wider ones, more for narrower.
const CELL_ALPHA: f64 = 0.1;

/// One cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentCell {
    /// Lower end in q.
    pub q_low: f64,
    /// Upper end in q.
    pub q_high: f64,
    /// A unit direction in its middle, in the frame of the scratch.
    pub direction: DVec3,
    /// The angle that it spans along the band, as an arc on the unit sphere.
    pub angle_rad: f64,
}

impl EnvironmentCell {
    /// The perceptual roughness of the mirror lobe that stands for the cell.
    pub fn environment_cell_roughness(&self) -> f64 {
        (CELL_ALPHA * self.angle_rad).sqrt().min(1.0)
    }
}

/// The bound between cells i - 1 and i in u, um: even over the main lobe, whose first zero lies at one wavelength, then growing
/// with the lobes' decay.
fn environment_cell_bound_um(i: usize) -> f64 {
    let outward = i as f64 - (ENVIRONMENT_CELLS / 2) as f64;
    let far = outward.abs() / 9.0;
    let far2 = far * far;
    0.07 * outward * (1.0 + far2 * far2 * far2 * far)
}

/// Cell `i` of a line. Cells follow one another in q from the arc's end to its start.
pub fn environment_cell(i: usize, line: BandLine, width_um: f64) -> EnvironmentCell {
    // A scratch of no width has no lobe: every bound but zero lies beyond the arc.
    let width = width_um.max(1e-3);
    let (end, start) = (line.q_end(), line.q_start());
    let bound = |i: usize| (environment_cell_bound_um(i) / width).clamp(end, start);
    let q_low = if i == 0 { end } else { bound(i) };
    let q_high = if i == ENVIRONMENT_CELLS - 1 {
        start
    } else {
        bound(i + 1)
    };
    // The points of the arc at both ends, across and up; their sum points to the middle.
    let at = |q: f64| DVec2::new(q - line.offset, line.cos_at(q));
    let (low, high) = (at(q_low), at(q_high));
    let middle = line.radius * (low + high).normalize_or(DVec2::Y);
    let half_chord = 0.5 * (high - low).length();
    let half_angle = (half_chord / line.radius.max(1e-9)).min(1.0).asin();
    EnvironmentCell {
        q_low,
        q_high,
        direction: DVec3::new(line.along, middle.x, middle.y),
        angle_rad: 2.0 * line.radius * half_angle,
    }
}

/// The light of an environment off a scratch of width `width_um` along a line of its band, cell by cell. `antiderivative` is
/// the scratch's response over q, from any fixed q on, at a cosine of the light's direction to the normal; `blurred` the
/// environment towards a direction (in the frame of the
/// scratch), blurred by the mirror lobe of a perceptual roughness.
pub fn environment_band(
    line: BandLine,
    width_um: f64,
    antiderivative: impl Fn(f64, f64) -> [f64; 3],
    blurred: impl Fn(DVec3, f64) -> DVec3,
) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for i in 0..ENVIRONMENT_CELLS {
        let cell = environment_cell(i, line, width_um);
        if cell.q_high > cell.q_low {
            let cos_i = chord_cos(line, cell.q_low, cell.q_high, width_um);
            let at = |q: f64| DVec3::from(antiderivative(q, cos_i));
            let blur = cell.environment_cell_roughness();
            sum += (at(cell.q_high) - at(cell.q_low)) * blurred(cell.direction, blur);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_tile_the_arc() {
        for wo in [
            DVec3::Z,
            DVec3::new(0.3, -0.5, 0.8).normalize(),
            DVec3::new(0.999, 0.0, 0.04).normalize(),
        ] {
            for width in [0.0, 0.5, 2.0, 50.0] {
                let line = BandLine::new(wo, 0.0);
                let mut at = line.q_end();
                for i in 0..ENVIRONMENT_CELLS {
                    let cell = environment_cell(i, line, width);
                    assert_eq!(cell.q_low, at);
                    assert!(cell.q_high >= cell.q_low);
                    assert!(
                        (cell.direction.length() - 1.0).abs() < 1e-9 && cell.direction.z >= 0.0
                    );
                    assert!(
                        cell.angle_rad.is_finite() && cell.angle_rad <= std::f64::consts::PI + 1e-9
                    );
                    at = cell.q_high;
                }
                assert_eq!(at, line.q_start());
            }
        }
    }
}

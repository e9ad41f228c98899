//! An environment along the band of a scratch: a 1-D integral, cut into cells (docs/model.md, section 8).
//!
//! Within a cell the environment is taken as one blurred value and the scratch's response as the exact difference of its
//! antiderivative, so the cells' responses sum to the whole whatever the environment. Cells are narrow where the response
//! is: at u = W q near zero.

use crate::band::BandLine;
use glam::DVec3;

/// Cells along the band.
pub const ENVIRONMENT_CELLS: usize = 10;

/// Bounds of the cells in u, um; the main lobe's first zero lies at one wavelength.
const CELL_BOUNDS_UM: [f64; 9] = [-1.5, -0.7, -0.35, -0.15, 0.0, 0.15, 0.35, 0.7, 1.5];

/// One cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentCell {
    /// Lower end in q.
    pub q_low: f64,
    /// Upper end in q.
    pub q_high: f64,
    /// A unit direction in its middle, in the frame of the scratch.
    pub direction: DVec3,
    /// The angle that it spans along the band.
    pub angle_rad: f64,
}

impl EnvironmentCell {
    /// The perceptual roughness of the GGX mirror lobe that is about as wide as the cell: a lobe of alpha spreads
    /// mirrored directions over some four alpha.
    pub fn roughness(&self) -> f64 {
        (0.25 * self.angle_rad).sqrt().min(1.0)
    }
}

/// Cell `i` of a line. Cells follow one another in q from the arc's end to its start; those beyond the arc are empty.
pub fn environment_cell(i: usize, line: BandLine, width_um: f64) -> EnvironmentCell {
    // A scratch of no width has no lobe: every bound but zero lies beyond the arc.
    let width = width_um.max(1e-3);
    let bound = |u: f64| (u / width).clamp(line.q_end(), line.q_start());
    let q_low = if i == 0 {
        line.q_end()
    } else {
        bound(CELL_BOUNDS_UM[i - 1])
    };
    let q_high = if i == ENVIRONMENT_CELLS - 1 {
        line.q_start()
    } else {
        bound(CELL_BOUNDS_UM[i])
    };
    let across = 0.5 * (q_low + q_high) - line.offset;
    let up = (line.radius * line.radius - across * across)
        .max(0.0)
        .sqrt();
    // Near the horizon a step in q spans a wide angle; the cell's own width bounds it.
    let angle_rad = (q_high - q_low) / up.max(0.5 * (q_high - q_low)).max(1e-6);
    EnvironmentCell {
        q_low,
        q_high,
        direction: DVec3::new(line.along, across, up),
        angle_rad,
    }
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
                    assert!(cell.angle_rad.is_finite() && cell.angle_rad <= 2.0 + 1e-9);
                    at = cell.q_high;
                }
                assert_eq!(at, line.q_start());
            }
        }
    }
}

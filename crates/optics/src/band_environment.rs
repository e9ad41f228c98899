//! An environment along the band of a scratch: a 1-D integral, cut into cells (docs/model.md, section 8).
//!
//! Within a cell the environment is taken as one blurred value and the scratch's response as the exact difference of its
//! antiderivative, so the cells' responses sum to the whole whatever the environment. Cells are even in x = q / (|q| + h), as
//! [`crate::band::chord_cos`] weighs directions: with the density h / (|q| + h)^2 in the place of the response's, all cells have the
//! same share of it, and the middle of a cell in x is where its light comes from. Where a cell is wider than a light, the map's own
//! lobes blur it: across the band too, where the scratch would not. So the blur is kept narrower than the cell; narrower still, and a
//! small light would show once a cell.
//!
//! Ten cells against a dense integral, relative rms of twelve scratches together (24 cells that were even in q and wider outwards, in
//! brackets): a studio 2.0 % (1.1), a workshop with small bright lamps 5.4 % (8.3), an evening sky 0.5 % (0.6), a window with sharp
//! edges 4.1 % (3.8).

use crate::band::BandLine;
use glam::DVec3;

/// Cells along the band.
pub const ENVIRONMENT_CELLS: usize = 10;

/// Scale of x as u = W q. Larger ones take more of the cells to the lobes beside the main one.
const CELL_SCALE_UM: f64 = 0.3;

/// Number of cells along the band for a grating. Its orders spread the colours over the whole band, so the cells are even in the
/// angle.
pub(crate) const ROW_CELLS: usize = 48;

/// A part of a light's chord on a grating, of one depth, is no longer in q.
const ROW_PART: f64 = 0.05;

/// Returns the number of parts into which a chord of the given length in q is cut for a grating.
pub fn row_part_count(length: f64) -> usize {
    (length / ROW_PART).ceil().clamp(1.0, ROW_CELLS as f64) as usize
}

/// Number of parts of a cell for shadow rays.
pub(crate) const CELL_PARTS: usize = 6;

/// Alpha of the lobe that blurs a cell over the chord that it spans.
const CELL_ALPHA: f64 = 0.08;

/// One cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnvironmentCell {
    /// Lower end in q.
    pub q_low: f64,
    /// Upper end in q.
    pub q_high: f64,
    /// The unit direction that stands for it, in the frame of the scratch. Its z is the cosine for the groove's depth.
    pub direction: DVec3,
    /// Length of the cell's chord on the unit sphere, for the angle that the cell spans along the band.
    pub angle_rad: f64,
}

impl EnvironmentCell {
    /// The perceptual roughness of the mirror lobe that stands for the cell.
    #[inline]
    pub fn environment_cell_roughness(&self) -> f64 {
        (CELL_ALPHA * self.angle_rad).sqrt()
    }

    /// The cell in parts that are even in q. `line` is the cell's.
    pub fn parts(&self, line: BandLine) -> [Self; CELL_PARTS] {
        let step = (self.q_high - self.q_low) / CELL_PARTS as f64;
        std::array::from_fn(|i| {
            let q_low = self.q_low + step * i as f64;
            let q_high = q_low + step;
            let ends = [q_low, q_high].map(|q| line.direction_at(q));
            Self {
                q_low,
                q_high,
                direction: line.direction_at(q_low + 0.5 * step),
                angle_rad: ends[0].distance(ends[1]),
            }
        })
    }
}

/// The cells of a line, from the arc's end to its start in q. Loops over plain numbers, which compilers turn into vector instructions.
#[inline(always)]
pub fn environment_cells(line: BandLine, width_um: f64) -> [EnvironmentCell; ENVIRONMENT_CELLS] {
    const POINTS: usize = 2 * ENVIRONMENT_CELLS + 1;
    // A scratch of no width has no lobe; what counts is that nothing is divided by zero.
    let scale = CELL_SCALE_UM / width_um.max(1e-3);
    let (end, start) = (line.q_end(), line.q_start());
    let low = end / (end.abs() + scale);
    let high = start / (start.abs() + scale);
    let step = (high - low) / (POINTS - 1) as f64;
    // The bounds of cells and, between them, their middles.
    let mut q = [0.0; POINTS];
    let mut cos = [0.0; POINTS];
    for (i, q) in q.iter_mut().enumerate() {
        let x = low + step * i as f64;
        let far = scale * x / (1.0 - x.abs()).max(1e-9);
        *q = far.max(end).min(start);
    }
    // Rounding must not leave out a part of the arc.
    q[0] = end;
    q[POINTS - 1] = start;
    for i in 0..POINTS {
        cos[i] = line.cos_at(q[i]);
    }
    std::array::from_fn(|i| {
        let (low, middle, high) = (2 * i, 2 * i + 1, 2 * i + 2);
        let (dq, dcos) = (q[high] - q[low], cos[high] - cos[low]);
        EnvironmentCell {
            q_low: q[low],
            q_high: q[high],
            direction: DVec3::new(line.along, q[middle] - line.offset, cos[middle]),
            angle_rad: (dq * dq + dcos * dcos).sqrt(),
        }
    })
}

/// The cells of a line for a grating, from the arc's end to its start in q.
pub fn row_cells(line: BandLine) -> [EnvironmentCell; ROW_CELLS] {
    // Twice as many steps as cells, for their middles too.
    let step = std::f64::consts::PI / (2 * ROW_CELLS) as f64;
    let at = |i: usize| line.offset - line.radius * (step * i as f64).cos();
    std::array::from_fn(|i| {
        let (q_low, middle, q_high) = (at(2 * i), at(2 * i + 1), at(2 * i + 2));
        EnvironmentCell {
            q_low,
            q_high,
            direction: line.direction_at(middle),
            angle_rad: 2.0 * line.radius * step.sin(),
        }
    })
}

/// Cell `i` of a line. Cells follow one another in q from the arc's end to its start.
pub fn environment_cell(i: usize, line: BandLine, width_um: f64) -> EnvironmentCell {
    environment_cells(line, width_um)[i]
}

/// Integrates the light of an environment off a scratch of width `width_um` along a line of its band, cell by cell. `antiderivative`
/// is the scratch's response over q, from any fixed q on, at a cosine of the light's direction to the normal; `blurred` the
/// environment towards a direction (in the frame of the scratch), blurred by the mirror lobe of a perceptual roughness.
#[inline(always)]
pub fn environment_band(
    line: BandLine,
    width_um: f64,
    antiderivative: impl Fn(f64, f64) -> [f64; 3],
    blurred: impl Fn(DVec3, f64) -> DVec3,
) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for cell in environment_cells(line, width_um) {
        if cell.q_high > cell.q_low {
            let at = |q: f64| DVec3::from(antiderivative(q, cell.direction.z));
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
                    assert!((0.0..=2.0 + 1e-9).contains(&cell.angle_rad));
                    at = cell.q_high;
                }
                assert_eq!(at, line.q_start());
            }
            let line = BandLine::new(wo, 0.0);
            let cells = row_cells(line);
            assert!((cells[0].q_low - line.q_end()).abs() < 1e-12);
            assert!((cells[ROW_CELLS - 1].q_high - line.q_start()).abs() < 1e-12);
            for (i, cell) in cells.iter().enumerate() {
                assert!(i == 0 || cells[i - 1].q_high == cell.q_low);
                assert!(cell.q_high >= cell.q_low);
                assert!((cell.direction.length() - 1.0).abs() < 1e-9 && cell.direction.z >= 0.0);
            }
        }
    }
}

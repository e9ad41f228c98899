//! Light of a groove over a chord. A scratch sends light about the mirror's direction, with one depth; the orders of a grating may lie anywhere on a
//! wide chord, where its depth is another. Twin: `ChordDepths` of scratch_light.wgsl.

use glam::DVec3;
use hairline_optics::band::BandLine;
use hairline_optics::band_environment::row_part_count;
use hairline_optics::table::TableRow;

/// The antiderivative over q, with a depth for each part of a chord of a grating.
#[derive(Clone)]
pub(super) struct PartedChord<'a> {
    width_um: f64,
    low: f64,
    step: f64,
    /// For each part, the antiderivative at its lower end, and the table at its depth.
    parts: Vec<(DVec3, TableRow<'a>)>,
}

impl<'a> PartedChord<'a> {
    /// The chord of a grating that is looked up as a scratch of a width, from q to q; `row` is its table at the cosine of a direction. None where one
    /// depth serves.
    pub(super) fn new(
        line: BandLine,
        (low, high): (f64, f64),
        width_um: f64,
        row: impl Fn(f64) -> TableRow<'a>,
    ) -> Option<Self> {
        let count = row_part_count(high - low);
        if count < 2 {
            return None;
        }
        let step = (high - low) / count as f64;
        let mut below = DVec3::ZERO;
        let part = |i: usize| {
            let start = low + step * i as f64;
            let row = row(line.direction_at(start + 0.5 * step).z);
            let at = |q: f64| DVec3::from(row.look_up(width_um * q));
            let part = (below - at(start), row);
            below += at(start + step) - at(start);
            part
        };
        Some(Self {
            width_um,
            low,
            step,
            parts: (0..count).map(part).collect(),
        })
    }

    /// Evaluates the antiderivative. Beyond the chord's ends the depths are those at the ends.
    pub(super) fn look_up(&self, q: f64) -> [f64; 3] {
        let i = ((q - self.low) / self.step).max(0.0) as usize;
        let (before, row) = &self.parts[i.min(self.parts.len() - 1)];
        (*before + DVec3::from(row.look_up(self.width_um * q))).to_array()
    }
}

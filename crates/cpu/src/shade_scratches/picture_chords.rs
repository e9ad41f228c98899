//! Chords of lights with pictures: a chord is cut into parts with one look-up each. Twin: scratch_picture.wgsl.

use super::scratch_light::ScratchLight;
use crate::picture::PictureView;
use glam::DVec3;
use hairline_optics::band::{BandLine, DrawnChord, OutlineRoots};
use hairline_optics::picture::{PICTURE_CELLS, PICTURE_ROW_CELLS, picture_place};

impl ScratchLight<'_> {
    /// Cuts the chords of a light into parts, from q to q, with the light that the picture sends from there. `of_luminance` is the
    /// antiderivative of the luminance that the groove sends.
    pub(super) fn picture_parts(
        &self,
        line: BandLine,
        roots: &OutlineRoots,
        picture: PictureView,
        of_luminance: impl Fn(f64) -> f64,
    ) -> impl Iterator<Item = (f64, f64, DVec3)> {
        let mut chord = DrawnChord::default();
        chord.find(roots.signed().iter().copied(), of_luminance);
        let chords: Vec<(f64, f64)> = chord.intervals().collect();
        let frame = self.frame;
        let towards = move |q: f64| frame.surface_from_band(line.direction_at(q));
        let weighed_um = self.weighed_um();
        let count = match self.row {
            Some(_) => PICTURE_ROW_CELLS,
            None => PICTURE_CELLS,
        };
        chords.into_iter().flat_map(move |(first, last)| {
            (0..count).map(move |i| {
                let place = |at: f64| {
                    picture_place((i as f64 + at) / count as f64, first, last, weighed_um)
                };
                let [low, middle, high] = [0.0, 0.5, 1.0].map(place);
                let directions = [low, middle, high].map(towards);
                (low, high, picture.on_chord(directions, middle))
            })
        })
    }
}

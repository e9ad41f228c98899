//! A scratch, or many of one direction, as seen from a point, and the light that they send to the viewer (docs/model.md, sections
//! 5 and 6).

use crate::light_view::{LightView, LightViews};
use crate::scratches::{Pixel, Work};
use glam::{DVec2, DVec3};
use hairline_optics::band::{
    BandFrame, BandLine, BandMotion, BandPlace, Cap, Outline, OutlineRoots, band_is_whole,
    band_lines, chord_cos, sphere_band_extent, sphere_chord,
};
use hairline_optics::band_environment::environment_band;
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::table::{ScratchTable, TableRow};
use hairline_scene::Environment;

/// What a scratch is like, or a class of many.
#[derive(Clone, Copy)]
pub(crate) struct Groove<'a> {
    pub table: &'a ScratchTable,
    pub width_um: f64,
    pub depth_nm: f64,
    /// Shares by which many are wider and deeper than their class, in the mean; 0 for a single scratch.
    pub moved: [f64; 2],
    /// What its light counts for.
    pub share: f64,
}

impl<'a> Groove<'a> {
    /// T over u for light and a viewer with cosines to the normal.
    fn row(&self, cos_i: f64, cos_o: f64) -> TableRow<'a> {
        let [wider, deeper] = self.moved;
        self.table
            .at_depth(oblique_depth_nm(self.depth_nm, cos_i, cos_o))
            .moved(wider, deeper)
    }
}

/// Scratches of one direction, all along which they see the light alike.
pub(crate) struct SegmentView<'a, const N: usize> {
    frame: BandFrame,
    /// `wo` in the frame of the scratch.
    wo: DVec3,
    grooves: [Groove<'a>; N],
    /// Variance of the tangent's angle about it; 0 for a single scratch.
    turn_rad2: f64,
    place: BandPlace,
    /// Which part of it is meant; else what the pixel sees of an endless one.
    part: Part,
}

/// A part of a scratch under a footprint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    /// What is left of the footprint's variance along the scratch, in which a piece with ends has less room.
    pub seen_along: f64,
    /// How far ahead of the pixel's middle it lies: in the picture, in standard deviations of the pixel's filter.
    pub ahead: [f64; 2],
}

impl Part {
    const WHOLE: Self = Self {
        seen_along: 1.0,
        ahead: [0.0; 2],
    };
}

/// Where the lights of a view are from the band's middle line: a bit for each, the 64th and those beyond share one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sides {
    /// By how much the sum of the directions to the viewer and to a light that does reach it turns for a step along the scratch.
    pub turn: f64,
    /// Lights that send nothing by way of the scratch.
    pub dark: u64,
    /// Lights beyond the line, along the tangent; others are before it.
    pub positive: u64,
}

impl<'a, const N: usize> SegmentView<'a, N> {
    /// A scratch at a `place` under the footprint.
    pub fn new(pixel: &Pixel, tangent: DVec2, grooves: [Groove<'a>; N], place: BandPlace) -> Self {
        let frame = BandFrame { tangent };
        Self {
            frame,
            wo: frame.band_from_surface(pixel.point.wo),
            grooves,
            turn_rad2: 0.0,
            place,
            part: Part::WHOLE,
        }
    }

    /// The light of a part of the scratch.
    pub fn at(self, part: Part) -> Self {
        Self { part, ..self }
    }

    /// How the band moves towards a light, itself given by how it moves over the pixel's filter.
    fn moved(&self, moves: [DVec2; 2]) -> BandMotion {
        let moves = moves.map(|m| m.dot(self.frame.tangent));
        let ahead = moves[0] * self.part.ahead[0] + moves[1] * self.part.ahead[1];
        self.place.moved_along(moves, self.part.seen_along, ahead)
    }

    /// What stands for many scratches of one direction, which lie all over the footprint: with them the band is as wide as it moves
    /// over the whole pixel.
    pub fn of_many(
        pixel: &Pixel,
        tangent: DVec2,
        grooves: [Groove<'a>; N],
        turn_rad2: f64,
    ) -> Self {
        // They lie on both sides, as far as the footprint goes: to none of them does the place across tell how ξt moves.
        let place = BandPlace::new([0.0; 2], 0.0, pixel.frame.window_um2);
        Self {
            turn_rad2,
            ..Self::new(pixel, tangent, grooves, place)
        }
    }

    /// Radiance by way of the lights, times the grooves' shares, Fresnel left out.
    pub fn lights(&self, pixel: &Pixel, views: &LightViews, work: &mut Work) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for light in 0..views.views.len() {
            sum += self.light(pixel, views, light, work);
        }
        sum
    }

    /// The same, and where lights are that don't reach it. `step` is one along the scratch in the picture, in standard deviations of the
    /// pixel's filter.
    pub fn lights_and_sides(
        &self,
        pixel: &Pixel,
        views: &LightViews,
        step: DVec2,
        work: &mut Work,
    ) -> (DVec3, Sides) {
        let (mut sum, mut sides) = (DVec3::ZERO, Sides::default());
        for (light, view) in views.views.iter().enumerate() {
            let sent = self.light(pixel, views, light, work);
            sum += sent;
            let cap = view.bound();
            let along = self.frame.tangent.dot(cap.axis.truncate());
            let shift = self.moved(views.moves[light]).shift;
            let middle = self.wo.x + shift + along * cap.cos_radius;
            let bit = 1 << light.min(63);
            if sent == DVec3::ZERO {
                sides.dark |= bit;
            } else {
                let [x, y] = views.moves[light];
                sides.turn = sides.turn.max((x * step.x + y * step.y).length());
            }
            sides.positive |= if middle > 0.0 { bit } else { 0 };
        }
        (sum, sides)
    }

    /// Radiance by way of one light.
    pub fn light(&self, pixel: &Pixel, views: &LightViews, light: usize, work: &mut Work) -> DVec3 {
        let (light, moves) = (&views.views[light], views.moves[light]);
        let tangent = self.frame.tangent;
        let mut motion = self.moved(moves);
        let bound = light.bound();
        work.counts.pairs += 1;
        if self.turn_rad2 > 0.0 {
            let sum = pixel.point.wo.truncate() + bound.cos_radius * bound.axis.truncate();
            let aside = tangent.perp_dot(sum);
            motion.variance += self.turn_rad2 * aside * aside;
        }
        // Most scratches are dark to most lights.
        let along = tangent.dot(bound.axis.truncate());
        if !self.may_meet(pixel, along, bound, motion) {
            return DVec3::ZERO;
        }
        match light {
            LightView::Sphere { cap, radiance } => {
                *radiance * self.sphere(pixel, *cap, motion, work)
            }
            LightView::Polygon {
                vertices,
                away,
                facing,
                sets,
                radiance,
                ..
            } => {
                let outline = views.outline(vertices, *away, *facing, *sets);
                *radiance * self.polygon(pixel, outline, motion, work)
            }
        }
    }

    /// Whether the band can meet a cap whose axis has the component `along` on the tangent.
    fn may_meet(&self, pixel: &Pixel, along: f64, cap: &Cap, motion: BandMotion) -> bool {
        let middle = self.wo.x + motion.shift + along * cap.cos_radius;
        // Around the pole of the tangent a cap reaches further.
        along.abs() >= cap.cos_radius
            || motion.reaches(
                middle - cap.sin_radius,
                middle + cap.sin_radius,
                pixel.frame.stds.mean,
            )
    }

    /// The antiderivative over q of what all grooves send for light from a part of a line.
    fn spectrum(&self, line: BandLine, (low, high): (f64, f64)) -> impl Fn(f64) -> [f64; 3] + 'a {
        let grooves = self.grooves;
        let rows = grooves.map(|groove| {
            let cos_i = chord_cos(line, low, high, groove.width_um);
            groove.row(cos_i, self.wo.z)
        });
        move |q| {
            let mut sum = [0.0; 3];
            for (groove, row) in grooves.iter().zip(&rows) {
                if groove.share > 0.0 {
                    let t = row.at(groove.width_um * q);
                    (0..3).for_each(|c| sum[c] += groove.share * t[c]);
                }
            }
            sum
        }
    }

    /// By a sphere of radiance 1.
    fn sphere(&self, pixel: &Pixel, cap: Cap, motion: BandMotion, work: &mut Work) -> DVec3 {
        let cap = cap.turned(self.frame);
        let wo = self.wo + motion.shift * DVec3::X;
        let (lowest, highest) = sphere_band_extent(wo, cap);
        if !motion.reaches(lowest, highest, pixel.frame.stds.mean) {
            return DVec3::ZERO;
        }
        work.counts.lit += 1;
        let lines = band_lines(wo.x, lowest, highest, motion.band(pixel.frame.stds).stds);
        lines.integral(wo, |line| {
            let chord = sphere_chord(line, cap);
            chord.integral(line, self.spectrum(line, chord.range(line)))
        })
    }

    /// By a polygon of radiance 1.
    fn polygon(
        &self,
        pixel: &Pixel,
        outline: Outline,
        motion: BandMotion,
        work: &mut Work,
    ) -> DVec3 {
        let wo = self.wo + motion.shift * DVec3::X;
        // Large lights cover the whole band, and their corners tell so.
        let (low, high) = outline.corner_extent(self.frame);
        let std = motion.widened(pixel.frame.stds.mean);
        if band_is_whole(wo.x, wo.x + low, wo.x + high, std) {
            work.counts.lit += 1;
            let line = BandLine::new(wo, 0.0);
            let spectrum = self.outline_spectrum(outline, line, &mut work.roots);
            return work.roots.integral(spectrum).into();
        }
        let (lowest, highest) = outline.band_extent(self.frame, wo.x);
        if !motion.reaches(lowest, highest, pixel.frame.stds.mean) {
            return DVec3::ZERO;
        }
        work.counts.lit += 1;
        let lines = band_lines(wo.x, lowest, highest, motion.band(pixel.frame.stds).stds);
        // One cosine for all lines, that of the middle one.
        let middle = lines.middle_line(wo);
        let spectrum = self.outline_spectrum(outline, middle, &mut work.middle_roots);
        lines.integral(wo, |line| {
            let roots = if line == middle {
                &work.middle_roots
            } else {
                outline.roots(self.frame, line, &mut work.roots);
                &work.roots
            };
            roots.integral(&spectrum)
        })
    }

    /// The roots of a polygon on a line, and the antiderivative for light from there.
    fn outline_spectrum(
        &self,
        outline: Outline,
        line: BandLine,
        roots: &mut OutlineRoots,
    ) -> impl Fn(f64) -> [f64; 3] + 'a {
        outline.roots(self.frame, line, roots);
        self.spectrum(line, roots.range)
    }

    /// By the environment, along the band's middle line, cell by cell.
    pub fn environment(&self, pixel: &Pixel, environment: &Environment) -> DVec3 {
        let of_groove = |groove: &Groove| {
            let sum = environment_band(
                BandLine::new(self.wo, 0.0),
                groove.width_um,
                |q, cos_i| groove.row(cos_i, self.wo.z).at(groove.width_um * q),
                |direction, roughness| {
                    let direction = self.frame.surface_from_band(direction);
                    environment.prefiltered(pixel.point.world_from_surface(direction), roughness)
                },
            );
            groove.share * sum
        };
        let lit = self.grooves.iter().filter(|groove| groove.share > 0.0);
        lit.map(of_groove).sum()
    }
}

//! Random directions from which light reaches the viewer off a scratch or a grating, drawn in proportion to that light, for shadow rays.

use super::scratch_light::ScratchLight;
use crate::light_view::{LightView, LightViews};
use crate::picture::PictureView;
use crate::sampling::luminance;
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::band::{
    BandFrame, BandLine, BandPlace, BandStds, Cap, DrawnChord, Outline, OutlineRoots, band_lines,
    sphere_band_extent, sphere_chord,
};
use hairline_optics::band_environment::EnvironmentCell;
use hairline_scene::Environment;

/// Direction from which a source's light falls on a scratch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnLight {
    /// Direction in the surface's frame.
    pub direction: DVec3,
    /// Light from this direction over that from a mean direction, given that directions are drawn by luminance.
    pub color: DVec3,
}

/// Choice of one of many, by the luminance that each sends.
pub(crate) struct Choice {
    /// Sum of the light of all items.
    total: DVec3,
    /// The sum of the luminances.
    weight: f64,
    /// Remainder, in [0, 1), of the number that picks.
    left: f64,
}

impl Choice {
    pub fn new(pick_u: f64) -> Self {
        Self {
            total: DVec3::ZERO,
            weight: 0.0,
            left: pick_u,
        }
    }

    /// Offers the next item, with the light that it sends. Returns whether it replaces the one chosen before.
    pub fn offer(&mut self, sent: DVec3) -> bool {
        let weight = luminance(sent);
        self.total += sent;
        if !(weight > 0.0) {
            return false;
        }
        self.weight += weight;
        let share = weight / self.weight;
        let is_taken = self.left < share;
        self.left = if is_taken {
            self.left / share
        } else {
            (self.left - share) / (1.0 - share)
        };
        is_taken
    }

    /// The sum of the luminances.
    pub fn total(&self) -> f64 {
        self.weight
    }
}

/// Choice of one of many lines, by the light that comes along them.
struct Offers<F> {
    chord: DrawnChord,
    lines: Choice,
    /// Line that was chosen, the parts of it that light covers, and the antiderivative of the light along it.
    taken: Option<(BandLine, DrawnChord, F)>,
}

impl<F: Fn(f64) -> DVec3> Offers<F> {
    fn new(pick_u: f64) -> Self {
        Self {
            chord: DrawnChord::default(),
            lines: Choice::new(pick_u),
            taken: None,
        }
    }

    /// Offers the part of a line between roots. `spectrum` is the antiderivative of what comes from there.
    fn offer(&mut self, line: BandLine, roots: impl Iterator<Item = (f64, f64)>, spectrum: F) {
        self.chord.find(roots, |q| luminance(spectrum(q)));
        let parts = self.chord.intervals();
        let sent = parts.map(|(low, high)| spectrum(high) - spectrum(low));
        if self.lines.offer(sent.sum()) {
            self.taken = Some((line, std::mem::take(&mut self.chord), spectrum));
        }
    }

    /// A direction on the line that was taken, drawn by `chord_u`.
    fn taken(&self, frame: BandFrame, chord_u: f64) -> Option<DrawnLight> {
        let (direction, here) = self.place(chord_u)?;
        let total = self.lines.total;
        let mean = total / luminance(total);
        // Channels that get nothing have no colour to differ in.
        let color = DVec3::select(mean.cmpgt(DVec3::ZERO), here / mean, DVec3::ONE);
        Some(DrawnLight {
            direction: frame.surface_from_band(direction),
            color: if color.is_finite() { color } else { DVec3::ONE },
        })
    }

    /// Draws the direction in the frame of the scratch, and the colour of the light from there, of luminance 1.
    fn place(&self, chord_u: f64) -> Option<(DVec3, DVec3)> {
        let (line, chord, spectrum) = self.taken.as_ref()?;
        let (low, high) = chord.draw(|q| luminance(spectrum(q)), chord_u)?;
        let sent = spectrum(high) - spectrum(low);
        let direction = line.direction_at(0.5 * (low + high));
        Some((direction, sent / luminance(sent)))
    }
}

/// The band that a direction is drawn in, with the numbers in [0, 1) that draw it.
struct DrawnBand {
    wo: DVec3,
    stds: BandStds,
    line_u: f64,
    pick_u: f64,
    chord_u: f64,
}

impl DrawnBand {
    /// One line in each part of the band that reaches a light.
    fn lines(&self, (lowest, highest): (f64, f64)) -> impl Iterator<Item = BandLine> {
        let lines = band_lines(self.wo.x, lowest, highest, self.stds);
        (0..lines.count).map(move |i| lines.drawn_line(self.wo, i, self.line_u))
    }
}

impl ScratchLight<'_> {
    /// Draws a direction from which a light reaches the viewer off the scratch, in proportion to the luminance from there, by three numbers in
    /// [0, 1). None where there is no light. Other arguments as for [`Self::light`].
    pub(crate) fn draw_light(
        &self,
        stds: &BandStds,
        place: BandPlace,
        views: &LightViews,
        view: usize,
        [line_u, pick_u, chord_u]: [f64; 3],
    ) -> Option<DrawnLight> {
        let light = &views.views[view];
        let motion = self.motion(place, views, view);
        let wo = self.wo + motion.shift * DVec3::X;
        let stds = motion.band(*stds).stds;
        // Draws one line in each part of the band, and one of these lines by the light along it.
        let band = DrawnBand {
            wo,
            stds,
            line_u,
            pick_u,
            chord_u,
        };
        match light {
            LightView::Sphere { cap, .. } => self.draw_on_sphere(&band, *cap),
            LightView::Polygon {
                vertices,
                away,
                facing,
                sets,
                ..
            } => {
                let outline = views.outline(vertices, *away, *facing, *sets);
                self.draw_on_outline(&band, &outline, views.picture(light))
            }
        }
    }

    fn draw_on_sphere(&self, band: &DrawnBand, cap: Cap) -> Option<DrawnLight> {
        let mut offers = Offers::new(band.pick_u);
        let cap = cap.turned(self.frame);
        for line in band.lines(sphere_band_extent(band.wo, cap)) {
            let on_line = sphere_chord(line, cap);
            let spectrum = self.spectrum(line, on_line.range(line));
            offers.offer(line, on_line.signed(line), move |q| spectrum(q).into());
        }
        offers.taken(self.frame, band.chord_u)
    }

    fn draw_on_outline(
        &self,
        band: &DrawnBand,
        outline: &Outline,
        picture: Option<PictureView>,
    ) -> Option<DrawnLight> {
        let mut offers = Offers::new(band.pick_u);
        let mut roots = OutlineRoots::default();
        for line in band.lines(outline.band_extent(self.frame, band.wo.x)) {
            outline.roots(self.frame, line, &mut roots);
            let spectrum = self.spectrum(line, roots.range);
            let of = |radiance: DVec3| {
                let spectrum = spectrum.clone();
                move |q: f64| radiance * DVec3::from(spectrum(q))
            };
            let Some(picture) = picture else {
                offers.offer(line, roots.signed().iter().copied(), of(DVec3::ONE));
                continue;
            };
            let of_luminance = |q: f64| luminance(spectrum(q).into());
            for (low, high, radiance) in self.picture_parts(line, &roots, picture, of_luminance) {
                let ends = [(-1.0, low), (1.0, high)];
                offers.offer(line, ends.into_iter(), of(radiance));
            }
        }
        offers.taken(self.frame, band.chord_u)
    }

    /// Draws a direction to the environment, as [`Self::draw_light`], by two numbers in [0, 1). A cell is drawn in proportion to its light, then
    /// one of its parts in proportion to the part's. The colour is the environment's in the drawn direction: the closed form takes the
    /// environment and the groove's depth as even over a cell, but an object may hide the cell's bright side alone.
    pub(crate) fn draw_environment(
        &self,
        point: &SurfacePoint,
        environment: &Environment,
        [pick_u, part_u]: [f64; 2],
    ) -> Option<DrawnLight> {
        let line = BandLine::new(self.wo, 0.0);
        let from = |direction: DVec3, roughness: f64| {
            let direction = self.frame.surface_from_band(direction);
            environment.prefiltered(point.world_from_surface(direction), roughness)
        };
        let response = |cell: &EnvironmentCell| {
            let row = self.row(cell.direction.z);
            move |q: f64| DVec3::from(row.look_up(self.width_um() * q))
        };
        let sent = |cell: &EnvironmentCell| {
            let (response, blur) = (response(cell), cell.environment_cell_roughness());
            (response(cell.q_high) - response(cell.q_low)) * from(cell.direction, blur)
        };
        let mut cells = Choice::new(pick_u);
        let mut taken = None;
        self.for_cells(|cell| {
            let sent = sent(cell);
            if cells.offer(sent) {
                taken = Some((*cell, luminance(sent)));
            }
        });
        let (cell, of_cell) = taken?;
        let mut parts = Choice::new(cells.left);
        let mut taken = None;
        for part in cell.parts(line) {
            let sent = sent(&part);
            if parts.offer(sent) {
                taken = Some((part, luminance(sent)));
            }
        }
        let (part, of_part) = taken?;
        // Within the part by the groove alone.
        let response = response(&part);
        let mut offers = Offers::new(0.0);
        let ends = [(-1.0, part.q_low), (1.0, part.q_high)];
        offers.offer(line, ends.into_iter(), response);
        let (direction, by_groove) = offers.place(part_u)?;
        let over_chance = cells.weight * parts.weight / (of_cell * of_part);
        let sent = from(direction, 0.0) * by_groove * (luminance(offers.lines.total) * over_chance);
        let color = sent / cells.total;
        Some(DrawnLight {
            direction: self.frame.surface_from_band(direction),
            // Channels that get nothing have no colour to differ in.
            color: if color.is_finite() { color } else { DVec3::ONE },
        })
    }

    /// Draws a direction under even light of radiance 1 from all sides, and returns the light that the scratch reflects of it.
    pub fn draw_all_around(&self, [pick_u, cell_u]: [f64; 2]) -> Option<(DrawnLight, DVec3)> {
        let line = BandLine::new(self.wo, 0.0);
        let mut offers = Offers::new(pick_u);
        self.for_cells(|cell| {
            let row = self.row(cell.direction.z);
            let ends = [(-1.0, cell.q_low), (1.0, cell.q_high)];
            let width_um = self.width_um();
            let spectrum = move |q: f64| DVec3::from(row.look_up(width_um * q));
            offers.offer(line, ends.into_iter(), spectrum);
        });
        let total = offers.lines.total;
        Some((offers.taken(self.frame, cell_u)?, total))
    }
}

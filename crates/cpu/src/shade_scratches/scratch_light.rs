//! A scratch as seen from a point, and the light that it sends to the viewer (docs/model.md, sections 5 and 6). Twin:
//! scratch_light.wgsl.

use super::chord_depths::PartedChord;
use super::course::Course;
use super::row_spread::{ROW_PROFILE, RowSpread};
use crate::light_view::{LightView, LightViews};
use crate::picture::PictureView;
use crate::sampling::luminance;
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_index::IndexedProfile;
use hairline_optics::band::{
    BandFrame, BandLine, BandLines, BandMotion, BandPlace, BandStds, Cap, Outline, OutlineRoots,
    band_is_whole, band_lines, chord_cos, sphere_band_extent, sphere_chord,
};
use hairline_optics::band_environment::{EnvironmentCell, environment_cells, row_cells};
use hairline_optics::grating::IncidenceRow;
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::table::{ScratchTable, SmoothRow, TableRow};
use hairline_scene::Environment;

/// Energy that a scratch takes from the reflection in the mirror's direction, where both cosines are the viewer's. Twin: `scratch_energy`.
pub(super) fn scratch_energy(
    profile: IndexedProfile,
    table: &ScratchTable,
    cos_o: f64,
) -> [f64; 3] {
    table.scratch_table_total(oblique_depth_nm(profile.depth_nm.into(), cos_o, cos_o))
}

/// T over u at one depth, or for one direction to the viewer.
#[derive(Clone)]
pub(super) enum GrooveRow<'a> {
    Depth(TableRow<'a>),
    Incidence(IncidenceRow<'a>),
    Smooth(SmoothRow<'a>),
}

impl GrooveRow<'_> {
    #[inline]
    pub fn look_up(&self, u_um: f64) -> [f64; 3] {
        match self {
            Self::Depth(row) => row.look_up(u_um),
            Self::Incidence(row) => row.look_up(u_um),
            Self::Smooth(row) => row.look_up(u_um),
        }
    }
}

/// Amount that is added to the estimate by which a pair is drawn, so that no light far above its estimate makes a bright dot.
const LEAST_LIKELY: f64 = 0.003;

/// A scratch from a point, or the grooves of a grating.
pub(crate) struct ScratchLight<'a> {
    pub(super) frame: BandFrame,
    /// `wo` in the frame of the scratch.
    pub(super) wo: DVec3,
    table: &'a ScratchTable,
    profile: IndexedProfile,
    /// Of a scratch: [`Course::turns_rad`].
    turns_rad: [f64; 2],
    pub(super) row: Option<RowSpread>,
    /// Place of the one line that stands for the band, if it is one of very many scratches ([`BandLines::by_one_line`]).
    one_line: Option<f64>,
}

impl<'a> ScratchLight<'a> {
    /// `wo` and the course in the surface's frame.
    pub fn new(
        wo: DVec3,
        course: Course,
        table: &'a ScratchTable,
        profile: IndexedProfile,
    ) -> Self {
        let frame = BandFrame {
            tangent: course.tangent,
        };
        Self {
            frame,
            wo: frame.band_from_surface(wo),
            table,
            profile,
            turns_rad: course.turns_rad,
            row: None,
            one_line: None,
        }
    }

    /// Uses one line of the band, whatever the light.
    pub fn by_one_line(self, node: Option<f64>) -> Self {
        Self {
            one_line: node,
            ..self
        }
    }

    /// The grooves of a grating of whose table `table` is.
    pub fn of_row(wo: DVec3, tangent: DVec2, table: &'a ScratchTable, row: RowSpread) -> Self {
        Self {
            row: Some(row),
            ..Self::new(wo, Course::straight(tangent), table, ROW_PROFILE)
        }
    }

    /// u for each unit of q.
    #[inline]
    pub(super) fn width_um(&self) -> f64 {
        self.profile.width_um.into()
    }

    /// Groove width for weights that depend on q: the scratch's, since its light lies about the mirror's direction; 0 for a grating, whose light
    /// lies about its orders, wherever they are.
    pub(super) fn weighed_um(&self) -> f64 {
        match self.row {
            Some(_) => 0.0,
            None => self.width_um(),
        }
    }

    /// Computes the movement of the band over the pixel towards a light. `place` is where a scratch lies under the footprint.
    #[inline]
    pub(super) fn motion(&self, place: BandPlace, views: &LightViews, view: usize) -> BandMotion {
        let tangent = self.frame.tangent;
        let moves = views.moves[view].map(|m| m.dot(tangent));
        let axis = views.views[view].bound().axis.truncate();
        let xi_n = self.wo.y + tangent.perp_dot(axis);
        match &self.row {
            None => place.moved([0, 1].map(|j| moves[j] + self.turns_rad[j] * xi_n)),
            Some(row) => row.motion(moves, xi_n),
        }
    }

    /// The cells of the environment along the middle line.
    #[inline(always)]
    pub(super) fn for_cells(&self, mut each: impl FnMut(&EnvironmentCell)) {
        let line = BandLine::new(self.wo, 0.0);
        match &self.row {
            None => environment_cells(line, self.width_um())
                .iter()
                .for_each(&mut each),
            Some(_) => row_cells(line).iter().for_each(&mut each),
        }
    }

    /// T over u for light with a cosine to the normal.
    pub(super) fn row(&self, cos_i: f64) -> GrooveRow<'a> {
        if self.table.by_incidence {
            return GrooveRow::Incidence(self.incidence_row());
        }
        let depth_nm = self.depth_nm(cos_i);
        match self.table.smooth_row(depth_nm) {
            Some(row) => GrooveRow::Smooth(row),
            None => GrooveRow::Depth(self.table.at_depth(depth_nm)),
        }
    }

    fn depth_nm(&self, cos_i: f64) -> f64 {
        oblique_depth_nm(self.profile.depth_nm.into(), cos_i, self.wo.z)
    }

    fn depth_row(&self, cos_i: f64) -> TableRow<'a> {
        self.table.at_depth(self.depth_nm(cos_i))
    }

    fn incidence_row(&self) -> IncidenceRow<'a> {
        IncidenceRow::new(self.table, [self.wo.y, self.wo.x])
    }

    /// Energy that the grooves of a grating take from the reflection in the mirror's direction.
    pub(crate) fn taken_by_row(&self) -> DVec3 {
        match self.table.by_incidence {
            true => self.incidence_row().taken().into(),
            false => self.all_around(),
        }
    }

    /// Radiance of one light off the scratch, without Fresnel's factor; none if the light does not reach the scratch. `place` is the scratch's
    /// place under the footprint.
    pub fn light(
        &self,
        stds: &BandStds,
        place: BandPlace,
        views: &LightViews,
        view: usize,
        roots: &mut [OutlineRoots; 2],
    ) -> Option<DVec3> {
        let light = &views.views[view];
        let tangent = self.frame.tangent;
        let motion = self.motion(place, views, view);
        let bound = light.bound();
        let along = tangent.dot(bound.axis.truncate());
        if !self.may_meet(stds, along, bound, motion) {
            return None;
        }
        match light {
            LightView::Sphere { cap, radiance } => {
                Some(*radiance * self.sphere(stds, *cap, motion)?)
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
                let variance = self.across_variance(motion.widened(stds.mean), bound);
                let picture = views.picture(light).map(|picture| (picture, variance));
                Some(*radiance * self.polygon(stds, outline, motion, roots, picture)?)
            }
        }
    }

    /// The variance of the band at q = 0 and for each q², given its standard deviation towards a light: the grooves of a grating that lie about a
    /// little widen it with the distance from the mirror's direction.
    fn across_variance(&self, std: f64, light: &Cap) -> [f64; 2] {
        let per_q2 = self.row.map_or(0.0, |row| row.angle_std_rad.powi(2));
        let q = self.wo.y + self.frame.tangent.perp_dot(light.axis.truncate());
        [std * std - per_q2 * q * q, per_q2]
    }

    /// Estimate of the light of a source off the scratch, over the scratch's energy; 0 where there is surely none. It is cheap, to draw one of
    /// many sources by.
    pub(super) fn likely(
        &self,
        stds: &BandStds,
        place: BandPlace,
        views: &LightViews,
        view: usize,
    ) -> f64 {
        let light = &views.views[view];
        let bound = light.bound();
        let motion = self.motion(place, views, view);
        let tangent = self.frame.tangent;
        let axis = bound.axis.truncate();
        if !self.may_meet(stds, tangent.dot(axis), bound, motion) {
            return 0.0;
        }
        // The groove's light falls off with u as the mean of sinc^2 over wavelengths of about half a micrometre.
        let u_um = self.width_um() * (self.wo.y + tangent.perp_dot(axis));
        let falls = self.width_um() * bound.sin_radius / (1.0 + 30.0 * u_um * u_um);
        luminance(light.radiance()) * (falls.min(1.0) + LEAST_LIKELY)
    }

    /// Whether the band can meet a cap whose axis has the component `along` on the tangent.
    fn may_meet(&self, stds: &BandStds, along: f64, cap: &Cap, motion: BandMotion) -> bool {
        let middle = self.wo.x + motion.shift + along * cap.cos_radius;
        // Around the pole of the tangent a cap reaches further.
        along.abs() >= cap.cos_radius
            || motion.reaches(middle - cap.sin_radius, middle + cap.sin_radius, stds.mean)
    }

    /// Antiderivative over q of the light that the groove sends from a part of a line.
    pub(super) fn spectrum(
        &self,
        line: BandLine,
        (low, high): (f64, f64),
    ) -> impl Fn(f64) -> [f64; 3] + Clone + 'a {
        let width_um = self.width_um();
        let row = self.row(chord_cos(line, low, high, self.weighed_um()));
        let is_parted = self.row.is_some() && !self.table.by_incidence;
        let parted = is_parted
            .then(|| PartedChord::new(line, (low, high), width_um, |cos_i| self.depth_row(cos_i)));
        let parted = parted.flatten();
        move |q| match &parted {
            Some(parted) => parted.look_up(q),
            None => row.look_up(width_um * q),
        }
    }

    /// Lines of the band along which the light is integrated.
    fn lines(&self, wo_t: f64, lowest: f64, highest: f64, stds: BandStds) -> BandLines {
        let lines = band_lines(wo_t, lowest, highest, stds);
        match self.one_line {
            Some(node) => lines.by_one_line(node),
            None => lines,
        }
    }

    /// Light of a sphere of radiance 1 off the scratch.
    fn sphere(&self, stds: &BandStds, cap: Cap, motion: BandMotion) -> Option<DVec3> {
        let cap = cap.turned(self.frame);
        let wo = self.wo + motion.shift * DVec3::X;
        let (lowest, highest) = sphere_band_extent(wo, cap);
        if !motion.reaches(lowest, highest, stds.mean) {
            return None;
        }
        let lines = self.lines(wo.x, lowest, highest, motion.band(*stds).stds);
        Some(lines.integral(wo, |line| {
            let chord = sphere_chord(line, cap);
            chord.integral(line, self.spectrum(line, chord.range(line)))
        }))
    }

    /// Light of a polygon of radiance 1 off the scratch.
    fn polygon(
        &self,
        stds: &BandStds,
        outline: Outline,
        motion: BandMotion,
        [middle_roots, roots]: &mut [OutlineRoots; 2],
        picture: Option<(PictureView, [f64; 2])>,
    ) -> Option<DVec3> {
        let wo = self.wo + motion.shift * DVec3::X;
        // Large lights cover the whole band, and their corners tell so.
        let (low, high) = outline.corner_extent(self.frame);
        let std = motion.widened(stds.mean);
        if band_is_whole(wo.x, wo.x + low, wo.x + high, std) {
            let line = BandLine::new(wo, 0.0);
            let spectrum = self.outline_spectrum(outline, line, roots);
            let picture = picture.map(|(picture, variance)| picture.with_across_variance(variance));
            return Some(self.on_line(line, roots, spectrum, picture).into());
        }
        let (lowest, highest) = outline.band_extent(self.frame, wo.x);
        if !motion.reaches(lowest, highest, stds.mean) {
            return None;
        }
        let lines = self.lines(wo.x, lowest, highest, motion.band(*stds).stds);
        // Several lines see the picture where they lie, and so does one of them.
        let picture = picture.map(|(picture, variance)| match (lines.count, self.one_line) {
            (1, None) => picture.with_across_variance(variance),
            _ => picture,
        });
        // One cosine for all lines: that of the middle line.
        let middle = lines.middle_line(wo);
        let spectrum = self.outline_spectrum(outline, middle, middle_roots);
        Some(lines.integral(wo, |line| {
            if line == middle {
                self.on_line(line, middle_roots, &spectrum, picture)
            } else {
                outline.roots(self.frame, line, roots);
                self.on_line(line, roots, &spectrum, picture)
            }
        }))
    }

    /// Light of an outline along a line, given its roots there and the antiderivative over q of the groove's light.
    fn on_line(
        &self,
        line: BandLine,
        roots: &OutlineRoots,
        spectrum: impl Fn(f64) -> [f64; 3],
        picture: Option<PictureView>,
    ) -> [f64; 3] {
        let Some(picture) = picture else {
            return roots.integral(spectrum);
        };
        let at = |q: f64| DVec3::from(spectrum(q));
        let parts = self.picture_parts(line, roots, picture, |q| luminance(at(q)));
        let sent = parts.map(|(low, high, radiance)| radiance * (at(high) - at(low)));
        sent.sum::<DVec3>().to_array()
    }

    /// Light of radiance 1 from all sides off the scratch.
    #[inline(always)]
    pub(crate) fn all_around(&self) -> DVec3 {
        let mut sum = DVec3::ZERO;
        self.for_cells(|cell| {
            let row = self.row(cell.direction.z);
            let at = |q: f64| DVec3::from(row.look_up(self.width_um() * q));
            sum += at(cell.q_high) - at(cell.q_low);
        });
        sum
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

    /// Light of the environment off the scratch, along the band's middle line, cell by cell.
    #[inline(always)]
    pub fn environment(&self, point: &SurfacePoint, environment: &Environment) -> DVec3 {
        let line = BandLine::new(self.wo, 0.0);
        match &self.row {
            None => {
                let cells = environment_cells(line, self.width_um());
                self.by_cells(&cells, point, environment)
            }
            Some(_) => self.by_cells(&row_cells(line), point, environment),
        }
    }

    #[inline(always)]
    fn by_cells<const N: usize>(
        &self,
        cells: &[EnvironmentCell; N],
        point: &SurfacePoint,
        environment: &Environment,
    ) -> DVec3 {
        let towards = cells.map(|cell| {
            let direction = self.frame.surface_from_band(cell.direction);
            point.world_from_surface(direction)
        });
        let roughness = cells.map(|cell| cell.environment_cell_roughness());
        let blurred = environment.prefiltered_all(towards, roughness);
        let mut sum = DVec3::ZERO;
        for (cell, blurred) in cells.iter().zip(blurred) {
            let row = self.row(cell.direction.z);
            let at = |q: f64| DVec3::from(row.look_up(self.width_um() * q));
            sum += (at(cell.q_high) - at(cell.q_low)) * blurred;
        }
        sum
    }
}

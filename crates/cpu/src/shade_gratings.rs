//! Shade gratings: the light of grooves that are finer than a pixel, and the energy that they take from the mirror's direction (docs/model.md,
//! section 12). A grating meets lights by the chords of a scratch, with a table of its own.

use crate::light_view::LightViews;
use crate::prepared::Prepared;
use crate::shade_scratches::{Course, Frame, Pick, Picks, ROW_PROFILE, RowSpread, ScratchLight};
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_optics::band::{Along, BandPlace, BandStds, OutlineRoots};
use hairline_scene::{Grating, GrooveGround, GroovePlace};

/// All gratings under a point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ShadedGratings {
    /// Radiance, Fresnel left out.
    pub radiance: DVec3,
    /// Energy that the base's mirror direction loses to the gratings: that of light from all around.
    pub taken: DVec3,
}

impl ShadedGratings {
    /// Shades the gratings of an object at a point. `views` are ready for scratches. `picks`, where there are shadows, has its sources cleared.
    pub fn new(
        prepared: &Prepared,
        point: &SurfacePoint,
        object: u32,
        views: &LightViews,
        picks: Option<&mut Picks>,
    ) -> Self {
        let scene = prepared.scene;
        let gratings = &scene.objects[object as usize].gratings;
        let ground = GrooveGround {
            textures: &scene.textures,
            mesh: &scene.objects[object as usize].mesh,
            triangle: point.triangle,
        };
        let [position_m, normal] = [point.position_m, point.normal];
        let seen = |grating: &Grating| {
            grating.seen_from_pixel(&ground, position_m, normal, point.footprint_axes_m)
        };
        // Gratings lie side by side: together they cover all of the surface at most.
        let covered: f64 = gratings
            .iter()
            .filter_map(seen)
            .map(|place| place.share)
            .sum();
        let mut sum = GratingSum {
            prepared,
            point,
            views,
            stds: Frame::new(point).stds,
            roots: Default::default(),
            picks,
            sum: Self::default(),
        };
        for grating in gratings {
            let (Some(seen), Some(table)) = (
                seen(grating),
                prepared.tables.grating_table(grating, point.material),
            ) else {
                continue;
            };
            let density = grating.groove_density(
                &ground,
                position_m,
                normal,
                seen.tangent,
                point.footprint_axes_m,
                point.coherence_um,
            );
            sum.add_grating(grating, seen, table, density / covered.max(1.0));
        }
        sum.sum
    }
}

/// Sums over the gratings under a point.
struct GratingSum<'a, 'p> {
    prepared: &'a Prepared<'a>,
    point: &'a SurfacePoint<'a>,
    views: &'a LightViews<'a>,
    stds: BandStds,
    roots: [OutlineRoots; 2],
    picks: Option<&'p mut Picks>,
    sum: ShadedGratings,
}

impl GratingSum<'_, '_> {
    /// Adds what a pixel sees of a grating. `scale` is a factor on its share.
    fn add_grating(&mut self, grating: &Grating, seen: GroovePlace, table: usize, scale: f64) {
        let (prepared, point, views) = (self.prepared, self.point, self.views);
        let row = |seen: GroovePlace| RowAt::new(point, seen, table, scale);
        let own = row(seen.of_one_spot());
        let own_light = own.light(prepared, point);
        for view in 0..views.views.len() {
            self.add_light(view, &own, &own_light);
            let half = (point.wo + views.views[view].bound().axis).with_z(0.0);
            let along = point.world_from_surface(half);
            if let Some(across) = grating.grooves_towards(seen, point.normal, along).map(row) {
                self.add_light(view, &across, &across.light(prepared, point));
            }
        }
        self.add_around(&own, &own_light);
        for row in grating.all_ways(seen, point.normal).map(row) {
            self.add_around(&row, &row.light(prepared, point));
        }
    }

    fn add_light(&mut self, view: usize, row: &RowAt, light: &ScratchLight) {
        let (place, roots) = (BandPlace::everywhere(), &mut self.roots);
        if let Some(sent) = light.light(&self.stds, place, self.views, view, roots) {
            self.add(Some(view), row, sent);
        }
    }

    /// Adds the light of the environment, and the energy that the base loses.
    fn add_around(&mut self, row: &RowAt, light: &ScratchLight) {
        if let Some(environment) = &self.prepared.scene.environment {
            let sent = light.environment(self.point, environment);
            self.add(Some(self.views.views.len()), row, sent);
        }
        self.add(None, row, light.taken_by_row());
    }

    /// Adds the light of a source, or without a source the energy that the base loses.
    fn add(&mut self, source: Option<usize>, row: &RowAt, sent: DVec3) {
        let sent = row.share * sent;
        let pick = || row.pick();
        match source {
            Some(_) => self.sum.radiance += sent,
            None => self.sum.taken += sent,
        }
        match (&mut self.picks, source) {
            (Some(picks), Some(source)) => picks.add_light(source, sent, pick),
            (Some(picks), None) => picks.add_energy(sent, pick),
            (None, _) => {}
        }
    }
}

/// Grooves of a grating in one direction.
struct RowAt {
    tangent: DVec2,
    row: RowSpread,
    /// Share of the pixel that they cover, as many as there are.
    share: f64,
}

impl RowAt {
    fn new(point: &SurfacePoint, seen: GroovePlace, table: usize, scale: f64) -> Self {
        let tangent = point.surface_from_world(seen.tangent).truncate();
        Self {
            tangent: tangent.normalize_or(DVec2::X),
            row: RowSpread {
                table,
                turns_rad: seen.turns_rad,
                angle_std_rad: seen.angle_std_rad,
            },
            share: scale * seen.share,
        }
    }

    fn light<'a>(&self, prepared: &'a Prepared, point: &SurfacePoint) -> ScratchLight<'a> {
        let table = &prepared.tables.tables[self.row.table];
        ScratchLight::of_row(point.wo, self.tangent, table, self.row)
    }

    /// Pick of these grooves, whose rays start anywhere under the pixel.
    fn pick(&self) -> Pick {
        Pick {
            course: Course::straight(self.tangent),
            place: BandPlace::everywhere(),
            along: Along {
                steps_um: [0.0; 2],
                blur_um: 1.0,
                ends: [f64::NEG_INFINITY, f64::INFINITY],
            },
            profile: ROW_PROFILE,
            row: Some(self.row),
            share: self.share,
            source: 0,
            radiance: DVec3::ZERO,
        }
    }
}

//! Shade gratings: the light of grooves that are finer than a pixel, and the energy that they take from the mirror's direction (docs/model.md,
//! section 12). A grating meets lights by the chords of a scratch, with a table of its own.

use crate::light_view::LightViews;
use crate::prepared::Prepared;
use crate::shade_scratches::{Course, Frame, Pick, Picks, ROW_PROFILE, RowSpread, ScratchLight};
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_optics::band::{Along, BandPlace, OutlineRoots};
use hairline_scene::{GrooveGround, GroovePlace};

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
        mut picks: Option<&mut Picks>,
    ) -> Self {
        let scene = prepared.scene;
        let environment = scene.environment.as_ref();
        let gratings = &scene.objects[object as usize].gratings;
        let ground = GrooveGround {
            textures: &scene.textures,
            mesh: &scene.objects[object as usize].mesh,
            triangle: point.triangle,
        };
        let [position_m, normal] = [point.position_m, point.normal];
        let seen = |grating: &hairline_scene::Grating| {
            grating.seen_from_pixel(&ground, position_m, normal, point.footprint_axes_m)
        };
        // Gratings lie side by side: together they cover all of the surface at most.
        let covered: f64 = gratings
            .iter()
            .filter_map(seen)
            .map(|place| place.share)
            .sum();
        let stds = Frame::new(point).stds;
        let mut roots = [OutlineRoots::default(), OutlineRoots::default()];
        let mut sum = Self::default();
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
            let scale = density / covered.max(1.0);
            let around = views.views.len();
            // Adds the light of a source, or without a source the energy that the base loses.
            let mut add = |source: Option<usize>, row: &RowAt, sent: DVec3| {
                let sent = scale * row.share * sent;
                let pick = || row.pick(scale);
                match source {
                    Some(_) => sum.radiance += sent,
                    None => sum.taken += sent,
                }
                match (&mut picks, source) {
                    (Some(picks), Some(source)) => picks.add_light(source, sent, pick),
                    (Some(picks), None) => picks.add_energy(sent, pick),
                    (None, _) => {}
                }
            };
            let row = |seen: GroovePlace| RowAt::new(point, seen, table);
            let own = row(seen.of_one_spot());
            let own_light = own.light(prepared, point);
            for view in 0..views.views.len() {
                let place = BandPlace::everywhere();
                if let Some(sent) = own_light.light(&stds, place, views, view, &mut roots) {
                    add(Some(view), &own, sent);
                }
                let half = (point.wo + views.views[view].bound().axis).with_z(0.0);
                let along = point.world_from_surface(half);
                if let Some(across) = grating.grooves_towards(seen, normal, along).map(row)
                    && let Some(sent) =
                        (across.light(prepared, point)).light(&stds, place, views, view, &mut roots)
                {
                    add(Some(view), &across, sent);
                }
            }
            let mut add_around = |row: &RowAt, light: &ScratchLight| {
                if let Some(environment) = environment {
                    add(Some(around), row, light.environment(point, environment));
                }
                add(None, row, light.taken_by_row());
            };
            add_around(&own, &own_light);
            for row in grating.all_ways(seen, normal).map(row) {
                add_around(&row, &row.light(prepared, point));
            }
        }
        sum
    }
}

/// Grooves of a grating in one direction.
struct RowAt {
    tangent: DVec2,
    row: RowSpread,
    /// Share of the pixel that they cover.
    share: f64,
}

impl RowAt {
    fn new(point: &SurfacePoint, seen: GroovePlace, table: usize) -> Self {
        let tangent = point.surface_from_world(seen.tangent).truncate();
        Self {
            tangent: tangent.normalize_or(DVec2::X),
            row: RowSpread {
                table,
                turns_rad: seen.turns_rad,
                angle_std_rad: seen.angle_std_rad,
            },
            share: seen.share,
        }
    }

    fn light<'a>(&self, prepared: &'a Prepared, point: &SurfacePoint) -> ScratchLight<'a> {
        let table = &prepared.tables.tables[self.row.table];
        ScratchLight::of_row(point.wo, self.tangent, table, self.row)
    }

    /// Pick of these grooves, whose rays start anywhere under the pixel.
    fn pick(&self, scale: f64) -> Pick {
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
            share: scale * self.share,
            source: 0,
            radiance: DVec3::ZERO,
        }
    }
}

//! Gratings at a point: one row of grooves, drawn as often as it covers the surface, with its grooves wherever they may lie.

use super::grooves::GrooveView;
use super::random::{Purpose, Random};
use glam::{DVec2, DVec3};
use hairline_cpu::surface::SurfacePoint;
use hairline_optics::band::{BandFrame, BandLine};
use hairline_optics::band_environment::row_cells;
use hairline_optics::coherent::GroovePiece;
use hairline_optics::grating::{
    GRATING_DEPTH_NM, GRATING_WIDTH_UM, Grating as Row, GroovesAt, IncidenceRow, RigorousGrating,
};
use hairline_optics::scratch::oblique_depth_nm;
use hairline_scene::{GrooveGround, Scene, ScratchTables};
use spec_math::cephes64::ndtri;

/// Distance of the grooves' ends in sigma. The window does not see them: its amplitude has fallen to 2e-8.
const END_SIGMA: f64 = 6.0;

/// A row of grooves from a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowView<'a> {
    pub row: Row,
    /// Its efficiencies, where they are rigorous.
    pub rigorous: Option<RigorousGrating<'a>>,
    pub frame: BandFrame,
    /// `wo` in the frame of its grooves.
    pub wo: DVec3,
    table: usize,
    /// Random position of the grooves in [0, 1) of a pitch.
    phase: f64,
    /// Actual places of the grooves, if a pixel could show single ones.
    single: Option<GroovesAt>,
    seed: u32,
    /// Density of single grooves at the point, over their mean.
    pub density: f64,
}

impl<'a> RowView<'a> {
    /// Draws one of the gratings at a point of an object, or none.
    pub(super) fn drawn(
        scene: &Scene,
        object: usize,
        tables: &'a ScratchTables,
        point: &SurfacePoint,
        random: Random,
    ) -> Option<Self> {
        let object = &scene.objects[object];
        let ground = GrooveGround {
            textures: &scene.textures,
            mesh: &object.mesh,
            triangle: point.triangle,
        };
        let (position_m, normal) = (point.position_m, point.normal);
        let seen = |grating: &hairline_scene::Grating| {
            grating.seen_from_pixel(&ground, position_m, normal, [DVec3::ZERO; 2])
        };
        let gratings = object.gratings.iter();
        let places: Vec<_> = gratings.filter_map(|g| Some((g, seen(g)?))).collect();
        let covered: f64 = places.iter().map(|(_, place)| place.share).sum();
        let [pick, angle, phase, _] = random.four(Purpose::Row);
        let mut left = pick * covered.max(1.0);
        for (grating, place) in places {
            if left >= place.share {
                left -= place.share;
                continue;
            }
            let tangent = point.surface_from_world(place.tangent).truncate();
            let turn = DVec2::from_angle(grating.angle_std_rad * ndtri(angle));
            let frame = BandFrame {
                tangent: tangent.normalize_or(DVec2::X).rotate(turn),
            };
            let single = match grating.shows_single_grooves(point.coherence_um) {
                true => grating.grooves_at(&ground, position_m, normal, place.tangent),
                false => None,
            };
            let table = tables.grating_table(grating, point.material)?;
            return Some(Self {
                row: tables.row(table),
                rigorous: tables.rigorous(table),
                frame,
                wo: frame.band_from_surface(point.wo),
                table,
                phase,
                single,
                seed: grating.seed,
                density: grating.groove_density(
                    &ground,
                    position_m,
                    normal,
                    place.tangent,
                    [DVec3::ZERO; 2],
                    point.coherence_um,
                ),
            });
        }
        None
    }

    /// The row's grooves in the window, each displaced by chance or by its number.
    pub(super) fn grooves(
        &self,
        random: Random,
        coherence_um: f64,
        reach_sigma: f64,
    ) -> impl Iterator<Item = GrooveView> {
        let Row {
            pitch_um,
            width_um,
            depth_nm,
            depth_spread,
            jitter_um,
        } = self.row;
        // Grooves that branch are up to twice as dense.
        let least_um = self
            .single
            .map_or(pitch_um, |at| at.pitch_um.abs().min(pitch_um));
        let reach = (reach_sigma * coherence_um / least_um).ceil() as i32 + 1;
        (-reach..=reach).filter_map(move |j| {
            let [place, depth, begun, _] = random.four(Purpose::RowGroove((j + reach) as u32));
            if let Some(at) = self.single
                && !self.row.has_groove(at, j, self.seed, begun)
            {
                return None;
            }
            let offset_um = match self.single {
                Some(at) => self.row.groove_offset_um(at, j, self.seed),
                None => (f64::from(j) + self.phase) * pitch_um + jitter_um * ndtri(place),
            };
            let piece = GroovePiece {
                tangent: self.frame.tangent,
                offset_um,
                // Ends beyond the window.
                start_um: -END_SIGMA * coherence_um,
                end_um: END_SIGMA * coherence_um,
                width_um,
                depth_nm: depth_nm * (1.0 + depth_spread * ndtri(depth)),
            };
            Some(GrooveView::of_row(self.frame, self.wo, piece, coherence_um))
        })
    }

    /// Light that the base's mirror direction loses to the row: the energy that the row sends of light from all around, as
    /// in the closed form.
    pub(super) fn taken(&self, tables: &ScratchTables) -> DVec3 {
        let table = &tables.tables[self.table];
        if table.by_incidence {
            let [across, along] = [self.wo.y, self.wo.x];
            return self.density * DVec3::from(IncidenceRow::new(table, [across, along]).taken());
        }
        let cells = row_cells(BandLine::new(self.wo, 0.0));
        let sent = cells.iter().map(|cell| {
            let depth_nm = oblique_depth_nm(GRATING_DEPTH_NM, cell.direction.z, self.wo.z);
            let row = table.at_depth(depth_nm);
            let at = |q: f64| DVec3::from(row.look_up(GRATING_WIDTH_UM * q));
            at(cell.q_high) - at(cell.q_low)
        });
        self.density * sent.sum::<DVec3>()
    }
}

//! The grooves in the coherence window around a point.

use glam::{DVec2, DVec3, Vec3};
use hairline_cpu::surface::SurfacePoint;
use hairline_index::scratch_index::FACING_MIN_COS;
use hairline_index::{Groove, SegmentTree};
use hairline_optics::band::BandFrame;
use hairline_optics::coherent::GroovePiece;
use hairline_optics::footprint::ScratchShare;
use hairline_optics::scratch::piece_share;
use hairline_optics::section::{Parts, Section, cover_of_part, width_class};
use hairline_scene::GrooveShapes;

/// Distance within which grooves matter, in sigma. The window's energy falls as exp(-p^2/sigma^2): 7e-7 of it lies beyond
/// 3.5.
pub(super) const REACH_OF_ENERGY: f64 = 3.5;
/// Number of standard deviations at which the window is cut off for interference: its amplitude is 4e-6 there.
pub(super) const REACH_OF_AMPLITUDE: f64 = 5.0;

/// A piece of a groove from a point.
#[derive(Clone, Debug)]
pub(super) struct GrooveView {
    pub frame: BandFrame,
    /// `wo` in the groove's frame.
    pub wo: DVec3,
    /// All of the cross section, at its deepest.
    pub piece: GroovePiece,
    pub section: Section,
    /// Index of the shape.
    pub shape: u8,
    /// Width that sends light.
    pub lit_um: f64,
    /// Width that sends light over the width that the share counts by.
    pub lit_per_share: f64,
    /// (6) at the point.
    pub share: ScratchShare,
    /// Whether it is one of a grating's, which run side by side.
    pub is_in_row: bool,
}

impl GrooveView {
    /// Makes the view of a piece; none where it lies on another side of the surface, or too far to matter.
    pub(crate) fn new(
        point: &SurfacePoint,
        groove: &Groove,
        shapes: &GrooveShapes,
        reach_sigma: f64,
    ) -> Option<Self> {
        if groove.normal.as_dvec3().dot(point.normal) < FACING_MIN_COS as f64 {
            return None;
        }
        let from_point = |p: Vec3| point.surface_from_world(p.as_dvec3() - point.position_m) * 1e6;
        let (start, end) = (from_point(groove.start_m), from_point(groove.end_m));
        let along = DVec2::new(end.x - start.x, end.y - start.y);
        let length_um = along.length();
        if !(length_um > 0.0) {
            return None;
        }
        let frame = BandFrame {
            tangent: along / length_um,
        };
        let (start, end) = (frame.band_from_surface(start), frame.band_from_surface(end));
        let sigma_um = point.coherence_um;
        let piece = GroovePiece {
            tangent: frame.tangent,
            offset_um: 0.5 * (start.y + end.y),
            start_um: start.x,
            end_um: end.x,
            width_um: groove.width_um as f64,
            depth_nm: groove.depth_nm as f64,
        };
        // Place along the groove at which the window ends.
        let nearest_um = 0.0_f64.clamp(piece.start_um, piece.end_um);
        let reach_um = reach_sigma * sigma_um + 0.5 * piece.width_um;
        if piece.offset_um.abs() > reach_um || nearest_um.abs() > reach_um {
            return None;
        }
        let section = shapes.section(groove.shape).clone();
        let parts = (width_class(piece.width_um / sigma_um) > 0)
            .then(|| section.parts(piece.width_um, sigma_um));
        let whole = [
            piece.start_um - groove.before_um as f64,
            piece.end_um + groove.after_um as f64,
        ];
        Some(Self {
            frame,
            wo: frame.band_from_surface(point.wo),
            piece,
            section,
            shape: groove.shape,
            lit_um: parts.as_ref().map_or(piece.width_um, |it| it.lit_um),
            lit_per_share: parts.as_ref().map_or(1.0, |parts| {
                parts.lit_um / (parts.width_um * parts.offsets_um.len() as f64)
            }),
            share: match &parts {
                None => point_share(&piece, whole, sigma_um),
                Some(parts) => parts_share(&piece, whole, sigma_um, parts),
            },
            is_in_row: false,
        })
    }

    /// Half width of the distribution over u = W q that directions across the groove are drawn by. A floor has that of sinc² at green, one
    /// wider than the window that of an edge; slopes mirror light to sides.
    pub(crate) fn drawn_um(&self, sigma_um: f64) -> f64 {
        let slopes_um = match self.section {
            Section::Rectangle => 0.0,
            _ => 2e-3 * self.piece.depth_nm,
        };
        DRAWN_UM.max(0.1 * self.lit_um / sigma_um) + slopes_um
    }

    /// Strips of one depth each, side by side, that the groove is for the whole field.
    pub(crate) fn strips(&self) -> impl Iterator<Item = GroovePiece> {
        let strips = self
            .section
            .strips(STRIPS.max((STRIPS_PER_UM * self.piece.width_um).ceil() as usize));
        let width_um = self.piece.width_um / strips.len() as f64;
        strips.into_iter().map(move |(x, share)| GroovePiece {
            offset_um: self.piece.offset_um + 0.5 * self.piece.width_um * x,
            width_um,
            depth_nm: self.piece.depth_nm * share,
            ..self.piece
        })
    }

    /// A groove of a grating, which is as long as its line.
    pub(crate) fn of_row(frame: BandFrame, wo: DVec3, piece: GroovePiece, sigma_um: f64) -> Self {
        Self {
            frame,
            wo,
            piece,
            section: Section::Rectangle,
            shape: 0,
            lit_um: piece.width_um,
            lit_per_share: 1.0,
            share: point_share(&piece, [f64::NEG_INFINITY, f64::INFINITY], sigma_um),
            is_in_row: true,
        }
    }
}

fn point_share(piece: &GroovePiece, whole_um: [f64; 2], sigma_um: f64) -> ScratchShare {
    let piece_um = [piece.start_um, piece.end_um];
    piece_share(
        piece.width_um,
        piece.offset_um,
        piece_um,
        whole_um,
        sigma_um,
    )
}

/// As [`point_share`], for a wide groove, each part of which counts where it lies.
fn parts_share(
    piece: &GroovePiece,
    whole_um: [f64; 2],
    sigma_um: f64,
    parts: &Parts,
) -> ScratchShare {
    let mut sum = ScratchShare {
        segment: 0.0,
        line: 0.0,
        cover: cover_of_part(width_class(piece.width_um / sigma_um)),
    };
    for offset_um in &parts.offsets_um {
        let part = GroovePiece {
            offset_um: piece.offset_um + offset_um,
            width_um: parts.width_um,
            ..*piece
        };
        let share = point_share(&part, whole_um, sigma_um);
        sum.segment += share.segment;
        sum.line += share.line;
    }
    sum
}

/// Half width of sinc² at green over u = W q, about.
const DRAWN_UM: f64 = 0.2;
/// Least number of strips of a groove that is no rectangle, and the least on a micrometre: half as many more would be told apart by light.
const STRIPS: usize = 24;
const STRIPS_PER_UM: f64 = 4.0;

/// All grooves of an object in the window around a point. None is wider than `widest_um`.
pub(super) fn gather(
    (tree, shapes): (&SegmentTree<Groove>, &GrooveShapes),
    widest_um: f64,
    object: usize,
    point: &SurfacePoint,
    reach_sigma: f64,
) -> Vec<GrooveView> {
    let mut views = Vec::new();
    let reach_m = ((reach_sigma * point.coherence_um + 0.5 * widest_um) * 1e-6) as f32;
    tree.gather(
        object,
        point.position_m.as_vec3(),
        Vec3::splat(reach_m),
        |i| {
            views.extend(GrooveView::new(
                point,
                &tree.segments[i],
                shapes,
                reach_sigma,
            ))
        },
    );
    views
}

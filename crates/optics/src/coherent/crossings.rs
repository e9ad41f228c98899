//! One floor where grooves cross: the deeper groove's. The part of the shallower one that lies in it is found once for a
//! point, and taken off again for each direction and wavelength.

use super::GroovePiece;
use super::cell::{Cell, REACH};
use super::polygon::{HalfPlane, Polygon};
use glam::DVec2;

/// Distance of polygons' ends from the middle in sigma, far enough that the part of a crossing that matters mostly stays
/// a parallelogram.
const FRAME: f64 = 2.0 * REACH;
/// Parts with less than this share of sigma squared are nothing but rounding.
const LEAST_AREA: f64 = 1e-11;
/// Distance of two corners, in sigma, below which they count as one.
const ROUNDING: f64 = 1e-10;

/// The parts of floors of one depth that are other grooves' floors. Cells that overlap count back.
#[derive(Clone, Debug)]
pub(super) struct Hidden {
    pub depth_nm: f64,
    pub cells: Vec<Cell>,
}

/// Finds the parts of each groove that deeper ones hide; of grooves of one depth the later is hidden.
pub(super) fn hidden_parts(pieces: &[GroovePiece], coherence_um: f64) -> Vec<Hidden> {
    let mut hidden = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let cells = hidden_cells(pieces, index, coherence_um);
        if !cells.is_empty() {
            hidden.push(Hidden {
                depth_nm: piece.depth_nm,
                cells,
            });
        }
    }
    hidden
}

fn hidden_cells(pieces: &[GroovePiece], index: usize, coherence_um: f64) -> Vec<Cell> {
    let piece = &pieces[index];
    let least_area = LEAST_AREA * coherence_um * coherence_um;
    let mut cells = Vec::new();
    let mut before: Vec<[HalfPlane; 4]> = Vec::new();
    let mut floor = None;
    for (other_index, other) in pieces.iter().enumerate() {
        if !((other.depth_nm, index) > (piece.depth_nm, other_index))
            || !may_meet(piece, other, REACH * coherence_um)
            || are_joined(piece, other)
        {
            continue;
        }
        let floor = floor.get_or_insert_with(|| rectangle(piece, FRAME * coherence_um));
        let sides = sides(other);
        let common = floor.clipped(&sides);
        if !(common.area() > least_area) {
            continue;
        }
        // Parts that earlier grooves hide are subtracted: mostly there are none, and the whole stays a parallelogram.
        let tile = |part: &Polygon, sign: f64, cells: &mut Vec<Cell>| {
            for trapezoid in part.trapezoids(ROUNDING * coherence_um) {
                trapezoid.cells(sign, coherence_um, cells);
            }
        };
        tile(&common, 1.0, &mut cells);
        for (at, earlier) in before.iter().enumerate() {
            let mut parts = vec![common.clipped(earlier)];
            for taken in &before[..at] {
                parts = parts
                    .iter()
                    .flat_map(|part| part.without(taken, least_area))
                    .collect();
            }
            for part in parts.iter().filter(|part| part.area() > least_area) {
                tile(part, -1.0, &mut cells);
            }
        }
        before.push(sides);
    }
    cells
}

/// The half-planes that a groove is the common part of.
fn sides(piece: &GroovePiece) -> [HalfPlane; 4] {
    let (tangent, normal) = (piece.tangent, piece.tangent.perp());
    let [near, far] = piece.across_um();
    [
        (normal, far),
        (-normal, -near),
        (tangent, piece.end_um),
        (-tangent, -piece.start_um),
    ]
    .map(|(normal, limit)| HalfPlane { normal, limit })
}

/// A groove within `frame_um` of the middle along its axes.
fn rectangle(piece: &GroovePiece, frame_um: f64) -> Polygon {
    let clamp = |low: f64, high: f64| [low.max(-frame_um), high.min(frame_um)];
    let [start, end] = clamp(piece.start_um, piece.end_um);
    let [near, far] = piece.across_um();
    let [near, far] = clamp(near, far);
    if !(start < end && near < far) {
        return Polygon::new(Vec::new());
    }
    let corner = |(u, v): (f64, f64)| u * piece.tangent + v * piece.tangent.perp();
    Polygon::new(
        [(start, near), (end, near), (end, far), (start, far)]
            .map(corner)
            .to_vec(),
    )
}

/// Two pieces of one groove that bends overlap on the inner side of the bend and gape as much on the outer: nothing of
/// them is hidden.
fn are_joined(a: &GroovePiece, b: &GroovePiece) -> bool {
    // Ends of a piece, and the outward direction at each.
    let ends = |g: &GroovePiece| {
        [(g.start_um, -g.tangent), (g.end_um, g.tangent)]
            .map(|(s, outward)| (s * g.tangent + g.offset_um * g.tangent.perp(), outward))
    };
    let length = |g: &GroovePiece| g.end_um - g.start_um;
    let near = 0.1 * a.width_um.min(length(a)).min(length(b));
    let goes_on = |(p, outward): (DVec2, DVec2)| {
        ends(b)
            .into_iter()
            .any(|(q, other_outward)| p.distance(q) < near && outward.dot(other_outward) < 0.0)
    };
    a.has_profile_of(b) && ends(a).into_iter().any(goes_on)
}

/// False where two middle lines stay apart within reach: most pairs.
fn may_meet(a: &GroovePiece, b: &GroovePiece, reach: f64) -> bool {
    // a's middle line within the window, as places along b's normal.
    let normal = b.tangent.perp();
    let start = a.offset_um * a.tangent.perp().dot(normal);
    let slope = a.tangent.dot(normal);
    let margin = 0.5 * (a.width_um + b.width_um);
    let (low, high) = (a.start_um.max(-reach), a.end_um.min(reach));
    let (p, q) = (start + slope * low, start + slope * high);
    low < high && p.min(q) < b.offset_um + margin && p.max(q) > b.offset_um - margin
}

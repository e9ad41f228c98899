//! Pieces of a scratch put together to arcs, as long as the view of a scene does not tell them from what was laid (docs/model.md,
//! section 6): a pixel then meets a scratch once, and not each of the chords that curves and triangles cut it into.

use crate::IndexedSegment;
use glam::Vec3;
use hairline_scene::{CameraFrame, Object, Scene};

/// Part of a pixel by which an arc may lie beside what was laid.
const DEVIATION_PX: f64 = 0.1;
/// Pieces that turn like a curve's chords are joined up to this length, in deviations: about a pixel and a half. In longer ones a pixel sees
/// that they are straight.
const CHORD_MAX: f32 = 16.0;
/// Largest turn of an arc: its chord stands for it, and a turned tangent for a small angle.
pub const TURN_MAX_RAD: f32 = 0.25;
/// Largest angle between a piece and the arc at its middle, besides what a chord turns along itself: a third of the width of the narrowest
/// bands.
const ANGLE_MAX_RAD: f32 = 1e-3;
/// Least cosine between the normals of pieces and their mean.
const SAME_SIDE_COS: f32 = 0.95;
/// A view whose pixels are larger by more than this has arcs of its own: a third of the number, which repays the trees.
const COARSER_MAX: f32 = 8.0;
/// No arc is of more pieces, so that trying one piece more stays cheap.
const PIECES_MAX: usize = 64;

/// What the trees of an index are over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pieces {
    /// The straight pieces that were laid: whatever the view, and for methods that know no arcs.
    Laid,
    /// Arcs, as long as the camera of the scene does not tell them from what was laid, at the size of its picture.
    Seen,
    /// Arcs that serve a camera that comes up to four times as near, too.
    Near,
}

/// See [`Pieces::Near`].
const NEARER: f32 = 4.0;

/// Distance by which arcs may lie beside what was laid, metres, and the box of each object; 0, and no box, where pieces stay as they were laid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Deviations(Vec<(f32, [Vec3; 2])>);

impl Deviations {
    /// Those of the pieces of a scene.
    pub(crate) fn from_scene(scene: &Scene, pieces: Pieces) -> Self {
        let frame = scene.camera.frame(scene.render.size_px);
        let of = |object: &Object| {
            let nearer = match pieces {
                // Their boxes are not measured: a scene is sketched at each step of a drag.
                Pieces::Laid => return (0.0, [Vec3::ZERO; 2]),
                Pieces::Seen => 1.0,
                Pieces::Near => NEARER,
            };
            let bounds_m = object.mesh.bounds_m().into();
            (seen_m(bounds_m, &frame) / nearer, bounds_m)
        };
        Self(scene.objects.iter().map(of).collect())
    }

    /// Whether arcs of these deviations serve a camera: they lie near enough to what was laid, and not by so much that far more arcs are
    /// there than are needed.
    pub(crate) fn serve(&self, camera: &CameraFrame) -> bool {
        self.0.iter().all(|&(own, bounds_m)| {
            let wanted = seen_m(bounds_m, camera);
            own <= wanted && own * COARSER_MAX >= wanted
        })
    }

    /// Whether pieces stay as they were laid.
    pub(crate) fn is_none(&self) -> bool {
        self.iter().all(|own| own == 0.0)
    }

    /// Object by object.
    pub(crate) fn iter(&self) -> impl Iterator<Item = f32> {
        self.0.iter().map(|(deviation_m, _)| *deviation_m)
    }
}

/// The deviation of what a camera sees: a tenth of a pixel where a box comes nearest to it, rounded down to a power of two, so that cameras that
/// are about as far away share trees.
fn seen_m([low, high]: [Vec3; 2], camera: &CameraFrame) -> f32 {
    let nearest_m = camera.position_m.clamp(low.as_dvec3(), high.as_dvec3());
    let px_m = camera.position_m.distance(nearest_m) * camera.per_px_x.length();
    let deviation_m = (DEVIATION_PX * px_m).log2().floor().exp2();
    // Not for an object without triangles.
    if deviation_m.is_finite() {
        deviation_m as f32
    } else {
        0.0
    }
}

/// Puts the pieces from `first` on, which follow one another along a scratch, together to arcs.
pub(crate) fn join(pieces: &mut Vec<IndexedSegment>, first: usize, deviation_m: f32) {
    if !(deviation_m > 0.0) {
        return;
    }
    // Arcs are written over the pieces that they stand for.
    let mut written = first;
    let mut from = first;
    while from < pieces.len() {
        let mut to = from + 1;
        let mut arc = pieces[from];
        while to < pieces.len() && to - from < PIECES_MAX {
            let Some(longer) = arc_of(&pieces[from..=to], deviation_m) else {
                break;
            };
            arc = longer;
            to += 1;
        }
        pieces[written] = arc;
        written += 1;
        from = to;
    }
    pieces.truncate(written);
}

/// The arc from the first of some pieces to the last; none where they are not one.
fn arc_of(pieces: &[IndexedSegment], deviation_m: f32) -> Option<IndexedSegment> {
    let [first, .., last] = pieces else {
        return None;
    };
    let joint = &pieces[pieces.len() - 2..];
    if joint[0].end_m != joint[1].start_m {
        return None;
    }
    let whole = last.end_m - first.start_m;
    let length_m = whole.length();
    let along = whole / length_m;
    let normal = pieces
        .iter()
        .map(|p| p.normal)
        .sum::<Vec3>()
        .normalize_or_zero();
    // Place along the chord, angle to it and length of each piece, and sums for the line of least squares through the angles.
    let mut angles = [(0.0, 0.0, 0.0); PIECES_MAX];
    let (mut by_place, mut places) = (0.0, 0.0);
    for (piece, found) in pieces.iter().zip(&mut angles) {
        let middle = 0.5 * (piece.start_m + piece.end_m) - first.start_m;
        let beside = (piece.end_m - first.start_m).cross(along).length();
        // Also where a piece is no number.
        if !(beside <= deviation_m && piece.normal.dot(normal) >= SAME_SIDE_COS) {
            return None;
        }
        let own = piece.end_m - piece.start_m;
        let aside = piece.normal.dot(along.cross(own));
        let ahead = own.dot(along) - own.dot(piece.normal) * along.dot(piece.normal);
        if !(ahead > 0.0 && aside.abs() < ahead) {
            return None;
        }
        let angle = (aside / ahead).atan();
        let place = middle.dot(along) - 0.5 * length_m;
        *found = (place, angle, own.length());
        by_place += own.length() * place * angle;
        places += own.length() * place * place;
    }
    let turn_per_m = by_place / places;
    let angles = &angles[..pieces.len()];
    let is_on_arc = |i: usize| {
        let (place, angle, length_m) = angles[i];
        // What was laid as a chord turns at its ends by what the curve turns along it.
        let before = angles[i.saturating_sub(1)].1 - angle;
        let after = angles[(i + 1).min(angles.len() - 1)].1 - angle;
        let own = match length_m <= CHORD_MAX * deviation_m {
            true => 0.5 * before.abs().max(after.abs()),
            false => 0.0,
        };
        (angle - turn_per_m * place).abs() <= ANGLE_MAX_RAD + own
    };
    let turn_rad = turn_per_m * length_m;
    let is_arc = turn_rad.abs() <= TURN_MAX_RAD && (0..angles.len()).all(is_on_arc);
    is_arc.then_some(IndexedSegment {
        end_m: last.end_m,
        normal,
        turn_rad,
        ..*first
    })
}

#[cfg(test)]
mod tests;

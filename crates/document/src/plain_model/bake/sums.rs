//! Slopes of scratches, summed up texel by texel.

use glam::{DVec2, DVec3};
use hairline_optics::section::Section;
use hairline_scene::{Object, Profile, Segment};

use super::atlas::Atlas;

/// Numbers of strips that a half of a groove may count as, side by side.
const STRIPS: [usize; 4] = [1, 4, 12, 60];
/// Largest width of a strip, in texels.
const STRIP_TEXELS: f64 = 0.25;

/// Scratches in a texel.
#[derive(Clone, Copy, Default)]
pub(super) struct TexelSum {
    /// Mean over the texel of the normals' lean: the slopes, downhill, in the axes of normal maps.
    pub lean: [f32; 2],
    /// Mean of its square.
    pub square: f32,
}

/// Sums of all scratches of an object that lie on the atlas.
pub(super) fn of_scratches(object: &Object, atlas: &Atlas) -> Vec<TexelSum> {
    let mut sums = vec![TexelSum::default(); atlas.size * atlas.size];
    for scratch in object.scratches.iter() {
        let section = &scratch.profile.section;
        let pieces = object.pieces(scratch).iter();
        for piece in pieces.filter(|piece| atlas.is_own(piece.triangle)) {
            add(piece, &scratch.profile, section, atlas, &mut sums);
        }
    }
    sums
}

/// Adds a straight piece, strip by strip.
fn add(
    piece: &Segment,
    profile: &Profile,
    section: &Section,
    atlas: &Atlas,
    sums: &mut [TexelSum],
) {
    let placed = atlas.placed(piece.triangle);
    let normal = piece.normal.as_dvec3();
    let ends_m = [piece.start_m, piece.end_m].map(|end| end.as_dvec3());
    let along_m = ends_m[1] - ends_m[0];
    let across = normal.cross(along_m).normalize_or_zero();
    let [tangent, bitangent] = placed.frame(normal);
    let direction = DVec2::new(across.dot(tangent), across.dot(bitangent));
    let texel_m2 = placed.texel_area_m2();
    let half_m = 0.5e-6 * f64::from(profile.width_um);
    let steepness = 1e-9 * f64::from(profile.depth_nm) / half_m;
    let finest = half_m / (STRIP_TEXELS * texel_m2.sqrt());
    let count = STRIPS.into_iter().find(|count| *count as f64 >= finest);
    let slopes = section.slopes(count.unwrap_or(STRIPS[STRIPS.len() - 1]));
    let strip_m = half_m / slopes.len() as f64;
    let share = along_m.length() * strip_m / texel_m2;
    for (i, slope) in slopes.iter().enumerate() {
        for side in [-1.0, 1.0] {
            let offset_m: DVec3 = across * (side * (i as f64 + 0.5) * strip_m);
            let lean = direction * (side * steepness * slope.mean);
            let square = steepness * steepness * slope.mean_square;
            let line = placed.in_map(ends_m.map(|end| end + offset_m));
            walk(line, |x, y, part| {
                if let Some(texel) = atlas.covered_texel(x, y) {
                    let (sum, share) = (&mut sums[texel], share * part);
                    sum.lean[0] += (share * lean.x) as f32;
                    sum.lean[1] += (share * lean.y) as f32;
                    sum.square += (share * square) as f32;
                }
            });
        }
    }
}

/// Calls back for each texel that a straight way passes through, with the share of the way there.
fn walk([from, to]: [DVec2; 2], mut visit: impl FnMut(i64, i64, f64)) {
    let step = to - from;
    // Shares of the way at which it passes into another column, or row.
    let mut next = DVec2::INFINITY;
    let between = step.abs().recip();
    for axis in 0..2 {
        let inside = from[axis] - from[axis].floor();
        let left = if step[axis] > 0.0 {
            1.0 - inside
        } else {
            inside
        };
        if step[axis] != 0.0 {
            next[axis] = left * between[axis];
        }
    }
    let mut at = 0.0;
    while at < 1.0 {
        let end = next.min_element().min(1.0);
        let texel = (from + step * (0.5 * (at + end))).floor();
        visit(texel.x as i64, texel.y as i64, end - at);
        for axis in 0..2 {
            if next[axis] <= end {
                next[axis] += between[axis];
            }
        }
        at = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_is_shared_out_among_the_texels_that_it_passes_through() {
        let shares = |from: [f64; 2], to: [f64; 2]| {
            let mut shares = Vec::new();
            walk([from.into(), to.into()], |x, y, share| {
                shares.push((x, y, (1e6 * share).round() / 1e6));
            });
            shares.retain(|(.., share)| *share > 0.0);
            shares
        };
        assert_eq!(shares([0.5, 0.5], [0.7, 0.5]), [(0, 0, 1.0)]);
        let right = [(-1, 0, 0.25), (0, 0, 0.5), (1, 0, 0.25)];
        assert_eq!(shares([-0.5, 0.5], [1.5, 0.5]), right);
        let up = [(3, 2, 0.4), (3, 1, 0.4), (3, 0, 0.2)];
        assert_eq!(shares([3.25, 3.0], [3.25, 0.5]), up);
        let down_left = [(1, 1, 0.2), (1, 0, 0.228571), (0, 0, 0.571429)];
        assert_eq!(shares([1.75, 1.25], [0.0, 0.0]), down_left);
    }
}

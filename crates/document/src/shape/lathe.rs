//! The profile of a lathe: straight pieces between points, with normals that are shared where it bends gently.

use glam::DVec2;

use super::profile::{Profile, ProfileEnd, ROUNDED_BEND_COS, is_floor};

/// A lathe's profile.
pub(super) fn profile(profile_m: &[[f64; 2]], smooth: bool) -> Profile {
    let mut points: Vec<DVec2> = profile_m.iter().map(|&p| p.into()).collect();
    points.dedup();
    // The left side of each piece.
    let faces: Vec<_> = points
        .windows(2)
        .map(|p| (p[1] - p[0]).perp().normalize_or(DVec2::Y))
        .collect();
    let closed = points.first() == points.last();
    let neighbour = |piece: usize, forward: bool| {
        let n = faces.len();
        let end = points[if forward { piece + 1 } else { piece }];
        match (forward, piece) {
            (true, i) if i + 1 < n => Some(faces[i + 1]),
            (false, i) if i > 0 => Some(faces[i - 1]),
            // Across the axis lies the piece's own mirror image.
            (_, i) if end.x == 0.0 => Some(faces[i] * DVec2::new(-1.0, 1.0)),
            (true, _) if closed => faces.first().copied(),
            (false, _) if closed => faces.last().copied(),
            _ => None,
        }
    };
    // A floor has vertices at its rim only, so it stays flat and what follows on it is bent to meet it.
    let is_floor = |piece: usize| is_floor(points[piece], points[piece + 1]);
    let next_to_floor = |piece: usize, forward: bool| match forward {
        true => piece + 1 < faces.len() && is_floor(piece + 1),
        false => piece > 0 && is_floor(piece - 1),
    };
    let normal = |piece: usize, forward: bool| match neighbour(piece, forward) {
        Some(other) if smooth && faces[piece].dot(other) > ROUNDED_BEND_COS => {
            match next_to_floor(piece, forward) {
                true => other,
                false => (faces[piece] + other).normalize(),
            }
        }
        _ => faces[piece],
    };
    let piece = |i: usize| {
        [false, true].map(|forward| ProfileEnd {
            point_m: points[i + usize::from(forward)],
            normal: normal(i, forward),
        })
    };
    Profile {
        pieces: (0..faces.len()).map(piece).collect(),
    }
}

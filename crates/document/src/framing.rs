//! Where a camera stands to see all of some points.

use crate::schema::SMALLEST_M;
use glam::{DVec2, DVec3};

/// Position and target of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// The pinhole.
    pub position_m: DVec3,
    /// Target in the middle of the picture, as deep as the middle of the points.
    pub target_m: DVec3,
}

/// Place of the camera as near to some points as possible so that all of them are in the picture. The camera's axes are `right`, `up` and
/// `forward`, and `tan` are the tangents of half its field of view, sideways and upwards.
pub fn framing(points_m: &[DVec3], [right, up, forward]: [DVec3; 3], tan: DVec2) -> Framing {
    let low = points_m.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points_m
        .iter()
        .copied()
        .fold(DVec3::NEG_INFINITY, DVec3::max);
    let middle = 0.5 * (low + high);
    // A point at (x, z), right of and in front of the middle, is in view from (cx, cz) if |x - cx| <= (z - cz) tan: so
    // cz <= (min(x + z tan) - max(x - z tan)) / (2 tan) suffices for some cx, and the middle of those cx is the best. Likewise
    // upwards.
    let (mut nearest, mut least, mut most) = (f64::INFINITY, DVec2::INFINITY, DVec2::NEG_INFINITY);
    for point in points_m {
        let point = *point - middle;
        let flat = DVec2::new(point.dot(right), point.dot(up));
        let depth = point.dot(forward);
        least = least.min(flat + depth * tan);
        most = most.max(flat - depth * tan);
        nearest = nearest.min(depth);
    }
    let cz = ((least - most) / (2.0 * tan)).min_element();
    // A limit that keeps the camera out of a flat object that is seen edge-on.
    let cz = cz.min(nearest - 10.0 * SMALLEST_M);
    let mut c = 0.5 * (least + most);
    // Along the axis that has room to spare, as much of it on either side: steps too short to overshoot.
    for _ in 0..16 {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for point in points_m {
            let point = *point - middle;
            let flat = DVec2::new(point.dot(right), point.dot(up));
            let seen = (flat - c) / (point.dot(forward) - cz);
            (low, high) = (low.min(seen), high.max(seen));
        }
        c += 0.5 * (nearest - cz) * (low + high);
    }
    let position_m = middle + right * c.x + up * c.y + forward * cz;
    Framing {
        position_m,
        target_m: position_m - forward * cz,
    }
}

//! Spots of circular grooves in rows, as a spinning peg that is set down again and again leaves them: engine turning (docs/model.md, section 12).
//! Twin: groove_spots.wgsl.

use glam::{DVec2, DVec3};

/// Radius of a spot, in spacings. Every place is within 0.625 of a spot's middle.
const RADIUS: f64 = 0.75;

/// The middle of the spot that is seen at a point: the last one that covers it. Each row lies over the one before, and each spot over the one
/// before it in its row; in every other row they stand by half a spacing further.
pub(super) fn middle_m(
    axis: DVec3,
    center_m: DVec3,
    along_row: DVec3,
    spacing_m: f64,
    point_m: DVec3,
) -> DVec3 {
    let onwards = axis.cross(along_row);
    let arm_m = point_m - center_m;
    let at = DVec2::new(along_row.dot(arm_m), onwards.dot(arm_m)) / spacing_m;
    let middle = middle(at);
    center_m + spacing_m * (along_row * middle.x + onwards * middle.y)
}

/// The same in the plane of the rows, in spacings.
fn middle(at: DVec2) -> DVec2 {
    // Others are a spacing away or further.
    let mut found = DVec2::ZERO;
    for row in [at.y.floor() + 1.0, at.y.floor()] {
        let shift = 0.5 * row.rem_euclid(2.0);
        let before = (at.x - shift).floor() + shift;
        for x in [before + 1.0, before] {
            found = DVec2::new(x, row);
            if found.distance_squared(at) < RADIUS * RADIUS {
                return found;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By looking at all spots around, from the last one to the first.
    #[test]
    fn the_last_spot_is_seen() {
        let spots: Vec<DVec2> = (-4..=4)
            .rev()
            .flat_map(|row: i32| {
                let shift = 0.5 * f64::from(row.rem_euclid(2));
                (-4..=4)
                    .rev()
                    .map(move |i| DVec2::new(f64::from(i) + shift, f64::from(row)))
            })
            .collect();
        for i in 0..40_000 {
            let at = DVec2::new(f64::from(i % 200), f64::from(i / 200)) * 0.02 - 2.0 + 0.003;
            let last = spots.iter().find(|spot| spot.distance(at) < RADIUS);
            assert_eq!(Some(&middle(at)), last, "{at}");
        }
    }

    #[test]
    fn spots_stand_in_the_plane_across_their_axis() {
        let (axis, along) = (DVec3::X, DVec3::Y);
        let center_m = DVec3::new(0.3, 0.1, 0.2);
        let at = |y, z| {
            let point_m = center_m + DVec3::new(0.7, y, z);
            middle_m(axis, center_m, along, 0.01, point_m) - center_m
        };
        assert!(at(0.0201, 0.0).distance(DVec3::new(0.0, 0.02, 0.0)) < 1e-12);
        assert!(at(0.005, 0.0101).distance(DVec3::new(0.0, 0.005, 0.01)) < 1e-12);
    }
}

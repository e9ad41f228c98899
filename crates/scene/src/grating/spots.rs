//! Rows of spots with circular grooves, as a spinning peg makes them: engine turning (docs/model.md, section 12). Twin: groove_spots.wgsl.

use glam::{DVec2, DVec3};

/// Radius of a spot, in spacings. Every place is within 0.625 of a spot's middle.
const RADIUS: f64 = 0.75;

/// Number of directions in which spots smaller than a pixel meet light from all around.
pub(super) const WAYS: usize = 8;

/// Standard deviation of a Gaussian over angles whose peak is 1/pi, the density of even angles.
pub(super) const ALL_AROUND_STD_RAD: f64 = 1.253_314_137_315_500_3;

/// Wider in cosines no band is: below [`hairline_optics::band::BAND_STD_MAX`], so that its own width has room.
pub(super) const WIDEST_XI: f64 = 0.28;

/// Grooves of a spot that turn by more within a pixel are taken to turn by so much: a fan is a width of the band, which holds for small angles, and
/// the samples of a pixel meet the others.
pub(super) const MOST_TURN_RAD: f64 = 0.12;

/// Standard deviations of the pixel's filter, in spacings, at which the pixel begins to see more than one spot, and from which on it sees all ways.
const MIXED: [f64; 2] = [0.15, 0.4];

/// Share of a pixel's grooves that run in all directions.
pub(super) fn mixed(spacing_m: f64, axes_m: [DVec3; 2]) -> f64 {
    let widest_m = axes_m[0].length().max(axes_m[1].length());
    let [from, to] = MIXED;
    let t = ((widest_m / spacing_m - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Directions of the rows of spots.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SpotRows {
    pub(super) axis: DVec3,
    pub(super) along_row: DVec3,
}

impl SpotRows {
    /// The unit vector at an angle to the rows.
    pub(super) fn arm(self, angle_rad: f64) -> DVec3 {
        self.along_row * angle_rad.cos() + self.axis.cross(self.along_row) * angle_rad.sin()
    }

    /// The angle of a direction to the rows.
    pub(super) fn angle_rad(self, direction: DVec3) -> f64 {
        let onwards = self.axis.cross(self.along_row).dot(direction);
        onwards.atan2(self.along_row.dot(direction))
    }
}

/// The density of places at an angle to the rows, seen from the middle of their spot or from the other side, over its mean: spots lie over one
/// another, and show more of some sides.
pub(super) fn density(angle_rad: f64) -> f64 {
    let terms = HARMONICS.map(|(turns, size, at)| size * (turns * (angle_rad - at)).cos());
    1.0 + terms.iter().sum::<f64>()
}

/// The first two terms of its Fourier series, as harmonic, amplitude and phase. Test: `spots_show_their_sides`.
const HARMONICS: [(f64, f64, f64); 2] = [(2.0, 0.1773, 1.1434), (4.0, 0.1102, 0.1765)];

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

/// Vector from the middle of the spot at a place of the plane of the rows, in spacings.
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

    /// The test looks at all spots around, from the last one to the first.
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

    /// The test looks at all places of a spacing along the rows and two across.
    #[test]
    fn spots_show_their_sides() {
        let places =
            (0..800).flat_map(|y| (0..400).map(move |x| DVec2::new(f64::from(x), f64::from(y))));
        let angles: Vec<f64> = places
            .map(|place| (place + 0.5) / 400.0)
            .map(|at| (at - middle(at)).to_angle())
            .collect();
        for (turns, size, at) in HARMONICS {
            let parts = angles.iter().map(|angle| DVec2::from_angle(turns * angle));
            let part = 2.0 * parts.sum::<DVec2>() / angles.len() as f64;
            assert!(
                (part.length() - size).abs() < 1e-3,
                "{turns}: {}",
                part.length()
            );
            assert!(
                (part.to_angle() - turns * at).abs() < 2e-3,
                "{turns}: {}",
                part.to_angle()
            );
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

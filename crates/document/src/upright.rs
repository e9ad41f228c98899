//! The axis of the world that points up: models stand by it, and environments have their top there.

use glam::DVec3;

/// The axis of the world nearest to the camera's up: the direction of the environment's top. A camera that is rolled a little
/// leaves the world upright. One that looks exactly down along Y or Z sees the top of the world, and its up is that of the picture alone; but
/// where that is +Y or +Z it says the axis, as ever. `view` goes from the camera to its target.
pub(crate) fn vertical_axis(up: DVec3, view: DVec3) -> DVec3 {
    let axis = DVec3::AXES[up.abs().max_position()];
    let axis = axis * axis.dot(up).signum();
    let uprights = [DVec3::Y, DVec3::Z];
    let over = -view.normalize_or_zero();
    let is_over = |upright: &DVec3| over.dot(*upright) > 1.0 - ALONG;
    let looked_down = uprights.into_iter().find(is_over);
    looked_down
        .filter(|_| !uprights.contains(&axis))
        .unwrap_or(axis)
}

/// Directions whose cosine is this near to 1 are the same: they are a millionth of a radian apart.
const ALONG: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_looks_straight_down_sees_the_top() {
        let down = [DVec3::NEG_Y, DVec3::NEG_Z];
        for (view, over) in down.into_iter().zip([DVec3::Y, DVec3::Z]) {
            // Up is that of the picture alone; a lean of a degree is enough to be no such view.
            for up in [DVec3::X, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
                if up.cross(view) != DVec3::ZERO {
                    assert_eq!(vertical_axis(up, view), over, "{up} {view}");
                    let leaning = view + 0.02 * up;
                    assert_eq!(vertical_axis(up, leaning), up, "{up} {view}");
                }
            }
            // Worlds have these, seen from the front or the back.
            let other = DVec3::Y + DVec3::Z - over;
            assert_eq!(vertical_axis(other, view), other);
            // Near to the axis: both agree.
            assert_eq!(vertical_axis(over + 0.1 * DVec3::X, view), over);
        }
        assert_eq!(vertical_axis(DVec3::new(0.3, 0.9, 0.1), DVec3::X), DVec3::Y);
    }
}

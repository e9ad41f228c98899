//! Single grooves of a grating: which number the one under a point has, and how far off it is (docs/model.md, section 12). Twin:
//! single_grooves.wgsl.

use super::field::{NO_DIRECTION_M, side};
use super::ground::GrooveCourse;
use super::{Bearing, Grating, GrooveField, GrooveGround};
use glam::DVec3;
use hairline_optics::grating::GroovesAt;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Least cosine between arcs and the direction away from their axis: nearer to the circles about it, arcs have no numbers.
const LEAST_COS: f64 = 0.02;

/// Single grooves are cut by planes or cones at one of eight angles to a half turn, the nearest to across the surface: they go on over slopes, and are
/// at most 2 % further apart than the pitch. In an eighth of a turn there are three, the cosine and the sine of each, up to a slope.
const CUTS: [([f64; 2], f64); 3] = [
    ([1.0, 0.0], 0.198_912_367_4),
    ([0.923_879_532_5, 0.382_683_432_4], 0.668_178_637_9),
    ([FRAC_1_SQRT_2, FRAC_1_SQRT_2], f64::INFINITY),
];

/// The cut nearest to a direction.
fn cut([x, y]: [f64; 2]) -> [f64; 2] {
    let (far, near) = (x.abs().max(y.abs()), x.abs().min(y.abs()));
    let [.., last] = CUTS;
    let found = CUTS.iter().find(|(_, most)| near < most * far);
    let [cos, sin] = found.unwrap_or(&last).0;
    let [along_x, along_y] = if x.abs() >= y.abs() {
        [cos, sin]
    } else {
        [sin, cos]
    };
    [along_x.copysign(x), along_y.copysign(y)]
}

impl GrooveField {
    /// Two coordinates of a point that grooves stay at, and how they change along a direction. None for grooves that do not keep a
    /// distance from one another.
    fn across_m(&self, point_m: DVec3, direction: DVec3) -> Option<[[f64; 2]; 2]> {
        match *self {
            Self::Along {
                direction: along,
                center_m,
            } => {
                let [first, second] = perpendicular_axes(along);
                let parts = |v: DVec3| [v.dot(first), v.dot(second)];
                Some([parts(point_m - center_m), parts(direction)])
            }
            Self::Around {
                axis,
                center_m,
                bearing: Bearing::Circular,
            } => {
                let arm_m = point_m - center_m;
                let height_m = axis.dot(arm_m);
                let away_m = arm_m - axis * height_m;
                let away = direction.dot(away_m.normalize_or_zero());
                Some([[away_m.length(), height_m], [away, direction.dot(axis)]])
            }
            Self::Spots { .. } => self.at_point(point_m).across_m(point_m, direction),
            Self::Around { .. } | Self::ByUv { .. } => None,
        }
    }

    /// Position among grooves that come nearer to one another along their way, in turns from the first one, and its derivative along a direction.
    fn turns(
        &self,
        course: &GrooveCourse,
        point_m: DVec3,
        normal: DVec3,
        direction: DVec3,
    ) -> Option<[f64; 2]> {
        let Self::Around {
            axis,
            center_m,
            bearing,
        } = *self
        else {
            let per_m = course.level_per_m.dot(direction);
            return (per_m != 0.0).then_some([course.level, per_m]);
        };
        let [first, second] = perpendicular_axes(axis);
        let arm_m = point_m - center_m;
        let [x, y] = [first, second].map(|way| way.dot(arm_m));
        let radius_m = x.hypot(y).max(NO_DIRECTION_M);
        let curvature_per_m = match bearing {
            Bearing::Spun { curvature_per_m } => curvature_per_m,
            Bearing::Circular | Bearing::Radial => 0.0,
        };
        // Arcs start from the axis at the angle of their chord less the half of what they turn until here.
        let sin = side(axis, normal) * 0.5 * radius_m * curvature_per_m;
        let cos = (1.0 - sin * sin).max(0.0).sqrt();
        if cos < LEAST_COS {
            return None;
        }
        let away = (first * x + second * y) / radius_m;
        let around = (second * x - first * y) / radius_m;
        let per_m = direction.dot(around) / radius_m - direction.dot(away) * sin / (radius_m * cos);
        Some([(y.atan2(x) - sin.asin()) / TAU, per_m / TAU])
    }
}

/// Two directions across one, at a right angle: the one follows the other counter-clockwise.
fn perpendicular_axes(axis: DVec3) -> [DVec3; 2] {
    let axis = axis.normalize();
    let other = if axis.z.abs() < 0.9 {
        DVec3::Z
    } else {
        DVec3::X
    };
    let first = axis.cross(other).normalize();
    [first, axis.cross(first)]
}

impl Grating {
    /// Whether some pixel, however small, shows single grooves on a surface of this coherence window.
    pub fn shows_single_grooves(&self, coherence_um: f64) -> bool {
        let is_numbered = match self.field {
            GrooveField::Along { .. } | GrooveField::Around { .. } | GrooveField::Spots { .. } => {
                true
            }
            GrooveField::ByUv { uv, .. } => uv.directions.is_none(),
        };
        is_numbered && self.row.shows_single_grooves(coherence_um)
    }

    /// The factor on the grooves that a pixel sees, in the place of their mean: single ones where pixel and coherence window are narrower than the
    /// pitch. `tangent` is along the grooves, and the rest as for [`Self::seen_from_pixel`].
    pub fn groove_density(
        &self,
        ground: &GrooveGround,
        point_m: DVec3,
        normal: DVec3,
        tangent: DVec3,
        axes_m: [DVec3; 2],
        coherence_um: f64,
    ) -> f64 {
        if !self.shows_single_grooves(coherence_um) {
            return 1.0;
        }
        let Some(at) = self.grooves_at(ground, point_m, normal, tangent) else {
            return 1.0;
        };
        let across = normal.cross(tangent);
        let [right_um, down_um] = axes_m.map(|axis| 1e6 * axis.dot(across));
        let window_um2 = 0.5 * coherence_um * coherence_um;
        let std_um = (right_um * right_um + down_um * down_um + window_um2).sqrt();
        self.row.groove_density(at, std_um, self.seed)
    }

    /// Grooves about a point of a surface with this normal, counted to the left of their tangent. None if they have no numbers.
    pub fn grooves_at(
        &self,
        ground: &GrooveGround,
        point_m: DVec3,
        normal: DVec3,
        tangent: DVec3,
    ) -> Option<GroovesAt> {
        let across = normal.cross(tangent);
        let Some([place_m, slope]) = self.field.across_m(point_m, across) else {
            let course = (self.field).course(ground, point_m, normal, [DVec3::ZERO; 2]);
            let [turns, per_m] = self.field.turns(&course, point_m, normal, across)?;
            return GroovesAt::branching(turns, per_m, self.row.pitch_um);
        };
        let [cos, sin] = cut(slope);
        // The other way counts the same grooves.
        let sign = if cos < 0.0 || (cos == 0.0 && sin < 0.0) {
            -1.0
        } else {
            1.0
        };
        let along_m = sign * (place_m[0] * cos + place_m[1] * sin);
        let stretch = 1.0 / (slope[0] * cos + slope[1] * sin);
        let pitch_m = 1e-6 * self.row.pitch_um;
        let number = (along_m / pitch_m).round();
        Some(GroovesAt {
            number: number as i32,
            offset_um: 1e6 * (number * pitch_m - along_m) * stretch * sign,
            pitch_um: self.row.pitch_um * stretch * sign,
            branches: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grating::tests::NOWHERE;
    use hairline_optics::grating::Grating as Row;

    fn grating(field: GrooveField) -> Grating {
        Grating {
            row: Row {
                pitch_um: 40.0,
                width_um: 8.0,
                depth_nm: 200.0,
                depth_spread: 0.0,
                jitter_um: 0.0,
            },
            field,
            angle_std_rad: 0.0,
            coverage: 1.0,
            radii_m: [0.0, f64::INFINITY],
            mask: None,
            seed: 1,
            is_rigorous: true,
        }
    }

    fn circular() -> GrooveField {
        GrooveField::Around {
            axis: DVec3::Z,
            center_m: DVec3::new(0.01, 0.0, 0.0),
            bearing: Bearing::Circular,
        }
    }

    /// A step across the grooves comes so much nearer to the one that is counted on that side.
    #[test]
    fn grooves_are_counted_across_the_surface() {
        let along = GrooveField::Along {
            direction: DVec3::new(1.0, 0.4, 0.0),
            center_m: DVec3::new(0.0, 0.3, 0.0),
        };
        for (field, normal) in [
            (along, DVec3::Z),
            (along, -DVec3::Z),
            (along, DVec3::new(0.0, 0.6, 0.8)),
            (circular(), DVec3::Z),
            (circular(), DVec3::X),
            (circular(), DVec3::new(0.6, 0.0, 0.8)),
        ] {
            let grating = grating(field);
            let point_m = DVec3::new(0.05, 0.0, 0.002);
            let tangent = field.tangent(&NOWHERE, point_m, normal).unwrap();
            let across = normal.cross(tangent);
            let at = |point_m| {
                grating
                    .grooves_at(&NOWHERE, point_m, normal, tangent)
                    .unwrap()
            };
            let here = at(point_m);
            assert!(
                (0.9999..1.03).contains(&(here.pitch_um.abs() / 40.0)),
                "{here:?}"
            );
            assert!(here.offset_um.abs() <= 0.501 * here.pitch_um.abs());
            for steps in [1.0, 5.0] {
                let there_m = point_m + across * steps * here.pitch_um * 1e-6;
                let there = at(there_m);
                // Circles bend away a little.
                assert!(
                    (there.offset_um - here.offset_um).abs() < 0.02,
                    "{here:?} {there:?}"
                );
                assert_eq!(
                    there.number - here.number,
                    steps as i32,
                    "{here:?} {there:?}"
                );
            }
            let along_m = point_m + tangent * 40e-6;
            let there = at(along_m);
            assert_eq!(there.number, here.number);
            // Cuts turn by a few degrees where the direction leaves the plane of the surface.
            assert!(
                (there.offset_um - here.offset_um).abs() < 2.0,
                "{here:?} {there:?}"
            );
        }
    }

    #[test]
    fn a_window_of_many_grooves_shows_none() {
        let disc = grating(circular());
        let seen = |coherence_um: f64, pixel_um: f64, at_um: f64| {
            let point_m = DVec3::new(0.05 + at_um * 1e-6, 0.0, 0.0);
            let axes_m = [DVec3::X, DVec3::Y].map(|axis| axis * pixel_um * 1e-6);
            disc.groove_density(&NOWHERE, point_m, DVec3::Z, DVec3::Y, axes_m, coherence_um)
        };
        // Groove 1000 lies 4 cm off the axis.
        assert!(seen(5.0, 1.0, 4.0) > 1.5 && seen(5.0, 1.0, 20.0) < 0.1);
        assert_eq!([seen(60.0, 1.0, 0.0), seen(5.0, 45.0, 0.0)], [1.0, 1.0]);
    }

    /// A step along a groove meets the same groove, and one across comes nearer to the next by its length.
    #[test]
    fn grooves_that_diverge_are_counted_along_their_way() {
        for bearing in [
            Bearing::Radial,
            Bearing::Spun {
                curvature_per_m: 18.0,
            },
            Bearing::Spun {
                curvature_per_m: -18.0,
            },
        ] {
            for normal in [DVec3::Z, -DVec3::Z, DVec3::new(0.36, 0.48, 0.8)] {
                let field = GrooveField::Around {
                    axis: DVec3::Z,
                    center_m: DVec3::new(0.01, 0.0, 0.0),
                    bearing,
                };
                let grating = grating(field);
                let at = |point_m| {
                    let tangent = field.tangent(&NOWHERE, point_m, normal).unwrap();
                    let at = grating.grooves_at(&NOWHERE, point_m, normal, tangent);
                    (tangent, at.unwrap())
                };
                let mut point_m = DVec3::new(0.05, 0.013, 0.0);
                let (tangent, here) = at(point_m);
                let size_um = here.pitch_um.abs();
                assert!((20.0..=40.0).contains(&size_um), "{here:?}");
                let across_m = normal.cross(tangent) * 2e-6;
                let (_, beside) = at(point_m + across_m);
                let numbers = f64::from(here.number - beside.number);
                let nearer_um = here.offset_um - beside.offset_um - numbers * beside.pitch_um;
                assert!((nearer_um - 2.0).abs() < 1e-3, "{here:?} {beside:?}");
                if normal.z.abs() == 1.0 {
                    for _ in 0..500 {
                        point_m += at(point_m).0 * 1e-6;
                    }
                    let (_, there) = at(point_m);
                    assert_eq!(there.number, here.number, "{here:?} {there:?}");
                    let strayed_um = there.offset_um - here.offset_um;
                    assert!(strayed_um.abs() < 0.3, "{here:?} {there:?}");
                }
            }
        }
    }
}

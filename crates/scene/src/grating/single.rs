//! Single grooves of a grating: which number the one under a point has, and how far off it is (docs/model.md, section 12). Twin:
//! single_grooves.wgsl.

use super::{Bearing, Grating, GrooveField};
use glam::DVec3;
use hairline_optics::grating::GroovesAt;
use std::f64::consts::FRAC_1_SQRT_2;

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
    /// Two coordinates of a point that grooves stay at, and how they change along a direction. None for radial and spun
    /// grooves: they diverge, so none has a number.
    fn across_m(&self, point_m: DVec3, direction: DVec3) -> Option<[[f64; 2]; 2]> {
        match *self {
            Self::Along {
                direction: along,
                center_m,
            } => {
                let along = along.normalize();
                let other = if along.z.abs() < 0.9 {
                    DVec3::Z
                } else {
                    DVec3::X
                };
                let first = along.cross(other).normalize();
                let second = along.cross(first);
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
            Self::Around { .. } => None,
        }
    }
}

impl Grating {
    /// Whether a pixel, however small, could show single grooves on a surface of this coherence window.
    pub fn shows_single_grooves(&self, coherence_um: f64) -> bool {
        let is_numbered = match self.field {
            GrooveField::Along { .. } => true,
            GrooveField::Around { bearing, .. } => bearing == Bearing::Circular,
        };
        is_numbered && self.row.shows_single_grooves(coherence_um)
    }

    /// The factor on what a pixel sees of the grooves, in the place of their mean: single ones where pixel and coherence window are narrower than
    /// the pitch. `tangent` is along the grooves, and the rest as for [`Self::seen_from_pixel`].
    pub fn groove_density(
        &self,
        point_m: DVec3,
        normal: DVec3,
        tangent: DVec3,
        axes_m: [DVec3; 2],
        coherence_um: f64,
    ) -> f64 {
        if !self.shows_single_grooves(coherence_um) {
            return 1.0;
        }
        let across = normal.cross(tangent);
        let Some(at) = self.grooves_at(point_m, across) else {
            return 1.0;
        };
        let [right_um, down_um] = axes_m.map(|axis| 1e6 * axis.dot(across));
        let window_um2 = 0.5 * coherence_um * coherence_um;
        let std_um = (right_um * right_um + down_um * down_um + window_um2).sqrt();
        self.row.groove_density(at, std_um, self.seed)
    }

    /// The grooves about a point, counted along a unit direction across them, in the plane of the surface. None where they have no numbers.
    pub fn grooves_at(&self, point_m: DVec3, across: DVec3) -> Option<GroovesAt> {
        let [place_m, slope] = self.field.across_m(point_m, across)?;
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
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grating::GrooveField;
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
            seed: 1,
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
            let tangent = field.tangent(point_m, normal).unwrap();
            let across = normal.cross(tangent);
            let here = grating.grooves_at(point_m, across).unwrap();
            assert!(
                (1.0..1.03).contains(&(here.pitch_um.abs() / 40.0)),
                "{here:?}"
            );
            assert!(here.offset_um.abs() <= 0.501 * here.pitch_um.abs());
            for steps in [1.0, 5.0] {
                let there_m = point_m + across * steps * here.pitch_um * 1e-6;
                let there = grating.grooves_at(there_m, across).unwrap();
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
            let there = grating.grooves_at(along_m, across).unwrap();
            assert_eq!(there.number, here.number);
            // Where the direction leaves the plane of the surface, cuts turn by a few degrees.
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
            disc.groove_density(point_m, DVec3::Z, DVec3::Y, axes_m, coherence_um)
        };
        // Groove 1000 lies 4 cm off the axis.
        assert!(seen(5.0, 1.0, 4.0) > 1.5 && seen(5.0, 1.0, 20.0) < 0.1);
        assert_eq!([seen(60.0, 1.0, 0.0), seen(5.0, 45.0, 0.0)], [1.0, 1.0]);
        let radial = grating(GrooveField::Around {
            axis: DVec3::Z,
            center_m: DVec3::ZERO,
            bearing: Bearing::Radial,
        });
        assert!(
            radial.grooves_at(DVec3::X, DVec3::Y).is_none() && !radial.shows_single_grooves(5.0)
        );
    }
}

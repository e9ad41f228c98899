//! Gratings as renderers read them: rows of grooves, and where on a surface they run which way.

mod field;
mod ground;
mod single;
mod spots;

use glam::DVec3;
use hairline_optics::gaussian::gaussian;
use hairline_optics::grating::Grating as Row;

use spots::SpotRows;
use std::f64::consts::PI;

pub use field::{Bearing, GrooveField, PlainField};
pub use ground::{GrooveGround, GroovePicture, UvField};

/// Grooves side by side that cover a part of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grating {
    /// The grooves.
    pub row: Row,
    /// Directions of the grooves.
    pub field: GrooveField,
    /// Standard deviation of a groove's angle to the field.
    pub angle_std_rad: f64,
    /// The share of the surface that they cover, where they are.
    pub coverage: f64,
    /// The least and the greatest distance from the field's axis, or from the middle of one that has none; 0 and infinity for everywhere.
    pub radii_m: [f64; 2],
    /// Further factor on their coverage, place by place: the red of a picture.
    pub mask: Option<GroovePicture>,
    /// Seed of the displacements of single grooves from their places.
    pub seed: u32,
    /// Whether orders have rigorous efficiencies, where grooves are [fine](crate::FINE_PITCH_UM) and the material has an index.
    pub is_rigorous: bool,
}

/// Grooves that a pixel sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroovePlace {
    /// Unit vector along the grooves in the plane of the surface.
    pub tangent: DVec3,
    /// Angles by which the grooves turn to the left over one standard deviation of the pixel's filter to the right and down.
    pub turns_rad: [f64; 2],
    /// Standard deviation of their angles at any place.
    pub angle_std_rad: f64,
    /// The share of the pixel that they cover.
    pub share: f64,
    /// The part of the share whose grooves run in all directions: they are those of spots that are smaller than the pixel. From 0 to 1.
    pub mixed: f64,
}

impl GroovePlace {
    /// Grooves of the spot at the point, without the mixed ones of others.
    pub fn of_one_spot(self) -> Self {
        Self {
            share: (1.0 - self.mixed) * self.share,
            ..self
        }
    }
}

impl Grating {
    /// The grooves that a pixel sees about a point of a surface, if any. `axes_m` are how the point moves by one standard deviation of the
    /// pixel's filter to the right and down.
    pub fn seen_from_pixel(
        &self,
        ground: &GrooveGround,
        point_m: DVec3,
        normal: DVec3,
        axes_m: [DVec3; 2],
    ) -> Option<GroovePlace> {
        let mut share = self.coverage * self.share_within(point_m, axes_m);
        if let Some(mask) = &self.mask {
            share *= ground.picture_share(mask, point_m, axes_m);
        }
        if share <= 0.0 {
            return None;
        }
        // Grooves as if the pixel saw one spot: across a rim they turn by any angle, which is no width of a fan.
        let field = self.field.at_point(point_m);
        let course = field.course(ground, point_m, normal, axes_m);
        let tangent = field.tangent_by(course.here, point_m, normal)?;
        let turns_rad = [0, 1].map(|i| {
            let (axis, step) = (axes_m[i], course.steps[i]);
            // Halfway, where a field that turns much over a pixel still tells by how much.
            let [before, after] = [-0.5, 0.5].map(|s| {
                let there = field.tangent_by(course.here + s * step, point_m + s * axis, normal);
                let there = there.unwrap_or(tangent);
                normal.dot(tangent.cross(there)).atan2(tangent.dot(there))
            });
            after - before
        });
        let (mixed, turned) = match self.field {
            GrooveField::Spots { spacing_m, .. } => {
                let turn_rad = turns_rad[0].hypot(turns_rad[1]);
                let turned = (spots::MOST_TURN_RAD / turn_rad.max(1e-9)).min(1.0);
                (spots::mixed(spacing_m, axes_m), turned)
            }
            _ => (0.0, 1.0),
        };
        Some(GroovePlace {
            tangent,
            turns_rad: turns_rad.map(|turn_rad| turned * turn_rad),
            angle_std_rad: self.angle_std_rad,
            share,
            mixed,
        })
    }

    /// The grooves in all directions that a pixel sees about a normal, evenly over half a turn. Their shares add up to the part of `seen` that is
    /// [mixed](GroovePlace::mixed); none where nothing is.
    pub fn all_ways(
        &self,
        seen: GroovePlace,
        normal: DVec3,
    ) -> impl Iterator<Item = GroovePlace> + use<> {
        let (spots, count) = match self.field {
            GrooveField::Spots {
                axis, along_row, ..
            } if seen.mixed > 0.0 => (SpotRows { axis, along_row }, spots::WAYS),
            _ => (SpotRows::default(), 0),
        };
        (0..count).filter_map(move |i| {
            let angle_rad = (i as f64 + 0.5) * PI / spots::WAYS as f64;
            let circles = GrooveField::circles(spots.axis, DVec3::ZERO);
            let tangent = circles.tangent_by(DVec3::ZERO, spots.arm(angle_rad), normal)?;
            Some(GroovePlace {
                tangent,
                turns_rad: [0.0; 2],
                share: seen.mixed * seen.share * spots::density(angle_rad) / spots::WAYS as f64,
                ..seen
            })
        })
    }

    /// Combines the grooves of [`Self::all_ways`] into one towards a light: the grooves across `along`, a direction in the plane of the surface,
    /// and fewer of them the more they turn away from it (docs/model.md, equation 45a). `along` is as long as the sine between the mirror's
    /// direction and the light's.
    pub fn grooves_towards(
        &self,
        seen: GroovePlace,
        normal: DVec3,
        along: DVec3,
    ) -> Option<GroovePlace> {
        let GrooveField::Spots {
            axis, along_row, ..
        } = self.field
        else {
            return None;
        };
        let density = spots::density(SpotRows { axis, along_row }.angle_rad(along));
        let all_std_rad = spots::ALL_AROUND_STD_RAD / density;
        let std_rad = all_std_rad.min(spots::WIDEST_XI / along.length().max(1e-9));
        (seen.mixed > 0.0).then(|| GroovePlace {
            tangent: normal.cross(along).normalize_or(seen.tangent),
            turns_rad: [0.0; 2],
            angle_std_rad: std_rad,
            share: seen.mixed * seen.share * std_rad / all_std_rad,
            ..seen
        })
    }

    /// Share of a pixel that lies between the grating's radii.
    fn share_within(&self, point_m: DVec3, axes_m: [DVec3; 2]) -> f64 {
        if self.radii_m == [0.0, f64::INFINITY] {
            return 1.0;
        }
        let (radius_m, away) = self.field.distance_m(point_m);
        let std_m = axes_m[0].dot(away).hypot(axes_m[1].dot(away)).max(1e-12);
        let [least_m, most_m] = self.radii_m;
        // There is nothing nearer than the axis.
        let inner = if least_m > 0.0 {
            (radius_m - least_m) / std_m
        } else {
            f64::INFINITY
        };
        gaussian().integral((radius_m - most_m) / std_m, inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Mesh;
    use std::sync::LazyLock;

    static NO_MESH: LazyLock<Mesh> = LazyLock::new(Mesh::default);

    /// A ground for fields that do not use texture coordinates.
    pub(super) static NOWHERE: LazyLock<GrooveGround> = LazyLock::new(|| GrooveGround {
        textures: &[],
        mesh: &NO_MESH,
        triangle: 0,
    });

    fn grating(bearing: Bearing, radii_m: [f64; 2]) -> Grating {
        Grating {
            row: Row {
                pitch_um: 1.6,
                width_um: 0.6,
                depth_nm: 110.0,
                depth_spread: 0.0,
                jitter_um: 0.0,
            },
            field: GrooveField::Around {
                axis: DVec3::Z,
                center_m: DVec3::new(0.01, 0.0, 0.0),
                bearing,
            },
            angle_std_rad: 0.0,
            coverage: 0.5,
            radii_m,
            mask: None,
            seed: 1,
            is_rigorous: true,
        }
    }

    const EVERYWHERE_M: [f64; 2] = [0.0, f64::INFINITY];

    #[test]
    fn grooves_run_around_and_across_their_axis() {
        let point_m = DVec3::new(0.05, 0.0, 0.002);
        for (bearing, expected) in [
            (Bearing::Circular, DVec3::Y),
            (Bearing::Radial, DVec3::X),
            // The circle's far side lies 0.08 m from the axis: halfway there an arc has turned by 30 degrees.
            (
                Bearing::Spun {
                    curvature_per_m: 25.0,
                },
                DVec3::new(0.75f64.sqrt(), 0.5, 0.0),
            ),
        ] {
            let axes_m = [DVec3::X * 1e-4, DVec3::Y * 1e-4];
            let grating = grating(bearing, EVERYWHERE_M);
            let place = grating
                .seen_from_pixel(&NOWHERE, point_m, DVec3::Z, axes_m)
                .unwrap();
            assert!(place.tangent.distance(expected) < 1e-9, "{place:?}");
            assert!((place.share - 0.5).abs() < 1e-12);
            // A step along a circle of 4 cm turns the pattern with it; one outwards bends a spiral further.
            assert!((place.turns_rad[1] - 1e-4 / 0.04).abs() < 1e-6, "{place:?}");
            let bends = if let Bearing::Spun { .. } = bearing {
                (0.5f64 + 12.5 * 0.5e-4).asin() - (0.5f64 - 12.5 * 0.5e-4).asin()
            } else {
                0.0
            };
            assert!(
                (place.turns_rad[0] - bends).abs() < 1e-6,
                "{place:?} {bends}"
            );
        }
        // Seen from the other side the pattern is the same.
        let below = grating(Bearing::Circular, EVERYWHERE_M);
        let place = below.seen_from_pixel(&NOWHERE, point_m, -DVec3::Z, [DVec3::ZERO; 2]);
        assert!(place.unwrap().tangent.distance(-DVec3::Y) < 1e-9);
    }

    #[test]
    fn grooves_end_at_their_radii() {
        let ring = grating(Bearing::Circular, [0.023, 0.058]);
        let share = |radius_m: f64| {
            let point_m = DVec3::new(0.01 + radius_m, 0.0, 0.0);
            let axes_m = [DVec3::X * 1e-4, DVec3::Y * 1e-4];
            let place = ring.seen_from_pixel(&NOWHERE, point_m, DVec3::Z, axes_m);
            place.map_or(0.0, |place| place.share)
        };
        assert!(share(0.02) < 1e-6 && share(0.06) < 1e-6);
        assert!((share(0.04) - 0.5).abs() < 1e-6);
        assert!((share(0.023) - 0.25).abs() < 1e-6 && (share(0.058) - 0.25).abs() < 1e-6);
        // Radii of parallel grooves are measured from their middle, in all directions.
        let mut parallel = grating(Bearing::Circular, [0.0, 0.02]);
        parallel.field = GrooveField::Along {
            direction: DVec3::X,
            center_m: DVec3::new(0.0, 0.0, 0.01),
        };
        for (height_m, expected) in [(0.0, 0.5), (0.03, 0.25), (0.04, 0.0)] {
            let axes_m = [DVec3::X * 1e-4, DVec3::Z * 1e-4];
            let place = parallel.seen_from_pixel(&NOWHERE, DVec3::Z * height_m, DVec3::Y, axes_m);
            let share = place.map_or(0.0, |place| place.share);
            assert!((share - expected).abs() < 1e-6, "{height_m}: {share}");
        }
        let nowhere = grating(Bearing::Circular, EVERYWHERE_M);
        let axis_m = DVec3::new(0.01, 0.0, 0.3);
        assert!(
            nowhere
                .seen_from_pixel(&NOWHERE, axis_m, DVec3::Z, [DVec3::ZERO; 2])
                .is_none()
        );
    }
}

//! Gratings as renderers read them: rows of grooves, and where on a surface they run which way.

mod ground;
mod single;
mod spots;

use glam::DVec3;
use hairline_optics::gaussian::gaussian;
use hairline_optics::grating::Grating as Row;

use crate::picture_lie::PictureLie;
use spots::SpotRows;
use std::f64::consts::PI;

pub use ground::GrooveGround;

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

/// A picture on the surface of a grating.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroovePicture {
    /// Index of the texture in the scene.
    pub texture: usize,
    /// Mapping of the picture onto the surface.
    pub lie: PictureLie,
}

/// Directions of grooves over a surface, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GrooveField {
    /// Grooves along a direction.
    Along {
        /// The direction, of any length.
        direction: DVec3,
        /// Point from which [`Grating::radii_m`] are measured.
        center_m: DVec3,
    },
    /// Grooves at a fixed bearing to the circles about an axis.
    Around {
        /// A unit vector.
        axis: DVec3,
        /// A point on it.
        center_m: DVec3,
        /// Bearing of the grooves to the circles.
        bearing: Bearing,
    },
    /// Grooves around the middles of spots in rows. The spots are pressed into the surface along an axis, each over those before it.
    Spots {
        /// A unit vector.
        axis: DVec3,
        /// The middle of a spot.
        center_m: DVec3,
        /// Direction of the rows: a unit vector across the axis.
        along_row: DVec3,
        /// Distance of neighbouring spots and rows.
        spacing_m: f64,
    },
    /// Grooves that follow the texture coordinates of the surface.
    ByUv {
        /// Direction by texture coordinates.
        uv: UvField,
        /// Point from which [`Grating::radii_m`] are measured.
        center_m: DVec3,
    },
}

/// Where grooves run, in the words of HAIRLINE_scratches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainField {
    /// `"along"`, `"circular"`, `"radial"` or `"spun"`; `"along-u"` or `"along-v"`, by texture coordinates.
    pub kind: &'static str,
    /// The direction of the grooves, of any length, or a unit vector along the axis; zero by texture coordinates.
    pub axis: DVec3,
    /// Point from which [`Grating::radii_m`] are measured.
    pub center_m: DVec3,
    /// Curvature of spun grooves, 0 of others.
    pub curvature_per_m: f64,
}

/// A direction by texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvField {
    /// Whether the grooves run along the second coordinate, in place of the first.
    pub along_v: bool,
    /// A picture (linear) of the scene's that turns it: red and green are the parts along the tangent and the bitangent, from -1 to 1.
    pub directions: Option<usize>,
}

/// Direction and numbering of grooves about a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct GrooveCourse {
    /// The direction there, of any length.
    pub here: DVec3,
    /// Change of the direction over one standard deviation of the pixel's filter to the right and down.
    pub steps: [DVec3; 2],
    /// Texture coordinate that stays the same along a groove, in turns of the texture, and its gradient: grooves are numbered by it.
    pub level: f64,
    pub level_per_m: DVec3,
}

/// Bearing of a pattern about an axis to the circles around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bearing {
    /// Along the circles.
    Circular,
    /// Across them.
    Radial,
    /// Along arcs of this curvature that pass through the axis.
    Spun {
        /// One over their radius.
        curvature_per_m: f64,
    },
}

/// Nearer than this to its axis a field has no direction.
const NO_DIRECTION_M: f64 = 1e-8;

/// Least part of a direction in the plane of a surface: below it the projection is noise.
const LEAST_PART: f64 = 1e-3;

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

impl GrooveField {
    /// The field without its pictures; none where grooves lie in spots.
    pub fn plain(&self) -> Option<PlainField> {
        let (kind, axis, center_m, curvature_per_m) = match *self {
            Self::Along {
                direction,
                center_m,
            } => ("along", direction, center_m, 0.0),
            Self::Around {
                axis,
                center_m,
                bearing,
            } => match bearing {
                Bearing::Circular => ("circular", axis, center_m, 0.0),
                Bearing::Radial => ("radial", axis, center_m, 0.0),
                Bearing::Spun { curvature_per_m } => ("spun", axis, center_m, curvature_per_m),
            },
            Self::ByUv { uv, center_m } => {
                let kind = if uv.along_v { "along-v" } else { "along-u" };
                (kind, DVec3::ZERO, center_m, 0.0)
            }
            Self::Spots { .. } => return None,
        };
        Some(PlainField {
            kind,
            axis,
            center_m,
            curvature_per_m,
        })
    }

    /// The unit direction of the grooves at a point, in the plane across a unit normal; none where there is none.
    pub fn tangent(&self, ground: &GrooveGround, point_m: DVec3, normal: DVec3) -> Option<DVec3> {
        let course = self.course(ground, point_m, normal, [DVec3::ZERO; 2]);
        self.tangent_by(course.here, point_m, normal)
    }

    fn course(
        &self,
        ground: &GrooveGround,
        point_m: DVec3,
        normal: DVec3,
        axes_m: [DVec3; 2],
    ) -> GrooveCourse {
        match self {
            Self::Along { direction, .. } => GrooveCourse {
                here: direction.normalize_or_zero(),
                ..GrooveCourse::default()
            },
            Self::Around { .. } | Self::Spots { .. } => GrooveCourse::default(),
            Self::ByUv { uv, .. } => ground.course(uv, point_m, normal, axes_m),
        }
    }

    /// `direction` is that of the course there. As for scratches (`document/src/scratches/guide.rs`).
    fn tangent_by(&self, direction: DVec3, point_m: DVec3, normal: DVec3) -> Option<DVec3> {
        let in_plane = |v: DVec3| v - normal * normal.dot(v);
        match *self {
            Self::Along { .. } | Self::ByUv { .. } => {
                let along = in_plane(direction);
                (along.length() > LEAST_PART).then(|| along.normalize())
            }
            Self::Around {
                axis,
                center_m,
                bearing,
            } => {
                let arm_m = point_m - center_m;
                let spin = side(axis, normal) * axis.cross(arm_m);
                let circle = in_plane(spin);
                if circle.length() < NO_DIRECTION_M {
                    return None;
                }
                let circle = circle.normalize();
                let outwards = circle.cross(normal);
                Some(match bearing {
                    Bearing::Circular => circle,
                    Bearing::Radial => outwards,
                    Bearing::Spun { curvature_per_m } => {
                        // A chord from the axis meets its circle at the angle asin(chord curvature / 2).
                        let sin = (0.5 * spin.length() * curvature_per_m).clamp(-1.0, 1.0);
                        outwards * (1.0 - sin * sin).max(0.0).sqrt() + circle * sin
                    }
                })
            }
            Self::Spots { .. } => self.about(point_m).tangent_by(direction, point_m, normal),
        }
    }

    /// The field that is about a point: of spots, that of the last one there.
    fn about(&self, point_m: DVec3) -> Self {
        match *self {
            Self::Spots {
                axis,
                center_m,
                along_row,
                spacing_m,
            } => Self::circles(
                axis,
                spots::middle_m(axis, center_m, along_row, spacing_m, point_m),
            ),
            field => field,
        }
    }

    fn circles(axis: DVec3, center_m: DVec3) -> Self {
        Self::Around {
            axis,
            center_m,
            bearing: Bearing::Circular,
        }
    }

    /// The distance from the axis or the middle, and the unit direction away from it.
    fn distance_m(&self, point_m: DVec3) -> (f64, DVec3) {
        let away_m = match *self {
            Self::Along { center_m, .. } | Self::ByUv { center_m, .. } => point_m - center_m,
            Self::Around { axis, center_m, .. } | Self::Spots { axis, center_m, .. } => {
                let arm_m = point_m - center_m;
                arm_m - axis * axis.dot(arm_m)
            }
        };
        (away_m.length(), away_m.normalize_or_zero())
    }
}

/// Patterns turn counter-clockwise seen from outside, so that one looks the same on both sides of a sheet.
fn side(axis: DVec3, normal: DVec3) -> f64 {
    if axis.dot(normal) < 0.0 { -1.0 } else { 1.0 }
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
        let field = self.field.about(point_m);
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

//! Directions of grooves over a surface.

use super::ground::{GrooveCourse, GrooveGround, UvField};
use super::spots;
use glam::DVec3;

/// Directions of grooves over a surface, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GrooveField {
    /// Grooves along a direction.
    Along {
        /// The direction, of any length.
        direction: DVec3,
        /// Point from which [`Grating::radii_m`](super::Grating::radii_m) are measured.
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
        /// Point from which [`Grating::radii_m`](super::Grating::radii_m) are measured.
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
    /// Point from which [`Grating::radii_m`](super::Grating::radii_m) are measured.
    pub center_m: DVec3,
    /// Curvature of spun grooves, 0 of others.
    pub curvature_per_m: f64,
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
pub(super) const NO_DIRECTION_M: f64 = 1e-8;

/// Least part of a direction in the plane of a surface: below it the projection is noise.
const LEAST_PART: f64 = 1e-3;

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

    pub(super) fn course(
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
    pub(super) fn tangent_by(
        &self,
        direction: DVec3,
        point_m: DVec3,
        normal: DVec3,
    ) -> Option<DVec3> {
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
            Self::Spots { .. } => self
                .at_point(point_m)
                .tangent_by(direction, point_m, normal),
        }
    }

    /// The field that is about a point: of spots, that of the last one there.
    pub(super) fn at_point(&self, point_m: DVec3) -> Self {
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

    pub(super) fn circles(axis: DVec3, center_m: DVec3) -> Self {
        Self::Around {
            axis,
            center_m,
            bearing: Bearing::Circular,
        }
    }

    /// The distance from the axis or the middle, and the unit direction away from it.
    pub(super) fn distance_m(&self, point_m: DVec3) -> (f64, DVec3) {
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
pub(super) fn side(axis: DVec3, normal: DVec3) -> f64 {
    if axis.dot(normal) < 0.0 { -1.0 } else { 1.0 }
}

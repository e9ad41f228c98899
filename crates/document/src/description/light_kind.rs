//! The shapes of lights.

use std::f64::consts::PI;

use glam::DVec3;
use hairline_scene::scene;
use serde::Serialize;

use super::keyed::kinds;
use super::ranges::Check;
use super::table::Table;
use super::values::{is_false, is_zero};
use crate::error::Error;
use crate::polygon;
use crate::schema::light;

/// `kind` of a `[[light]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum LightKind {
    /// `"sphere"`
    Sphere {
        /// Required.
        center_m: [f64; 3],
        /// Required.
        radius_m: f64,
    },
    /// `"disk"`: flat and round; shines to the side of its target.
    Disk {
        /// Required.
        center_m: [f64; 3],
        /// A point on the axis, before the disk. Required.
        target_m: [f64; 3],
        /// Required.
        radius_m: f64,
        /// Whether the other side shines too.
        #[serde(skip_serializing_if = "is_false")]
        two_sided: bool,
    },
    /// `"rectangle"`: shines to the side of its target.
    Rectangle {
        /// Required.
        center_m: [f64; 3],
        /// A point on the axis, before the rectangle. Required.
        target_m: [f64; 3],
        /// Width from side to side, across the height. Required.
        width_m: f64,
        /// Height along the direction in its plane that is nearest to y, or to z where it faces along y. Required.
        height_m: f64,
        /// Turns it about its axis, counter-clockwise as seen from the target.
        #[serde(skip_serializing_if = "is_zero")]
        rotation_deg: f64,
        /// Whether the other side shines too.
        #[serde(skip_serializing_if = "is_false")]
        two_sided: bool,
    },
    /// `"polygon"`: planar, simple, convex or not; shines to the side that sees its vertices counter-clockwise.
    Polygon {
        /// Corners, at least three. Required.
        vertices_m: Vec<[f64; 3]>,
        /// Whether the other side shines too.
        two_sided: bool,
    },
    /// `"tube"`: all within a radius of a line; its ends are half spheres.
    Tube {
        /// The ends of the line. Required.
        ends_m: [[f64; 3]; 2],
        /// Required.
        radius_m: f64,
    },
    /// `"sun"`: round, and so far off that it stands in one direction for all of the scene.
    Sun {
        /// The way that its light goes, of any length. Required.
        direction: [f64; 3],
        /// The angle that it spans as seen from the scene, across.
        angle_deg: f64,
        /// Irradiance of a surface that faces it, W m^-2 in effect; not negative. It takes the place of a radiance.
        irradiance: f64,
    },
}

kinds! { LightKind,
    /// Value of `kind` for it.
    name {
        "sphere" => Sphere { center_m: light::CENTER_M, radius_m: light::RADIUS_M },
        "disk" => Disk { center_m: light::CENTER_M, target_m: light::TARGET_M, radius_m: light::RADIUS_M, two_sided: light::TWO_SIDED },
        "rectangle" => Rectangle { center_m: light::CENTER_M, target_m: light::TARGET_M, width_m: light::WIDTH_M, height_m: light::HEIGHT_M, rotation_deg: light::ROTATION_DEG, two_sided: light::TWO_SIDED },
        "polygon" => Polygon { vertices_m: light::VERTICES_M, two_sided: light::TWO_SIDED },
        "tube" => Tube { ends_m: light::ENDS_M, radius_m: light::RADIUS_M },
        "sun" => Sun { direction: light::DIRECTION, angle_deg: light::ANGLE_DEG, irradiance: light::IRRADIANCE },
    }
}

impl LightKind {
    /// A sphere.
    pub fn sphere(center_m: [f64; 3], radius_m: f64) -> Self {
        Self::Sphere { center_m, radius_m }
    }

    /// A polygon that shines to one side.
    pub fn polygon(vertices_m: Vec<[f64; 3]>) -> Self {
        Self::Polygon {
            vertices_m,
            two_sided: false,
        }
    }

    /// A sun as wide as ours, of irradiance 1.
    pub fn sun(direction: [f64; 3]) -> Self {
        Self::Sun {
            direction,
            angle_deg: light::ANGLE_DEG.initial(),
            irradiance: light::IRRADIANCE.initial(),
        }
    }

    /// Name of such a light for users.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "sphere light",
            Self::Disk { .. } => "disk light",
            Self::Rectangle { .. } => "rectangle light",
            Self::Polygon { .. } => "polygon light",
            Self::Tube { .. } => "tube light",
            Self::Sun { .. } => "sun",
        }
    }

    /// The vertices of a polygon, which may be edited one by one; none of others.
    pub fn vertices_m(&self) -> &[[f64; 3]] {
        match self {
            Self::Polygon { vertices_m, .. } => vertices_m,
            _ => &[],
        }
    }

    /// Corners of the light's polygon for renderers, counter-clockwise as seen from where it shines; none if it is not flat.
    pub fn corners_m(&self) -> Vec<DVec3> {
        match self {
            Self::Sphere { .. } | Self::Tube { .. } | Self::Sun { .. } => Vec::new(),
            Self::Disk {
                center_m,
                target_m,
                radius_m,
                ..
            } => {
                let [x, y] = plane(*center_m, *target_m, 0.0);
                polygon::disk_corners_m((*center_m).into(), *radius_m * x, *radius_m * y)
            }
            Self::Rectangle {
                center_m,
                target_m,
                width_m,
                height_m,
                rotation_deg,
                ..
            } => {
                let [x, y] = plane(*center_m, *target_m, *rotation_deg);
                let (x, y) = (0.5 * width_m * x, 0.5 * height_m * y);
                let center_m = DVec3::from(*center_m);
                [-x - y, x - y, x + y, y - x]
                    .map(|arm| center_m + arm)
                    .into()
            }
            Self::Polygon { vertices_m, .. } => vertices_m.iter().map(|&v| v.into()).collect(),
        }
    }

    /// Middle of the light: of a polygon the middle of the box around it; that of a sun is far off.
    pub fn middle_m(&self) -> DVec3 {
        self.in_scene([0.0; 3]).bounding_sphere().0
    }

    /// The unit direction in front of a flat one.
    pub fn axis(&self) -> Option<DVec3> {
        hairline_scene::vector_area_m2(&self.corners_m()).try_normalize()
    }

    /// Unit direction of the width of a light that faces a target, to the right as seen from there.
    pub(super) fn across(&self) -> Option<DVec3> {
        let (center_m, target_m, rotation_deg) = match self {
            Self::Disk {
                center_m, target_m, ..
            } => (center_m, target_m, 0.0),
            Self::Rectangle {
                center_m,
                target_m,
                rotation_deg,
                ..
            } => (center_m, target_m, *rotation_deg),
            _ => return None,
        };
        let [across, _] = plane(*center_m, *target_m, rotation_deg);
        Some(across)
    }

    /// Whether `target_m` sets the light's direction, with or without a cone.
    pub(super) fn has_target(&self) -> bool {
        matches!(self, Self::Disk { .. } | Self::Rectangle { .. })
    }

    /// Whether both sides of a flat one shine.
    pub fn is_two_sided(&self) -> bool {
        match self {
            Self::Sphere { .. } | Self::Tube { .. } | Self::Sun { .. } => false,
            Self::Disk { two_sided, .. }
            | Self::Rectangle { two_sided, .. }
            | Self::Polygon { two_sided, .. } => *two_sided,
        }
    }

    /// The unit direction that the light of a sun goes in; none of others.
    pub fn sunbeam(&self) -> Option<DVec3> {
        match self {
            Self::Sun { direction, .. } => Some(DVec3::from(*direction).normalize_or(DVec3::NEG_Z)),
            _ => None,
        }
    }

    /// Makes the width of a rectangle run along a direction, as far as its plane allows. Other kinds stay as they are.
    pub fn lay_width_along(&mut self, along: DVec3) {
        if let Self::Rectangle {
            center_m,
            target_m,
            rotation_deg,
            ..
        } = self
        {
            let [x, y] = plane(*center_m, *target_m, 0.0);
            *rotation_deg = along.dot(y).atan2(along.dot(x)).to_degrees();
        }
    }

    pub(super) fn check_at(&self, key: &str) -> Check {
        self.check_keys(key)?;
        match self {
            Self::Disk {
                center_m, target_m, ..
            }
            | Self::Rectangle {
                center_m, target_m, ..
            } => aimed(key, *center_m, *target_m),
            Self::Tube { ends_m: [a, b], .. }
                if DVec3::from(*a).distance(DVec3::from(*b)) < NEAREST_TARGET_M =>
            {
                Err(Error::new(
                    format!("{key}.ends_m"),
                    "found two equal ends",
                    "must be two places; a round lamp is a `sphere`",
                ))
            }
            Self::Polygon { .. } => polygon::check(&self.corners_m()).map_err(|flaw| {
                Error::new(format!("{key}.vertices_m"), flaw.to_string(), flaw.remedy())
            }),
            _ => Ok(()),
        }
    }

    /// Converts it to a light of a scene. `radiance` is that of its surface; for a sun it is a factor on the radiance from its
    /// irradiance.
    pub(super) fn in_scene(&self, radiance: [f64; 3]) -> scene::Light {
        match self {
            Self::Sphere { center_m, radius_m } => {
                scene::Light::sphere((*center_m).into(), *radius_m, radiance)
            }
            Self::Tube { ends_m, radius_m } => {
                scene::Light::tube(ends_m.map(DVec3::from), *radius_m, radiance)
            }
            Self::Sun {
                direction,
                angle_deg,
                irradiance,
            } => {
                let towards_it = -DVec3::from(*direction).normalize_or(DVec3::NEG_Z);
                let radius_rad = 0.5 * angle_deg.to_radians();
                // A disc of even radiance in the sky.
                let surface = irradiance / (PI * radius_rad.sin().powi(2));
                scene::Light::sun(towards_it, radius_rad, radiance.map(|c| c * surface))
            }
            _ => scene::Light::polygon(self.corners_m(), radiance, self.is_two_sided()),
        }
    }
}

/// Least distance of a target from the light's middle: a nearer one has no direction in single precision.
const NEAREST_TARGET_M: f64 = 1e-6;

pub(super) fn aimed(key: &str, center_m: [f64; 3], target_m: [f64; 3]) -> Check {
    match DVec3::from(center_m).distance(target_m.into()) >= NEAREST_TARGET_M {
        true => Ok(()),
        false => Err(Error::new(
            format!("{key}.target_m"),
            "found the light's own middle",
            "must be another point, which the light is to face",
        )),
    }
}

/// The axes of width and height of a flat light: with the way to the target they are right-handed.
fn plane(center_m: [f64; 3], target_m: [f64; 3], rotation_deg: f64) -> [DVec3; 2] {
    let axis = (DVec3::from(target_m) - DVec3::from(center_m)).normalize_or(DVec3::Z);
    // A direction within a milliradian of y leaves too few digits of a width across it.
    let up = match axis.cross(DVec3::Y).length() > 1e-3 {
        true => DVec3::Y,
        false => DVec3::Z,
    };
    let x = up.cross(axis).normalize();
    let y = axis.cross(x);
    let (sin, cos) = rotation_deg.to_radians().sin_cos();
    [cos * x + sin * y, cos * y - sin * x]
}

//! The shapes of lights.

use std::f64::consts::PI;

use glam::DVec3;
use hairline_keys::Keyed;
use hairline_scene::scene;

use super::ranges::Check;
use crate::error::Error;
use crate::polygon;
use crate::schema::Key;
use crate::schema::key::{Form, linear};

/// The angle that the sun spans as the earth sees it, degrees.
pub const SUN_DEG: f64 = 0.53;

/// `kind` of a `[[light]]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(tag = "kind", check = LightKind::check_shape)]
pub enum LightKind {
    /// A sphere.
    #[kind("sphere")]
    Sphere {
        /// Its middle.
        #[key(unit("m").in_range(-1000.0, 1000.0)
            .control("Position", linear(-5.0, 5.0).sized(), "Where the light hangs. Around its highlight those scratches light up that run crosswise to the way there."))]
        center_m: [f64; 3],
        /// Its radius.
        #[key(unit("m").size()
            .control("Radius", log(2e-3, 1.0).sized(), "Small lights give pure rainbows and hard-edged glints; large ones overlap the colours to white around the highlight. At the same radiance a larger one also lights more."))]
        radius_m: f64,
    },
    /// Flat and round; it faces the target and shines to its side.
    #[kind("disk")]
    Disk {
        /// As of a sphere.
        center_m: [f64; 3],
        /// A point before it on its axis: it shines to that side.
        #[key(like(&TARGET))]
        target_m: [f64; 3],
        /// As of a sphere.
        radius_m: f64,
        /// Whether the other side shines too.
        #[key(flag(false).omitted().labelled("Two-sided", "Whether the other side of it shines too."))]
        two_sided: bool,
    },
    /// It faces the target and shines to its side.
    #[kind("rectangle")]
    Rectangle {
        /// As of a sphere.
        center_m: [f64; 3],
        /// As of a disk.
        target_m: [f64; 3],
        /// From side to side, across the height.
        #[key(unit("m").size()
            .control("Width", log(2e-3, 1.0).sized(), "From side to side. Narrow lights keep colours pure across their width."))]
        width_m: f64,
        /// Along the direction in its plane that is nearest to y; to z, where it faces along y.
        #[key(unit("m").size()
            .control("Height", log(2e-3, 1.0).sized(), "From lower to upper edge. Long lights fill more scratches with colour."))]
        height_m: f64,
        /// Turns it about its axis, counter-clockwise as seen from the target.
        #[key(unit("°").number(0.0).in_range(-360.0, 360.0).omitted()
            .control("Rotation", linear(-180.0, 180.0), "Turns the light about its axis, counter-clockwise as seen from its target."))]
        rotation_deg: f64,
        /// As of a disk.
        two_sided: bool,
    },
    /// Flat; it shines to the side that sees its vertices counter-clockwise.
    #[kind("polygon")]
    Polygon {
        /// Its corners, in one plane and without crossing edges, convex or not. It shines to the side that sees them counter-clockwise.
        #[key(unit("m").in_range(-1000.0, 1000.0).range_words("3 to 4096 points, ±1000 each")
            .control("Corner", linear(-5.0, 5.0).sized(), "A corner of the light. Its outline is mirrored in the surface, and scratches draw it out; long, thin shapes keep colours pure across their short side."))]
        vertices_m: Vec<[f64; 3]>,
        /// As of a disk.
        two_sided: bool,
    },
    /// A straight lamp with round ends, all around: what is within the radius of the line. It lights nothing that is within it.
    #[kind("tube")]
    Tube {
        /// The ends of the line.
        #[key(unit("m").in_range(-1000.0, 1000.0).range_words("two points, ±1000 each")
            .control("End", linear(-5.0, 5.0).sized(), "An end of the line within the tube. Scratches that run along the tube show colours across it."))]
        ends_m: [[f64; 3]; 2],
        /// As of a sphere.
        radius_m: f64,
    },
    /// A sun stands in one direction for all of the scene: a round lamp 100 km off.
    #[kind("sun")]
    Sun {
        /// The way that its light goes, of any length.
        #[key(direction()
            .control("Direction", linear(-1.0, 1.0), "The way that the light goes, from the sun to the scene. Its length does not matter."))]
        direction: [f64; 3],
        /// The angle that it spans, across; the default is that of the sun. A wider one sends as much.
        #[key(unit("°").number(SUN_DEG).in_range(0.01, 90.0)
            .control("Angle", log(0.1, 10.0), "How wide it is as seen from the scene: the sun 0.53 degrees. A wider one blurs rainbows and the edges of shadows; the scene stays as bright."))]
        angle_deg: f64,
        /// What falls on a surface that faces it. 683 lux are 1 W m⁻². White paper under 3.14 has radiance 1.
        #[key(unit("W m⁻²").number(1.0).at_least_0()
            .control("Irradiance", log(1e-3, 10.0), "What falls on a surface that faces the sun, W per square metre; 683 lux are 1. White paper under 3.14 is as bright as white gets."))]
        irradiance: f64,
    },
}

/// A point that a light faces.
pub(super) const TARGET: Key = Key::new("target_m", Form::Numbers(3))
    .unit("m")
    .in_range(-1000.0, 1000.0)
    .control(
        "Target",
        linear(-5.0, 5.0).sized(),
        "A point that the light faces. Its distance does not matter.",
    );

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
            angle_deg: Self::ANGLE_DEG.initial(),
            irradiance: Self::IRRADIANCE.initial(),
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

    /// Middle, target and rotation in degrees of a light that faces a target.
    fn aim(&self) -> Option<([f64; 3], [f64; 3], f64)> {
        match *self {
            Self::Disk {
                center_m, target_m, ..
            } => Some((center_m, target_m, 0.0)),
            Self::Rectangle {
                center_m,
                target_m,
                rotation_deg,
                ..
            } => Some((center_m, target_m, rotation_deg)),
            _ => None,
        }
    }

    /// Unit direction of the width of a light that faces a target, to the right as seen from there.
    pub(super) fn width_direction(&self) -> Option<DVec3> {
        let (center_m, target_m, rotation_deg) = self.aim()?;
        let [across, _] = plane(center_m, target_m, rotation_deg);
        Some(across)
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

    /// Whether it may have barn doors: it faces a target, and shines to that side alone.
    pub fn takes_barn_doors(&self) -> bool {
        self.aim().is_some() && !self.is_two_sided()
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

    /// Refuses shapes that are none.
    fn check_shape(&self, key: &str) -> Check {
        if let Some((center_m, target_m, _)) = self.aim() {
            return aimed(key, center_m, target_m);
        }
        match self {
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

//! `shape` of an `[[object]]`.

use serde::Serialize;

use super::keyed::kinds;
use super::ranges::{Check, found, written};
use super::table::{Read, Table, Value};
use crate::error::Error;
use crate::schema::{Key, shape};
use crate::shape::text;

/// A built-in shape about the origin, z up.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// A rectangle in the xy plane that faces +z.
    Plane {
        /// Edge lengths along x and y. Required.
        size_m: [f64; 2],
    },
    /// A disk in the xy plane that faces +z.
    Disk {
        /// Required.
        radius_m: f64,
    },
    /// A sphere.
    Sphere {
        /// Required.
        radius_m: f64,
    },
    /// A box with its middle in the origin.
    Box {
        /// Edge lengths along x, y and z. Required.
        size_m: [f64; 3],
        /// Radius of the rounded edges and corners, at most half of the shortest edge.
        rounding_m: f64,
    },
    /// A cylinder about the z axis with its middle in the origin, closed at both ends.
    Cylinder {
        /// Required.
        radius_m: f64,
        /// Height from end to end. Required.
        height_m: f64,
        /// Radius of the rounded rims, at most the cylinder's radius and half of its height.
        rounding_m: f64,
    },
    /// A ring of round section about the z axis.
    Torus {
        /// Radius from the axis to the middle of the tube. Required.
        radius_m: f64,
        /// Radius of the tube, below `radius_m`. Required.
        tube_radius_m: f64,
    },
    /// The part of a sphere above a plane: a watch glass. It faces outwards, its rim lies in the xy plane, and it is open below.
    Dome {
        /// Radius of the rim. Required.
        radius_m: f64,
        /// Height of the top over the rim, at most `radius_m`: then it is a half sphere. Required.
        height_m: f64,
    },
    /// A floor that turns up into a wall at its +y end, as in a studio. It faces +z and -y.
    Sweep {
        /// Extent of the floor along x and y, about the origin. Required.
        size_m: [f64; 2],
        /// Height of the wall over the floor. Required.
        height_m: f64,
        /// Radius of the turn between them, at most `height_m` and the floor's extent along y.
        rounding_m: f64,
    },
    /// A line of letters that stand on the xy plane, read from +z, with its middle over the origin: a logo.
    Text {
        /// Text of up to 200 characters of the built-in font, Ubuntu Light: Latin, Greek, Cyrillic. Required.
        line: String,
        /// Height of capitals, along y. Required.
        height_m: f64,
        /// Depth along z. Required.
        depth_m: f64,
    },
    /// A profile turned about the z axis.
    Lathe {
        /// Points `[r, z]`, at least two, r not negative. The surface faces to the left of the way along the profile, r
        /// to the right and z up: a plate's upper side runs from the axis outwards, a cup's outside runs downwards.
        /// A profile that ends where it starts is closed, as for a ring. Required.
        profile_m: Vec<[f64; 2]>,
        /// Facets around, from 3 to 4096.
        segments: u32,
        /// Whether the profile is rounded where it bends by less than 40 degrees; sharper corners stay.
        smooth: bool,
    },
}

kinds! { Shape,
    /// Value of `shape` for it.
    kind {
        "plane" => Plane { size_m: shape::PLANE_SIZE_M },
        "disk" => Disk { radius_m: shape::RADIUS_M },
        "sphere" => Sphere { radius_m: shape::RADIUS_M },
        "box" => Box { size_m: shape::BOX_SIZE_M, rounding_m: shape::BOX_ROUNDING_M },
        "cylinder" => Cylinder { radius_m: shape::RADIUS_M, height_m: shape::HEIGHT_M, rounding_m: shape::CYLINDER_ROUNDING_M },
        "torus" => Torus { radius_m: shape::RING_RADIUS_M, tube_radius_m: shape::TUBE_RADIUS_M },
        "dome" => Dome { radius_m: shape::RADIUS_M, height_m: shape::DOME_HEIGHT_M },
        "sweep" => Sweep { size_m: shape::PLANE_SIZE_M, height_m: shape::HEIGHT_M, rounding_m: Or(&shape::SWEEP_ROUNDING_M, half_of_the_most) },
        "text" => Text { line: shape::LINE, height_m: shape::CAPITALS_M, depth_m: shape::DEPTH_M },
        "lathe" => Lathe { profile_m: shape::PROFILE_M, segments: shape::SEGMENTS, smooth: shape::SMOOTH },
    }
}

impl Shape {
    /// Refuses values out of range; `key` is the way to `shape`.
    pub(super) fn check_at(&self, key: &str) -> Check {
        let table = format!("{key}.{}", self.kind());
        self.check_keys(&table)?;
        let way = |key: &Key| format!("{table}.{}", key.name);
        match self {
            Self::Plane { .. } | Self::Disk { .. } | Self::Sphere { .. } => Ok(()),
            Self::Box { size_m, rounding_m } => {
                let shortest = size_m.iter().copied().fold(f64::INFINITY, f64::min);
                let what = "half of the shortest edge";
                at_most(
                    &way(&shape::BOX_ROUNDING_M),
                    *rounding_m,
                    0.5 * shortest,
                    what,
                )
            }
            Self::Cylinder {
                radius_m,
                height_m,
                rounding_m,
            } => {
                let most = radius_m.min(0.5 * height_m);
                let what = "the radius and half of the height";
                at_most(&way(&shape::CYLINDER_ROUNDING_M), *rounding_m, most, what)
            }
            Self::Torus {
                radius_m,
                tube_radius_m,
            } => match tube_radius_m < radius_m {
                true => Ok(()),
                false => Err(Error::new(
                    way(&shape::TUBE_RADIUS_M),
                    found(*tube_radius_m),
                    format!("must be below `radius_m`, {}", written(*radius_m)),
                )),
            },
            Self::Dome { radius_m, height_m } => at_most(
                &way(&shape::DOME_HEIGHT_M),
                *height_m,
                *radius_m,
                "`radius_m`",
            ),
            Self::Sweep {
                size_m,
                height_m,
                rounding_m,
            } => {
                let most = height_m.min(size_m[1]);
                let what = "`height_m` and the extent along y";
                at_most(&way(&shape::SWEEP_ROUNDING_M), *rounding_m, most, what)
            }
            Self::Text { line, .. } => check_letters(&way(&shape::LINE), line),
            Self::Lathe { profile_m, .. } if profile_m.len() < 2 => {
                let found = format!("found {} points", profile_m.len());
                let right = "must be at least two";
                Err(Error::new(way(&shape::PROFILE_M), found, right))
            }
            Self::Lathe { .. } => Ok(()),
        }
    }
}

/// Radius of a sweep that leaves it out.
fn half_of_the_most(sweep: &Table) -> Result<f64, Error> {
    let height_m: f64 = sweep.value(&shape::HEIGHT_M)?;
    let [_, along_y_m]: [f64; 2] = sweep.value(&shape::PLANE_SIZE_M)?;
    Ok(0.5 * height_m.min(along_y_m))
}

/// Characters of a text.
const CHARACTERS_MOST: usize = 200;

/// Refuses a line of text that the built-in font cannot write; `key` is the way to it.
pub(super) fn check_letters(key: &str, line: &str) -> Check {
    let count = line.chars().count();
    if line.trim().is_empty() || count > CHARACTERS_MOST {
        let found = match count > CHARACTERS_MOST {
            true => format!("found {count} characters"),
            false => format!("found {line:?}"),
        };
        let right = format!("must be 1 to {CHARACTERS_MOST}, not blank");
        return Err(Error::new(key, found, right));
    }
    let missing = text::missing(line);
    if !missing.is_empty() {
        let found = format!("found {missing:?}");
        let right = "must be characters of the font, Ubuntu Light, in one line";
        return Err(Error::new(key, found, right));
    }
    Ok(())
}

fn at_most(key: &str, value: f64, most: f64, what: &str) -> Check {
    match value <= most {
        true => Ok(()),
        false => Err(Error::new(
            key,
            found(value),
            format!("must be at most {what}: {}", written(most)),
        )),
    }
}

impl Read for Shape {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let kinds: Vec<&str> = shape::SHAPE.choices.iter().map(|it| it.name).collect();
        let outer = Table::read(value, key, &kinds)?;
        let mut present = shape::SHAPE.choices.iter().filter(|it| outer.has(it.name));
        let (Some(choice), None) = (present.next(), present.next()) else {
            let found = format!("found {} shapes", outer.entries.len());
            let right = "must be one, such as `{ disk = { radius_m = 0.1 } }`";
            return Err(Error::new(key, found, right));
        };
        let value = outer.get(choice.name).expect("the kind was found just now");
        let table = Table::of_choice(choice, value, &outer.way(choice.name))?;
        Self::read_kind(choice.name, &table)
    }
}

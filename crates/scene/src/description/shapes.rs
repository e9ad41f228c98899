//! `shape` of an `[[object]]`.

use serde::Serialize;

use super::ranges::{Check, found, written};
use super::table::{Read, Table, Value};
use crate::error::Error;
use crate::schema::{Bounds, Key, shape};
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

impl Shape {
    /// Value of `shape` for it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Plane { .. } => "plane",
            Self::Disk { .. } => "disk",
            Self::Sphere { .. } => "sphere",
            Self::Box { .. } => "box",
            Self::Cylinder { .. } => "cylinder",
            Self::Torus { .. } => "torus",
            Self::Dome { .. } => "dome",
            Self::Sweep { .. } => "sweep",
            Self::Text { .. } => "text",
            Self::Lathe { .. } => "lathe",
        }
    }

    /// Refuses values out of range; `key` is the way to `shape`.
    pub(super) fn check_at(&self, key: &str) -> Check {
        let table = format!("{key}.{}", self.kind());
        let way = |key: &Key| format!("{table}.{}", key.name);
        let rounding = |key: &Key, value: f64, most: f64, what: &str| {
            key.check(&table, &value)?;
            at_most(&way(key), value, most, what)
        };
        match self {
            Self::Plane { size_m } => shape::PLANE_SIZE_M.check(&table, size_m),
            Self::Disk { radius_m } | Self::Sphere { radius_m } => {
                shape::RADIUS_M.check(&table, radius_m)
            }
            Self::Box { size_m, rounding_m } => {
                shape::BOX_SIZE_M.check(&table, size_m)?;
                let shortest = size_m.iter().copied().fold(f64::INFINITY, f64::min);
                let what = "half of the shortest edge";
                rounding(&shape::BOX_ROUNDING_M, *rounding_m, 0.5 * shortest, what)
            }
            Self::Cylinder {
                radius_m,
                height_m,
                rounding_m,
            } => {
                shape::RADIUS_M.check(&table, radius_m)?;
                shape::HEIGHT_M.check(&table, height_m)?;
                let most = radius_m.min(0.5 * height_m);
                let what = "the radius and half of the height";
                rounding(&shape::CYLINDER_ROUNDING_M, *rounding_m, most, what)
            }
            Self::Torus {
                radius_m,
                tube_radius_m,
            } => {
                shape::RING_RADIUS_M.check(&table, radius_m)?;
                shape::TUBE_RADIUS_M.check(&table, tube_radius_m)?;
                match tube_radius_m < radius_m {
                    true => Ok(()),
                    false => Err(Error::new(
                        way(&shape::TUBE_RADIUS_M),
                        found(*tube_radius_m),
                        format!("must be below `radius_m`, {}", written(*radius_m)),
                    )),
                }
            }
            Self::Dome { radius_m, height_m } => {
                shape::RADIUS_M.check(&table, radius_m)?;
                shape::DOME_HEIGHT_M.check(&table, height_m)?;
                at_most(
                    &way(&shape::DOME_HEIGHT_M),
                    *height_m,
                    *radius_m,
                    "`radius_m`",
                )
            }
            Self::Sweep {
                size_m,
                height_m,
                rounding_m,
            } => {
                shape::PLANE_SIZE_M.check(&table, size_m)?;
                shape::HEIGHT_M.check(&table, height_m)?;
                let most = height_m.min(size_m[1]);
                let what = "`height_m` and the extent along y";
                rounding(&shape::SWEEP_ROUNDING_M, *rounding_m, most, what)
            }
            Self::Text {
                line,
                height_m,
                depth_m,
            } => {
                let count = line.chars().count();
                if line.trim().is_empty() || count > CHARACTERS_MOST {
                    let found = format!("found {count} characters");
                    let right = format!("must be 1 to {CHARACTERS_MOST}, not blank");
                    return Err(Error::new(way(&shape::LINE), found, right));
                }
                let missing = text::missing(line);
                if !missing.is_empty() {
                    let found = format!("found {missing:?}");
                    let right = "must be characters of the font, Ubuntu Light, in one line";
                    return Err(Error::new(way(&shape::LINE), found, right));
                }
                shape::CAPITALS_M.check(&table, height_m)?;
                shape::DEPTH_M.check(&table, depth_m)
            }
            Self::Lathe {
                profile_m,
                segments,
                ..
            } => {
                shape::SEGMENTS.check(&table, &f64::from(*segments))?;
                let profile = way(&shape::PROFILE_M);
                if profile_m.len() < 2 {
                    let found = format!("found {} points", profile_m.len());
                    return Err(Error::new(profile, found, "must be at least two"));
                }
                let heights = shape::PROFILE_M
                    .second
                    .as_ref()
                    .map_or(Bounds::Any, |it| it.bounds);
                for (i, [r, z]) in profile_m.iter().enumerate() {
                    shape::PROFILE_M
                        .bounds
                        .check(&format!("{profile}[{i}][0]"), *r)?;
                    heights.check(&format!("{profile}[{i}][1]"), *z)?;
                }
                Ok(())
            }
        }
    }
}

/// Characters of a text.
const CHARACTERS_MOST: usize = 200;

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
        Ok(match choice.name {
            "plane" => Self::Plane {
                size_m: table.value(&shape::PLANE_SIZE_M)?,
            },
            "disk" => Self::Disk {
                radius_m: table.value(&shape::RADIUS_M)?,
            },
            "sphere" => Self::Sphere {
                radius_m: table.value(&shape::RADIUS_M)?,
            },
            "box" => Self::Box {
                size_m: table.value(&shape::BOX_SIZE_M)?,
                rounding_m: table.value(&shape::BOX_ROUNDING_M)?,
            },
            "cylinder" => Self::Cylinder {
                radius_m: table.value(&shape::RADIUS_M)?,
                height_m: table.value(&shape::HEIGHT_M)?,
                rounding_m: table.value(&shape::CYLINDER_ROUNDING_M)?,
            },
            "torus" => Self::Torus {
                radius_m: table.value(&shape::RING_RADIUS_M)?,
                tube_radius_m: table.value(&shape::TUBE_RADIUS_M)?,
            },
            "dome" => Self::Dome {
                radius_m: table.value(&shape::RADIUS_M)?,
                height_m: table.value(&shape::DOME_HEIGHT_M)?,
            },
            "sweep" => {
                let size_m: [f64; 2] = table.value(&shape::PLANE_SIZE_M)?;
                let height_m: f64 = table.value(&shape::HEIGHT_M)?;
                let half = 0.5 * height_m.min(size_m[1]);
                Self::Sweep {
                    size_m,
                    height_m,
                    rounding_m: table.or(shape::SWEEP_ROUNDING_M.name, half)?,
                }
            }
            "text" => Self::Text {
                line: table.value(&shape::LINE)?,
                height_m: table.value(&shape::CAPITALS_M)?,
                depth_m: table.value(&shape::DEPTH_M)?,
            },
            _ => Self::Lathe {
                profile_m: table.required(shape::PROFILE_M.name)?,
                segments: table.value(&shape::SEGMENTS)?,
                smooth: table.value(&shape::SMOOTH)?,
            },
        })
    }
}

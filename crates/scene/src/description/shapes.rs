//! `shape` of an `[[object]]`.

use serde::Serialize;

use super::limits;
use super::ranges::{Check, found, size, within, written};
use super::table::{Read, Table, Value};
use crate::error::Error;
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
        /// Radius of the rounded edges and corners, at most half of the shortest edge. Default: 0, sharp.
        rounding_m: f64,
    },
    /// A cylinder about the z axis with its middle in the origin, closed at both ends.
    Cylinder {
        /// Required.
        radius_m: f64,
        /// Height from end to end. Required.
        height_m: f64,
        /// Radius of the rounded rims, at most the cylinder's radius and half of its height. Default: 0, sharp.
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
        /// Radius of the turn between them, at most `height_m` and the floor's extent along y. Default: half of the smaller of these.
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
        /// Facets around, from 3 to 4096. Default: 256.
        segments: u32,
        /// Whether the profile is rounded where it bends by less than 40 degrees; sharper corners stay. Default: true.
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
        let way = |name: &str| format!("{key}.{}.{name}", self.kind());
        let sized = |name: &str, value: f64| size(&way(name), value);
        let edges = |edges: &[f64]| {
            edges
                .iter()
                .enumerate()
                .try_for_each(|(i, &edge)| sized(&format!("size_m[{i}]"), edge))
        };
        let rounding = |value: f64, most: f64, what: &str| {
            let key = way("rounding_m");
            within(&key, value, limits::ROUNDING_M)?;
            at_most(&key, value, most, what)
        };
        match self {
            Self::Plane { size_m } => edges(size_m),
            Self::Disk { radius_m } | Self::Sphere { radius_m } => sized("radius_m", *radius_m),
            Self::Box { size_m, rounding_m } => {
                edges(size_m)?;
                let shortest = size_m.iter().copied().fold(f64::INFINITY, f64::min);
                rounding(*rounding_m, 0.5 * shortest, "half of the shortest edge")
            }
            Self::Cylinder {
                radius_m,
                height_m,
                rounding_m,
            } => {
                sized("radius_m", *radius_m)?;
                sized("height_m", *height_m)?;
                let most = radius_m.min(0.5 * height_m);
                rounding(*rounding_m, most, "the radius and half of the height")
            }
            Self::Torus {
                radius_m,
                tube_radius_m,
            } => {
                sized("radius_m", *radius_m)?;
                sized("tube_radius_m", *tube_radius_m)?;
                match tube_radius_m < radius_m {
                    true => Ok(()),
                    false => Err(Error::new(
                        way("tube_radius_m"),
                        found(*tube_radius_m),
                        format!("must be below `radius_m`, {}", written(*radius_m)),
                    )),
                }
            }
            Self::Dome { radius_m, height_m } => {
                sized("radius_m", *radius_m)?;
                sized("height_m", *height_m)?;
                at_most(&way("height_m"), *height_m, *radius_m, "`radius_m`")
            }
            Self::Sweep {
                size_m,
                height_m,
                rounding_m,
            } => {
                edges(size_m)?;
                sized("height_m", *height_m)?;
                let most = height_m.min(size_m[1]);
                rounding(*rounding_m, most, "`height_m` and the extent along y")
            }
            Self::Text {
                line,
                height_m,
                depth_m,
            } => {
                let key = way("line");
                let count = line.chars().count();
                if line.trim().is_empty() || count > limits::TEXT_MOST {
                    let found = format!("found {count} characters");
                    let right = format!("must be 1 to {}, not blank", limits::TEXT_MOST);
                    return Err(Error::new(key, found, right));
                }
                let missing = text::missing(line);
                if !missing.is_empty() {
                    let found = format!("found {missing:?}");
                    let right = "must be characters of the font, Ubuntu Light, in one line";
                    return Err(Error::new(key, found, right));
                }
                sized("height_m", *height_m)?;
                sized("depth_m", *depth_m)
            }
            Self::Lathe {
                profile_m,
                segments,
                ..
            } => {
                within(&way("segments"), (*segments).into(), limits::LATHE_SEGMENTS)?;
                let profile = way("profile_m");
                if profile_m.len() < 2 {
                    let found = format!("found {} points", profile_m.len());
                    return Err(Error::new(profile, found, "must be at least two"));
                }
                for (i, [r, z]) in profile_m.iter().enumerate() {
                    within(&format!("{profile}[{i}][0]"), *r, limits::PROFILE_RADIUS_M)?;
                    within(&format!("{profile}[{i}][1]"), *z, limits::COORDINATE_M)?;
                }
                Ok(())
            }
        }
    }
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
        const KINDS: [&str; 10] = [
            "plane", "disk", "sphere", "box", "cylinder", "torus", "dome", "sweep", "text", "lathe",
        ];
        let outer = Table::read(value, key, &KINDS)?;
        let mut present = KINDS.iter().filter(|kind| outer.get(kind).is_some());
        let (Some(kind), None) = (present.next(), present.next()) else {
            let found = format!("found {} shapes", outer.entries.len());
            let right = "must be one, such as `{ disk = { radius_m = 0.1 } }`";
            return Err(Error::new(key, found, right));
        };
        let inner = |keys| {
            let value = outer.get(kind).expect("the kind was found just now");
            Table::read(value, &outer.way(kind), keys)
        };
        Ok(match *kind {
            "plane" => Self::Plane {
                size_m: inner(&["size_m"])?.required("size_m")?,
            },
            "disk" => Self::Disk {
                radius_m: inner(&["radius_m"])?.required("radius_m")?,
            },
            "sphere" => Self::Sphere {
                radius_m: inner(&["radius_m"])?.required("radius_m")?,
            },
            "box" => {
                let table = inner(&["size_m", "rounding_m"])?;
                Self::Box {
                    size_m: table.required("size_m")?,
                    rounding_m: table.or("rounding_m", 0.0)?,
                }
            }
            "cylinder" => {
                let table = inner(&["radius_m", "height_m", "rounding_m"])?;
                Self::Cylinder {
                    radius_m: table.required("radius_m")?,
                    height_m: table.required("height_m")?,
                    rounding_m: table.or("rounding_m", 0.0)?,
                }
            }
            "torus" => {
                let table = inner(&["radius_m", "tube_radius_m"])?;
                Self::Torus {
                    radius_m: table.required("radius_m")?,
                    tube_radius_m: table.required("tube_radius_m")?,
                }
            }
            "dome" => {
                let table = inner(&["radius_m", "height_m"])?;
                Self::Dome {
                    radius_m: table.required("radius_m")?,
                    height_m: table.required("height_m")?,
                }
            }
            "sweep" => {
                let table = inner(&["size_m", "height_m", "rounding_m"])?;
                let size_m: [f64; 2] = table.required("size_m")?;
                let height_m: f64 = table.required("height_m")?;
                Self::Sweep {
                    size_m,
                    height_m,
                    rounding_m: table.or("rounding_m", 0.5 * height_m.min(size_m[1]))?,
                }
            }
            "text" => {
                let table = inner(&["line", "height_m", "depth_m"])?;
                Self::Text {
                    line: table.required("line")?,
                    height_m: table.required("height_m")?,
                    depth_m: table.required("depth_m")?,
                }
            }
            _ => {
                let table = inner(&["profile_m", "segments", "smooth"])?;
                Self::Lathe {
                    profile_m: table.required("profile_m")?,
                    segments: table.or("segments", 256)?,
                    smooth: table.or("smooth", true)?,
                }
            }
        })
    }
}

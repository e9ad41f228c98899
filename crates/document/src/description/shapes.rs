//! `shape` of an `[[object]]`.

use hairline_keys::Keyed;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::key_value::KeyValue;
use super::keyed::{Inner, Keyed, Kinds};
use super::ranges::{Check, Numbers, found, written};
use super::table::Table;
use super::toml_value::{Read, Value};
use crate::error::Error;
use crate::schema::KindKeys;
use crate::schema::key::{Form, Initial, Key, LARGEST_M, linear, log};
use crate::shape::text;

/// A built-in shape about the origin, z up. Each is a table of its own: `shape = { disk = { radius_m = 0.1 } }`.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(tag = "", check = Shape::check_proportions)]
pub enum Shape {
    /// A rectangle in the xy plane that faces +z.
    #[kind("plane")]
    Plane {
        /// Its edges along x and y.
        #[key(PLANE_SIZE_M: like(&EDGE))]
        size_m: [f64; 2],
    },
    /// A disk in the xy plane that faces +z.
    #[kind("disk")]
    Disk {
        /// Its radius.
        #[key(like(&RADIUS))]
        radius_m: f64,
    },
    /// A sphere.
    #[kind("sphere")]
    Sphere {
        /// As of a disk.
        radius_m: f64,
    },
    /// A box about the origin.
    #[kind("box")]
    Box {
        /// Its edges along x, y and z.
        #[key(BOX_SIZE_M: like(&EDGE))]
        size_m: [f64; 3],
        /// Radius of its edges and corners. Each side has the whole texture.
        #[key(BOX_ROUNDING_M: like(&ROUNDING).number(0.0).range_words("0 to half of the shortest edge"))]
        rounding_m: f64,
    },
    /// Closed, about the origin and the z axis.
    #[kind("cylinder")]
    Cylinder {
        /// As of a disk.
        radius_m: f64,
        /// From its lower to its upper end.
        #[key(like(&HEIGHT))]
        height_m: f64,
        /// Radius of its rims.
        #[key(CYLINDER_ROUNDING_M: like(&ROUNDING).number(0.0).range_words("0 to the radius and half of the height"))]
        rounding_m: f64,
    },
    /// A ring about z.
    #[kind("torus")]
    Torus {
        /// From the axis to the middle of the tube.
        #[key(RING_RADIUS_M: like(&RADIUS))]
        radius_m: f64,
        /// The radius of the tube.
        #[key(unit("m").size().range_words("1e-5 to below `radius_m`")
            .control("Tube radius", log(0.01, 1.0).sized(), "Half the thickness of the ring, below its radius. A thin tube draws highlights out to fine lines."))]
        tube_radius_m: f64,
    },
    /// A watch glass: the part of a sphere over its rim, which lies in the xy plane. Open below.
    #[kind("dome")]
    Dome {
        /// As of a disk: that of the rim.
        radius_m: f64,
        /// The height of the top over the rim.
        #[key(DOME_HEIGHT_M: like(&HEIGHT).range_words("1e-5 to `radius_m`"))]
        height_m: f64,
    },
    /// A studio's floor, about the origin, which turns up into a wall at its +y end.
    #[kind("sweep")]
    Sweep {
        /// As of a plane.
        #[key(= Self::PLANE_SIZE_M)]
        size_m: [f64; 2],
        /// As of a cylinder.
        height_m: f64,
        /// Radius of the turn.
        #[key(SWEEP_ROUNDING_M: like(&ROUNDING).words("half of the most").range_words("0 to the height and the floor's extent along y"))]
        #[read(half_of_the_most)]
        rounding_m: f64,
    },
    /// Letters that stand on the xy plane, read from +z: a logo. Its middle is over the origin.
    #[kind("text")]
    Text {
        /// The letters. The font is built in, Ubuntu Light: Latin, Greek, Cyrillic.
        #[key(range_words("1 to 200 characters").labelled("Text", "What it says: Latin, Greek or Cyrillic letters."))]
        line: String,
        /// The height of capitals, along y.
        #[key(CAPITALS_M: like(&HEIGHT))]
        height_m: f64,
        /// The depth of all letters, along z.
        #[key(unit("m").size()
            .control("Depth", log(0.01, 1.0).sized(), "How far the letters stand out of what they stand on."))]
        depth_m: f64,
    },
    /// A profile turned about the z axis: a plate, a pan, a ring.
    // The surface faces to the left of the way along the profile, r to the right and z up: a plate's upper side runs from the axis outwards, a cup's
    // outside runs downwards. A profile that ends where it starts is closed, as for a ring.
    #[kind("lathe")]
    Lathe {
        /// The profile that is turned.
        #[key(unit("m").in_range(0.0, LARGEST_M).range_words("two or more points `[r, z]`, r from 0 to 1000")
            .control("Radius", linear(0.0, 1.0).sized(), "Distance of this point of the outline from the axis. Steps and bends of the outline show as rings of highlight.")
            .second("Height", linear(-1.0, 1.0).sized(), Bounds::Within(-LARGEST_M, LARGEST_M), "m", "Height of this point of the outline along the axis."))]
        profile_m: Vec<[f64; 2]>,
        /// Facets around.
        #[key(number(256.0).in_range(3.0, 4096.0)
            .control("Segments", linear(16.0, 512.0), "Facets around the axis. More: a rounder outline and smoother highlights, and a little more work."))]
        segments: u32,
        /// Rounds the profile where it bends by less than 40 degrees; sharper corners stay.
        #[key(flag(true).labelled("Smooth", "Whether the profile is rounded where it bends gently."))]
        smooth: bool,
    },
}

const EDGE: Key = Key::new("size_m", Form::Numbers(3))
    .unit("m")
    .size()
    .control("Edge", log(0.05, 5.0).sized(), "Length of an edge. With a count, the same scratches spread over more surface; with a density, there are more of them.");

const RADIUS: Key = Key::new("radius_m", Form::Number)
    .unit("m")
    .size()
    .control("Radius", log(0.05, 5.0).sized(), "Half its width. With a count, the same scratches spread over more surface; with a density, there are more of them.");

const HEIGHT: Key = Key::new("height_m", Form::Number).unit("m").size().control(
    "Height",
    log(0.05, 5.0).sized(),
    "From its lower to its upper end.",
);

const ROUNDING: Key = Key::new("rounding_m", Form::Number)
    .unit("m")
    .in_range(0.0, LARGEST_M)
    .control("Rounding", linear(0.0, 0.5).sized(), "Radius of its edges. Rounded edges catch a line of light from almost everywhere; 0 leaves them sharp and dark.");

impl Shape {
    /// Each is a table of its own.
    pub(crate) const KINDS: KindKeys = KindKeys {
        tag: Self::TAG,
        choices: Self::CHOICES,
        of_table: &[],
    };

    /// A number that others of the shape bound: its key, its value, its most, and that in words.
    fn bounded(&mut self) -> Option<(&'static Key, &mut f64, f64, &'static str)> {
        Some(match self {
            Self::Box { size_m, rounding_m } => {
                let shortest = size_m.iter().copied().fold(f64::INFINITY, f64::min);
                let words = "half of the shortest edge";
                (Self::BOX_ROUNDING_M, rounding_m, 0.5 * shortest, words)
            }
            Self::Cylinder {
                radius_m,
                height_m,
                rounding_m,
            } => {
                let most = radius_m.min(0.5 * *height_m);
                let words = "the radius and half of the height";
                (Self::CYLINDER_ROUNDING_M, rounding_m, most, words)
            }
            Self::Torus {
                radius_m,
                tube_radius_m,
            } => {
                let most = radius_m.next_down();
                (Self::TUBE_RADIUS_M, tube_radius_m, most, "`radius_m`")
            }
            Self::Dome { radius_m, height_m } => {
                (Self::DOME_HEIGHT_M, height_m, *radius_m, "`radius_m`")
            }
            Self::Sweep {
                size_m,
                height_m,
                rounding_m,
            } => {
                let most = height_m.min(size_m[1]);
                let words = "`height_m` and the extent along y";
                (Self::SWEEP_ROUNDING_M, rounding_m, most, words)
            }
            _ => return None,
        })
    }

    /// Makes the number smaller that others of the shape bound. A torus keeps a hole.
    pub fn keep_proportions(&mut self) {
        let share = match self {
            Self::Torus { .. } => 0.999,
            _ => 1.0,
        };
        if let Some((_, value, most, _)) = self.bounded() {
            *value = value.min(share * most);
        }
    }

    /// Refuses shapes that cannot be; `table` is the path of their keys.
    fn check_proportions(&self, table: &str) -> Check {
        let key_path = |key: &Key| format!("{table}.{}", key.name);
        if let Some((key, value, most, words)) = self.clone().bounded()
            && *value > most
        {
            let right = match self {
                Self::Torus { radius_m, .. } => {
                    format!("must be below {words}, {}", written(*radius_m))
                }
                _ => format!("must be at most {words}: {}", written(most)),
            };
            return Err(Error::new(key_path(key), found(*value), right));
        }
        match self {
            Self::Text { line, .. } => check_letters(&key_path(Self::LINE), line),
            Self::Lathe { profile_m, .. } if profile_m.len() < 2 => {
                let found = format!("found {} points", profile_m.len());
                let right = "must be at least two";
                Err(Error::new(key_path(Self::PROFILE_M), found, right))
            }
            _ => Ok(()),
        }
    }
}

/// Radius of a sweep that leaves it out.
fn half_of_the_most(sweep: &Table) -> Result<f64, Error> {
    let height_m: f64 = sweep.value(Shape::HEIGHT_M)?;
    let [_, along_y_m]: [f64; 2] = sweep.value(Shape::PLANE_SIZE_M)?;
    sweep.or(Shape::SWEEP_ROUNDING_M.name, 0.5 * height_m.min(along_y_m))
}

/// Characters of a text.
const CHARACTERS_MOST: usize = 200;

/// Refuses a line of text that the built-in font cannot write; `key` is its path.
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

impl Read for Shape {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let kinds: Vec<&str> = Self::CHOICES.iter().map(|choice| choice.name).collect();
        let outer = Table::read(value, key, &kinds)?;
        let mut present = Self::CHOICES.iter().filter(|choice| outer.has(choice.name));
        let (Some(choice), None) = (present.next(), present.next()) else {
            let found = format!("found {} shapes", outer.entries.len());
            let right = "must be one, such as `{ disk = { radius_m = 0.1 } }`";
            return Err(Error::new(key, found, right));
        };
        let value = outer.get(choice.name).expect("the kind was found just now");
        let table = Table::read_entries(choice.entries, value, &outer.key_path(choice.name))?;
        Self::read_keys(&table.with_kind(choice.name))
    }
}

impl Numbers for Shape {}

impl KeyValue for Shape {
    const FORM: Form = Form::Table;

    fn initial(_: Initial) -> Option<Self> {
        None
    }

    fn check_at(&self, _: &Key, key_path: &str) -> Check {
        self.check_keys(&format!("{key_path}.{}", self.name()))
    }

    fn written(&self) -> impl Serialize {
        self
    }
}

impl Serialize for Shape {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(self.name(), &Inner(self))?;
        map.end()
    }
}

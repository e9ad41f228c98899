//! From parsed TOML to a [`Description`]: keys, types, defaults. Ranges are left to `check`.

use std::path::PathBuf;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::hint;
use super::{
    Amount, Around, Camera, Description, Distribution, Environment, Laid, Layer, Light, LightKind,
    Listed, Material, MaterialKind, MetalColor, Named, Object, Pattern, Render, Scratches, Shape,
    Surface,
};
use crate::error::Error;

type Value<'a> = Spanned<DeValue<'a>>;

/// Something that a scene file can hold as a value.
trait Read: Sized {
    /// `key` is the way to the value, for errors.
    fn read(value: &Value, key: &str) -> Result<Self, Error>;
}

/// Reads a whole scene file.
pub(super) fn description(root: &DeTable) -> Result<Description, Error> {
    let table = Table::open(
        root,
        "",
        &[
            "camera",
            "render",
            "environment",
            "material",
            "object",
            "scratches",
            "light",
        ],
    )?;
    Ok(Description {
        camera: table.required("camera")?,
        render: table.or("render", Render::default())?,
        environment: table.optional("environment")?,
        materials: table.or("material", Vec::new())?,
        objects: table.or("object", Vec::new())?,
        scratches: table.or("scratches", Vec::new())?,
        lights: table.or("light", Vec::new())?,
    })
}

impl Read for Camera {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read(
            value,
            key,
            &["position_m", "target_m", "up", "fov_y_deg", "exposure_ev"],
        )?;
        Ok(Self {
            position_m: table.required("position_m")?,
            target_m: table.required("target_m")?,
            up: table.or("up", [0.0, 1.0, 0.0])?,
            fov_y_deg: table.or("fov_y_deg", 30.0)?,
            exposure_ev: table.or("exposure_ev", 0.0)?,
        })
    }
}

impl Read for Render {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read(value, key, &["size_px", "filter_std_px", "tone_map"])?;
        let default = Self::default();
        Ok(Self {
            size_px: table.or("size_px", default.size_px)?,
            filter_std_px: table.or("filter_std_px", default.filter_std_px)?,
            tone_map: table.or("tone_map", default.tone_map)?,
        })
    }
}

impl Read for Environment {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read(
            value,
            key,
            &["file", "rotation_deg", "intensity", "visible"],
        )?;
        Ok(Self {
            file: table.required("file")?,
            rotation_deg: table.or("rotation_deg", 0.0)?,
            intensity: table.or("intensity", 1.0)?,
            visible: table.or("visible", true)?,
        })
    }
}

impl Read for Material {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        const SHARED: [&str; 4] = ["name", "kind", "roughness", "coherence_um"];
        let (kind, table) = Table::read_kind(
            value,
            key,
            "kind",
            &SHARED,
            &[
                ("metal", &["metal", "base_color"]),
                ("dielectric", &["ior", "base_color"]),
                ("metallic-roughness", &["base_color", "metallic"]),
                ("mirror", &[]),
            ],
        )?;
        let kind = match kind {
            "metal" => MaterialKind::Metal(match table.either("metal", "base_color")? {
                "metal" => MetalColor::Measured(table.required("metal")?),
                _ => MetalColor::Color(table.required("base_color")?),
            }),
            "dielectric" => MaterialKind::Dielectric {
                ior: table.or("ior", 1.5)?,
                base_color: table.or("base_color", [0.5; 3])?,
            },
            "metallic-roughness" => MaterialKind::MetallicRoughness {
                base_color: table.or("base_color", [1.0; 3])?,
                metallic: table.or("metallic", 1.0)?,
            },
            _ => MaterialKind::Mirror,
        };
        Ok(Self {
            name: table.required("name")?,
            kind,
            roughness: table.or("roughness", 0.1)?,
            coherence_um: table.or("coherence_um", super::DEFAULT_COHERENCE_UM)?,
        })
    }
}

impl Read for Object {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read(
            value,
            key,
            &[
                "name",
                "shape",
                "mesh",
                "material",
                "translation_m",
                "rotation_deg",
                "scale",
            ],
        )?;
        let name = table.required("name")?;
        let surface = match table.either("shape", "mesh")? {
            "shape" => Surface::Shape(table.required("shape")?),
            _ => Surface::Mesh(table.required("mesh")?),
        };
        let ScaleFactors(scale) = table.or("scale", ScaleFactors([1.0; 3]))?;
        Ok(Self {
            name,
            surface,
            material: table.optional("material")?,
            translation_m: table.or("translation_m", [0.0; 3])?,
            rotation_deg: table.or("rotation_deg", [0.0; 3])?,
            scale,
        })
    }
}

/// One number or three.
struct ScaleFactors([f64; 3]);

impl Read for ScaleFactors {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Array(_) => Read::read(value, key).map(Self),
            _ => f64::read(value, key).map(|factor| Self([factor; 3])),
        }
    }
}

impl Read for Shape {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        const KINDS: [&str; 4] = ["plane", "disk", "sphere", "lathe"];
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
            _ => {
                let lathe = inner(&["profile_m", "segments", "smooth"])?;
                Self::Lathe {
                    profile_m: lathe.required("profile_m")?,
                    segments: lathe.or("segments", 256)?,
                    smooth: lathe.or("smooth", true)?,
                }
            }
        })
    }
}

impl Read for Scratches {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        const AROUND: [&str; 3] = ["axis", "center_m", "jitter_deg"];
        const LAID: [&str; 6] = [
            "count",
            "density_per_m2",
            "seed",
            "length_m",
            "width_um",
            "depth_nm",
        ];
        let with = |own: &[&'static str]| [&LAID[..], own].concat();
        let (pattern, table) = Table::read_kind(
            value,
            key,
            "pattern",
            &["object", "pattern"],
            &[
                ("random", &with(&["curvature_per_m"])),
                ("parallel", &with(&["direction", "jitter_deg"])),
                ("circular", &with(&AROUND)),
                ("radial", &with(&AROUND)),
                ("spun", &with(&[&AROUND[..], &["curvature_per_m"]].concat())),
                ("swirl", &with(&["curvature_per_m"])),
                ("file", &["file"]),
            ],
        )?;
        let object = table.required("object")?;
        if pattern == "file" {
            let file = table.required("file")?;
            return Ok(Self {
                object,
                layer: Layer::Listed(Listed { file }),
            });
        }
        let around = || -> Result<Around, Error> {
            let default = Around::default();
            Ok(Around {
                axis: table.or("axis", default.axis)?,
                center_m: table.or("center_m", default.center_m)?,
                jitter_deg: table.or("jitter_deg", default.jitter_deg)?,
            })
        };
        let curvature_per_m =
            |mean, spread| table.or("curvature_per_m", Distribution { mean, spread });
        let pattern = match pattern {
            "random" => Pattern::Random {
                curvature_per_m: curvature_per_m(0.0, 0.0)?,
            },
            "parallel" => Pattern::Parallel {
                direction: table.or("direction", [1.0, 0.0, 0.0])?,
                jitter_deg: table.or("jitter_deg", 0.0)?,
            },
            "circular" => Pattern::Circular(around()?),
            "radial" => Pattern::Radial(around()?),
            "spun" => Pattern::Spun {
                around: around()?,
                curvature_per_m: curvature_per_m(20.0, 0.0)?,
            },
            _ => Pattern::Swirl {
                curvature_per_m: curvature_per_m(25.0, 8.0)?,
            },
        };
        let amount = match table.either("count", "density_per_m2")? {
            "count" => Amount::Count(table.required("count")?),
            _ => Amount::DensityPerM2(table.required("density_per_m2")?),
        };
        let drawn = |key, mean, spread| table.or(key, Distribution { mean, spread });
        Ok(Self {
            object,
            layer: Layer::Laid(Laid {
                pattern,
                amount,
                seed: table.or("seed", 1)?,
                length_m: drawn("length_m", 0.02, 0.5)?,
                width_um: drawn("width_um", 1.5, 0.3)?,
                depth_nm: drawn("depth_nm", 200.0, 0.2)?,
            }),
        })
    }
}

impl Read for Distribution {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Table(_) => {
                let table = Table::read(value, key, &["mean", "spread"])?;
                Ok(Self {
                    mean: table.required("mean")?,
                    spread: table.or("spread", 0.0)?,
                })
            }
            other => match number(other) {
                Some(mean) => Ok(Self { mean, spread: 0.0 }),
                None => Err(wrong_type(
                    value,
                    key,
                    "a number, or `{ mean = .., spread = .. }`",
                )),
            },
        }
    }
}

impl Read for Light {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let (kind, table) = Table::read_kind(
            value,
            key,
            "kind",
            &["kind", "radiance", "color"],
            &[
                ("sphere", &["center_m", "radius_m"]),
                ("polygon", &["vertices_m", "two_sided"]),
            ],
        )?;
        let kind = match kind {
            "sphere" => LightKind::Sphere {
                center_m: table.required("center_m")?,
                radius_m: table.required("radius_m")?,
            },
            _ => LightKind::Polygon {
                vertices_m: table.required("vertices_m")?,
                two_sided: table.or("two_sided", false)?,
            },
        };
        Ok(Self {
            kind,
            radiance: table.or("radiance", 1.0)?,
            color: table.or("color", [1.0; 3])?,
        })
    }
}

/// A table all of whose keys are known.
struct Table<'a> {
    entries: &'a DeTable<'a>,
    key: String,
    known: Vec<&'a str>,
}

impl<'a> Table<'a> {
    fn open(entries: &'a DeTable<'a>, key: &str, known: &[&'a str]) -> Result<Self, Error> {
        let table = Self {
            entries,
            key: key.to_owned(),
            known: known.to_vec(),
        };
        for (name, value) in entries {
            let name = name.get_ref().as_ref();
            if !known.contains(&name) {
                let right = hint::instead_of_key(name, number(value.get_ref()), known);
                return Err(Error::new(table.way(name), "unknown key", right));
            }
        }
        Ok(table)
    }

    fn read(value: &'a Value<'a>, key: &str, known: &[&'a str]) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Table(entries) => Self::open(entries, key, known),
            _ => Err(wrong_type(value, key, "a table")),
        }
    }

    /// A table in which the value of `tag` decides what other keys belong to it, besides the `shared` ones.
    fn read_kind(
        value: &'a Value<'a>,
        key: &str,
        tag: &'static str,
        shared: &[&'a str],
        kinds: &[(&'static str, &[&'a str])],
    ) -> Result<(&'static str, Self), Error> {
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(wrong_type(value, key, "a table"));
        };
        let unchecked = Self {
            entries,
            key: key.to_owned(),
            known: vec![tag],
        };
        let Some(tag_value) = unchecked.get(tag) else {
            let names = hint::list(kinds.iter().map(|(name, _)| *name));
            return Err(Error::new(
                key,
                format!("`{tag}` is missing"),
                format!("must be one of {names}"),
            ));
        };
        let names: Vec<_> = kinds.iter().map(|(name, _)| (*name, *name)).collect();
        let kind = one_of(tag_value, &unchecked.way(tag), &names)?;
        let own = kinds.iter().find(|(name, _)| *name == kind);
        let known = [shared, own.map_or(&[], |(_, own)| *own)].concat();
        for name in entries.keys().map(|name| name.get_ref().as_ref()) {
            let owners = kinds.iter().filter(|(_, keys)| keys.contains(&name));
            let owners: Vec<_> = owners.map(|(owner, _)| *owner).collect();
            if !known.contains(&name) && !owners.is_empty() {
                return Err(Error::new(
                    unchecked.way(name),
                    format!("{tag} `{kind}` has no such key"),
                    format!("it belongs to {}", hint::list(owners)),
                ));
            }
        }
        Ok((kind, Self::open(entries, key, &known)?))
    }

    fn get(&self, name: &str) -> Option<&'a Value<'a>> {
        debug_assert!(self.known.contains(&name), "{name} is read but not known");
        self.entries.get(name)
    }

    fn way(&self, name: &str) -> String {
        match self.key.as_str() {
            "" => name.to_owned(),
            key => format!("{key}.{name}"),
        }
    }

    fn optional<T: Read>(&self, name: &str) -> Result<Option<T>, Error> {
        self.get(name)
            .map(|value| T::read(value, &self.way(name)))
            .transpose()
    }

    fn or<T: Read>(&self, name: &str, default: T) -> Result<T, Error> {
        Ok(self.optional(name)?.unwrap_or(default))
    }

    fn required<T: Read>(&self, name: &str) -> Result<T, Error> {
        self.optional(name)?.ok_or_else(|| {
            let place = match self.key.as_str() {
                "" => "the scene".to_owned(),
                key => format!("`{key}`"),
            };
            Error::new(
                &self.key,
                format!("`{name}` is missing"),
                format!("{place} needs it"),
            )
        })
    }

    /// Which of two keys that exclude each other is there.
    fn either(&self, a: &'static str, b: &'static str) -> Result<&'static str, Error> {
        match (self.get(a), self.get(b)) {
            (Some(_), None) => Ok(a),
            (None, Some(_)) => Ok(b),
            (found, _) => {
                let found = match found {
                    Some(_) => format!("found both `{a}` and `{b}`"),
                    None => format!("found neither `{a}` nor `{b}`"),
                };
                Err(Error::new(
                    &self.key,
                    found,
                    "must have exactly one of them",
                ))
            }
        }
    }
}

impl Read for f64 {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        number(value.get_ref()).ok_or_else(|| wrong_type(value, key, &a_number(key)))
    }
}

impl Read for u64 {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let integer = match value.get_ref() {
            // TOML promises 64 bits with a sign.
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok(),
            _ => None,
        };
        integer
            .and_then(|i| Self::try_from(i).ok())
            .ok_or_else(|| wrong_type(value, key, "a whole number from 0 to 2^63 - 1"))
    }
}

impl Read for u32 {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let integer = u64::read(value, key)?;
        u32::try_from(integer).map_err(|_| wrong_type(value, key, "a number below 2^32"))
    }
}

impl Read for bool {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Boolean(boolean) => Ok(*boolean),
            _ => Err(wrong_type(value, key, "`true` or `false`")),
        }
    }
}

impl Read for String {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::String(text) => Ok(text.clone().into_owned()),
            _ => Err(wrong_type(value, key, "a text in quotes")),
        }
    }
}

impl Read for PathBuf {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        String::read(value, key).map(Self::from)
    }
}

impl<T: Named> Read for T {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        one_of(value, key, T::NAMES)
    }
}

impl<T: Read + Default + Copy, const N: usize> Read for [T; N] {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let mut result = [T::default(); N];
        match value.get_ref() {
            DeValue::Array(array) if array.len() == N => {
                for (i, element) in array.iter().enumerate() {
                    result[i] = T::read(element, &format!("{key}[{i}]"))?;
                }
                Ok(result)
            }
            _ => Err(wrong_type(value, key, &format!("an array of {N} numbers"))),
        }
    }
}

impl<T: Read> Read for Vec<T> {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        match value.get_ref() {
            DeValue::Array(array) => array
                .iter()
                .enumerate()
                .map(|(i, element)| T::read(element, &format!("{key}[{i}]")))
                .collect(),
            // `[light]` where `[[light]]` was meant.
            DeValue::Table(_) if !key.contains('.') => Err(wrong_type(
                value,
                key,
                &format!("written `[[{key}]]`, since there may be several"),
            )),
            _ => Err(wrong_type(value, key, "an array")),
        }
    }
}

fn one_of<T: Copy>(value: &Value, key: &str, names: &[(&'static str, T)]) -> Result<T, Error> {
    let all = || names.iter().map(|(name, _)| *name);
    let DeValue::String(text) = value.get_ref() else {
        let right = format!("one of the texts {}", hint::list(all()));
        return Err(wrong_type(value, key, &right));
    };
    if let Some((_, named)) = names.iter().find(|(name, _)| name == text) {
        return Ok(*named);
    }
    let right = match hint::nearest(text, all()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("must be one of {}", hint::list(all())),
    };
    Err(Error::new(key, describe(value), right))
}

/// Integers are numbers too. `None` for anything else, and for numbers beyond the range of f64.
fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix())
            .ok()
            .map(|i| i as f64),
        DeValue::Float(f) => f.as_str().parse().ok(),
        _ => None,
    }
}

/// "a number", with the unit that the key promises.
fn a_number(key: &str) -> String {
    const UNITS: [(&str, &str); 9] = [
        ("_per_m2", "per square metre"),
        ("_per_m", "per metre"),
        ("_um", "micrometres"),
        ("_nm", "nanometres"),
        ("_m", "metres"),
        ("_deg", "degrees"),
        ("_px", "pixels"),
        ("_ev", "stops"),
        ("radiance", "W sr^-1 m^-2"),
    ];
    let name = key.rsplit('.').next().unwrap_or(key);
    let name = name.split('[').next().unwrap_or(name);
    match UNITS.iter().find(|(suffix, _)| name.ends_with(suffix)) {
        Some((_, unit)) => format!("a number ({unit})"),
        None => "a number".to_owned(),
    }
}

fn wrong_type(value: &Value, key: &str, right: &str) -> Error {
    Error::new(key, describe(value), format!("must be {right}"))
}

fn describe(value: &Value) -> String {
    match value.get_ref() {
        DeValue::String(text) => format!("found the text \"{}\"", shortened(text)),
        DeValue::Integer(i) => format!("found the whole number {i}"),
        DeValue::Float(f) => format!("found the number {f}"),
        DeValue::Boolean(boolean) => format!("found `{boolean}`"),
        DeValue::Datetime(date) => format!("found the date {date}"),
        DeValue::Array(array) => format!("found an array of {}", array.len()),
        DeValue::Table(_) => "found a table".to_owned(),
    }
}

fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}..", &text[..end]),
        None => text.to_owned(),
    }
}

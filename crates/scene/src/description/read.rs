//! Reads parsed TOML to a [`Description`]: keys, types, defaults. Ranges are left to `check`.

use toml::de::{DeTable, DeValue};

use super::lens;
use super::sizes;
use super::table::{Read, Table, Value, number, wrong_type};
use super::{
    Amount, Around, Brush, Brushed, Camera, Description, Distribution, Environment, Laid, Layer,
    LayerPlaces, Listed, Map, Material, MaterialKind, MetalColor, Object, Pattern, Render,
    Scratches, Stroke, Studio, Surface, Up,
};
use crate::error::Error;
use crate::scene::{Anisotropy, Coat, Specular};

/// Reads a whole scene file.
pub(super) fn description(root: &DeTable) -> Result<Description, Error> {
    let table = Table::open(
        root,
        "",
        &[
            "camera",
            "render",
            "environment",
            "studio",
            "ground",
            "material",
            "object",
            "scratches",
            "grating",
            "light",
        ],
    )?;
    let mut description = Description {
        camera: table.required("camera")?,
        render: table.or("render", Render::default())?,
        environment: table.optional("environment")?,
        studio: table.or("studio", Studio::NONE)?,
        ground: table.optional("ground")?,
        materials: table.or("material", Vec::new())?,
        objects: table.or("object", Vec::new())?,
        scratches: table.or("scratches", Vec::new())?,
        gratings: table.or("grating", Vec::new())?,
        lights: table.or("light", Vec::new())?,
        lights_of: None,
        notes: Vec::new(),
    };
    // A lens sees by the picture's shape.
    if let Some(camera) = table.get("camera") {
        let camera = Table::read(camera, "camera", &CAMERA_KEYS)?;
        if let Some(fov_y_deg) = lens::fov_y_deg(&camera, description.render.size_px)? {
            description.camera.fov_y_deg = fov_y_deg;
        }
    }
    if !description.is_lit() && !table.has("studio") {
        description.studio = Studio::default();
        description.ground.get_or_insert_default();
    }
    Ok(description)
}

/// Keys of earlier versions that are there, and why they have no effect.
pub(super) fn keys_without_effect(
    root: &DeTable,
) -> impl Iterator<Item = (&'static str, &'static str)> {
    let render = root.get("render").map(|value| value.get_ref());
    let gather = match render {
        Some(DeValue::Table(render)) => render.get("gather"),
        _ => None,
    };
    let why = "this key has no effect any more; every scratch counts for itself";
    gather.map(|_| ("render.gather", why)).into_iter()
}

const CAMERA_KEYS: [&str; 13] = [
    "of_file",
    "position_m",
    "target_m",
    "up",
    "fov_y_deg",
    "exposure_ev",
    lens::KEYS[0],
    lens::KEYS[1],
    lens::KEYS[2],
    "aperture_mm",
    "focus_distance_m",
    "shift",
    "world_up",
];

impl Read for Camera {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read(value, key, &CAMERA_KEYS)?;
        let of_file: Option<String> = table.optional("of_file")?;
        // Until the file is read, anywhere.
        let [position_m, target_m] = match of_file {
            Some(_) => [
                table.or("position_m", [0.0; 3])?,
                table.or("target_m", [1.0; 3])?,
            ],
            None => [table.required("position_m")?, table.required("target_m")?],
        };
        Ok(Self {
            of_file,
            position_m,
            target_m,
            up: table.or("up", [0.0, 1.0, 0.0])?,
            fov_y_deg: table.or("fov_y_deg", 30.0)?,
            exposure_ev: table.or("exposure_ev", 0.0)?,
            sensor_width_mm: table.optional("sensor_width_mm")?,
            aperture_mm: lens::aperture_mm(&table)?,
            focus_distance_m: lens::focus_distance_m(&table)?,
            shift: table.optional("shift")?,
            world_up: table.optional("world_up")?,
        })
    }
}

impl Read for Render {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        // `gather` was a key of earlier versions: see `keys_without_effect`.
        let keys = ["size_px", "filter_std_px", "tone_map", "gather"];
        let table = Table::read(value, key, &keys)?;
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
            &["file", "builtin", "rotation_deg", "intensity", "visible"],
        )?;
        Ok(Self {
            map: match table.either("file", "builtin")? {
                "file" => Map::File(table.required("file")?),
                _ => Map::BuiltIn(table.required("builtin")?),
            },
            rotation_deg: table.or("rotation_deg", 0.0)?,
            intensity: table.or("intensity", 1.0)?,
            visible: table.or("visible", true)?,
        })
    }
}

impl Read for Material {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        const SHARED: [&str; 8] = [
            "name",
            "kind",
            "roughness",
            "coherence_um",
            "clearcoat",
            "clearcoat_roughness",
            "anisotropy",
            "anisotropy_direction_deg",
        ];
        let (kind, table) = Table::read_kind(
            value,
            key,
            "kind",
            &SHARED,
            &[
                ("metal", &["metal", "base_color"]),
                ("dielectric", &["ior", "base_color"]),
                (
                    "metallic-roughness",
                    &["base_color", "metallic", "specular", "specular_color"],
                ),
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
                specular: Specular {
                    weight: table.or("specular", 1.0)?,
                    color: table.or("specular_color", [1.0; 3])?,
                },
            },
            _ => MaterialKind::Mirror,
        };
        let coat = match table.optional("clearcoat")? {
            Some(weight) => Some(Coat {
                weight,
                roughness: table.or("clearcoat_roughness", 0.0)?,
            }),
            None if table.has("clearcoat_roughness") => {
                return Err(Error::new(
                    table.way("clearcoat_roughness"),
                    "found no `clearcoat` beside it",
                    "add one, such as `clearcoat = 1`",
                ));
            }
            None => None,
        };
        let anisotropy = match table.optional("anisotropy")? {
            Some(strength) => Some(Anisotropy {
                strength,
                direction_deg: table.or("anisotropy_direction_deg", 0.0)?,
            }),
            None if table.has("anisotropy_direction_deg") => {
                return Err(Error::new(
                    table.way("anisotropy_direction_deg"),
                    "found no `anisotropy` beside it",
                    "add one, such as `anisotropy = 0.6`",
                ));
            }
            None => None,
        };
        Ok(Self {
            coat,
            anisotropy,
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
                "up",
                "fit_m",
                "time_s",
                "animation",
                "overrides",
                "translation_m",
                "rotation_deg",
                "scale",
                "hidden",
            ],
        )?;
        let name = table.required("name")?;
        let surface = match table.either("shape", "mesh")? {
            "shape" => Surface::Shape(table.required("shape")?),
            _ => Surface::Mesh(table.required("mesh")?),
        };
        if let Surface::Shape(_) = surface
            && let Some(extra) = ["up", "fit_m", "time_s", "animation", "overrides"]
                .into_iter()
                .find(|it| table.get(it).is_some())
        {
            return Err(Error::new(
                table.way(extra),
                "a shape has no such key",
                "it belongs to an object with a `mesh`",
            ));
        }
        let ScaleFactors(scale) = table.or("scale", ScaleFactors([1.0; 3]))?;
        Ok(Self {
            name,
            surface,
            material: table.optional("material")?,
            up: table.or("up", Up::default())?,
            fit_m: table.optional("fit_m")?,
            time_s: table.optional("time_s")?,
            animation: table.optional("animation")?,
            overrides: table.or("overrides", Vec::new())?,
            translation_m: table.or("translation_m", [0.0; 3])?,
            rotation_deg: table.or("rotation_deg", [0.0; 3])?,
            scale,
            hidden: table.or("hidden", false)?,
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

impl Read for Scratches {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        const AROUND: [&str; 3] = ["axis", "center_m", "jitter_deg"];
        const AMOUNTS: [&str; 2] = ["count", "density_per_m2"];
        let with = |own: &[&'static str]| [&AMOUNTS[..], &["seed"], &sizes::KEYS, own].concat();
        let (pattern, table) = Table::read_kind(
            value,
            key,
            "pattern",
            &[
                "object", "material", "node", "where", "pattern", "name", "hidden", "solo",
                "strokes",
            ],
            &[
                ("random", &with(&["curvature_per_m"])),
                ("parallel", &with(&["direction", "jitter_deg"])),
                ("circular", &with(&AROUND)),
                ("radial", &with(&AROUND)),
                ("spun", &with(&[&AROUND[..], &["curvature_per_m"]].concat())),
                ("swirl", &with(&["curvature_per_m"])),
                (
                    "drawn",
                    &[&sizes::KEYS[..], &["seed", "jitter_deg"]].concat(),
                ),
                ("file", &["file"]),
            ],
        )?;
        Ok(Self {
            object: table.required("object")?,
            material: table.optional("material")?,
            node: table.optional("node")?,
            place: table.or("where", LayerPlaces::default())?,
            name: table.optional("name")?,
            hidden: table.or("hidden", false)?,
            solo: table.or("solo", false)?,
            layer: layer(pattern, &table)?,
            strokes: table.or("strokes", Vec::new())?,
        })
    }
}

/// The axis that a pattern turns about.
pub(super) fn around(table: &Table) -> Result<Around, Error> {
    let default = Around::default();
    Ok(Around {
        axis: table.or("axis", default.axis)?,
        center_m: table.or("center_m", default.center_m)?,
        jitter_deg: table.or("jitter_deg", default.jitter_deg)?,
    })
}

/// Reads the keys of a `[[scratches]]` that belong to its pattern.
fn layer(pattern: &str, table: &Table) -> Result<Layer, Error> {
    if pattern == "file" {
        let file = table.required("file")?;
        return Ok(Layer::Listed(Listed { file }));
    }
    let seed = table.or("seed", super::DEFAULT_SEED)?;
    let sizes = sizes::read(table)?;
    let around = || around(table);
    let curvature_per_m = |mean, spread| table.or("curvature_per_m", Distribution { mean, spread });
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
        "swirl" => Pattern::Swirl {
            curvature_per_m: curvature_per_m(25.0, 8.0)?,
        },
        _ => {
            return Ok(Layer::Brushed(Brushed {
                seed,
                ..Brushed::new(table.or("jitter_deg", 0.0)?, sizes)
            }));
        }
    };
    let amount = match table.either("count", "density_per_m2")? {
        "count" => Amount::Count(table.required("count")?),
        _ => Amount::DensityPerM2(table.required("density_per_m2")?),
    };
    Ok(Layer::Laid(Laid {
        seed,
        ..Laid::new(pattern, amount, sizes)
    }))
}

impl Read for Stroke {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        const PAINT: [&str; 3] = ["density_per_m", "width", "depth"];
        let known = [&["points_m", "radius_m", "erase"][..], &PAINT[..]].concat();
        let table = Table::read(value, key, &known)?;
        let brush = match table.or("erase", false)? {
            true => {
                if let Some(extra) = PAINT.into_iter().find(|name| table.get(name).is_some()) {
                    return Err(Error::new(
                        table.way(extra),
                        "an erasing stroke has no such key",
                        "leave it out, or leave out `erase = true`",
                    ));
                }
                Brush::Erase
            }
            false if table.get("density_per_m").is_none() => {
                return Err(Error::new(
                    key,
                    "found neither `density_per_m` nor `erase = true`",
                    "must have exactly one of them",
                ));
            }
            false => Brush::Paint {
                density_per_m: table.required("density_per_m")?,
                width: table.or("width", 1.0)?,
                depth: table.or("depth", 1.0)?,
            },
        };
        Ok(Self {
            points_m: table.required("points_m")?,
            radius_m: table.required("radius_m")?,
            brush,
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

//! Reads parsed TOML to a [`Description`]: keys, types, defaults. Ranges are left to `check`.

use hairline_scene::{Anisotropy, Coat, Specular};
use toml::de::{DeTable, DeValue};

use super::keyed::{Keyed, keyed};
use super::lens;
use super::ranges::Check;
use super::table::{Held, Read, Table, Value, number, wrong_type};
use super::{
    Amount, Around, Brush, Brushed, Camera, Cover, Description, Distribution, Engraved,
    Environment, Laid, Layer, LayerPlaces, Listed, Map, Material, MaterialKind, MetalColor, Object,
    Pattern, Render, Scratches, Stroke, Studio, Surface,
};
use crate::error::Error;
use crate::schema::{
    Initial, camera, cover, environment, look, material, object, render, scratches, stroke,
};

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
            "look",
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
        looks: table.or("look", Vec::new())?,
        lights_of: None,
        notes: Vec::new(),
    };
    let size_px = description.render.size_px;
    if let Some(value) = table.get("camera") {
        see_by_lens(&mut description.camera, value, "camera", size_px)?;
    }
    if let Some(DeValue::Array(rows)) = table.get("look").map(|value| value.get_ref()) {
        for (i, (row, look)) in rows.iter().zip(&mut description.looks).enumerate() {
            let row = Table::of(&look::LOOK, row, "look")?;
            if let (Some(value), Some(camera)) = (row.get("camera"), &mut look.camera) {
                see_by_lens(camera, value, &format!("look[{i}].camera"), size_px)?;
            }
        }
    }
    if !description.is_lit() && !table.has("studio") {
        description.studio = Studio::default();
        // Without objects a ground is asked for by name: where it is not, they were forgotten.
        if !description.objects.is_empty() {
            description.ground.get_or_insert_default();
        }
    }
    Ok(description)
}

/// Gives a camera the field of view of the lens in its table, which sees by the picture's shape.
fn see_by_lens(
    camera: &mut Camera,
    value: &Value,
    key: &str,
    size_px: [u32; 2],
) -> Result<(), Error> {
    let table = Table::of(&camera::CAMERA, value, key)?;
    if let Some(fov_y_deg) = lens::fov_y_deg(&table, size_px)? {
        camera.fov_y_deg = fov_y_deg;
    }
    Ok(())
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

impl Read for Render {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        // `gather` was a key of earlier versions: see `keys_without_effect`.
        let older = match value.get_ref() {
            DeValue::Table(entries) => entries.get("gather").map(|_| "gather"),
            _ => None,
        };
        let known = render::RENDER.keys.iter().map(|key| key.name);
        let known: Vec<_> = known.chain(older).collect();
        let table = Table::read(value, key, &known)?;
        if let Some(bits) = table.get(render::PNG_BITS.name)
            && !matches!(bits.get_ref(), DeValue::Integer(_))
        {
            let key = table.way(render::PNG_BITS.name);
            return Err(wrong_type(bits, &key, "8 or 16"));
        }
        Self::read_keys(&table)
    }
}

keyed! { Render: Default {
    size_px: render::SIZE_PX,
    filter_std_px: render::FILTER_STD_PX,
    tone_map: render::TONE_MAP,
    transparent: render::TRANSPARENT,
    behind: render::BEHIND,
    png_bits: render::PNG_BITS,
} }

impl Read for Environment {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::of(&environment::ENVIRONMENT, value, key)?;
        Ok(Self {
            map: match table.either("file", "builtin")? {
                "file" => Map::File(table.required("file")?),
                _ => Map::BuiltIn(table.required("builtin")?),
            },
            rotation_deg: table.value(&environment::ROTATION_DEG)?,
            intensity: table.value(&environment::INTENSITY)?,
            visible: table.value(&environment::VISIBLE)?,
        })
    }
}

keyed! { Cover: Default of cover::COVER {
    ior: cover::IOR,
    thickness_mm: cover::THICKNESS_MM,
    color: cover::COLOR,
} }

impl Read for Material {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let (kind, table) = Table::of_kind(&material::MATERIAL, value, key)?;
        let kind = match kind {
            "metal" => {
                MaterialKind::Metal(match table.one_of(&["metal", "base_color", "n_k"])? {
                    "metal" => MetalColor::Measured(table.required("metal")?),
                    "n_k" => MetalColor::Own(table.required("n_k")?),
                    _ => MetalColor::Color(table.required("base_color")?),
                })
            }
            "dielectric" => MaterialKind::Dielectric {
                ior: table.value(&material::IOR)?,
                base_color: table.value(&material::BODY_COLOR)?,
            },
            "metallic-roughness" => MaterialKind::MetallicRoughness {
                base_color: table.value(&material::BASE_COLOR)?,
                metallic: table.value(&material::METALLIC)?,
                specular: Specular {
                    weight: table.value(&material::SPECULAR)?,
                    color: table.value(&material::SPECULAR_COLOR)?,
                },
            },
            _ => MaterialKind::Mirror,
        };
        let coat = match table.value(&material::CLEARCOAT)? {
            Some(weight) => Some(Coat {
                weight,
                roughness: table.value(&material::CLEARCOAT_ROUGHNESS)?,
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
        let anisotropy = match table.value(&material::ANISOTROPY)? {
            Some(strength) => Some(Anisotropy {
                strength,
                direction_deg: table.value(&material::ANISOTROPY_DIRECTION_DEG)?,
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
        // A key of metals, which other kinds do not know.
        let cover: Option<Cover> = match table.has("cover") {
            true => table.value(&material::COVER)?,
            false => None,
        };
        if let (Some(_), MaterialKind::Metal(MetalColor::Color(_))) = (cover, &kind) {
            return Err(Error::new(
                table.way("cover"),
                "found a plate over a metal that a colour stands for",
                "belongs to `metal` or `n_k`, whose refractive index is known",
            ));
        }
        if cover.is_some() && coat.is_some() {
            return Err(Error::new(
                table.way("cover"),
                "found a `clearcoat` beside it",
                "leave one of them out",
            ));
        }
        Ok(Self {
            coat,
            cover,
            anisotropy,
            name: table.value(&material::NAME)?,
            kind,
            roughness: table.value(&material::ROUGHNESS)?,
            coherence_um: table.value(&material::COHERENCE_UM)?,
        })
    }
}

impl Read for Object {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::of(&object::OBJECT, value, key)?;
        let name = table.value(&object::NAME)?;
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
            material: table.value(&object::MATERIAL)?,
            up: table.value(&object::UP)?,
            fit_m: table.value(&object::FIT_M)?,
            time_s: table.value(&object::TIME_S)?,
            animation: table.value(&object::ANIMATION)?,
            overrides: table.value(&object::OVERRIDES)?,
            translation_m: table.value(&object::TRANSLATION_M)?,
            rotation_deg: table.value(&object::ROTATION_DEG)?,
            scale,
            hidden: table.value(&object::HIDDEN)?,
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
        let (pattern, table) = Table::of_kind(&scratches::SCRATCHES, value, key)?;
        Ok(Self {
            object: table.value(&scratches::OBJECT)?,
            material: table.value(&scratches::MATERIAL)?,
            node: table.value(&scratches::NODE)?,
            place: table.or(scratches::WHERE.name, LayerPlaces::default())?,
            name: table.value(&scratches::NAME)?,
            hidden: table.value(&scratches::HIDDEN)?,
            solo: table.value(&scratches::SOLO)?,
            profile: table.value(&scratches::PROFILE)?,
            layer: layer(pattern, &table)?,
            strokes: table.value(&scratches::STROKES)?,
        })
    }
}

keyed! { Around: Default {
    axis: scratches::AXIS,
    center_m: scratches::CENTER_M,
    jitter_deg: scratches::JITTER_DEG,
} }

/// Lengths, widths and depths.
fn sizes(table: &Table) -> Result<[Distribution; 3], Error> {
    Ok([
        table.value(&scratches::LENGTH_M)?,
        table.value(&scratches::WIDTH_UM)?,
        table.value(&scratches::DEPTH_NM)?,
    ])
}

/// Reads the keys of a `[[scratches]]` that belong to its pattern.
fn layer(pattern: &str, table: &Table) -> Result<Layer, Error> {
    if pattern == "file" {
        let file = table.required(scratches::FILE.name)?;
        return Ok(Layer::Listed(Listed { file }));
    }
    if matches!(pattern, "curve" | "text" | "svg") {
        return Ok(Layer::Engraved(Engraved::read(pattern, table)?));
    }
    let seed = table.value(&scratches::SEED)?;
    let sizes = sizes(table)?;
    if pattern == "drawn" {
        return Ok(Layer::Brushed(Brushed {
            seed,
            ..Brushed::new(table.value(&scratches::JITTER_DEG)?, sizes)
        }));
    }
    let pattern = Pattern::read_kind(pattern, table)?;
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
        let table = Table::of(&stroke::STROKES, value, key)?;
        let brush = match table.value(&stroke::ERASE)? {
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
                width: table.value(&stroke::WIDTH)?,
                depth: table.value(&stroke::DEPTH)?,
            },
        };
        Ok(Self {
            points_m: table.value(&stroke::POINTS_M)?,
            radius_m: table.value(&stroke::RADIUS_M)?,
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

impl Held for Distribution {
    fn initial(initial: Initial) -> Option<Self> {
        let (mean, spread) = match initial {
            Initial::Number(mean) => (mean, 0.0),
            Initial::Sizes(mean, spread) => (mean, spread),
            _ => return None,
        };
        Some(Self { mean, spread })
    }
}

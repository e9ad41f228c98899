//! An object of a file with HAIRLINE_scratches: its scratches and gratings as they lie.

use std::path::Path;
use std::sync::Arc;

use bevy::log::warn;
use gltf::accessor::{DataType, Dimensions, Item, Iter};
use hairline_optics::metal::Metal;
use hairline_optics::table::ENGINE_COLUMNS;
use hairline_scene::{
    Base, Description, Loader, Profile, Scene, SceneBuilder, Scratch, SectionId, Segment,
};
use serde_json::{Map, Value, json};

use crate::Scratches;
use crate::scratches::{Field, Grating};

pub(crate) const NAME: &str = "HAIRLINE_scratches";

/// An object in its own frame and unit.
pub(crate) struct WornObject {
    pub name: String,
    /// With the object's scratches.
    scene: Scene,
    gratings: Vec<Grating>,
    pub metal: Option<Metal>,
}

impl WornObject {
    /// In metres, where a unit of the object is so long.
    pub(crate) fn scratches(&self, metres: f32) -> Scratches {
        let mut scene = self.scene.clone();
        for piece in Arc::make_mut(&mut scene.objects[0].segments) {
            piece.start_m *= metres;
            piece.end_m *= metres;
        }
        let mut scratches = Scratches::of_scene(&scene, 0);
        for grating in &self.gratings {
            let mut grating = grating.clone();
            let center = grating.numbers.y_axis;
            grating.numbers.y_axis = (metres * center.truncate()).extend(center.w);
            scratches.gratings.push(grating);
        }
        scratches
    }

    /// None of an object without scratches and gratings.
    pub(crate) fn read(
        gltf: &gltf::Gltf,
        extension: &Value,
        object: &Value,
    ) -> Result<Option<Self>, String> {
        let of_object =
            |table| rows(extension, table).filter(|(_, row)| row["object"] == object["name"]);
        let mut layers = Vec::new();
        for (i, row) in of_object("scratches") {
            match row.get("laid") {
                Some(laid) => layers.push((i, row, laid)),
                None => {
                    warn!("{NAME}: not drawn: scratches[{i}], which the file has without `laid`")
                }
            }
        }
        let mut gratings = Vec::new();
        for (i, row) in of_object("grating") {
            match row.get("laid") {
                Some(laid) => {
                    gratings.push(read_grating(gltf, laid, &format!("grating[{i}].laid"))?)
                }
                None => warn!("{NAME}: not drawn: grating[{i}], which the file has without `laid`"),
            }
        }
        if layers.is_empty() && gratings.is_empty() {
            return Ok(None);
        }
        // Materials and cross sections are read as those of scene files; nothing else of this scene is used.
        let mut materials = rows(extension, "material").map(|(_, row)| row);
        let material = materials.find(|row| row["name"] == object["material"]);
        let mut material = material.cloned().unwrap_or(json!({ "kind": "mirror" }));
        material["name"] = json!("material");
        let sections = layers.iter().map(|(_, row, _)| {
            let mut layer = json!({ "object": "object", "pattern": "random", "count": 1 });
            if let Some(profile) = row.get("profile") {
                layer["profile"] = profile.clone();
            }
            layer
        });
        let tables = [
            ("studio", json!({ "hidden": true })),
            (
                "camera",
                json!({ "position_m": [0.0, 0.0, 1.0], "target_m": [0.0, 0.0, 0.0], "up": [0.0, 1.0, 0.0] }),
            ),
            ("material", json!([material])),
            (
                "object",
                json!([{ "name": "object", "material": "material", "shape": { "plane": { "size_m": [1.0, 1.0] } } }]),
            ),
            ("scratches", sections.collect()),
        ];
        let tables = tables.map(|(name, it)| (name.to_owned(), it));
        let tables = Map::from_iter(tables);
        let mut description = Description::from_json(&tables).map_err(|error| error.to_string())?;
        let described = std::mem::take(&mut description.scratches);
        let scene = SceneBuilder::new().build(&Loader::default(), &description, Path::new("."));
        let mut scene = scene.map_err(|error| error.to_string())?;
        let (mut scratches, mut segments) = (Vec::new(), Vec::new());
        for ((i, _, laid), described) in layers.iter().zip(&described) {
            let section = SectionId::new(&described.profile);
            let way = format!("scratches[{i}].laid");
            read_layer(
                gltf,
                laid,
                &way,
                (*i as u32, section),
                &mut scratches,
                &mut segments,
            )?;
        }
        let base = scene.materials[0].base;
        if let Base::Covered { .. } = base {
            warn!(
                "{NAME}: not drawn: the plate over the material of {}",
                object["name"]
            );
        }
        let own = &mut scene.objects[0];
        (own.scratches, own.segments) = (Arc::new(scratches), Arc::new(segments));
        Ok(Some(Self {
            name: object["name"].as_str().unwrap_or_default().to_owned(),
            scene,
            gratings,
            metal: match base {
                Base::Metal(metal) => Some(metal),
                _ => None,
            },
        }))
    }
}

/// Rows of a table that are not hidden, with their numbers.
pub(crate) fn rows<'a>(
    extension: &'a Value,
    table: &str,
) -> impl Iterator<Item = (usize, &'a Value)> {
    let all = extension.get(table).and_then(Value::as_array);
    let all = all.into_iter().flatten().enumerate();
    all.filter(|(_, row)| row.get("hidden") != Some(&Value::Bool(true)))
}

/// The straight pieces of a layer, those of a scratch one after the other.
fn read_layer(
    gltf: &gltf::Gltf,
    laid: &Value,
    way: &str,
    (layer, section): (u32, SectionId),
    scratches: &mut Vec<Scratch>,
    segments: &mut Vec<Segment>,
) -> Result<(), String> {
    let three = |key| accessor::<[f32; 3]>(gltf, laid, way, key, Dimensions::Vec3, DataType::F32);
    let one = |key| accessor::<f32>(gltf, laid, way, key, Dimensions::Scalar, DataType::F32);
    let (starts, ends, normals) = (three("start_m")?, three("end_m")?, three("normal")?);
    let (widths, depths) = (one("width_um")?, one("depth_nm")?);
    let numbers: Vec<u32> = accessor(
        gltf,
        laid,
        way,
        "scratch",
        Dimensions::Scalar,
        DataType::U32,
    )?;
    let counts = [
        starts.len(),
        ends.len(),
        normals.len(),
        widths.len(),
        depths.len(),
    ];
    if counts.iter().any(|count| *count != numbers.len()) {
        let right = "must be as many of each";
        return Err(format!(
            "{way}: found accessors of {counts:?} and {} elements; {right}",
            numbers.len()
        ));
    }
    let all = [&starts, &ends, &normals].into_iter().flatten().flatten();
    if !all.chain(&widths).chain(&depths).all(|x| x.is_finite()) {
        return Err(format!(
            "{way}: found a number that is infinite or none; must be finite"
        ));
    }
    let mut first = 0;
    for piece in numbers.chunk_by(|a, b| a == b) {
        let own = first..first + piece.len();
        first = own.end;
        let from = segments.len() as u32;
        segments.extend(own.clone().map(|i| Segment {
            start_m: starts[i].into(),
            end_m: ends[i].into(),
            normal: normals[i].into(),
            triangle: 0,
        }));
        scratches.push(Scratch {
            profile: Profile {
                width_um: widths[own.start],
                depth_nm: depths[own.start],
                section,
            },
            layer,
            closed: own.len() > 2 && starts[own.start] == ends[own.end - 1],
            segments: from..segments.len() as u32,
        });
    }
    Ok(())
}

fn read_grating(gltf: &gltf::Gltf, laid: &Value, way: &str) -> Result<Grating, String> {
    let one = |key: &str| {
        let found = number(laid, key);
        found.ok_or_else(|| format!("{way}.{key}: found no number; must be one"))
    };
    let many = |key: &str| {
        let found = numbers(laid, key);
        found.ok_or_else(|| format!("{way}.{key}: found something else; must be three numbers"))
    };
    let radii_m = numbers(laid, "radii_m");
    let words: Vec<u32> = accessor(gltf, laid, way, "texels", Dimensions::Scalar, DataType::U32)?;
    let field = Field {
        kind: laid["kind"].as_str().unwrap_or_default(),
        axis: many("axis")?,
        center: many("center")?,
        radii_m: radii_m
            .ok_or_else(|| format!("{way}.radii_m: found something else; must be two numbers"))?,
        curvature_per_m: one("curvature_per_m")?,
        coverage: one("coverage")?,
        angle_std_rad: one("angle_std_rad")?,
        coherence_um: one("coherence_um")?,
    };
    let count = words.len();
    let texels = words.as_chunks::<4>().0.to_vec();
    Grating::new(&field, Arc::new(texels)).ok_or_else(|| {
        let found = format!("found the kind {} and {count} words of `texels`", laid["kind"]);
        format!("{way}: {found}; must be along, circular, radial or spun, and {ENGINE_COLUMNS} columns of 256 or 512 rows")
    })
}

pub(crate) fn number(value: &Value, key: &str) -> Option<f64> {
    value.get(key)?.as_f64()
}

/// So many numbers.
pub(crate) fn numbers<const N: usize>(value: &Value, key: &str) -> Option<[f64; N]> {
    let list = value.get(key)?.as_array()?;
    let numbers: Option<Vec<f64>> = list.iter().map(Value::as_f64).collect();
    numbers?.try_into().ok()
}

/// The elements of an accessor that a key names.
fn accessor<T: Item>(
    gltf: &gltf::Gltf,
    laid: &Value,
    way: &str,
    key: &str,
    dimensions: Dimensions,
    data_type: DataType,
) -> Result<Vec<T>, String> {
    let number = laid.get(key).and_then(Value::as_u64);
    let found = number.and_then(|number| gltf.document.accessors().nth(number as usize));
    let right = format!("must be the number of an accessor, {dimensions:?} of {data_type:?}");
    let is_right = |it: &gltf::Accessor| {
        it.count() > 0 && it.dimensions() == dimensions && it.data_type() == data_type
    };
    let blob = gltf.blob.as_deref();
    // Its own buffer is the first.
    let bytes = |buffer: gltf::Buffer| blob.filter(|_| buffer.index() == 0);
    let elements = found
        .filter(is_right)
        .and_then(|it| Iter::<T>::new(it, bytes));
    elements.map_or_else(
        || Err(format!("{way}.{key}: found {}; {right}", laid[key])),
        |elements| Ok(elements.collect()),
    )
}

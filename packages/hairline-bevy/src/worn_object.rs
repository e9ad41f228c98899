//! An object of a file with HAIRLINE_scratches: its scratches and gratings.

use std::sync::Arc;

use bevy::log::warn;
use gltf::accessor::{DataType, Dimensions, Item, Iter};
use hairline_document::description::{Grating, Scratches as Layer};
use hairline_document::{Error, object_of_gratings};
use hairline_engine::{GratingField, GratingTexels, LaidGrating, Pieces};
use hairline_optics::metal::Metal;
use hairline_optics::section::Section;
use hairline_optics::table::{ENGINE_COLUMNS, ENGINE_GRATING_ROWS, ROWS};
use hairline_scene::DEFAULT_COHERENCE_UM;
use serde_json::{Value, json};

use crate::Scratches;
use crate::scratches::drawn;
use crate::unlaid_layers::UnlaidLayers;

pub(crate) const NAME: &str = "HAIRLINE_scratches";

/// The scratches of an object.
#[derive(Clone)]
enum ScratchSource {
    /// As they lie.
    Laid(Pieces),
    /// To be laid.
    Unlaid(UnlaidLayers),
}

/// An object in its own frame and unit.
#[derive(Clone)]
pub(crate) struct WornObject {
    pub name: String,
    scratches: ScratchSource,
    coherence_um: f64,
    gratings: Vec<GratingTexels>,
    pub metal: Option<Metal>,
}

impl WornObject {
    /// In metres, where a unit of the object is so long.
    ///
    /// # Errors
    /// What is wrong with its scratches.
    pub(crate) fn scratches(&self, metres: f32) -> Result<Scratches, String> {
        let mut pieces = match &self.scratches {
            ScratchSource::Laid(pieces) => pieces.clone(),
            ScratchSource::Unlaid(layers) => {
                layers.lay(metres).map_err(|error| error.to_string())?
            }
        };
        for rows in [&mut pieces.starts, &mut pieces.ends] {
            for x in rows.as_flattened_mut() {
                *x *= metres;
            }
        }
        let scratches = Scratches::of_pieces(&pieces, self.coherence_um, 1.0);
        let mut scratches = scratches.map_err(|error| error.to_string())?;
        scratches.gratings = self.gratings.clone();
        for grating in &mut scratches.gratings {
            for x in &mut grating.numbers[4..7] {
                *x *= metres;
            }
        }
        Ok(scratches)
    }

    /// None of an object without scratches and gratings.
    pub(crate) fn read(
        gltf: &gltf::Gltf,
        extension: &Value,
        number: u64,
        object: &Value,
    ) -> Result<Option<Self>, String> {
        let of_object =
            |table| rows(extension, table).filter(|(_, row)| row["object"] == object["name"]);
        let layers: Vec<_> = of_object("scratches").collect();
        let mut materials = rows(extension, "material").map(|(_, row)| row);
        let material = materials.find(|row| row["name"] == object["material"]);
        let material = material.unwrap_or(&Value::Null);
        let named = |(name, _): &&(&str, Metal)| material["metal"] == **name;
        let metal = Metal::NAMED.iter().find(named).map(|(_, metal)| *metal);
        let coherence_um = self::number(material, "coherence_um").unwrap_or(DEFAULT_COHERENCE_UM);
        let mut gratings = Vec::new();
        for (i, row) in of_object("grating") {
            match row.get("laid") {
                Some(laid) if row.get("mask").is_some() || is_by_uv(laid) => {
                    warn!(
                        "{NAME}: not drawn: grating[{i}], which has a mask or follows texture coordinates"
                    )
                }
                Some(laid) => {
                    gratings.push(read_grating(gltf, laid, &format!("grating[{i}].laid"))?)
                }
                None => {
                    let told = |error: Error| format!("grating[{i}]: {error}");
                    let row = Grating::from_json(json!([row])).map_err(told)?;
                    gratings.extend(drawn(LaidGrating::of_object(
                        object_of_gratings(&row),
                        metal,
                        coherence_um,
                    )));
                }
            }
        }
        if layers.is_empty() && gratings.is_empty() {
            return Ok(None);
        }
        let laid = layers
            .iter()
            .map(|(i, row)| Some((*i, *row, row.get("laid")?)));
        let scratches = match laid.collect::<Option<Vec<_>>>() {
            Some(layers) => {
                let mut pieces = Pieces::default();
                for (i, row, laid) in layers {
                    let section = Layer::section_from_json(row.get("profile").cloned());
                    let section = section.map_err(|error| error.to_string())?;
                    let way = format!("scratches[{i}].laid");
                    read_layer(gltf, laid, &way, (i as u32, section), &mut pieces)?;
                }
                ScratchSource::Laid(pieces)
            }
            None => {
                let name = &object["name"];
                ScratchSource::Unlaid(UnlaidLayers::read(gltf, extension, number, name)?)
            }
        };
        if material.get("cover").is_some() {
            warn!(
                "{NAME}: not drawn: the plate over the material of {}",
                object["name"]
            );
        }
        Ok(Some(Self {
            name: object["name"].as_str().unwrap_or_default().to_owned(),
            scratches,
            coherence_um,
            gratings,
            metal,
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

/// Adds the straight pieces of a layer.
fn read_layer(
    gltf: &gltf::Gltf,
    laid: &Value,
    way: &str,
    (layer, section): (u32, Section),
    pieces: &mut Pieces,
) -> Result<(), String> {
    let three = |key| accessor::<[f32; 3]>(gltf, laid, way, key, Dimensions::Vec3, DataType::F32);
    let one = |key| accessor::<f32>(gltf, laid, way, key, Dimensions::Scalar, DataType::F32);
    pieces.starts.extend(three("start_m")?);
    pieces.ends.extend(three("end_m")?);
    pieces.normals.extend(three("normal")?);
    pieces.widths_um.extend(one("width_um")?);
    pieces.depths_nm.extend(one("depth_nm")?);
    let numbers: Vec<u32> = accessor(
        gltf,
        laid,
        way,
        "scratch",
        Dimensions::Scalar,
        DataType::U32,
    )?;
    let count = numbers.len();
    let first = pieces.scratch.iter().max().map_or(0, |number| number + 1);
    let numbers = numbers.iter().map(|number| number.saturating_add(first));
    pieces.scratch.extend(numbers);
    pieces.sections.extend(vec![section; count]);
    pieces.layers.extend(vec![layer; count]);
    pieces.check().map_err(|error| format!("{way}: {error}"))
}

/// Whether grooves follow texture coordinates.
fn is_by_uv(laid: &Value) -> bool {
    laid["kind"] == "along-u" || laid["kind"] == "along-v"
}

fn read_grating(gltf: &gltf::Gltf, laid: &Value, way: &str) -> Result<GratingTexels, String> {
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
    let field = GratingField {
        kind: laid["kind"].as_str().unwrap_or_default(),
        axis: many("axis")?,
        center_m: many("center")?,
        radii_m: radii_m
            .ok_or_else(|| format!("{way}.radii_m: found something else; must be two numbers"))?,
        curvature_per_m: one("curvature_per_m")?,
        coverage: one("coverage")?,
        angle_std_rad: one("angle_std_rad")?,
        coherence_um: one("coherence_um")?,
    };
    let count = words.len();
    let texels = words.as_chunks::<4>().0.to_vec();
    GratingTexels::new(&field, Arc::new(texels)).ok_or_else(|| {
        let found = format!("found the kind {} and {count} words of `texels`", laid["kind"]);
        format!("{way}: {found}; must be along, circular, radial or spun, and {ENGINE_COLUMNS} columns of 2 to {ENGINE_GRATING_ROWS} rows or {ROWS}")
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
pub(crate) fn accessor<T: Item>(
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
    let is_right = |accessor: &gltf::Accessor| {
        accessor.count() > 0
            && accessor.dimensions() == dimensions
            && accessor.data_type() == data_type
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

//! Layers of a file that has their scratches by seeds and lists: Hairline's own code lays them on the object's triangles.

use std::sync::Arc;

use bevy::log::warn;
use bevy::math::{Mat3, Mat4, Vec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use hairline_document::description::Scratches;
use hairline_document::{Arrays, Error, MeshArrays, ScratchArrays, lay_on_mesh};
use hairline_engine::Pieces;
use serde_json::{Value, json};

use crate::worn_object::{NAME, accessor};

/// The layers of one object, by the parts of it that they lie on.
#[derive(Clone)]
pub(crate) struct UnlaidLayers {
    /// Triangles of a part in the object's frame, and all layers of the file, of which those on the part are shown.
    parts: Vec<(MeshArrays, Vec<Scratches>)>,
    lists: Arrays,
}

/// A material and a node that layers lie on; none for the whole object.
type Part = [Option<String>; 2];

/// Triangles in the frame of their object.
#[derive(Default)]
struct Triangles {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    corners: Vec<[u32; 3]>,
}

impl UnlaidLayers {
    /// Those of the file's object `number`, of that `name`.
    ///
    /// # Errors
    /// What is wrong with a layer, by its key.
    pub fn read(
        gltf: &gltf::Gltf,
        extension: &Value,
        number: u64,
        name: &Value,
    ) -> Result<Self, String> {
        let mut rows = extension["scratches"].clone();
        let mut lists = Arrays::default();
        // Parts of layers; none where a layer is not drawn.
        let mut part_of: Vec<Option<Part>> = Vec::new();
        for (i, row) in rows.as_array_mut().into_iter().flatten().enumerate() {
            let is_own = row["object"] == *name;
            let Some(row) = row.as_object_mut() else {
                return Err(format!("scratches[{i}]: must be an object"));
            };
            row.remove("laid");
            let mut named = |key| Some(row.remove(key)?.as_str()?.to_owned());
            let part = [named("material"), named("node")];
            let is_drawing = row.get("pattern") == Some(&json!("svg"));
            if let Some(drawing) = row.get_mut("file").filter(|_| is_drawing) {
                let file = &extension["files"][drawing.as_u64().unwrap_or(u64::MAX) as usize];
                let svg = view_of(gltf, &file["bufferView"]).ok_or_else(|| {
                    let way = format!("scratches[{i}].file");
                    format!("{way}: found {drawing}; must be the number of one of `files`")
                })?;
                lists.insert_drawing(format!("drawing {i}.svg"), svg);
                *drawing = json!(format!("drawing {i}.svg"));
            } else if let Some(list) = row.get_mut("file") {
                if is_own {
                    let read = read_list(gltf, list, &format!("scratches[{i}].file"))?;
                    lists.insert_scratches(format!("list {i}"), Arc::new(read));
                }
                *list = json!(format!("list {i}"));
            }
            let mut pictures = false;
            if let Some(place) = row.get_mut("where").and_then(Value::as_object_mut) {
                for key in ["mask", "density"] {
                    pictures |= place.remove(key).is_some();
                }
            }
            if is_own && pictures {
                warn!(
                    "{NAME}: not drawn: scratches[{i}], which has a picture in `where` and no `laid`: export it with `--laid on`"
                );
            }
            part_of.push((is_own && !pictures).then_some(part));
        }
        let mut parts: Vec<&Part> = part_of.iter().flatten().collect();
        parts.sort();
        parts.dedup();
        let of_part = |part: &Part| {
            let mut shown = rows.clone();
            for (row, of) in shown.as_array_mut().into_iter().flatten().zip(&part_of) {
                if of.as_ref() != Some(part) {
                    // All of them, as a layer's seed counts with those before it.
                    row["hidden"] = json!(true);
                }
            }
            let layers = Scratches::from_json(shown).map_err(|error| error.to_string())?;
            let mesh = Triangles::read(gltf, number, part).arrays();
            Ok((mesh.map_err(|error| error.to_string())?, layers))
        };
        let parts: Result<_, String> = parts.into_iter().map(of_part).collect();
        Ok(Self {
            parts: parts?,
            lists,
        })
    }

    /// Lays them, where the unit of the object is so long.
    ///
    /// # Errors
    /// What is wrong with a layer or with the triangles below it, by its key.
    pub fn lay(&self, metres_per_unit: f32) -> Result<Pieces, Error> {
        let mut all = Pieces::default();
        for (mesh, layers) in &self.parts {
            let object = lay_on_mesh(mesh, layers, &self.lists, metres_per_unit.into())?;
            let own = Pieces::of_object(&object, metres_per_unit.into());
            let first = all.scratch.last().map_or(0, |last| last + 1);
            all.starts.extend(own.starts);
            all.ends.extend(own.ends);
            all.normals.extend(own.normals);
            all.widths_um.extend(own.widths_um);
            all.depths_nm.extend(own.depths_nm);
            all.scratch
                .extend(own.scratch.iter().map(|number| first + number));
            all.sections.extend(own.sections);
            all.layers.extend(own.layers);
        }
        Ok(all)
    }
}

/// A list of straight scratches, or of the straight pieces of bent ones.
fn read_list(gltf: &gltf::Gltf, list: &Value, way: &str) -> Result<ScratchArrays, String> {
    let ends = |key| accessor::<[f32; 3]>(gltf, list, way, key, Dimensions::Vec3, DataType::F32);
    let sizes = |key| -> Result<Vec<f64>, String> {
        let sizes = accessor::<f32>(gltf, list, way, key, Dimensions::Scalar, DataType::F32)?;
        Ok(sizes.into_iter().map(f64::from).collect())
    };
    let [starts, ends] = [ends("start_m")?, ends("end_m")?];
    let both = starts.into_iter().zip(ends);
    let ends = both.map(|(start, end)| [start, end].map(|at| at.map(f64::from)));
    let [widths_um, depths_nm] = [sizes("width_um")?, sizes("depth_nm")?];
    let told = |error: Error| format!("{way}: {error}");
    let pieces = ScratchArrays::new(ends.collect(), [&widths_um, &depths_nm]).map_err(told)?;
    let Some(view) = list.get("scratches_u32") else {
        return Ok(pieces);
    };
    let bytes = view_of(gltf, view).ok_or_else(|| {
        format!("{way}.scratches_u32: found {view}; must be the number of a buffer view")
    })?;
    let numbers = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|it| u32::from_le_bytes(*it));
    let numbers: Vec<u32> = numbers.collect();
    pieces.with_scratches(&numbers).map_err(told)
}

/// The bytes of a buffer view, by its number.
fn view_of<'a>(gltf: &'a gltf::Gltf, number: &Value) -> Option<&'a [u8]> {
    let view = gltf.document.views().nth(number.as_u64()? as usize)?;
    // Its own buffer is the first.
    let blob = gltf
        .blob
        .as_deref()
        .filter(|_| view.buffer().index() == 0)?;
    blob.get(view.offset()..)?.get(..view.length())
}

impl Triangles {
    /// Those of a part of the object of that number.
    fn read(gltf: &gltf::Gltf, number: u64, part: &Part) -> Self {
        let is_object = |node: &gltf::Node| {
            let own = node.extension_value(NAME).and_then(|own| own.get("object"));
            own.and_then(Value::as_u64) == Some(number)
        };
        let mut triangles = Self::default();
        let [_, node] = part;
        if let Some(object) = gltf.document.nodes().find(is_object) {
            triangles.add(gltf, &object, Mat4::IDENTITY, node.is_none(), part);
        }
        triangles
    }

    /// Adds those of a node and of all below it. `is_in`: whether it lies below the part's node.
    fn add(
        &mut self,
        gltf: &gltf::Gltf,
        node: &gltf::Node,
        to_object: Mat4,
        is_in: bool,
        part: &Part,
    ) {
        let [material, name] = part;
        let is_in = is_in || node.name() == name.as_deref();
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            let of = primitive.material();
            let is_its = material.is_none() || of.name() == material.as_deref();
            if is_in && is_its && primitive.mode() == Mode::Triangles {
                self.add_primitive(gltf, &primitive, to_object);
            }
        }
        for child in node.children() {
            let matrix = to_object * Mat4::from_cols_array_2d(&child.transform().matrix());
            self.add(gltf, &child, matrix, is_in, part);
        }
    }

    fn add_primitive(&mut self, gltf: &gltf::Gltf, primitive: &gltf::Primitive, to_object: Mat4) {
        let blob = gltf.blob.as_deref();
        // Its own buffer is the first.
        let reader = primitive.reader(|buffer| blob.filter(|_| buffer.index() == 0));
        let Some(positions) = reader.read_positions() else {
            return;
        };
        let exact = |v: Vec3| v.as_dvec3().to_array();
        let first = self.positions.len() as u32;
        let placed = positions.map(|at| exact(to_object.transform_point3(at.into())));
        self.positions.extend(placed);
        let count = self.positions.len() as u32 - first;
        let upright = Mat3::from_mat4(to_object).inverse().transpose();
        let normals = reader.read_normals().into_iter().flatten();
        self.normals.extend(
            normals.map(|normal| exact((upright * Vec3::from(normal)).normalize_or_zero())),
        );
        let corners: Vec<u32> = match reader.read_indices() {
            Some(indices) => indices.into_u32().collect(),
            None => (0..count).collect(),
        };
        let (triangles, _) = corners.as_chunks::<3>();
        self.corners
            .extend(triangles.iter().map(|corners| corners.map(|i| first + i)));
    }

    /// Flat where a part of it has no normals.
    fn arrays(self) -> Result<MeshArrays, Error> {
        let normals = (self.normals.len() == self.positions.len()).then_some(self.normals);
        MeshArrays::new(self.positions, self.corners, normals, None)
    }
}

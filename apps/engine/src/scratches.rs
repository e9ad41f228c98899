//! Scratches on meshes.

use std::sync::Arc;

use hairline_document::description::Scratches;
use hairline_document::{Arrays, MeshArrays, ScratchArrays, lay_on_mesh};
use hairline_engine::{Pieces, ScratchTexels};
use hairline_optics::section::Section;
use serde_json::Value;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::{parsed, thrown};

/// Lists, pictures and drawings that layers name.
#[wasm_bindgen]
#[derive(Default)]
pub struct Files(Arrays);

#[wasm_bindgen]
impl Files {
    /// None yet.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a picture: four bytes a texel, rows from the top.
    ///
    /// # Errors
    /// Bytes that are no whole rows.
    pub fn picture(&mut self, name: &str, width: u32, rgba: &[u8]) -> Result<(), JsError> {
        let added = self.0.insert_picture(name, width, rgba);
        added.map_err(|error| JsError::new(&format!("{name}: {error}")))
    }

    /// Adds a drawing: an SVG file.
    pub fn drawing(&mut self, name: &str, svg: &[u8]) {
        self.0.insert_drawing(name, svg);
    }

    /// Adds a list of straight scratches: six numbers for the ends of each, in the frame of the mesh, in metres. With numbers of scratches they are pieces:
    /// those side by side with one number are one scratch.
    ///
    /// # Errors
    /// Arrays of other lengths, numbers out of range.
    pub fn list(
        &mut self,
        name: &str,
        ends_m: &[f64],
        widths_um: &[f64],
        depths_nm: &[f64],
        scratches: Option<Vec<u32>>,
    ) -> Result<(), JsError> {
        let ends = ends_m.as_chunks::<6>().0.iter();
        let ends = ends.map(|[a, b, c, d, e, f]| [[*a, *b, *c], [*d, *e, *f]]);
        let list = ScratchArrays::new(ends.collect(), [widths_um, depths_nm]);
        let list = match scratches {
            Some(numbers) => list.and_then(|list| list.with_scratches(&numbers)),
            None => list,
        };
        let list = list.map_err(thrown)?;
        self.0.insert_scratches(name, Arc::new(list));
        Ok(())
    }
}

/// Straight pieces of scratches, in the mesh's own frame: what the class `Scratches` of JavaScript has.
#[wasm_bindgen]
pub struct Laid(Pieces);

#[wasm_bindgen]
impl Laid {
    /// Lays layers on triangles. Positions, normals and indices are as in a vertex buffer; `layers` is JSON, rows with the keys of `[[scratches]]`.
    ///
    /// # Errors
    /// What is wrong with the mesh or with a layer.
    #[wasm_bindgen(constructor)]
    pub fn new(
        positions: &[f64],
        normals: Option<Vec<f64>>,
        uvs: Option<Vec<f64>>,
        index: &[u32],
        layers: &str,
        files: &Files,
        metres_per_unit: f64,
    ) -> Result<Self, JsError> {
        let rows = |numbers: &[f64]| numbers.as_chunks::<3>().0.to_vec();
        let uvs = uvs.map(|numbers| numbers.as_chunks::<2>().0.to_vec());
        let triangles = index.as_chunks::<3>().0.to_vec();
        let mesh = MeshArrays::new(
            rows(positions),
            triangles,
            normals.as_deref().map(rows),
            uvs,
        );
        let layers = Scratches::from_json(parsed(layers)?).map_err(thrown)?;
        let laid = lay_on_mesh(&mesh.map_err(thrown)?, &layers, &files.0, metres_per_unit);
        Ok(Self(Pieces::of_object(
            &laid.map_err(thrown)?,
            metres_per_unit,
        )))
    }

    /// Three numbers a piece.
    pub fn starts(&self) -> Vec<f32> {
        self.0.starts.as_flattened().to_vec()
    }

    /// Three numbers a piece.
    pub fn ends(&self) -> Vec<f32> {
        self.0.ends.as_flattened().to_vec()
    }

    /// Three numbers a piece.
    pub fn normals(&self) -> Vec<f32> {
        self.0.normals.as_flattened().to_vec()
    }

    /// Micrometres.
    #[wasm_bindgen(js_name = widthsUm)]
    pub fn widths_um(&self) -> Vec<f32> {
        self.0.widths_um.clone()
    }

    /// Nanometres.
    #[wasm_bindgen(js_name = depthsNm)]
    pub fn depths_nm(&self) -> Vec<f32> {
        self.0.depths_nm.clone()
    }

    /// Numbers of scratches.
    pub fn scratch(&self) -> Vec<u32> {
        self.0.scratch.clone()
    }

    /// Indices of layers.
    pub fn layers(&self) -> Vec<u32> {
        self.0.layers.clone()
    }
}

/// Scratches as shaders find them.
#[wasm_bindgen]
pub struct Tree {
    made: ScratchTexels,
    /// Cross sections that JavaScript has numbered.
    sections: Vec<Section>,
}

#[wasm_bindgen]
impl Tree {
    /// Makes the tree of pieces, in the mesh's own frame. `profiles` is JSON, a list of cross sections that begins with the rectangle; `profile_of` are indices
    /// in it, one a piece.
    ///
    /// # Errors
    /// Arrays of different lengths, numbers out of range, too many shapes or pieces.
    #[allow(clippy::too_many_arguments)]
    #[wasm_bindgen(constructor)]
    pub fn new(
        starts: &[f32],
        ends: &[f32],
        normals: Option<Vec<f32>>,
        widths_um: Vec<f32>,
        depths_nm: Vec<f32>,
        scratch: Vec<u32>,
        profile_of: &[u32],
        profiles: &str,
        coherence_um: f64,
        metres_per_unit: f64,
    ) -> Result<Self, JsError> {
        let Value::Array(profiles) = parsed(profiles)? else {
            return Err(JsError::new("profiles: must be a list"));
        };
        let sections = profiles
            .into_iter()
            .map(|profile| Scratches::section_from_json(Some(profile)));
        let sections: Result<Vec<_>, _> = sections.collect();
        let sections = sections.map_err(thrown)?;
        let rows = |numbers: &[f32]| numbers.as_chunks::<3>().0.to_vec();
        let count = widths_um.len();
        let pieces = Pieces {
            starts: rows(starts),
            ends: rows(ends),
            normals: normals.map_or_else(|| vec![[0.0; 3]; count], |normals| rows(&normals)),
            widths_um,
            depths_nm,
            scratch,
            sections: (profile_of.iter())
                .map(|i| sections[*i as usize].clone())
                .collect(),
            layers: vec![0; count],
        };
        let made = pieces
            .texels(coherence_um, metres_per_unit)
            .map_err(thrown)?;
        Ok(Self { made, sections })
    }

    /// Texels of the tree's texture, four words each.
    pub fn texels(&self) -> Vec<u32> {
        self.made.tree.as_flattened().to_vec()
    }

    /// Rows that tables need for the deepest scratch.
    #[wasm_bindgen(js_name = tableRows)]
    pub fn table_rows(&self) -> usize {
        self.made.table_rows
    }

    /// Shapes of the grooves, two numbers each: the index of the cross section, and the class of widths.
    pub fn shapes(&self) -> Vec<u32> {
        let shapes = self.made.shapes.iter().flat_map(|shape| {
            let mut known = self.sections.iter();
            let profile = known.position(|it| *it == shape.section);
            [profile.unwrap_or(0) as u32, shape.width_class.into()]
        });
        shapes.collect()
    }
}

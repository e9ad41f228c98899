//! The spectra of many scratches (docs/model.md, equation 24c): a table for each class of an object and each material's table there.

use super::BundleIndex;
use crate::scratch_index::ScratchIndex;
use hairline_optics::spread_table::SizePart;
use hairline_optics::table::ScratchTable;
use hairline_scene::{Scene, ScratchTables};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// What many scratches add up to, and the spectra of their populations.
#[derive(Clone, Debug)]
pub struct Bundles {
    /// The grids.
    pub index: Arc<BundleIndex>,
    tables: Vec<ScratchTable>,
    /// By object, class and the table of single scratches.
    places: HashMap<[usize; 3], usize>,
}

/// Sizes that differ by less than this share, as rounding does, are the same.
const ALIKE: f64 = 1e-5;

impl Bundles {
    /// Takes the grids of the scene's scratches, or builds them, and builds the tables, all cores at work; `tables` are those of
    /// single scratches.
    pub fn new(scene: &Scene, scratches: &ScratchIndex, tables: &ScratchTables) -> Self {
        let index = scratches.grids(scene);
        let mut wanted = Vec::new();
        for (o, object) in scene.objects.iter().enumerate() {
            let mut of_object: Vec<usize> = object
                .mesh
                .triangle_materials
                .iter()
                .map(|m| tables.materials[*m as usize].table as usize)
                .collect();
            of_object.sort_unstable();
            of_object.dedup();
            for class in 0..index.objects[o].classes.len() {
                wanted.extend(of_object.iter().map(|table| [o, class, *table]));
            }
        }
        let spread = |[object, class, table]: &[usize; 3]| {
            let sizes = &index.objects[*object].classes[*class].sizes;
            // Scratches that are all alike need no mean.
            let alike = |part: &SizePart| {
                let is_one = |size: f64| (size - 1.0).abs() <= ALIKE;
                is_one(part.width) && part.depths.iter().all(|depth| is_one(*depth))
            };
            if sizes.iter().all(alike) {
                return tables.tables[*table].clone();
            }
            tables.tables[*table].spread(sizes)
        };
        Self {
            tables: wanted.par_iter().map(spread).collect(),
            places: wanted.into_iter().zip(0..).collect(),
            index,
        }
    }

    /// The table of an object's class where the material's own is `table`, one that the object has.
    pub fn table(&self, object: usize, class: usize, table: usize) -> &ScratchTable {
        &self.tables[self.places[&[object, class, table]]]
    }

    /// All tables.
    pub fn tables(&self) -> &[ScratchTable] {
        &self.tables
    }

    /// The place of [`Self::table`] in [`Self::tables`]; none for a table that the object does not have.
    pub fn place(&self, object: usize, class: usize, table: usize) -> Option<usize> {
        self.places.get(&[object, class, table]).copied()
    }
}

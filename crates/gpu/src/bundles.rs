//! What many scratches add up to (docs/model.md, section 7) as texels: the grids of all objects in one array of 16 bytes each.
//! Twin: `shaders/bundles.wgsl`, which reads them.
//!
//! First a texel for each object, then whatever those point to. Coordinates of vertices are counted from a vertex near the
//! origin that uploaded positions are relative to, for the sake of the last digits of single precision.

use std::sync::Arc;

use glam::DVec3;
use hairline_index::ScratchIndex;
use hairline_index::bundles::{
    Bundle, BundleLevel, Bundles, ClassBundles, HEIGHT_CELLS, ObjectBundles, Vertex,
};
use hairline_optics::metal::Metal;
use hairline_optics::table::ScratchTable;
use hairline_scene::{Scene, ScratchTables};

use crate::error::Error;
use crate::rows;
use crate::transfer::Transfer;
use crate::upload::Source;

/// One texel.
type Texel = [u32; 4];

/// An empty slot of a hash table.
const EMPTY: u32 = u32::MAX;
/// Texels of a vertex. Twin: bundles.wgsl.
const BUNDLE_TEXELS: usize = size_of::<Bundle>() / size_of::<Texel>();

/// The grids on the device, and what they were made from.
pub(crate) struct UploadedBundles {
    pub rows: wgpu::TextureView,
    /// None where the method has no use for any.
    pub made: Option<Arc<Bundles>>,
    index: Arc<ScratchIndex>,
    spectra: SpectraKey,
    origin_m: DVec3,
}

/// What the spectra of populations are made from, beside the scratches: the metal of each table, and each material's table.
#[derive(Clone, PartialEq)]
struct SpectraKey {
    metals: Vec<Option<Metal>>,
    of_materials: Vec<u32>,
}

impl SpectraKey {
    fn of(tables: &ScratchTables) -> Self {
        Self {
            metals: tables.metals.clone(),
            of_materials: tables.materials.iter().map(|m| m.table).collect(),
        }
    }
}

impl UploadedBundles {
    /// What `last` has, if it was made from the same scratches; else builds the grids and writes them.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where not even the coarsest grids fit, [`Error::OutOfMemory`].
    pub async fn upload(
        transfer: &mut Transfer<'_>,
        source: &Source<'_>,
        origin_m: DVec3,
        last: Option<&Self>,
    ) -> Result<Self, Error> {
        let Source {
            scene,
            index,
            tables,
            method,
        } = *source;
        let wanted = method.gather.has_grids();
        let spectra = SpectraKey::of(tables);
        let is_like = |last: &Self| {
            Arc::ptr_eq(&last.index, index) && last.spectra == spectra && last.origin_m == origin_m
        };
        let same = |last: &&Self| last.made.is_some() == wanted && (!wanted || is_like(last));
        if let Some(last) = last.filter(same) {
            return Ok(Self {
                rows: last.rows.clone(),
                made: last.made.clone(),
                index: Arc::clone(index),
                spectra,
                origin_m,
            });
        }
        let made = wanted.then(|| Arc::new(Bundles::new(scene, index, tables)));
        let what = "grids of scratches";
        let texels = match &made {
            Some(bundles) => {
                let (_, allowed) = rows::bytes_and_allowed(transfer.gpu, 0, 1);
                let room = (allowed / size_of::<Texel>() as u64) as usize;
                let packed = pack(bundles, scene, tables, origin_m, room);
                packed.map_err(|needed| {
                    let (gpu, texel) = (transfer.gpu, size_of::<Texel>() as u64);
                    gpu.too_large(what, needed as u64 * texel, allowed, "bytes")
                })?
            }
            None => vec![[0; 4]],
        };
        Ok(Self {
            rows: rows::upload(transfer, what, &texels).await?,
            made,
            index: Arc::clone(index),
            spectra,
            origin_m,
        })
    }

    /// Whether both were made as one.
    pub fn same_as(&self, other: &Self) -> bool {
        match (&self.made, &other.made) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        }
    }

    /// Tables of classes, which follow those of single scratches.
    pub fn tables(&self) -> &[ScratchTable] {
        self.made.as_ref().map_or(&[], |made| made.tables())
    }
}

/// The texels, at most `room` of them: the finest grids are left out where all do not fit, and more scratches are then
/// found one by one. `Err` has how many texels the least takes.
fn pack(
    bundles: &Bundles,
    scene: &Scene,
    tables: &ScratchTables,
    origin_m: DVec3,
    room: usize,
) -> Result<Vec<Texel>, usize> {
    let most_levels = bundles.index.objects.iter().map(|o| o.level_count).max();
    let mut needed = 0;
    for skipped in 0..most_levels.unwrap_or(1).max(1) {
        needed = texel_count(bundles, tables, skipped);
        if needed <= room {
            return Ok(Packing::of(
                bundles, scene, tables, origin_m, skipped, needed,
            ));
        }
    }
    Err(needed)
}

/// Levels of an object from the one after `skipped` on; at least the coarsest.
fn levels_from(object: &ObjectBundles, skipped: usize) -> usize {
    skipped.min(object.level_count.saturating_sub(1))
}

fn texel_count(bundles: &Bundles, tables: &ScratchTables, skipped: usize) -> usize {
    let objects = bundles.index.objects.iter();
    let of_object = |object: &ObjectBundles| {
        let levels = object
            .classes
            .iter()
            .flat_map(|class| &class.levels[levels_from(object, skipped)..]);
        let of_levels: usize = levels
            .map(|level| 2 + slot_count(level) + BUNDLE_TEXELS * level.bundles.len())
            .sum();
        2 + object.classes.len() * (tables.tables.len() + 2) + of_levels
    };
    objects.map(of_object).sum()
}

/// A power of two, at least twice as many as there are vertices.
fn slot_count(level: &BundleLevel) -> usize {
    (2 * level.vertices.len()).next_power_of_two()
}

struct Packing {
    texels: Vec<Texel>,
    origin_m: DVec3,
}

impl Packing {
    fn of(
        bundles: &Bundles,
        scene: &Scene,
        tables: &ScratchTables,
        origin_m: DVec3,
        skipped: usize,
        count: usize,
    ) -> Vec<Texel> {
        let mut packing = Self {
            texels: Vec::with_capacity(count),
            origin_m,
        };
        packing.texels.resize(2 * scene.objects.len(), [0; 4]);
        for (o, object) in bundles.index.objects.iter().enumerate() {
            if object.classes.is_empty() {
                continue;
            }
            let first = levels_from(object, skipped);
            // Layers of the classes' tables, class by class; those of single scratches come before them.
            let layers = packing.texels.len();
            for class in 0..object.classes.len() {
                for table in 0..tables.tables.len() {
                    let place = bundles.place(o, class, table).unwrap_or(0);
                    let layer = tables.tables.len() + place;
                    packing.texels.push([layer as u32, 0, 0, 0]);
                }
            }
            let sizes = packing.texels.len();
            let size = |class: &ClassBundles| {
                let [low, high] = [class.range.low, class.range.high];
                // Shaders need not know infinities.
                let range = [low[0], low[1], high[0], high[1]].map(|x| x.clamp(-1e30, 1e30));
                let mean = [class.width_um, class.depth_nm, 0.0, 0.0];
                [mean, range].map(|texel| texel.map(f32::to_bits))
            };
            packing.texels.extend(object.classes.iter().flat_map(size));
            // Two texels for each level of each class, class by class.
            let heads = packing.texels.len();
            let level_count = object.level_count - first;
            let head_count = 2 * level_count * object.classes.len();
            packing.texels.resize(heads + head_count, [0; 4]);
            let mut head = heads;
            for class in &object.classes {
                for level in &class.levels[first..] {
                    let words = packing.level(level);
                    packing.texels[head..head + 2].copy_from_slice(&words);
                    head += 2;
                }
            }
            let cell_m = object.classes[0].levels[first].cell_m;
            // As many levels coarser.
            let dense_cell_m = object.dense_cell_m * (cell_m / object.cell_m);
            packing.texels[2 * o] = [
                object.classes.len() as u32,
                level_count as u32,
                cell_m.to_bits(),
                tables.tables.len() as u32,
            ];
            packing.texels[2 * o + 1] = [
                layers as u32,
                heads as u32,
                sizes as u32,
                dense_cell_m.to_bits(),
            ];
        }
        packing.texels
    }

    /// Writes the hash table and the vertices of a level; returns its head.
    fn level(&mut self, level: &BundleLevel) -> [Texel; 2] {
        let cell_m = f64::from(level.cell_m);
        // A whole number of steps of height, so that those stay what they are.
        let step = f64::from(HEIGHT_CELLS);
        let base = (self.origin_m / (cell_m * step)).floor() * step;
        let rest = self.origin_m / cell_m - base;
        let bases = base.as_ivec3();
        let moved = |vertex: &Vertex| {
            let [u, v, w] = hairline_index::bundles::Side(vertex.side).axes();
            Vertex {
                side: vertex.side,
                at: [vertex.at[0] - bases[u], vertex.at[1] - bases[v]],
                height: vertex.height - bases[w] / HEIGHT_CELLS as i32,
            }
        };
        // So many slots a search looks at, at most.
        let mut longest = 1;
        let slots = self.texels.len();
        let count = slot_count(level);
        self.texels.resize(slots + count, [0, 0, 0, EMPTY]);
        for (i, vertex) in level.vertices.iter().enumerate() {
            let vertex = moved(vertex);
            let first = vertex.hash() as usize;
            let mut away = 0;
            while self.texels[slots + ((first + away) & (count - 1))][3] != EMPTY {
                away += 1;
            }
            // One more: that an empty one ends it.
            longest = longest.max(away as u32 + 2);
            let slot = (first + away) & (count - 1);
            // A side is less than 8, and heights have room for twice a thousand kilometres of the finest cells.
            self.texels[slots + slot] = [
                vertex.at[0] as u32,
                vertex.at[1] as u32,
                vertex.side | (vertex.height as u32) << 3,
                i as u32,
            ];
        }
        let bundles = self.texels.len();
        for bundle in &level.bundles {
            let place_m = bundle.place_m.as_dvec3() - self.origin_m;
            let relative = Bundle {
                place_m: place_m.as_vec3(),
                ..*bundle
            };
            let texels: [Texel; BUNDLE_TEXELS] = bytemuck::cast(relative);
            self.texels.extend(texels);
        }
        let rest = rest.as_vec3().to_array().map(f32::to_bits);
        [
            [slots as u32, count as u32 - 1, bundles as u32, longest],
            [rest[0], rest[1], rest[2], level.cell_m.to_bits()],
        ]
    }
}

//! What many scratches add up to, place by place: at the vertices of square grids over the surface, each twice as coarse as the one
//! before, how much scratch lies there in which direction (docs/model.md, section 7).
//!
//! Scratches are splatted to vertices, bilinearly, and to directions, linearly. A tent of side h is the sum of tents of side h/2
//! with weights (1/2, 1, 1/2), so a coarser grid is made from the finer one and equals one made from the scratches. The grids
//! lie in the planes across the world's axes; a scratch belongs to the one of six sides that its normal leans to most, so the
//! two sides of a sheet never meet. Sheets above one another are told apart by their height in steps of four cells.
//!
//! Vertices that have no scratch do not exist: the others are found by a hash of their coordinates, in a table of open addresses.

mod sizes;
mod spectra;
mod splat;

pub use spectra::Bundles;

use crate::scratch_index::effective_segments;
use crate::watch::Watch;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use hairline_optics::spread_table::SizePart;
use hairline_scene::{GRID_SEGMENT_BYTES, Object, Scene};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Directions in a half circle.
pub const BUNDLE_BINS: usize = 128;
/// Heights of a vertex are kept in steps of so many cells.
pub const HEIGHT_CELLS: f32 = 4.0;

/// All scratches around a vertex: 27 texels of 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Bundle {
    /// World space, metres; the mean height on the surface.
    pub place_m: Vec3,
    /// Sum of width times length, weighted by the vertex's tent.
    pub weight_um2: f32,
    /// Mean normal, not of unit length where they differ.
    pub normal: Vec3,
    /// What a bin's 255 stands for, as a share of `weight_um2`.
    pub bin_scale: f32,
    /// What 127 stands for in `wider` and in `deeper`, as a share of `weight_um2`.
    pub moved_scales: [f32; 2],
    /// Nothing; a whole number of texels.
    pub unused: [f32; 2],
    /// How the weight is spread over directions: bin b stands for the angle pi b / 128 from [`Side::reference`].
    pub bins: [u8; BUNDLE_BINS],
    /// The same, each scratch times the share by which it is wider than the class's mean.
    pub wider: [i8; BUNDLE_BINS],
    /// And deeper.
    pub deeper: [i8; BUNDLE_BINS],
}

/// One of the six sides that normals lean to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side(pub u32);

impl Side {
    /// All of them.
    pub const ALL: [Self; 6] = [Self(0), Self(1), Self(2), Self(3), Self(4), Self(5)];

    /// The side of a normal.
    pub fn of(normal: Vec3) -> Self {
        let size = normal.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        Self(2 * axis + u32::from(normal[axis as usize] < 0.0))
    }

    /// The world's axes along the grid's two coordinates and the height.
    pub fn axes(self) -> [usize; 3] {
        match self.0 / 2 {
            0 => [1, 2, 0],
            1 => [2, 0, 1],
            _ => [0, 1, 2],
        }
    }

    /// How far a normal leans to this side.
    pub fn lean(self, normal: Vec3) -> f32 {
        let up = normal[self.axes()[2]];
        if self.0.is_multiple_of(2) { up } else { -up }
    }

    /// The direction across a normal that directions are measured from.
    pub fn reference(self, normal: Vec3) -> Vec3 {
        let axis = Vec3::AXES[self.axes()[0]];
        (axis - normal * normal.dot(axis)).normalize_or(axis)
    }
}

/// Where a vertex lies in its grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Vertex {
    /// The side as a number.
    pub side: u32,
    /// Both coordinates, in cells.
    pub at: [i32; 2],
    /// Height in steps of [`HEIGHT_CELLS`].
    pub height: i32,
}

impl Vertex {
    /// What a table of open addresses begins a search at, but for its size. Twin: bundles.wgsl.
    pub fn hash(self) -> u32 {
        // Mixing by H. Prospector's 32-bit constants ("lowbias32"), one coordinate after the other.
        let mut hash = self.side;
        for word in [self.at[0] as u32, self.at[1] as u32, self.height as u32] {
            hash = (hash ^ word).wrapping_mul(0x7feb_352d);
            hash = (hash ^ (hash >> 15)).wrapping_mul(0x846c_a68b);
            hash ^= hash >> 16;
        }
        hash
    }
}

/// An empty slot of the table.
const EMPTY: u32 = u32::MAX;

/// One grid.
#[derive(Clone, Debug, Default)]
pub struct BundleLevel {
    /// Side of a cell.
    pub cell_m: f32,
    /// The vertices that have scratches, and what they have.
    pub vertices: Vec<Vertex>,
    /// Side by side with `vertices`.
    pub bundles: Vec<Bundle>,
    /// Indices into `bundles`, or `u32::MAX`; a power of two of them. A vertex is in the first slot from its hash on that has
    /// it; an empty one ends the search.
    slots: Vec<u32>,
}

impl BundleLevel {
    fn new(cell_m: f32, mut vertices: Vec<Vertex>, mut bundles: Vec<Bundle>) -> Self {
        // They grew piece by piece, to up to twice their size.
        vertices.shrink_to_fit();
        bundles.shrink_to_fit();
        let mut slots = vec![EMPTY; (2 * vertices.len()).next_power_of_two()];
        let mask = slots.len() - 1;
        for (i, vertex) in vertices.iter().enumerate() {
            let mut slot = vertex.hash() as usize & mask;
            while slots[slot] != EMPTY {
                slot = (slot + 1) & mask;
            }
            slots[slot] = i as u32;
        }
        Self {
            cell_m,
            vertices,
            bundles,
            slots,
        }
    }

    /// What lies at a vertex.
    #[inline]
    pub fn find(&self, vertex: Vertex) -> Option<&Bundle> {
        let mask = self.slots.len() - 1;
        let mut slot = vertex.hash() as usize & mask;
        loop {
            let index = self.slots[slot];
            if index == EMPTY {
                return None;
            }
            if self.vertices[index as usize] == vertex {
                return Some(&self.bundles[index as usize]);
            }
            slot = (slot + 1) & mask;
        }
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.vertices) + size_of_val(&*self.bundles) + size_of_val(&*self.slots)
    }
}

/// Widths (um) and depths (nm) from `low` on and below `high`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SizeRange {
    /// Of the range.
    pub low: [f32; 2],
    /// Not of the range.
    pub high: [f32; 2],
}

impl SizeRange {
    /// Whether a width and a depth are of the range.
    pub fn holds(&self, size: [f32; 2]) -> bool {
        (0..2).all(|i| self.low[i] <= size[i] && size[i] < self.high[i])
    }
}

/// The grids of one class of scratches, from fine to coarse, each twice as coarse as the one before.
#[derive(Clone, Debug, Default)]
pub struct ClassBundles {
    /// Not empty.
    pub levels: Vec<BundleLevel>,
    /// Mean width, weighted by area like the next.
    pub width_um: f32,
    /// Mean depth.
    pub depth_nm: f32,
    /// Whose scratches these are.
    pub range: SizeRange,
    /// Widths and depths that stand for the class's.
    pub sizes: Vec<SizePart>,
}

/// The grids of all scratches of an object.
#[derive(Clone, Debug, Default)]
pub struct ObjectBundles {
    /// Side of the finest grid's cells, the same for all classes.
    pub cell_m: f32,
    /// What that would be however long scratches are: it tells from which footprints on they are so many that adding them up may pay.
    pub dense_cell_m: f32,
    /// How many levels each class has.
    pub level_count: usize,
    /// Scratches of like sizes together.
    pub classes: Vec<ClassBundles>,
}

impl ObjectBundles {
    /// The class of a scratch.
    pub fn class_of(&self, width_um: f32, depth_nm: f32) -> usize {
        let size = [width_um, depth_nm];
        let mut classes = self.classes.iter();
        classes.position(|c| c.range.holds(size)).unwrap_or(0)
    }
}

/// The grids of all objects of a scene.
#[derive(Clone, Debug, Default)]
pub struct BundleIndex {
    /// One for each object.
    pub objects: Vec<ObjectBundles>,
}

/// Into how many classes of size an object's scratches are parted at most.
pub const CLASSES_MAX: usize = 4;
/// So many scratches cross a cell of the finest grid, in the mean. The fewer, the more the lit ones of a footprint differ from the
/// mean of their class.
const CELL_SCRATCHES: f64 = 25.0;
/// A scratch crosses about so many cells of the finest grid at most: each crossing has to be splatted, and with cells that only shrink
/// as scratches become more, the time that grids take would grow faster than they do.
const SCRATCH_CELLS: f64 = 16.0;
/// No footprint is narrower than the coherence window.
const CELL_MIN_M: f64 = 16e-6;
/// The coarsest grid has about so many cells.
const COARSEST_CELLS: f64 = 64.0;

impl BundleIndex {
    /// Builds the grids, all cores at work; the same for any number of them.
    pub fn build(scene: &Scene) -> Self {
        Self::watched(scene, &Watch::default()).unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// The same while another watches. `None` if it was cancelled.
    pub fn watched(scene: &Scene, watch: &Watch) -> Option<Self> {
        let account = Account {
            watch,
            all: scene.objects.iter().map(|o| o.segments.len()).sum(),
            done: AtomicUsize::new(0),
        };
        let objects = scene.objects.iter();
        let objects = objects.map(|object| build_object(scene, object, &account));
        let index = Self {
            objects: objects.collect(),
        };
        // What was left out makes no grid.
        (!(watch.cancelled)()).then(|| {
            (watch.progress)(1.0);
            index
        })
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        let classes = self.objects.iter().flat_map(|o| &o.classes);
        classes
            .flat_map(|class| &class.levels)
            .map(BundleLevel::bytes)
            .sum()
    }
}

/// How far the work on all segments has come.
struct Account<'a> {
    watch: &'a Watch<'a>,
    all: usize,
    done: AtomicUsize,
}

/// Of all the work, what the finest grids take.
const FINEST_SHARE: f64 = 0.8;

impl Account<'_> {
    /// Notes that segments have been splatted. Whether to go on.
    fn add(&self, segments: usize) -> bool {
        let done = self.done.fetch_add(segments, Ordering::Relaxed) + segments;
        let share = done as f64 / self.all.max(1) as f64;
        (self.watch.progress)(FINEST_SHARE * share.min(1.0));
        !(self.watch.cancelled)()
    }
}

fn build_object(scene: &Scene, object: &Object, account: &Account) -> ObjectBundles {
    let segments = effective_segments(scene, object);
    if segments.is_empty() {
        return ObjectBundles::default();
    }
    let classes = sizes::classes(segments, CLASSES_MAX);
    let area_m2 = area_m2(object);
    let [dense_cell_m, cell_m] = finest_cells_m(object, area_m2, classes.len());
    let level_count = level_count(area_m2, cell_m);
    let classes = classes
        .into_par_iter()
        .map(|class| {
            let segments = class.segments;
            let mean = sizes::mean(&segments);
            let mut levels = vec![splat::finest(&segments, mean, cell_m, account)];
            while levels.len() < level_count {
                let coarser = splat::coarser(&levels[levels.len() - 1]);
                levels.push(coarser);
            }
            let [width_um, depth_nm] = mean;
            ClassBundles {
                levels,
                width_um,
                depth_nm,
                range: class.range,
                sizes: sizes::representative(&segments),
            }
        })
        .collect();
    ObjectBundles {
        cell_m,
        dense_cell_m,
        level_count,
        classes,
    }
}

/// The side of the finest cells: [`ObjectBundles::dense_cell_m`], [`ObjectBundles::cell_m`]. Each is a power of two in micrometres: it
/// stays what it is when a layer changes a little.
fn finest_cells_m(object: &Object, area_m2: f64, classes: usize) -> [f32; 2] {
    let length_m: f64 = object
        .segments
        .iter()
        .map(|s| s.start_m.distance(s.end_m) as f64)
        .sum();
    let by_scratches = CELL_SCRATCHES * area_m2 / length_m.max(1e-9);
    let mean_length_m = length_m / object.scratches.len().max(1) as f64;
    let by_crossings = mean_length_m / SCRATCH_CELLS;
    // Coarser levels add a third; hash and coordinates a tenth.
    let bundle_bytes = 1.5 * size_of::<Bundle>() as f64 * classes as f64;
    // What the estimate of a scene's memory counts on.
    let bytes = GRID_SEGMENT_BYTES as f64 * object.segments.len() as f64;
    let most = (bytes / bundle_bytes).max(1.0);
    let by_memory = (area_m2 / most).sqrt();
    let octave = |cell_m: f64| (1e6 * cell_m.max(CELL_MIN_M)).log2();
    // The memory stays within its bound.
    let dense = octave(by_scratches).round().max(octave(by_memory).ceil());
    let cell = dense.max(octave(by_crossings).round());
    [dense, cell].map(|octave| (octave.exp2() * 1e-6) as f32)
}

/// From the finest cells to the coarsest.
fn level_count(area_m2: f64, cell_m: f32) -> usize {
    let across = (area_m2 / COARSEST_CELLS).sqrt() / f64::from(cell_m);
    across.log2().ceil().max(0.0) as usize + 1
}

fn area_m2(object: &Object) -> f64 {
    let mesh = &object.mesh;
    mesh.triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| mesh.positions_m[v as usize].as_dvec3());
            0.5 * (b - a).cross(c - a).length()
        })
        .sum()
}

/// Splits sorted items into runs of equal keys.
fn runs<T>(items: &[T], key: impl Fn(&T) -> u64) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for i in 1..=items.len() {
        if i == items.len() || key(&items[i]) != key(&items[start]) {
            runs.push(start..i);
            start = i;
        }
    }
    runs
}

#[cfg(test)]
mod tests;

//! From scratches to the finest grid, and from a grid to the next one. Tiles of vertices are filled one by one, each by one thread
//! with all that touches it, in a fixed order.

use super::{Account, BUNDLE_BINS, Bundle, BundleLevel, HEIGHT_CELLS, Side, Vertex, runs};
use crate::scratch_index::IndexedSegment;
use glam::Vec3;
use rayon::prelude::*;

/// Vertices along the side of a tile, as a power of two: half a megabyte for all of them, which stays in a core's own cache.
const TILE_BITS: u32 = 4;
const TILE: usize = 1 << TILE_BITS;
/// Steps along a scratch for each cell. Footprints are wide enough to blur them: exp(-2 pi^2 0.64) is left of their rhythm.
const STEPS_PER_CELL: f32 = 1.0;

/// A tile as one number that orders by side, then by place.
fn tile_key(side: u32, at: [i32; 2]) -> u64 {
    let [x, y] = at.map(|i| u64::from(((i >> TILE_BITS) + (1 << 28)) as u32));
    (u64::from(side) << 60) | (x << 30) | y
}

/// Vertices of one tile while they are filled.
struct Tile {
    side: u32,
    /// The least coordinates of its vertices.
    low: [i32; 2],
    /// The first of the bundles at each place, plus one; further ones by `next`.
    first: Vec<u32>,
    next: Vec<u32>,
    vertices: Vec<Vertex>,
    sums: Vec<Sums>,
}

#[derive(Clone)]
struct Sums {
    weight: f32,
    height_m: f32,
    normal: Vec3,
    /// Weight, and that times how much wider and deeper; the fourth is nothing, so that an addition is one of vectors.
    bins: [[f32; 4]; BUNDLE_BINS],
}

impl Tile {
    /// The tile of a vertex.
    fn of(side: u32, at: [i32; 2]) -> Self {
        Self {
            side,
            low: at.map(|i| i >> TILE_BITS << TILE_BITS),
            first: vec![0; TILE * TILE],
            next: Vec::new(),
            vertices: Vec::new(),
            sums: Vec::new(),
        }
    }

    /// The sums at a vertex of its side, if it is of this tile.
    #[inline]
    fn at(&mut self, at: [i32; 2], height: i32) -> Option<&mut Sums> {
        let [x, y] = [0, 1].map(|i| at[i].wrapping_sub(self.low[i]) as usize);
        if x >= TILE || y >= TILE {
            return None;
        }
        let place = y * TILE + x;
        let mut index = self.first[place];
        while index != 0 && self.vertices[index as usize - 1].height != height {
            index = self.next[index as usize - 1];
        }
        if index == 0 {
            index = self.begin(place, at, height);
        }
        Some(&mut self.sums[index as usize - 1])
    }

    #[cold]
    fn begin(&mut self, place: usize, at: [i32; 2], height: i32) -> u32 {
        self.vertices.push(Vertex {
            side: self.side,
            at,
            height,
        });
        self.next.push(self.first[place]);
        self.sums.push(Sums {
            weight: 0.0,
            height_m: 0.0,
            normal: Vec3::ZERO,
            bins: [[0.0; 4]; BUNDLE_BINS],
        });
        self.first[place] = self.vertices.len() as u32;
        self.first[place]
    }

    fn bundles(self, cell_m: f32) -> Vec<(Vertex, Bundle)> {
        let both = self.vertices.into_iter().zip(&self.sums);
        both.filter(|(_, sums)| sums.weight > 0.0)
            .map(|(vertex, sums)| (vertex, sums.bundle(vertex, cell_m)))
            .collect()
    }
}

impl Sums {
    fn bundle(&self, vertex: Vertex, cell_m: f32) -> Bundle {
        let per_weight = 1.0 / self.weight;
        let [u, v, w] = Side(vertex.side).axes();
        let mut place_m = Vec3::ZERO;
        place_m[u] = vertex.at[0] as f32 * cell_m;
        place_m[v] = vertex.at[1] as f32 * cell_m;
        place_m[w] = self.height_m * per_weight;
        let most = |kind: usize| self.bins.iter().fold(0.0, |m: f32, b| m.max(b[kind].abs()));
        let most_bin = most(0);
        let signed = |kind: usize| {
            let most = most(kind);
            let per_most = if most > 0.0 { 127.0 / most } else { 0.0 };
            // Of a positive number the part before the point.
            let bins = self
                .bins
                .map(|b| (b[kind] * per_most + 128.5) as i32 as i8 ^ i8::MIN);
            (bins, most * per_weight)
        };
        let (wider, widest) = signed(1);
        let (deeper, deepest) = signed(2);
        Bundle {
            place_m,
            weight_um2: self.weight,
            normal: self.normal * per_weight,
            bin_scale: most_bin * per_weight,
            moved_scales: [widest, deepest],
            unused: [0.0; 2],
            bins: self.bins.map(|b| (b[0] * (255.0 / most_bin) + 0.5) as u8),
            wider,
            deeper,
        }
    }
}

/// A vertex of the tile of a key, and its side.
fn tile_of(key: u64) -> (u32, [i32; 2]) {
    let place = |shift: u32| (((key >> shift) & 0x3fff_ffff) as i32 - (1 << 28)) << TILE_BITS;
    ((key >> 60) as u32, [place(30), place(0)])
}

/// Fills all tiles: `items` are what touches each, by tile and then in order. Is told after each tile how many of them were its, and
/// leaves the rest empty where it is not to go on.
fn fill(
    mut items: Vec<(u64, u32)>,
    cell_m: f32,
    goes_on: &(dyn Fn(usize) -> bool + Sync),
    add: impl Fn(&mut Tile, usize) + Sync,
) -> BundleLevel {
    items.par_sort_unstable();
    let tiles: Vec<Vec<(Vertex, Bundle)>> = runs(&items, |item| item.0)
        .into_par_iter()
        .map(|run| {
            let (side, at) = tile_of(items[run.start].0);
            let mut tile = Tile::of(side, at);
            if !goes_on(run.len()) {
                return Vec::new();
            }
            for (_, item) in &items[run] {
                add(&mut tile, *item as usize);
            }
            tile.bundles(cell_m)
        })
        .collect();
    let (vertices, bundles) = tiles.into_iter().flatten().unzip();
    BundleLevel::new(cell_m, vertices, bundles)
}

/// The tiles of all vertices within a rectangle.
fn tiles_between(side: u32, low: [i32; 2], high: [i32; 2]) -> impl Iterator<Item = u64> {
    let [xs, ys] = [0, 1].map(|i| (low[i] >> TILE_BITS)..=(high[i] >> TILE_BITS));
    xs.flat_map(move |x| {
        ys.clone()
            .map(move |y| tile_key(side, [x << TILE_BITS, y << TILE_BITS]))
    })
}

/// The finest grid. `mean` is the class's mean width (um) and depth (nm).
pub(super) fn finest(
    segments: &[IndexedSegment],
    mean: [f32; 2],
    cell_m: f32,
    account: &Account,
) -> BundleLevel {
    let per_cell = 1.0 / cell_m;
    let items: Vec<(u64, u32)> = segments
        .par_iter()
        .enumerate()
        .flat_map_iter(|(i, segment)| {
            let side = Side::of(segment.normal);
            let [u, v, _] = side.axes();
            let (a, b) = (
                segment.start_m.min(segment.end_m),
                segment.start_m.max(segment.end_m),
            );
            let low = [a[u], a[v]].map(|x| (x * per_cell).floor() as i32);
            let high = [b[u], b[v]].map(|x| (x * per_cell).floor() as i32 + 1);
            tiles_between(side.0, low, high).map(move |key| (key, i as u32))
        })
        .collect();
    // A segment counts for the tiles that it touches.
    let each = segments.len() as f64 / items.len().max(1) as f64;
    let goes_on = |items: usize| account.add((items as f64 * each) as usize);
    fill(items, cell_m, &goes_on, |tile, i| {
        splat(tile, &segments[i], mean, cell_m);
    })
}

fn splat(tile: &mut Tile, segment: &IndexedSegment, mean: [f32; 2], cell_m: f32) {
    let over = |size: f32, mean: f32| if mean > 0.0 { size / mean - 1.0 } else { 0.0 };
    let wider = over(segment.width_um, mean[0]);
    let deeper = over(segment.depth_nm, mean[1]);
    let side = Side::of(segment.normal);
    let [u, v, w] = side.axes();
    let along = segment.end_m - segment.start_m;
    let length_m = along.length();
    let steps = (length_m / cell_m * STEPS_PER_CELL).ceil().max(1.0);
    let per_step = 1.0 / steps;
    let weight = segment.width_um * length_m * 1e6 * per_step;
    let n = segment.normal;
    let reference = side.reference(n);
    let angle = along.dot(n.cross(reference)).atan2(along.dot(reference));
    let bin = angle.rem_euclid(std::f32::consts::PI) / std::f32::consts::PI * BUNDLE_BINS as f32;
    let low_bin = bin as usize % BUNDLE_BINS;
    let high_share = bin.fract();
    let bins = [
        (low_bin, 1.0 - high_share),
        ((low_bin + 1) % BUNDLE_BINS, high_share),
    ];
    let per_cell = 1.0 / cell_m;
    let rise = [u, v].map(|axis| -n[axis] / n[w] * cell_m);
    for step in 0..steps as u32 {
        let place = segment.start_m + along * ((step as f32 + 0.5) * per_step);
        let (x, y) = (place[u] * per_cell, place[v] * per_cell);
        let height = whole(place[w] * per_cell / HEIGHT_CELLS + 0.5);
        let corner = [whole(x), whole(y)];
        let [fx, fy] = [x - corner[0] as f32, y - corner[1] as f32];
        for (dx, dy, tent) in [
            (0, 0, (1.0 - fx) * (1.0 - fy)),
            (1, 0, fx * (1.0 - fy)),
            (0, 1, (1.0 - fx) * fy),
            (1, 1, fx * fy),
        ] {
            if let Some(sums) = tile.at([corner[0] + dx, corner[1] + dy], height) {
                let weight = weight * tent;
                sums.weight += weight;
                // The height of the surface over the vertex itself.
                let aside = rise[0] * (dx as f32 - fx) + rise[1] * (dy as f32 - fy);
                sums.height_m += weight * (place[w] + aside);
                sums.normal += weight * n;
                for (bin, share) in bins {
                    let (sum, weight) = (&mut sums.bins[bin], weight * share);
                    for (sum, moved) in sum.iter_mut().zip([1.0, wider, deeper, 0.0]) {
                        *sum += weight * moved;
                    }
                }
            }
        }
    }
}

/// The whole number at or below: `floor` is a call where processors are not known to have it.
#[inline]
fn whole(x: f32) -> i32 {
    let towards_zero = x as i32;
    towards_zero - i32::from(x < towards_zero as f32)
}

/// The grid that is twice as coarse.
pub(super) fn coarser(fine: &BundleLevel) -> BundleLevel {
    let cell_m = 2.0 * fine.cell_m;
    let items: Vec<(u64, u32)> = fine
        .vertices
        .par_iter()
        .enumerate()
        .flat_map_iter(|(i, vertex)| {
            let low = vertex.at.map(|x| x.div_euclid(2));
            let high = vertex.at.map(|x| (x + 1).div_euclid(2));
            tiles_between(vertex.side, low, high).map(move |key| (key, i as u32))
        })
        .collect();
    fill(items, cell_m, &|_| true, |tile, i| {
        let (vertex, bundle) = (fine.vertices[i], &fine.bundles[i]);
        let halves = |x: i32| {
            let (low, high) = (x.div_euclid(2), (x + 1).div_euclid(2));
            let both = [(low, 0.5), (high, 0.5)];
            if low == high {
                [(low, 1.0), (low, 0.0)]
            } else {
                both
            }
        };
        for (x, x_share) in halves(vertex.at[0]) {
            for (y, y_share) in halves(vertex.at[1]) {
                if x_share * y_share == 0.0 {
                    continue;
                }
                if let Some(sums) = tile.at([x, y], (vertex.height + 1).div_euclid(2)) {
                    let weight = x_share * y_share * bundle.weight_um2;
                    let [u, v, w] = Side(vertex.side).axes();
                    let n = bundle.normal;
                    let aside = [
                        x as f32 * cell_m - bundle.place_m[u],
                        y as f32 * cell_m - bundle.place_m[v],
                    ];
                    let rise = -(n[u] * aside[0] + n[v] * aside[1]) / n[w];
                    sums.weight += weight;
                    sums.height_m += weight * (bundle.place_m[w] + rise);
                    sums.normal += weight * n;
                    let [wider, deeper] = bundle.moved_scales.map(|s| weight * s / 127.0);
                    let scale = weight * bundle.bin_scale / 255.0;
                    for (b, sum) in sums.bins.iter_mut().enumerate() {
                        sum[0] += scale * f32::from(bundle.bins[b]);
                        sum[1] += wider * f32::from(bundle.wider[b]);
                        sum[2] += deeper * f32::from(bundle.deeper[b]);
                    }
                }
            }
        }
    })
}

// What many scratches add up to: grids over the surfaces, as texels. Twins: src/bundles.rs writes them, index/src/bundles.rs
// says what they mean.

// Directions in a half circle.
const BUNDLE_BINS: u32 = 128u;
// Texels of a vertex; its directions begin at the fourth, 16 to a texel: shares, then those times how much wider, then how much
// deeper what lies there is.
const BUNDLE_TEXELS: u32 = 27u;
const BUNDLE_BIN_TEXELS: u32 = 8u;
// Heights of vertices are kept in steps of so many cells.
const BUNDLE_HEIGHT_CELLS: f32 = 4.0;
// No vertex.
const BUNDLE_NONE: u32 = 0xffffffffu;

fn bundle_texel(i: u32) -> vec4u {
    return textureLoad(bundle_rows, row_texel(i), 0);
}

// The grids of an object. Its scratches are parted into populations, each with grids of its own.
struct BundleGrids {
    populations: u32,           // 0: there are no grids
    levels: u32,                // each twice as coarse as the one before
    cell_m: f32,                // side of the finest cells
    tables: u32,
    first_layer: u32,           // texels of the populations' tables
    first_level: u32,           // texels of the levels
    first_size: u32,            // texels of the populations' mean widths and depths
    dense_cell_m: f32,          // side of the finest cells if scratches were short
}

fn bundle_grids(object: u32) -> BundleGrids {
    let a = bundle_texel(2u * object);
    let b = bundle_texel(2u * object + 1u);
    return BundleGrids(a.x, a.y, bitcast<f32>(a.z), a.w, b.x, b.y, b.z, bitcast<f32>(b.w));
}

// The layer of the scratch tables that holds a population's spectrum on a material whose own table is `table`.
fn bundle_table(grids: BundleGrids, population: u32, table: u32) -> u32 {
    return bundle_texel(grids.first_layer + population * grids.tables + table).x;
}

// Mean width (um) and depth (nm) of a population.
fn bundle_size(grids: BundleGrids, population: u32) -> vec2f {
    return bitcast<vec2f>(bundle_texel(grids.first_size + 2u * population).xy);
}

// The population of a width and a depth: its range begins with these and ends before those.
fn bundle_population(grids: BundleGrids, size: vec2f) -> u32 {
    for (var i = 0u; i < grids.populations; i += 1u) {
        gather_rounds += 1u;
        let range = bitcast<vec4f>(bundle_texel(grids.first_size + 2u * i + 1u));
        if all(range.xy <= size) && all(size < range.zw) {
            return i;
        }
    }
    return 0u;
}

// One grid of a population.
struct BundleLevel {
    first_slot: u32,            // texels of a hash table with open addresses
    slot_mask: u32,
    first_vertex: u32,
    longest: u32,               // slots that are looked at for a vertex, at most
    rest: vec3f,                // where the origin of positions lies, in cells from the vertex (0, 0) at height 0
    cell_m: f32,
}

fn bundle_level(grids: BundleGrids, population: u32, level: u32) -> BundleLevel {
    let first = grids.first_level + 2u * (population * grids.levels + level);
    let a = bundle_texel(first);
    let b = bitcast<vec4f>(bundle_texel(first + 1u));
    return BundleLevel(a.x, a.y, a.z, a.w, b.xyz, b.w);
}

// By H. Prospector's 32-bit constants ("lowbias32"), one coordinate after the other.
fn bundle_hash(side: u32, at: vec2i, height: i32) -> u32 {
    let words = vec3u(bitcast<vec2u>(at), bitcast<u32>(height));
    var hash = side;
    for (var i = 0u; i < 3u; i += 1u) {
        hash = (hash ^ words[i]) * 0x7feb352du;
        hash = (hash ^ (hash >> 15u)) * 0x846ca68bu;
        hash = hash ^ (hash >> 16u);
    }
    return hash;
}

// The first texel of a vertex, or BUNDLE_NONE.
fn bundle_find(level: BundleLevel, side: u32, at: vec2i, height: i32) -> u32 {
    let key = vec3u(bitcast<vec2u>(at), side | (bitcast<u32>(height) << 3u));
    var slot = bundle_hash(side, at, height);
    gather_rounds += 3u;
    for (var i = 0u; i < level.longest; i += 1u) {
        gather_rounds += 1u;
        let texel = bundle_texel(level.first_slot + (slot & level.slot_mask));
        if texel.w == BUNDLE_NONE {
            break;
        }
        if all(texel.xyz == key) {
            return level.first_vertex + BUNDLE_TEXELS * texel.w;
        }
        slot += 1u;
    }
    return BUNDLE_NONE;
}

// Sides are six, to which normals lean: two to each of the world's axes, the second one against it.
const BUNDLE_SIDES: u32 = 6u;

// A vector's components along a side's grid, and, third, along its axis.
fn bundle_turned(side: u32, v: vec3f) -> vec3f {
    return select(select(v.xyz, v.zxy, side / 2u == 1u), v.yzx, side / 2u == 0u);
}

// The side of a normal.
fn bundle_side(normal: vec3f) -> u32 {
    let size = abs(normal);
    let axis = select(select(2u, 1u, size.y >= size.z), 0u, size.x >= size.y && size.x >= size.z);
    return 2u * axis + u32(normal[axis] < 0.0);
}

// How far a normal leans to a side.
fn bundle_lean(side: u32, normal: vec3f) -> f32 {
    let along = bundle_turned(side, normal).z;
    return select(along, -along, (side & 1u) == 1u);
}

// The direction across a normal that directions of a side are measured from.
fn bundle_reference(side: u32, normal: vec3f) -> vec3f {
    // The first of the grid's axes.
    let axis = select(select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 0.0, 1.0), side / 2u == 1u), vec3f(0.0, 1.0, 0.0), side / 2u == 0u);
    return surface_normalize_or(axis - normal * dot(normal, axis), axis);
}

// What the pixels of a tile need to know of a scratch that passes through it: a record, as texels hold it.
//
// A pixel's share of a scratch is a product of functions of two lengths, which are affine on the tile's plane. What the scratch
// sends is known at a few stations along it, as many as it changes, and pixels take what lies between.

// Texels of a tile before all records: how many it has and where, and its plane.
const RECORD_HEAD: u32 = 1u + PLANE_TEXELS;
// In place of how many: pixels walk for themselves, there was no room.
const RECORDS_NONE: u32 = 0xffffffffu;
// In place of half of the share on the line: pixels look at the scratch for themselves.
const RECORD_LEFT: f32 = -1.0;
// Most places along a scratch at which its light is known.
const RECORD_STATIONS: u32 = 5u;
// Of a scratch: across, along, the rest, its stations.
const RECORD_TEXELS: u32 = 3u + RECORD_STATIONS;
// A block of scratches: its texels of the list, then the records.
const RECORD_BLOCK_TEXELS: u32 = TILE_BLOCK * (1u + RECORD_TEXELS);

struct Record {
    // Across it: constant and change by place on the plane of the distance over sqrt(2) standard deviations, and half of the share
    // on the line.
    across: vec4f,
    // Along it: constant and change of the distance from the first station in units of the blur, and where the segment begins.
    along: vec4f,
    end: f32,                   // where it ends
    steps: f32,                 // stations to a unit
    last: f32,                  // number of the last station
    energy: vec3f,              // what it takes from the base
}

// The first texel of entry `i`'s record, from the first of its tile.
fn record_texel(i: u32) -> u32 {
    return i / TILE_BLOCK * RECORD_BLOCK_TEXELS + TILE_BLOCK + i % TILE_BLOCK * RECORD_TEXELS;
}

// The texel of the list for entry `i`, from the same place.
fn record_list_texel(i: u32) -> u32 {
    return i / TILE_BLOCK * RECORD_BLOCK_TEXELS + i % TILE_BLOCK;
}

fn record_rest(record: Record) -> vec4u {
    return vec4u(
        pack2x16float(record.energy.xy),
        pack2x16float(vec2f(record.energy.z, record.last)),
        bitcast<u32>(record.end),
        bitcast<u32>(record.steps),
    );
}

fn record_from_texels(across: vec4u, along: vec4u, rest: vec4u) -> Record {
    let energy_last = unpack2x16float(rest.y);
    return Record(
        bitcast<vec4f>(across),
        bitcast<vec4f>(along),
        bitcast<f32>(rest.z),
        bitcast<f32>(rest.w),
        energy_last.y,
        vec3f(unpack2x16float(rest.x), energy_last.x),
    );
}

// Where the records of parts of scratches lie, and which are wanted.
//
// Behind all else of the queues follow: how many parts there are; five words for each tile, the plane that it sees; a word for each
// straight piece, the number of its first part and in the upper bits how many follow; three words for each part: its piece, which part
// of how many it is, and a tile that wants it. Twin: src/tile_room.rs.

// The queue that the parts' workgroups are counted in.
const QUEUE_RECORDS: u32 = 5u;
// Invocations that share a workgroup: so many as a processor runs in step.
override RECORD_LANES: u32 = 32u;
// Parts that an invocation works on at once.
const RECORDS: u32 = 16u;
// In place of the number of a part, where there is none.
const RECORD_NONE: u32 = 0xffffffffu;
// Of the number of a part: there is room for fewer. Pieces have no more parts than the other bits count.
const RECORD_BITS: u32 = 26u;

// A part of a straight piece.
struct ScratchPart {
    segment: u32,
    part: u32,
    parts: u32,
    tile: u32,                  // + 1; 0 if no tile wants it
}

fn record_counted() -> u32 {
    let tiles = tile_counts();
    return (QUEUES + 2u) * tiles.x * tiles.y + 1u;
}

fn record_plane_word(tile: u32) -> u32 {
    return record_counted() + 1u + 5u * tile;
}

fn record_piece_word(segment: u32) -> u32 {
    let tiles = tile_counts();
    return record_plane_word(tiles.x * tiles.y) + segment;
}

fn record_part_word(i: u32) -> u32 {
    return record_piece_word(frame.record_segments) + 3u * i;
}

fn record_room() -> u32 {
    return (arrayLength(&queues.tiles) - record_part_word(0u)) / 3u;
}

// What a tile's pixels see, where it is a plane.
struct RecordPlane {
    normal: vec3f,
    coherence_um: f32,
    table: u32,
}

fn record_set_plane(tile: u32, normal: vec3f, coherence_um: f32, table: u32) {
    let word = record_plane_word(tile);
    atomicStore(&queues.tiles[word], bitcast<u32>(normal.x));
    atomicStore(&queues.tiles[word + 1u], bitcast<u32>(normal.y));
    atomicStore(&queues.tiles[word + 2u], bitcast<u32>(normal.z));
    atomicStore(&queues.tiles[word + 3u], bitcast<u32>(coherence_um));
    atomicStore(&queues.tiles[word + 4u], table);
}

fn record_plane(tile: u32) -> RecordPlane {
    let word = record_plane_word(tile);
    let x = atomicLoad(&queues.tiles[word]);
    let y = atomicLoad(&queues.tiles[word + 1u]);
    let z = atomicLoad(&queues.tiles[word + 2u]);
    let coherence_um = atomicLoad(&queues.tiles[word + 3u]);
    return RecordPlane(bitcast<vec3f>(vec3u(x, y, z)), bitcast<f32>(coherence_um), atomicLoad(&queues.tiles[word + 4u]));
}

// The texel of a part's record, behind all lists.
fn record_at(number: u32) -> u32 {
    return tile_chunk_texel(frame.tile_chunks) + RECORD_TEXELS * number;
}

// How many parts there are.
fn record_count() -> u32 {
    return min(atomicLoad(&queues.tiles[record_counted()]), record_room());
}

// The number of a piece's part at a share of its length, or RECORD_NONE.
fn record_number(segment: u32, share: f32) -> u32 {
    let word = record_piece_word(min(segment, max(frame.record_segments, 1u) - 1u));
    let first = atomicLoad(&queues.tiles[word]);
    let last_part = first >> RECORD_BITS;
    let part = min(u32(share * f32(last_part + 1u)), last_part);
    let has_parts = segment < frame.record_segments && first != RECORD_NONE;
    return select(RECORD_NONE, (first & ((1u << RECORD_BITS) - 1u)) + part, has_parts);
}

// Takes places for so many parts; returns the first.
fn record_take(parts: u32) -> u32 {
    let first = atomicAdd(&queues.tiles[record_counted()], parts);
    // A workgroup more whenever those before are full.
    let per = RECORD_LANES * RECORDS;
    let full = record_room();
    let groups = (min(first + parts, full) + per - 1u) / per - (min(first, full) + per - 1u) / per;
    if groups > 0u {
        atomicAdd(&queues.counts[3u * QUEUE_RECORDS], groups);
    }
    return first;
}

// Says that a piece's parts have their places from `first` on, if there is room for them; no tile wants them yet.
fn record_put(segment: u32, first: u32, parts: u32) {
    let has_room = parts > 0u && first + parts <= record_room();
    let word = first | ((parts - 1u) << RECORD_BITS);
    atomicStore(&queues.tiles[record_piece_word(segment)], select(RECORD_NONE, word, has_room));
    for (var i = 0u; i < parts; i += 1u) {
        if first + i < record_room() {
            let place = record_part_word(first + i);
            atomicStore(&queues.tiles[place], segment);
            atomicStore(&queues.tiles[place + 1u], i | (parts << 16u));
            atomicStore(&queues.tiles[place + 2u], 0u);
        }
    }
}

fn record_part(i: u32) -> ScratchPart {
    let place = record_part_word(i);
    let which = atomicLoad(&queues.tiles[place + 1u]);
    return ScratchPart(
        atomicLoad(&queues.tiles[place]),
        which & 0xffffu,
        which >> 16u,
        atomicLoad(&queues.tiles[place + 2u]),
    );
}

// What lengths across scratches are to be multiplied with at a pixel that sees the surface at a depth. Seen from the camera, a length in
// the picture stands for one on the plane that grows with the depth: exactly so, where no footprint that grows with it as well blurs
// what lies there; else a part is too short to tell.
fn record_scale(depth_m: f32) -> f32 {
    return select(1.0, depth_m, METHOD_FOOTPRINT == FOOTPRINT_OFF);
}

// Says that a tile wants a part's record.
fn record_want(i: u32, tile: u32) {
    atomicStore(&queues.tiles[record_part_word(i) + 2u], tile + 1u);
}

// Which tiles are to be shaded how.

@group(3) @binding(3) var<storage, read_write> queues: TileQueues;

// Tiles whose list holds all scratches that their pixels may see.
const QUEUE_LISTED: u32 = 0u;
// Tiles that show several objects, or whose list is not complete: pixels walk for themselves.
const QUEUE_WALKED: u32 = 1u;
// Tiles that show no object.
const QUEUE_EMPTY: u32 = 2u;
// Tiles with pixels whose footprints cover many scratches, beside being in another queue. A workgroup for each of their pixels.
const QUEUE_BUNDLED: u32 = 3u;
// Tiles whose list is complete, and whose scratches all have records that serve there.
const QUEUE_RECORDED: u32 = 4u;
const QUEUES: u32 = 5u;

// A queue's count is the number of workgroups of an indirect dispatch along x; what follows is that along the others.
fn queue_push(queue: u32, tile: u32) {
    let place = atomicAdd(&queues.counts[3u * queue], 1u);
    let tiles = tile_counts();
    atomicStore(&queues.tiles[queue * tiles.x * tiles.y + place], tile);
}

// Set in an entry of QUEUE_LISTED once its tile is in QUEUE_WALKED too.
const QUEUE_MOVED: u32 = 0x80000000u;

// Has a listed tile's pixels walk for themselves as well: the first pixel that asks puts it in the queue.
fn queue_move(place: u32) {
    let tile = atomicOr(&queues.tiles[place], QUEUE_MOVED);
    if (tile & QUEUE_MOVED) == 0u {
        queue_push(QUEUE_WALKED, tile);
    }
}

fn queue_tile(queue: u32, place: u32) -> u32 {
    let tiles = tile_counts();
    return atomicLoad(&queues.tiles[queue * tiles.x * tiles.y + place]) & ~QUEUE_MOVED;
}

// Takes a chunk for a list; one that there is no room for is beyond frame.tile_chunks. They are counted behind the marks.
fn queue_take_chunk() -> u32 {
    let tiles = tile_counts();
    return atomicAdd(&queues.tiles[(QUEUES + 2u) * tiles.x * tiles.y], 1u);
}

// Marks a pixel of a tile whose single scratches have been added up: no list is for it. `place` counts row by row.
fn queue_mark_tallied(tile: u32, place: u32) {
    let tiles = tile_counts();
    atomicOr(&queues.tiles[QUEUES * tiles.x * tiles.y + 2u * tile + place / 32u], 1u << (place % 32u));
}

// The pixels of a tile that are marked, a bit for each.
fn queue_tallied(tile: u32) -> vec2u {
    let tiles = tile_counts();
    let first = QUEUES * tiles.x * tiles.y + 2u * tile;
    return vec2u(atomicLoad(&queues.tiles[first]), atomicLoad(&queues.tiles[first + 1u]));
}

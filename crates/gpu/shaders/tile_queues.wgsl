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

// A queue's count is the number of workgroups of an indirect dispatch along x; what follows is that along the others.
fn queue_push(queue: u32, tile: u32) {
    let place = atomicAdd(&queues.counts[3u * queue], 1u);
    let tiles = tile_counts();
    queues.tiles[queue * tiles.x * tiles.y + place] = tile;
}

fn queue_tile(queue: u32, place: u32) -> u32 {
    let tiles = tile_counts();
    return queues.tiles[queue * tiles.x * tiles.y + place];
}

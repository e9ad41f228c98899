// Pass: finds the start of each tile's list among the sorted entries. One invocation a tile.
// Needs: film.

@group(3) @binding(0) var<storage, read> entries: array<vec4u>;
// One more than tiles.
@group(3) @binding(1) var<storage, read_write> list_starts: array<u32>;

@compute @workgroup_size(64)
fn tile_lists(@builtin(global_invocation_id) id: vec3u) {
    let tiles = strip_tiles();
    if id.x > tiles.x * tiles.y {
        return;
    }
    // The first entry of the tile or of a later one.
    var low = 0u;
    var high = frame.entry_count;
    while low < high {
        let middle = low + (high - low) / 2u;
        if entries[middle].x < id.x {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    list_starts[id.x] = low;
}

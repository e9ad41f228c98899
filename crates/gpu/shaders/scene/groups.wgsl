// Tile of a group, and the chunks of the tile's list.
// Needs: film, at_hits.

// First group of each tile, in later steps; one more than tiles.
@group(3) @binding(0) var<storage, read> group_starts: array<u32>;

// Segments of a list that one workgroup of shade_scratches takes. Small enough that no software driver ends its loops. Twin: src/strip.rs.
const CHUNK_SEGMENTS: u32 = 512u;

// Start and end of the list of a group, as places in the array of starts: a list for each tile, or for each sample.
fn group_list(group: u32) -> vec2u {
    if AT_HITS {
        return GROUP * vec2u(group, group + 1u);
    }
    let tile = group_tile(group);
    return vec2u(tile, tile + 1u);
}

fn group_tile(group: u32) -> u32 {
    if frame.step == 0u {
        return group;
    }
    let tiles = strip_tiles();
    var low = 0u;
    var high = tiles.x * tiles.y;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if group_starts[middle] <= group {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

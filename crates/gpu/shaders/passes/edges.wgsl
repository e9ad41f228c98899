// Pass: numbers the pixels of each tile that have an edge or a crease, and counts the groups of their samples. A workgroup a tile.
// Twin: cpu/src/silhouettes.rs says which pixels these are; resolve.wgsl has marked them.
// Needs: film.

@group(3) @binding(0) var<storage, read_write> film: Film;
// One more than tiles; becomes prefix sums.
@group(3) @binding(1) var<storage, read_write> group_starts: array<u32>;

var<workgroup> edge_flags: array<u32, GROUP>;

@compute @workgroup_size(64)
fn edges(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let tiles = strip_tiles();
    let tile = min(workgroup.y * workgroups.x + workgroup.x, tiles.x * tiles.y - 1u);
    let pixel = group_pixel(tile, lane);
    let is_there = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    var edge = 0u;
    if is_there {
        edge = min(film.pixels[film_index(pixel)].edge, 1u);
    }
    edge_flags[lane] = edge;
    workgroupBarrier();
    var before = 0u;
    for (var i = 0u; i < lane; i += 1u) {
        before += edge_flags[i];
    }
    if edge != 0u {
        film.pixels[film_index(pixel)].edge = before + 1u;
    }
    if lane == GROUP - 1u {
        group_starts[tile] = ((before + edge) * frame.samples + GROUP - 1u) / GROUP;
        group_starts[tiles.x * tiles.y] = 0u;
    }
}

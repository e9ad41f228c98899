// Pass: the entries of tile lists, segment after segment: the tile, the segment, and a bit for each pixel of the tile that its line comes
// near to. sort.wgsl brings them in the order of tiles.
// Twin: cpu/src/bin.rs.
// Needs: projected.

@group(3) @binding(0) var<storage, read> entry_starts: array<u32>;
@group(3) @binding(1) var<storage, read_write> entries: array<vec4u>;

@compute @workgroup_size(256)
fn bin(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let index = 256u * (workgroup.y * workgroups.x + workgroup.x) + lane;
    // Without entries there are none, or there is no room for them.
    if index >= frame.segment_count || frame.entry_count == 0u {
        return;
    }
    var at = entry_starts[index];
    if at == entry_starts[index + 1u] {
        return;
    }
    let line = project_segment(index);
    for (var row = line.first_row; row < line.end_row; row += 1u) {
        let columns = projected_columns(line, row);
        for (var column = columns.x; column < columns.y; column += 1u) {
            let near = pixels_near(line, vec2f(TILE_PX * vec2u(column, row)));
            entries[at] = vec4u(row * strip_tiles().x + column, index, near);
            at += 1u;
        }
    }
}

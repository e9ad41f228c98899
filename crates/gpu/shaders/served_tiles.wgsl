// Pass: which of the tiles that have asked for records find that each of them serves. In the others some scratches are left to pixels.
// One invocation a tile.

@compute @workgroup_size(64)
fn served_tiles(@builtin(global_invocation_id) id: vec3u) {
    let tile = id.x;
    let counts = tile_counts();
    if tile >= counts.x * counts.y {
        return;
    }
    let head = tile_list_texel(TILE_HEAD_TEXELS * tile);
    let plane_key = head.z;
    let asks = head.w != 0u;
    let count = select(0u, head.x, asks);
    // A list too long for a loop that a driver may end is not looked through.
    var serves = count <= GATHER_MAX_ROUNDS;
    var chunk = head.y;
    for (var at = 0u; at < count && serves; at += 1u) {
        gather_rounds += 1u;
        let list = tile_chunk_texel(chunk);
        let number = tile_list_texel(list + at % TILE_CHUNK).w;
        let texel = record_at(select(number, 0u, number == RECORD_NONE));
        let half_line = record_half_line(tile_list_texel(texel + 1u));
        let sent = tile_list_texel(texel + RECORD_HEAD_TEXELS);
        // Lists are filled up with entries of no scratch.
        serves = number == RECORD_NONE || (half_line >= 0.0 && record_key(sent) == plane_key);
        if (at + 1u) % TILE_CHUNK == 0u {
            chunk = tile_list_texel(list + TILE_CHUNK).x;
        }
    }
    if asks {
        queue_push(select(QUEUE_LISTED, QUEUE_RECORDED, serves), tile);
    }
}

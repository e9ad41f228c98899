// Pass: from what is visible to radiance, in tiles whose scratches have records that serve there (scratch_records.wgsl). Each pixel
// takes those whose bit it finds.

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = queue_tile(QUEUE_RECORDED, workgroup.x);
    let here = tile_pixel(tile, lane);
    let count = here.list.x;
    var depth_m: f32;
    let point = tile_pixel_on_plane(here, tile_plane_at(tile), &depth_m);
    var single_share = 1.0;
    var sums: ScratchSums;
    var alone = here.seen.x != 0u;
    if METHOD_GATHER != GATHER_EXACT {
        single_share = bundle_single_share_at(point, here.seen.y);
        alone = alone && single_share > 0.0 && film_wants_singles(here.pixel);
        sums = film_resume(here.pixel, 0u).sums;
    }
    let scale = record_scale(depth_m);
    let records = record_at(0u);
    var chunk = here.list.y;
    for (var first = 0u; first < count; first += TILE_CHUNK) {
        let list = tile_chunk_texel(chunk);
        chunk = tile_list_texel(list + TILE_CHUNK).x;
        var near = select(vec2u(0u), tile_chunk_near(list, count - first, here.in_tile), alone);
        let adds = bits_count(near);
        for (var i = 0u; i < adds; i += 1u) {
            gather_rounds += 1u;
            let entry = tile_list_texel(list + bits_take(&near));
            record_add(record_there(records + RECORD_TEXELS * entry.w, here.at_px, scale), single_share, &sums);
        }
    }
    if !here.inside {
        return;
    }
    tile_pixel_add(here, point, depth_m, sums);
}

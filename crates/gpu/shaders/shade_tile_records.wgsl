// Pass: from what is visible to radiance, in tiles whose scratches have records that serve there (scratch_records.wgsl). Each pixel
// takes those whose bit it finds.

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let tile = queue_tile(QUEUE_RECORDED, workgroup.x);
    let head = tile_list_texel(tile);
    let count = head.x;
    let in_film = tile_corner(tile) + local.xy;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let at_px = tile_middle_px(tile_corner(tile)) + tile_at_px(in_film);
    let ray = tile_ray(at_px);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    // Any triangle does for pixels that see none; what they find is dropped.
    var depth_m: f32;
    let point = hit_surface_point(max(seen.x, 1u) - 1u, ray, &depth_m);
    var single_share = 1.0;
    var sums: ScratchSums;
    var alone = seen.x != 0u;
    if METHOD_GATHER != GATHER_EXACT {
        single_share = bundle_single_share_at(point, seen.y);
        alone = alone && single_share > 0.0 && film_wants_singles(pixel);
        sums = film_resume(pixel, 0u).sums;
    }
    let scale = record_scale(depth_m);
    var chunk = head.y;
    for (var first = 0u; first < count; first += TILE_CHUNK) {
        let list = tile_chunk_texel(chunk);
        chunk = tile_list_texel(list + TILE_CHUNK).x;
        var near = select(vec2u(0u), tile_chunk_near(list, count - first, local.xy), alone);
        let adds = bits_count(near);
        for (var i = 0u; i < adds; i += 1u) {
            gather_rounds += 1u;
            let entry = tile_list_texel(list + bits_take(&near));
            record_add(record_there(entry.w, at_px, scale), single_share, &sums);
        }
    }
    if !inside {
        return;
    }
    if seen.x == 0u {
        film_add_background(pixel, ray);
        return;
    }
    let masked = gather_masked(sums, objects[seen.y].depth_coherence);
    film_add_surface(pixel, point, depth_m, masked, base_radiance(point));
}

// Pass: from what is visible to radiance, in tiles that have a list of scratches. The list has a bit for each pixel and scratch;
// each pixel takes those whose bit it finds. shade.wgsl does all other pixels.

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let tile = queue_tile(QUEUE_LISTED, workgroup.x);
    let head = tile_list_texel(tile);
    let count = head.x;
    let in_film = tile_corner(tile) + local.xy;
    let pixel = in_film + vec2u(0u, frame.rows.x);
    let inside = pixel.x < frame.size_px.x && pixel.y < frame.rows.y;
    let ray = film_ray(pixel);
    let seen = select(vec2u(0u), film_visible(pixel), inside);
    // Any triangle does for pixels that see none; what they find is dropped.
    var depth_m: f32;
    let point = hit_surface_point(max(seen.x, 1u) - 1u, ray, &depth_m);
    var view = gather_pixel(point);
    var batch: GatherBatch;
    var sums: ScratchSums;
    var alone = seen.x != 0u;
    if METHOD_GATHER != GATHER_EXACT {
        view.single_share = bundle_single_share_at(point, seen.y);
        alone = alone && view.single_share > 0.0 && film_wants_singles(pixel);
        sums = film_resume(pixel, 0u).sums;
    }
    var overflows = false;
    // A walk may be left where a device ends long loops; this is not.
    let room = min(GATHER_SEGMENTS, GATHER_MAX_ROUNDS / gather_rounds_a_segment());
    var chunk = head.y;
    for (var first = 0u; first < count; first += TILE_CHUNK) {
        let list = tile_chunk_texel(chunk);
        chunk = tile_list_texel(list + TILE_CHUNK).x;
        var near = select(vec2u(0u), tile_chunk_near(list, count - first, local.xy), alone);
        let touching = bits_count(near);
        overflows = overflows || batch.count + touching > room;
        let wanted = select(touching, 0u, overflows);
        for (var i = 0u; i < wanted; i += 1u) {
            gather_rounds += 1u;
            let segment = tile_list_texel(list + bits_take(&near)).x;
            gather_weigh(point, view, segment, &batch, &sums);
        }
    }
    if !inside {
        return;
    }
    if seen.x == 0u {
        film_add_background(pixel, ray);
        return;
    }
    if overflows {
        queue_move(workgroup.x);
        return;
    }
    sums.radiance += gather_light(point, view, &batch);
    let masked = gather_masked(sums, objects[seen.y].depth_coherence);
    film_add_surface(pixel, point, depth_m, masked, base_radiance(point));
}

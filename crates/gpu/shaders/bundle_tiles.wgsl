// Pass: which tiles have pixels whose footprints may cover many scratches. One invocation a pixel; tiles are workgroups.

var<workgroup> bundle_wanted: atomic<u32>;

@compute @workgroup_size(8, 8)
fn bundle_tiles(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let pixel = film_pixel(workgroup.xy, workgroups.xy, local.xy);
    if pixel.x < frame.size_px.x && pixel.y < frame.rows.y {
        let seen = film_visible(pixel);
        if seen.x != 0u && bundle_grids(seen.y).populations > 0u {
            var depth_m: f32;
            let point = hit_surface_point(seen.x - 1u, film_ray(pixel), &depth_m);
            let choice = bundle_choice(gather_pixel(point), bundle_grids(seen.y));
            if choice.any || choice.may_tally {
                atomicStore(&bundle_wanted, 1u);
            }
        }
    }
    workgroupBarrier();
    if lane == 0u && atomicLoad(&bundle_wanted) == 1u {
        let in_film = pixel - vec2u(0u, frame.rows.x);
        queue_push(QUEUE_BUNDLED, in_film.y / TILE_PX * tile_counts().x + in_film.x / TILE_PX);
    }
}

// Pass: tiles that show no object.

@compute @workgroup_size(8, 8)
fn background(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let tile = queue_tile(QUEUE_EMPTY, workgroup.x);
    let pixel = tile_corner(tile) + local.xy + vec2u(0u, frame.rows.x);
    if pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    film_add_background(pixel, shade_background(film_ray(pixel)).base);
}

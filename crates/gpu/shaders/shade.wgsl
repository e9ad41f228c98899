// Pass: from what is visible to radiance, pixel by pixel. Twin: reference/src/closed_form.rs.

// Whether the pass does the tiles of a queue; else all pixels of the film.
override SHADE_QUEUED: bool = false;

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    var pixel: vec2u;
    if SHADE_QUEUED {
        pixel = tile_corner(queue_tile(QUEUE_WALKED, workgroup.x)) + local.xy + vec2u(0u, frame.rows.x);
    } else {
        pixel = film_pixel(workgroup.xy, workgroups.xy, local.xy);
    }
    if pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    // Complete since an earlier dispatch.
    if film.pixels[film_index(pixel)].samples > frame.sample {
        return;
    }
    let ray = film_ray(pixel);
    let seen = film_visible(pixel);
    var value: FilmPixel;
    if seen.x == 0u {
        value = shade_background(ray);
    } else {
        var depth_m: f32;
        let point = hit_surface_point(seen.x - 1u, ray, &depth_m);
        var masked = Masked(vec3f(0.0), vec3f(0.0));
        if HAS_SCRATCHES {
            let object = objects[seen.y];
            var list: SegmentList;
            var start = object.first_node;
            if METHOD_LOOKUP == LOOKUP_TRIANGLES {
                list = segment_list(seen.x - 1u, object.end_node);
                start = segment_list_begin(list);
            }
            var walk = film_resume(pixel, start);
            gather_scratches(point, object, list, bundle_single_share_at(point, seen.y), &walk);
            if walk.at < object.end_node || walk.at >= WALK_LISTED {
                film_keep(pixel, walk);
                return;
            }
            masked = gather_masked(walk.sums, object.depth_coherence);
        }
        value = shade_surface(point, depth_m, masked, base_radiance(point));
    }
    film_add(pixel, value);
}

// Pass: from what is visible to radiance, by the method of 2018 or by parts of it; shade.wgsl is the default path's. Twin:
// reference/src/closed_form.rs.

// Radiance of the scratches and the share of the base that they take.
fn published_masked(sums: ScratchSums, depth_coherence: f32) -> Masked {
    if METHOD_MASK == MASK_ENERGY {
        return mask_resolve(sums, depth_coherence);
    }
    if METHOD_MASK == MASK_DENSITY {
        return Masked(sums.radiance, min(sums.energy, vec3f(1.0)));
    }
    return Masked(sums.radiance, sums.energy);
}

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = film_pixel(workgroup.xy, workgroups.xy, local.xy);
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
        let object = objects[seen.y];
        var masked: Masked;
        if HAS_SCRATCHES {
            var walk = film_resume(pixel, object.first_node);
            let end = published_walk_end(object, seen.x - 1u);
            published_scratches(published_seen(point), object, seen.x - 1u, end, &walk);
            if walk.at < end {
                film_keep(pixel, walk);
                return;
            }
            masked = published_masked(walk.sums, object.depth_coherence);
        }
        value = shade_surface(point, depth_m, masked, published_base(point));
    }
    film_add(pixel, value);
}

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
    let at = vec2f(pixel) + 0.5 + frame.jitter_px - 0.5 * vec2f(frame.size_px);
    let ray = frame.forward + frame.per_px_x * at.x + frame.per_px_y * at.y;
    let seen = film_visible(pixel);
    var value: FilmPixel;
    if seen.x == 0u {
        value.base = scene_background(normalize(ray));
        film_add(pixel, value);
        return;
    }
    var depth_m: f32;
    var point = hit_surface_point(seen.x - 1u, ray, &depth_m);
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
    let light = published_base(point);
    // A groove interrupts the reflecting surface; what shines from under it passes.
    value.base = point.emission + light.diffuse + light.specular * (1.0 - masked.taken);
    value.scratches = masked.scratches * fresnel_eval(FresnelRgb(point.f0, point.fresnel_a), point.wo.z);
    value.density = masked.taken;
    value.normal = point.normal;
    value.depth_m = depth_m;
    value.coverage = 1.0;
    film_add(pixel, value);
}

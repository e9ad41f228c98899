// Pass: from what is visible to radiance. Twin: reference/src/closed_form.rs.

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2u(id.x, frame.rows.x + id.y);
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
    let point = hit_surface_point(seen.x - 1u, ray, &depth_m);
    let object = objects[seen.y];
    var walk = film_resume(pixel, object);
    gather_scratches(point, object, &walk);
    if walk.at < object.end_node {
        film_keep(pixel, walk);
        return;
    }
    let masked = mask_resolve(walk.sums, object.depth_coherence);
    let light = base_radiance(point);
    // A groove interrupts the reflecting surface; what shines from under it passes.
    value.base = point.emission + light.diffuse + light.specular * (1.0 - masked.taken);
    value.scratches = masked.scratches * fresnel_eval(FresnelRgb(point.f0, point.fresnel_a), point.wo.z);
    value.density = masked.taken;
    value.normal = point.normal;
    value.depth_m = depth_m;
    value.coverage = 1.0;
    film_add(pixel, value);
}

// What a pixel adds to the film, once it is known what scratches do there.

// The ray of a pixel's sample, one along the view axis.
fn film_ray(pixel: vec2u) -> vec3f {
    let at = vec2f(pixel) + 0.5 + frame.jitter_px - 0.5 * vec2f(frame.size_px);
    return frame.forward + frame.per_px_x * at.x + frame.per_px_y * at.y;
}

fn film_add_background(pixel: vec2u, ray: vec3f) {
    var value: FilmPixel;
    value.base = scene_background(normalize(ray));
    film_add(pixel, value);
}

fn film_add_surface(pixel: vec2u, point: SurfacePoint, depth_m: f32, masked: Masked, light: BaseRadiance) {
    var value: FilmPixel;
    // A groove interrupts the reflecting surface; what shines from under it passes.
    value.base = point.emission + light.diffuse + light.specular * (1.0 - masked.taken);
    value.scratches = masked.scratches * fresnel_eval(FresnelRgb(point.f0, point.fresnel_a), point.wo.z);
    value.density = masked.taken;
    value.normal = point.normal;
    value.depth_m = depth_m;
    value.coverage = 1.0;
    film_add(pixel, value);
}

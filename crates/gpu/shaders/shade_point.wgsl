// What a pixel is on the film, once it is known what scratches do there.
//
// A pass adds to the film in one place: a software driver goes both ways at every branch, and compiles each place.

// The ray of a pixel's sample, one along the view axis.
fn film_ray(pixel: vec2u) -> vec3f {
    let at = vec2f(pixel) + 0.5 + frame.jitter_px - 0.5 * vec2f(frame.size_px);
    return frame.forward + frame.per_px_x * at.x + frame.per_px_y * at.y;
}

fn shade_background(ray: vec3f) -> FilmPixel {
    var value: FilmPixel;
    value.base = scene_background(normalize(ray));
    return value;
}

fn shade_surface(point: SurfacePoint, depth_m: f32, masked: Masked, light: BaseRadiance) -> FilmPixel {
    var value: FilmPixel;
    // A groove interrupts the reflecting surface; what shines from under it passes.
    value.base = point.emission + light.diffuse + light.specular * (1.0 - masked.taken);
    value.scratches = masked.scratches * fresnel_eval(FresnelRgb(point.f0, point.fresnel_a), point.wo.z);
    value.density = masked.taken;
    value.normal = point.normal;
    value.depth_m = depth_m;
    value.coverage = 1.0;
    return value;
}

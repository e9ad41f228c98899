// Parts of a pixel: its base is the mean over places of the filter. Twin: cpu/src/pixel_parts.rs.
// Needs: hit, ggx.

// Spread of the slopes of a normal map over a pixel, over the alpha of its lobe, from which on it has parts, and from which on it has many.
const PARTS_SPREAD: f32 = 0.25;
const MANY_PARTS_SPREAD: f32 = 0.6;

// Number of places along each axis of the filter: 1 where the pixel is a part itself. Odd: an even number has none in the middle, where lights
// would be 8 to 14 % too faint.
fn parts_along(point: SurfacePoint) -> u32 {
    var along = parts_of_lobe(point.slope_std, point.roughness);
    if HAS_COATS {
        let coat = surface_coat(point.coat);
        let of_coat = parts_of_lobe(surface_of_coat(point).slope_std, coat.y);
        along = max(along, select(1u, of_coat, coat.x > 0.0));
    }
    return along;
}

fn parts_of_lobe(slope_std: f32, roughness: f32) -> u32 {
    let alpha = ggx_alpha(roughness);
    return select(select(1u, 3u, slope_std > PARTS_SPREAD * alpha), 5u, slope_std > MANY_PARTS_SPREAD * alpha);
}

// Binomial weights: with a filter as wide as parts_std() the places add up to the pixel's.
fn parts_weight(along: u32, part: u32) -> f32 {
    return parts_weight_along(along, part % along) * parts_weight_along(along, part / along);
}

fn parts_weight_along(along: u32, i: u32) -> f32 {
    var weight = 1.0 / f32(1u << (along - 1u));
    for (var j = 0u; j < i; j += 1u) {
        weight *= f32(along - 1u - j) / f32(j + 1u);
    }
    return weight;
}

// Standard deviation of the filter of each place, over that of the pixel's. Steps are twice that.
fn parts_std(along: u32) -> f32 {
    return inverseSqrt(f32(along));
}

// The surface at one of the places of a pixel that sees a point, on the plane of its triangle, which goes on beyond its edges.
fn pixel_part(position_m: vec3f, triangle: u32, along: u32, part: u32) -> SurfacePoint {
    let a = vertices[3u * triangle].position_m;
    let e1 = vertices[3u * triangle + 1u].position_m - a;
    let e2 = vertices[3u * triangle + 2u].position_m - a;
    let geometric = cross(e1, e2);
    let facet = surface_normalize_or(geometric, frame.forward);
    let view = parts_view(position_m, frame.footprint_std_px);
    let place = vec2f(vec2u(part % along, part / along)) - 0.5 * f32(along - 1u);
    let at = view.stds * 2.0 * parts_std(along) * place;
    let step_m = hit_axis(view, facet, view.right) * at.x + hit_axis(view, facet, view.down) * at.y;
    let bary = hit_barycentric_step(e1, e2, geometric, position_m - a) + hit_barycentric_step(e1, e2, geometric, step_m);
    let there = parts_view(position_m + step_m, parts_std(along) * frame.footprint_std_px);
    var seen = hit_surface(triangle, bary, there);
    seen.distance_m = there.depth_m * length(there.ray);
    return seen;
}

fn parts_view(position_m: vec3f, stds: f32) -> HitView {
    let from_camera_m = position_m - frame.camera_m;
    let depth_m = dot(from_camera_m, frame.forward);
    return HitView(from_camera_m / depth_m, depth_m, frame.per_px_x, frame.per_px_y, stds, MIN_FOOTPRINT_COS, true);
}

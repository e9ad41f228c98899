// Rays through pixels, and the footprints that pixels leave on a surface. Twin: scene/src/camera.rs.

const MIN_FOOTPRINT_COS: f32 = 0.035;

// Movement of the hit point, in the plane of the surface, when the ray moves by `per_px`. The ray's component along the view
// axis is one, `depth_m` is the hit's distance along it.
fn footprint_axis(ray: vec3f, depth_m: f32, normal: vec3f, per_px: vec3f) -> vec3f {
    return footprint_axis_from(ray, depth_m, normal, per_px, MIN_FOOTPRINT_COS);
}

// footprint_axis() with the least cosine at which the axis still grows.
fn footprint_axis_from(ray: vec3f, depth_m: f32, normal: vec3f, per_px: vec3f, least_cos: f32) -> vec3f {
    let cos_ray = dot(ray, normal);
    let limit = least_cos * length(ray);
    let bounded = select(cos_ray, select(limit, -limit, cos_ray < 0.0), abs(cos_ray) < limit);
    return (per_px - ray * (dot(per_px, normal) / bounded)) * depth_m;
}

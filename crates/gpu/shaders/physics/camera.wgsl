// From a pixel to a ray and to the footprint that it leaves on a surface. Twin: scene/src/camera.rs.

const MIN_FOOTPRINT_COS: f32 = 0.035;

// How far a point of the plane through the hit moves when the ray moves by `per_px`. The ray's component along the view axis
// is one, `depth_m` is the hit's distance along it.
fn footprint_axis(ray: vec3f, depth_m: f32, normal: vec3f, per_px: vec3f) -> vec3f {
    let cos_ray = dot(ray, normal);
    let limit = MIN_FOOTPRINT_COS * length(ray);
    let bounded = select(cos_ray, select(limit, -limit, cos_ray < 0.0), abs(cos_ray) < limit);
    return (per_px - ray * (dot(per_px, normal) / bounded)) * depth_m;
}

// Pass: surface points of what the rays have met. A workgroup a group. Twin: cpu/src/bounces.rs.
// Needs: hit, film, pixel_point, ggx.

// Points that the rays come from.
@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> rays: array<BounceRay>;
@group(3) @binding(2) var<storage, read_write> hit_points: array<PixelPoint>;
@group(3) @binding(3) var<storage, read_write> hit_paints: array<PixelPaint>;

// Rays that graze a surface see no more of it than this cosine lets them.
const HIT_LEAST_COS: f32 = 0.25;

// One standard deviation of what is seen by way of a point, across a ray: as wide as there, wider by the way, by how the normals turn there, and
// by the solid angle that the ray stands for (as path differentials: F. Suykens and Y. Willems, 2001).
fn width_m(pixel: PixelPoint, direction: vec3f, distance_m: f32, solid_angle_sr: f32) -> f32 {
    let width_here_m = here_m(pixel, direction);
    // Spread of a disk of this solid angle: half its radius.
    let drawn_rad2 = 0.25 * solid_angle_sr / GGX_PI;
    let spread_rad = width_here_m / pixel.distance_m + sqrt(2.0 * dot(pixel.turns, pixel.turns) + drawn_rad2);
    return width_here_m + distance_m * spread_rad;
}

// Distance of the viewer's image in the mirror from a hit: where the directions to the viewer meet that a footprint there has.
fn viewer_m(pixel: PixelPoint, direction: vec3f, distance_m: f32) -> f32 {
    let turned_per_m = sqrt(2.0 * dot(pixel.turns, pixel.turns)) / max(here_m(pixel, direction), 1e-20);
    return distance_m + 1.0 / (1.0 / pixel.distance_m + turned_per_m);
}

// One standard deviation of the footprint of a point, across a ray from there.
fn here_m(pixel: PixelPoint, direction: vec3f) -> f32 {
    let um = pixel.footprint_um;
    return 1e-6 * sqrt(abs((um.x * um.w - um.y * um.z) * dot(pixel.normal, direction)));
}

@compute @workgroup_size(8, 8)
fn bounce_surface(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    let ray = rays[at];
    if !(ray.distance_m > 0.0) {
        var nothing: PixelPoint;
        hit_points[at] = nothing;
        return;
    }
    let right = surface_any_across(ray.direction);
    let all_m = max(width_m(points[at], ray.direction, ray.distance_m, ray.solid_angle_sr), 1e-12);
    var point = hit_surface(ray.triangle, ray.place, HitView(ray.direction, 1.0, right, cross(ray.direction, right), all_m, HIT_LEAST_COS, false));
    point.distance_m = viewer_m(points[at], ray.direction, ray.distance_m);
    // Rays meet other places each: the scratches of one place stand for those of a wide footprint, which are many.
    let scratches_m = min(width_m(points[at], ray.direction, ray.distance_m, 0.0), 1e-6 * point.coherence_um);
    point.footprint_x_um *= scratches_m / all_m;
    point.footprint_y_um *= scratches_m / all_m;
    hit_points[at] = pixel_point_pack(point, ray.object, ray.distance_m, lane);
    hit_paints[at] = pixel_paint_pack(point, ray.triangle);
}

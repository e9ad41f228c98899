// Pass: follows each sample's ray and adds its weight to the sums of its source. A workgroup a group. Twin: cpu/src/shadows.rs.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read> rays: array<ShadowRay>;
// Of even rounds and of odd ones, sample by sample.
@group(3) @binding(3) var<storage, read_write> halves: array<ShadowHalf>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;
@group(3) @binding(5) var triangle_tree: texture_2d<u32>;

// Relative to the scene: some ten steps of single precision.
const STEP: f32 = 1e-6;

// Where on the surface a ray starts.
struct RayStart {
    position_m: vec3f,
    triangle: u32,              // + 1
}

// The point of a triangle; on the surface that the normals of its vertices describe, where that lies above the triangle.
// J. Hanika, "Hacking the Shadow Terminator", 2021.
fn ray_start(triangle: u32, barycentric: vec2f, to_viewer: vec3f) -> RayStart {
    let a = vertices[3u * triangle];
    let b = vertices[3u * triangle + 1u];
    let c = vertices[3u * triangle + 2u];
    let weights = vec3f(1.0 - barycentric.x - barycentric.y, barycentric);
    let e1 = b.position_m - a.position_m;
    let e2 = c.position_m - a.position_m;
    var position_m = a.position_m + e1 * barycentric.x + e2 * barycentric.y;
    if any(a.normal != b.normal) || any(a.normal != c.normal) {
        let below_m = vec3f(
            dot(position_m - a.position_m, a.normal),
            dot(position_m - b.position_m, b.normal),
            dot(position_m - c.position_m, c.normal),
        );
        // On the viewer's side.
        let side = select(1.0, -1.0, dot(cross(e1, e2), to_viewer) < 0.0);
        let rises = -weights * min(side * below_m, vec3f(0.0));
        position_m += side * (a.normal * rises.x + b.normal * rises.y + c.normal * rises.z);
    }
    return RayStart(position_m, triangle + 1u);
}

// Where on its own triangle the camera's ray through a place meets the surface, if it does.
fn own_barycentric(triangle: u32, ray: vec3f) -> vec2f {
    let a = vertices[3u * triangle].position_m;
    return surface_barycentric(frame.camera_m, ray, a, vertices[3u * triangle + 1u].position_m, vertices[3u * triangle + 2u].position_m);
}

// What a pixel shows so many standard deviations of its filter to the right and down. On the triangles themselves: a step along the plane
// of the normal would end below them where they are hollow.
fn under_the_pixel(pixel: PixelPoint, own: u32, stds: vec2f) -> RayStart {
    let middle = (pixel.position_m - frame.camera_m) / pixel.depth_m;
    let ray = middle + frame.footprint_std_px * (frame.per_px_x * stds.x + frame.per_px_y * stds.y);
    let there = own_barycentric(own, ray);
    if there.x >= 0.0 && there.y >= 0.0 && there.x + there.y <= 1.0 {
        return ray_start(own, there, -ray);
    }
    let hit = tree_hit(triangle_tree, tree_ray(frame.camera_m, normalize(ray)), 1e30, 0u, false);
    if hit.triangle != 0u && hit.object == pixel.object - 1u {
        return ray_start(hit.triangle - 1u, hit.barycentric, -ray);
    }
    return ray_start(own, own_barycentric(own, middle), -middle);
}

@compute @workgroup_size(8, 8)
fn shadow_trace(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    var is_hidden = false;
    let ray = rays[at];
    if ray.distance_m > 0.0 {
        let start = under_the_pixel(points[at], paints[at].triangle, vec2f(ray.offset_x, ray.offset_y));
        let step_m = STEP * (shadow_round.extent_m + length(start.position_m));
        let origin_m = start.position_m + step_m * (ray.direction + points[at].normal);
        let hit = tree_hit(triangle_tree, tree_ray(origin_m, ray.direction), ray.distance_m, start.triangle, true);
        is_hidden = hit.triangle != 0u;
    }
    let half = 2u * at + shadow_round.round % 2u;
    var sum: ShadowHalf;
    if shadow_round.round > 1u {
        sum = halves[half];
    }
    sum.specular += ray.specular;
    sum.body += ray.body;
    if is_hidden {
        sum.specular_hidden += ray.specular;
        sum.body_hidden += ray.body;
    }
    halves[half] = sum;
}

// Origins of rays of a sample that must not meet the surface that they leave. Twin: cpu/src/shadows.rs.
// Needs: cutouts, pixel_point, at_hits, shadow.

// Origin of a ray on the surface.
struct RayStart {
    position_m: vec3f,
    triangle: u32,              // + 1
    facet: vec3f,               // normal of the triangle on the viewer's side, of any length
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
    let across = cross(e1, e2);
    // On the viewer's side.
    let side = select(1.0, -1.0, dot(across, to_viewer) < 0.0);
    if any(a.normal != b.normal) || any(a.normal != c.normal) {
        let below_m = vec3f(
            dot(position_m - a.position_m, a.normal),
            dot(position_m - b.position_m, b.normal),
            dot(position_m - c.position_m, c.normal),
        );
        let rises = -weights * min(side * below_m, vec3f(0.0));
        position_m += side * (a.normal * rises.x + b.normal * rises.y + c.normal * rises.z);
    }
    return RayStart(position_m, triangle + 1u, side * across);
}

// Place on its own triangle where the camera's ray through a place meets the surface, if it does.
fn own_barycentric(triangle: u32, ray: vec3f) -> vec2f {
    let a = vertices[3u * triangle].position_m;
    return surface_barycentric(frame.camera_m, ray, a, vertices[3u * triangle + 1u].position_m, vertices[3u * triangle + 2u].position_m);
}

// Place that a pixel shows so many standard deviations of its filter to the right and down: the hit of the camera's ray there, if it is
// the pixel's own object. On the triangles themselves, since a step along the plane of the normal would end below them where they are
// hollow. Not on the plane of the pixel's own triangle either: it goes on behind what stands on it. Where the surface has turned away from the ray's
// direction it is the middle of the pixel, which sends light that way: a convex body does not stand before itself.
fn under_the_pixel(tree: texture_2d<u32>, pixel: PixelPoint, own: u32, stds: vec2f, direction: vec3f) -> RayStart {
    let middle = (pixel.position_m - frame.camera_m) / pixel.depth_m;
    let ray = middle + frame.footprint_std_px * (frame.per_px_x * stds.x + frame.per_px_y * stds.y);
    let hit = cutout_hit(tree, tree_ray(frame.camera_m, normalize(ray)), 1e30, 0u, false, pixel.object);
    if hit.triangle != 0u && hit.object == pixel.object - 1u {
        let start = ray_start(hit.triangle - 1u, hit.barycentric, -ray);
        if dot(start.facet, direction) > 0.0 {
            return start;
        }
    }
    return ray_start(own, own_barycentric(own, middle), -middle);
}

// Origin of a ray of a sample: under its pixel, or, for a hit of another ray, at the hit.
fn sample_start(tree: texture_2d<u32>, pixel: PixelPoint, own: u32, stds: vec2f, direction: vec3f) -> RayStart {
    if AT_HITS {
        let a = vertices[3u * own].position_m;
        let b = vertices[3u * own + 1u].position_m;
        let c = vertices[3u * own + 2u].position_m;
        let across = surface_normalize_or(cross(b - a, c - a), pixel.normal);
        let wo = pixel_wo(pixel.cos_o);
        return ray_start(own, surface_barycentric(pixel.position_m, across, a, b, c), pixel.axis_x * wo.x + pixel.normal * wo.z);
    }
    return under_the_pixel(tree, pixel, own, stds, direction);
}

// A little off the surface.
fn ray_from(start: RayStart, direction: vec3f, normal: vec3f, extent_m: f32) -> TreeRay {
    return tree_ray(start.position_m + ray_step_m(start.position_m, extent_m) * (direction + normal), direction);
}

// Directions to area lights, drawn evenly over the solid angle in which a point sees them. Twins: cpu/src/sampling/lights/sphere.rs and
// polygon.rs, which name the papers. A polygon is a fan of triangles about its first vertex: where it is not convex some of them overlap,
// and a direction counts as often as they cover it. All vectors are in the surface's frame.
// Needs: lights, ggx, contents, shadow.

struct DrawnToLight {
    direction: vec3f,
    distance_m: f32,
    whole: f32,                 // solid angle that is drawn from, overlaps counted; 0: nothing is seen
}

// Hit of a direction on a light.
struct MetLight {
    distance_m: f32,            // 0: it does not
    covers: f32,                // how often the drawn solid angle covers it
}

// 1 - cos of the cone that a sphere fills; 2 from inside.
fn sphere_versine(center_m: vec3f, radius_m: f32) -> f32 {
    let sin2 = radius_m * radius_m / max(dot(center_m, center_m), 1e-30);
    return select(2.0, sin2 / (1.0 + sqrt(max(1.0 - sin2, 0.0))), sin2 < 1.0);
}

// Distance at which a direction meets a sphere first, or passes it nearest; below zero where it passes.
fn sphere_reach_m(center_m: vec3f, radius_m: f32, direction: vec3f) -> f32 {
    let along = dot(center_m, direction);
    // A cross product, since a difference of squares cancels for far spheres.
    let beside = cross(center_m, direction);
    let half_chord2 = radius_m * radius_m - dot(beside, beside);
    let half_chord = sqrt(max(half_chord2, 0.0));
    let distance = length(center_m);
    if distance <= radius_m {
        return max(along + half_chord, 1e-30);
    }
    let first = (distance - radius_m) * (distance + radius_m) / max(along + half_chord, 1e-30);
    return select(-first, first, half_chord2 >= 0.0 && along > 0.0);
}

fn sphere_draw(center_m: vec3f, radius_m: f32, u: vec2f) -> DrawnToLight {
    let versine = sphere_versine(center_m, radius_m);
    let axis = select(vec3f(0.0, 0.0, 1.0), normalize(center_m), versine < 2.0);
    let v = u.x * versine;
    let across = surface_any_across(axis);
    let phi = 2.0 * GGX_PI * u.y;
    let round = across * cos(phi) + cross(axis, across) * sin(phi);
    let direction = axis * (1.0 - v) + round * sqrt(max(v * (2.0 - v), 0.0));
    // Rounding may take a direction at the limb past it; there the ray touches.
    return DrawnToLight(direction, abs(sphere_reach_m(center_m, radius_m, direction)), 2.0 * GGX_PI * versine);
}

// A triangle as seen from the point: the unit directions to its corners.
struct SphericalTriangle {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    volume: f32,                // their determinant, positive
    angle: f32,                 // solid
}

fn spherical_triangle(a_m: vec3f, b_m: vec3f, c_m: vec3f) -> SphericalTriangle {
    let a = surface_direction(a_m);
    let b = surface_direction(b_m);
    let c = surface_direction(c_m);
    // Product of the edges' lengths, so that small triangles do not cancel.
    let lengths = max(length(a_m) * length(b_m) * length(c_m), 1e-30);
    let volume = abs(dot(cross(b_m - a_m, c_m - a_m), a_m)) / lengths;
    return SphericalTriangle(a, b, c, volume, 2.0 * atan2(volume, 1.0 + dot(a, b) + dot(b, c) + dot(c, a)));
}

// Cuts off `part` of the triangle's solid angle by a great circle through b, and goes the share `u` of what is left along it.
fn spherical_triangle_draw(triangle: SphericalTriangle, part: f32, u: f32) -> vec3f {
    let a = triangle.a;
    let b = triangle.b;
    let c = triangle.c;
    let sin_part = sin(0.5 * part);
    let toward_a = cos(0.5 * part) * triangle.volume - sin_part * (dot(a, c) + dot(b, c));
    let o = surface_normalize_or(a * toward_a + c * (sin_part * (1.0 + dot(a, b))), a);
    let d = o * (2.0 * dot(a, o)) - a;
    let versine = 0.5 * dot(d - b, d - b);
    let along = u * versine;
    let tangent = surface_normalize_or(d - b + b * versine, vec3f(0.0));
    return normalize(b * (1.0 - along) + tangent * sqrt(max(along * (2.0 - along), 0.0)));
}

// A polygon, or the outline of a tube.
fn outline_draw(point: SurfacePoint, light: Light, outline: OutlineView, u: vec2f) -> DrawnToLight {
    var whole = 0.0;
    var left = u.x;
    var chosen: SphericalTriangle;
    let first = outline_corner_m(lights, outline, 0u);
    var b = outline_corner_m(lights, outline, 1u);
    // In one pass: a triangle takes over with its share of all so far, and what is left of the number is stretched again.
    for (var i = 2u; i < light.vertex_count; i += 1u) {
        let c = outline_corner_m(lights, outline, i);
        let triangle = spherical_triangle(first, b, c);
        whole += triangle.angle;
        let share = triangle.angle / max(whole, 1e-30);
        if left < share {
            left /= share;
            chosen = triangle;
        } else {
            left = (left - share) / max(1.0 - share, 1e-30);
        }
        b = c;
    }
    let direction = spherical_triangle_draw(chosen, left * chosen.angle, u.y);
    return DrawnToLight(direction, outline_reach_m(point, light, direction), whole);
}

// The distance at which a direction passes through the polygon's plane, or into a tube; below zero or not finite where it does not.
fn outline_reach_m(point: SurfacePoint, light: Light, direction: vec3f) -> f32 {
    var reach_m: f32;
    if light_is_tube(light) {
        let a = light_end_m(light.first_vertex);
        let b = light_end_m(light.first_vertex + 1u);
        let start_m = surface_from_world(point, a.xyz - point.position_m);
        reach_m = tube_reach_m(start_m, surface_from_world(point, b.xyz - point.position_m), a.w, direction);
    } else {
        let normal = surface_from_world(point, light.normal);
        let corner_m = surface_from_world(point, light_corner_m(light.first_vertex) - point.position_m);
        reach_m = dot(normal, corner_m) / dot(normal, direction);
    }
    return reach_m;
}

fn outline_meets(point: SurfacePoint, light: Light, outline: OutlineView, direction: vec3f) -> MetLight {
    let distance_m = outline_reach_m(point, light, direction);
    if !(distance_m > 0.0 && distance_m < 1e30) {
        return MetLight(0.0, 0.0);
    }
    var covers = 0.0;
    var winding = 0.0;
    let first = outline_corner_m(lights, outline, 0u);
    var b = outline_corner_m(lights, outline, 1u);
    for (var i = 2u; i < light.vertex_count; i += 1u) {
        let c = outline_corner_m(lights, outline, i);
        let sides = vec3f(dot(cross(first, b - first), direction), dot(cross(b, c - b), direction), dot(cross(c, first - c), direction));
        let sign = f32(all(sides > vec3f(0.0))) - f32(all(sides < vec3f(0.0)));
        winding += sign;
        covers += abs(sign);
        b = c;
    }
    return MetLight(select(0.0, distance_m, winding != 0.0), covers);
}

fn light_draw(point: SurfacePoint, light: Light, u: vec2f) -> DrawnToLight {
    var drawn: DrawnToLight;
    if HAS_SPHERES && light.kind == LIGHT_SPHERE {
        drawn = sphere_draw(surface_from_world(point, light.center_m - point.position_m), light.radius_m, u);
    }
    if HAS_POLYGONS && light.kind != LIGHT_SPHERE {
        let outline = surface_outline(point, light);
        if outline.facing != 0.0 {
            drawn = outline_draw(point, light, outline, u);
        }
    }
    return drawn;
}

// The light that light_draw has drawn from, along any direction.
fn light_meets(point: SurfacePoint, light: Light, direction: vec3f) -> MetLight {
    var met: MetLight;
    if HAS_SPHERES && light.kind == LIGHT_SPHERE {
        let reach_m = sphere_reach_m(surface_from_world(point, light.center_m - point.position_m), light.radius_m, direction);
        met = MetLight(max(reach_m, 0.0), 1.0);
    }
    if HAS_POLYGONS && light.kind != LIGHT_SPHERE {
        met = outline_meets(point, light, surface_outline(point, light), direction);
    }
    return met;
}

// Distance, in world space, within which a surface hides a light from a point. It ends a step before a flat light, so that a ray does not meet
// the surface that the light lies in.
fn light_clear_m(light: Light, from_m: vec3f, direction: vec3f, distance_m: f32, extent_m: f32) -> f32 {
    let step_m = ray_step_m(from_m + distance_m * direction, extent_m);
    // Others have no normal.
    let along = select(1.0, abs(dot(light.normal, direction)), dot(light.normal, light.normal) > 0.5);
    // A distance of 0 would mean that no ray is cast; a point that is nearer to the light's plane has nothing before it.
    return max(distance_m - step_m / max(along, 1e-20), 1e-20);
}

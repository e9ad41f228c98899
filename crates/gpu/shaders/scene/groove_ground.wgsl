// The triangle that gratings are looked at on, and what they take from it: pictures, and directions by texture coordinates. Twin:
// crates/scene/src/grating/ground.rs.
// Needs: gratings, scene, surface_point.

// The weights of the second and third corner at a point of a triangle, and how they change along two steps; the same of its place in texture space.
struct GrooveGround {
    weights: vec2f,
    right: vec2f,
    down: vec2f,
    uv: vec2f,
    filter_side: f32,           // of the pixel in texture space
    u_per_m: vec3f,
    v_per_m: vec3f,
}

fn groove_ground(triangle: u32, position_m: vec3f, right_m: vec3f, down_m: vec3f) -> GrooveGround {
    let a = vertices[3u * triangle];
    let b = vertices[3u * triangle + 1u];
    let c = vertices[3u * triangle + 2u];
    let e1 = b.position_m - a.position_m;
    let e2 = c.position_m - a.position_m;
    let geometric = cross(e1, e2);
    // Unit geometric normal over twice the area, each factor by itself within the range of single precision.
    let twice_area = max(length(geometric), 1e-30);
    let unit = geometric / twice_area;
    // Gradients of the two weights.
    let of_b = cross(e2, unit) / twice_area;
    let of_c = cross(unit, e1) / twice_area;
    let arm_m = position_m - a.position_m;
    let weights = vec2f(dot(of_b, arm_m), dot(of_c, arm_m));
    let uv_a = vec2f(a.u, a.v);
    let uv_b = vec2f(b.u, b.v) - uv_a;
    let uv_c = vec2f(c.u, c.v) - uv_a;
    let uv_area = abs(uv_b.x * uv_c.y - uv_b.y * uv_c.x);
    return GrooveGround(
        weights,
        vec2f(dot(of_b, right_m), dot(of_c, right_m)),
        vec2f(dot(of_b, down_m), dot(of_c, down_m)),
        uv_a + weights.x * uv_b + weights.y * uv_c,
        sqrt(uv_area / twice_area * length(cross(right_m, down_m))),
        uv_b.x * of_b + uv_c.x * of_c,
        uv_b.y * of_b + uv_c.y * of_c,
    );
}

fn groove_picture(texture: vec2u, uv: vec2f, filter_side: f32) -> vec4f {
    let lod = surface_texture_lod(filter_side, scene_texture_size(texture), scene_texture_levels(texture));
    return scene_texture(texture, uv, lod, filter_side);
}

// Share of a grating that a mask leaves: its mean over the pixel.
fn groove_mask(grating: Grating, triangle: u32, position_m: vec3f, right_m: vec3f, down_m: vec3f) -> f32 {
    let ground = groove_ground(triangle, position_m, right_m, down_m);
    if (grating.maps & GROOVES_MASK_BY_SIDES) == 0u {
        return groove_picture(grating.mask, ground.uv, ground.filter_side).x;
    }
    let normals = mat3x3f(vertices[3u * triangle].normal, vertices[3u * triangle + 1u].normal, vertices[3u * triangle + 2u].normal);
    let normal = normals * vec3f(1.0 - ground.weights.x - ground.weights.y, ground.weights);
    let x = grating.tiles_x.xyz;
    let y = grating.tiles_y.xyz;
    let z = grating.tiles_z.xyz;
    let p = vec3f(dot(x, position_m), dot(y, position_m), dot(z, position_m)) + vec3f(grating.tiles_x.w, grating.tiles_y.w, grating.tiles_z.w);
    // Normals transform by the transpose of the inverse. The shares are sharp, so that few places mix two sides.
    let towards = vec3f(dot(x, normal) / dot(x, x), dot(y, normal) / dot(y, y), dot(z, normal) / dot(z, z));
    let nearest = towards / max(length(towards), 1e-30);
    let shares = nearest * nearest * nearest * nearest;
    let right = vec3f(dot(x, right_m), dot(y, right_m), dot(z, right_m));
    let down = vec3f(dot(x, down_m), dot(y, down_m), dot(z, down_m));
    let filter_side = sqrt(length(cross(right, down)));
    var sum = 0.0;
    for (var side = 0u; side < 3u; side += 1u) {
        let uv = vec2f(select(p.x, p.y, side == 0u), select(-p.z, -p.y, side == 2u));
        if shares[side] > 0.0 {
            sum += shares[side] * groove_picture(grating.mask, uv, filter_side).x;
        }
    }
    return sum / max(shares.x + shares.y + shares.z, 1e-30);
}

// The direction of grooves by texture coordinates at weights of the corners and a place of the texture; not a unit vector.
fn groove_along(grating: Grating, triangle: u32, weights: vec2f, uv: vec2f, filter_side: f32, normal: vec3f) -> vec3f {
    let a = vertices[3u * triangle];
    let b = vertices[3u * triangle + 1u];
    let c = vertices[3u * triangle + 2u];
    let interpolated = a.tangent * (1.0 - weights.x - weights.y) + b.tangent * weights.x + c.tangent * weights.y;
    let tangent = interpolated - normal * dot(normal, interpolated);
    // Either side of a sheet shows the same grooves.
    let geometric = cross(b.position_m - a.position_m, c.position_m - a.position_m);
    let outward = normal * select(1.0, -1.0, dot(geometric, normal) < 0.0);
    let bitangent = cross(outward, tangent) * select(1.0, -1.0, (a.material & VERTEX_BITANGENT_FLIPPED) != 0u);
    var way = vec2f(1.0, 0.0);
    if scene_has_texture(grating.directions) {
        way = 2.0 * groove_picture(grating.directions, uv, filter_side).xy - 1.0;
    }
    if (grating.maps & GROOVES_BY_V) != 0u {
        way = vec2f(-way.y, way.x);
    }
    return tangent * way.x + bitangent * way.y;
}

// Course of grooves that run by texture coordinates.
fn groove_course_by_uv(grating: Grating, triangle: u32, position_m: vec3f, normal: vec3f, right_m: vec3f, down_m: vec3f) -> GrooveCourse {
    let ground = groove_ground(triangle, position_m, right_m, down_m);
    var course: GrooveCourse;
    // The middle, then to both sides, halfway. One copy of the code.
    for (var i = 0u; i < 5u; i += 1u) {
        let step = select(select(ground.down, ground.right, i < 3u), vec2f(0.0), i == 0u);
        let step_m = select(select(down_m, right_m, i < 3u), vec3f(0.0), i == 0u);
        let side = select(-1.0, 1.0, (i & 1u) != 0u);
        let uv = ground.uv + 0.5 * side * vec2f(dot(ground.u_per_m, step_m), dot(ground.v_per_m, step_m));
        let there = groove_along(grating, triangle, ground.weights + 0.5 * side * step, uv, ground.filter_side, normal);
        if i == 0u {
            course.here = there;
        } else if i < 3u {
            course.right += side * there;
        } else {
            course.down += side * there;
        }
    }
    let by_v = (grating.maps & GROOVES_BY_V) != 0u;
    course.level = select(ground.uv.y, ground.uv.x, by_v);
    // Directions of a picture follow no level.
    course.level_per_m = select(select(ground.v_per_m, ground.u_per_m, by_v), vec3f(0.0), scene_has_texture(grating.directions));
    return course;
}

// Converts a triangle that a ray meets to the surface point: interpolation, normal map, textures. Twin:
// cpu/src/surface.rs.
// Needs: scene, surface_point, camera, coat.

// View of a point.
struct HitView {
    ray: vec3f,
    depth_m: f32,               // of the point, in lengths of the ray
    right: vec3f,               // how the ray changes
    down: vec3f,
    stds: f32,                  // standard deviations of the filter, in such changes
    least_cos: f32,             // footprints are no longer than at this cosine
    bumps_turn: bool,           // whether bumps of normal maps turn the normal over the footprint, and what is finer than a texel alone spreads
}

fn hit_axis(view: HitView, normal: vec3f, change: vec3f) -> vec3f {
    return footprint_axis_from(view.ray, view.depth_m, normal, change, view.least_cos);
}

// Place of a look-up in textures: by either set of coordinates, with a filter so wide in texture space.
struct TexturePlace {
    uv: vec2f,
    filter_side: f32,
    other_uv: vec2f,
    other_side: f32,
}

// Area of the footprint in texture space, as the side of a square, of a triangle with these edges there.
fn hit_texture_footprint(uv_b: vec2f, uv_c: vec2f, geometric: vec3f, axis_x: vec3f, axis_y: vec3f) -> f32 {
    let uv_area = abs(uv_b.x * uv_c.y - uv_b.y * uv_c.x);
    return sqrt(uv_area / max(length(geometric), 1e-30) * length(cross(axis_x, axis_y)));
}

fn hit_has_texture(texture: vec2u) -> bool {
    return HAS_TEXTURES && scene_has_texture(texture);
}

// The coordinates that a texture lies by, and the side of its filter.
fn hit_place(texture: vec2u, place: TexturePlace) -> vec3f {
    return select(vec3f(place.uv, place.filter_side), vec3f(place.other_uv, place.other_side), scene_by_other_uv(texture));
}

fn hit_texture(texture: vec2u, place: TexturePlace) -> vec4f {
    let there = hit_place(texture, place);
    let lod = surface_texture_lod(there.z, scene_texture_size(texture), scene_texture_levels(texture));
    return scene_texture(texture, there.xy, lod, there.z);
}

// Twin: host.rs.
fn vertex_color(vertex: Vertex) -> vec4f {
    return vec4f(unpack2x16unorm(vertex.color.x), unpack2x16unorm(vertex.color.y));
}

// Change of the barycentric coordinates of the second and third vertex over a step in the plane of a triangle with these edges.
fn hit_barycentric_step(e1: vec3f, e2: vec3f, geometric: vec3f, step: vec3f) -> vec2f {
    // Unit geometric normal over twice the area, each factor by itself within the range of single precision.
    let twice_area = max(length(geometric), 1e-30);
    let unit = geometric / twice_area;
    return vec2f(dot(cross(step, e2), unit), dot(cross(e1, step), unit)) / twice_area;
}

// Turn of the interpolated normal of a triangle over a step of the barycentric coordinates; `interpolated` is not yet a unit vector.
fn hit_normal_turn(a: Vertex, b: Vertex, c: Vertex, interpolated: vec3f, step: vec2f) -> vec3f {
    let length2 = dot(interpolated, interpolated);
    let change = (b.normal - a.normal) * step.x + (c.normal - a.normal) * step.y;
    if length2 < 1e-12 {
        return vec3f(0.0);
    }
    return (change - interpolated * (dot(change, interpolated) / length2)) * inverseSqrt(length2);
}

// Sets the frame of a point's surface towards the viewer, and the footprint there.
fn hit_turn(point: ptr<function, SurfacePoint>, normal: vec3f, to_viewer: vec3f, view: HitView) {
    (*point).normal = normal;
    // The viewer in the x-z plane; any x will do where they look along the normal.
    (*point).axis_x = surface_normalize_or(to_viewer - normal * dot(normal, to_viewer), surface_any_across(normal));
    (*point).axis_y = cross(normal, (*point).axis_x);
    let cos_view = dot(normal, to_viewer);
    (*point).wo = vec3f(sqrt(max(1.0 - cos_view * cos_view, 0.0)), 0.0, cos_view);
    let x_um = hit_axis(view, normal, view.right) * (1e6 * view.stds);
    let y_um = hit_axis(view, normal, view.down) * (1e6 * view.stds);
    (*point).footprint_x_um = vec2f(dot(x_um, (*point).axis_x), dot(x_um, (*point).axis_y));
    (*point).footprint_y_um = vec2f(dot(y_um, (*point).axis_x), dot(y_um, (*point).axis_y));
}

// Sets the material of a point's surface.
fn hit_paint(point: ptr<function, SurfacePoint>, material: Material) {
    (*point).emission = material.emission;
    (*point).roughness = material.roughness;
    var dielectric_f0 = vec3f(material.dielectric_f0);
    (*point).f90 = 1.0;
    if HAS_SPECULAR {
        dielectric_f0 = material.specular * min(dielectric_f0 * material.specular_color, vec3f(1.0));
        (*point).f90 = mix(material.specular, 1.0, material.metallic);
    }
    (*point).f0 = mix(dielectric_f0, material.base_color, material.metallic);
    (*point).curve = material.curve;
    (*point).diffuse = material.base_color * (1.0 - material.metallic);
    (*point).metallic = material.metallic;
    (*point).coherence_um = material.coherence_um;
    (*point).table = material.table;
    (*point).coat = coat_pack(material.coat);
    if material.is_unlit != 0u {
        (*point).emission = material.base_color;
        (*point).f0 = vec3f(0.0);
        (*point).f90 = 0.0;
        (*point).diffuse = vec3f(0.0);
    }
}

// Unit vectors on a surface along u and across it.
struct HitTangents {
    along: vec3f,
    across: vec3f,
}

fn hit_tangents(a: Vertex, b: Vertex, c: Vertex, weights: vec3f, smooth_normal: vec3f) -> HitTangents {
    let tangent = a.tangent * weights.x + b.tangent * weights.y + c.tangent * weights.z;
    let along = surface_normalize_or(tangent - smooth_normal * dot(smooth_normal, tangent), surface_any_across(smooth_normal));
    let flip = select(1.0, -1.0, (a.material & VERTEX_BITANGENT_FLIPPED) != 0u);
    return HitTangents(along, cross(smooth_normal, along) * flip);
}

// Whether the normals of its coat are not those of what is under it.
fn hit_has_coat_normals(material: Material) -> bool {
    let has_coat = HAS_COAT_NORMALS && unpack2x16unorm(material.coat).x > 0.0;
    return has_coat && any(material.coat_normal_texture != material.normal_texture);
}

// Normal of a texel of a normal map.
fn hit_texel_normal(looked_up: vec4f, scale: f32, tangents: HitTangents, smooth_normal: vec3f) -> vec3f {
    let texel = looked_up.xyz * 2.0 - 1.0;
    let slopes = tangents.along * (texel.x * scale) + tangents.across * (texel.y * scale);
    return surface_normalize_or(slopes + smooth_normal * texel.z, smooth_normal);
}

// Normal by a normal map, if there is one, and the spread of its slopes there: `as_turns` of what is finer than a texel.
fn hit_normal(map: vec2u, scale: f32, a: Vertex, b: Vertex, c: Vertex, weights: vec3f, place: TexturePlace, smooth_normal: vec3f, as_turns: bool) -> vec4f {
    if !hit_has_texture(map) {
        return vec4f(smooth_normal, 0.0);
    }
    let tangents = hit_tangents(a, b, c, weights, smooth_normal);
    var looked_up: vec4f;
    if as_turns {
        looked_up = hit_texture(map, place);
    } else {
        let there = hit_place(map, place);
        let lod = surface_texture_lod(there.z, scene_texture_size(map), scene_texture_levels(map));
        looked_up = scene_normals(map, there.xy, lod, there.z);
    }
    return vec4f(hit_texel_normal(looked_up, scale, tangents, smooth_normal), looked_up.w * abs(scale));
}

// Turn of the normal by a normal map over a step of the barycentric coordinates.
fn hit_bump_turn(map: vec2u, scale: f32, a: Vertex, b: Vertex, c: Vertex, weights: vec3f, place: TexturePlace, smooth_normal: vec3f, step: vec2f) -> vec3f {
    let tangents = hit_tangents(a, b, c, weights, smooth_normal);
    let uv = 2.0 * (vec2f(b.u - a.u, b.v - a.v) * step.x + vec2f(c.u - a.u, c.v - a.v) * step.y);
    let other_uv = 2.0 * ((b.other_uv - a.other_uv) * step.x + (c.other_uv - a.other_uv) * step.y);
    var turn = vec3f(0.0);
    for (var sign = -1.0; sign < 1.5; sign += 2.0) {
        let there = TexturePlace(place.uv + sign * uv, place.filter_side, place.other_uv + sign * other_uv, place.other_side);
        turn += 0.25 * sign * hit_texel_normal(hit_texture(map, there), scale, tangents, smooth_normal);
    }
    return turn;
}

// Sets the direction in which its facets lean most, and their alphas.
fn hit_brush(point: ptr<function, SurfacePoint>, material: Material, place: TexturePlace, tangents: HitTangents) {
    var strength = material.anisotropy;
    var own = vec2f(1.0, 0.0);
    if hit_has_texture(material.anisotropy_texture) {
        let texel = hit_texture(material.anisotropy_texture, place);
        own = 2.0 * texel.xy - 1.0;
        strength *= texel.z;
    }
    let turn = vec2f(cos(material.anisotropy_direction_rad), sin(material.anisotropy_direction_rad));
    let way = tangents.along * (turn.x * own.x - turn.y * own.y) + tangents.across * (turn.y * own.x + turn.x * own.y);
    let under_coat = surface_under_coat(*point);
    let local = vec2f(dot(way, under_coat.axis_x), dot(way, under_coat.axis_y));
    (*point).long_axis = select(vec2f(1.0, 0.0), local * inverseSqrt(max(dot(local, local), 1e-30)), dot(local, local) > 1e-20);
    let rough = clamp((*point).roughness, 0.0, 1.0);
    let alpha = max(rough * rough, 0.002);
    (*point).long_alpha = alpha + (1.0 - alpha) * strength * strength;
}

// Clear layer of a material at a place of its textures, packed as its factors are.
fn hit_coat(material: Material, place: TexturePlace) -> u32 {
    var coat = unpack2x16unorm(material.coat);
    if hit_has_texture(material.coat_texture) {
        coat.x *= hit_texture(material.coat_texture, place).x;
    }
    if hit_has_texture(material.coat_roughness_texture) {
        coat.y *= hit_texture(material.coat_roughness_texture, place).y;
    }
    return pack2x16unorm(coat);
}

// Material at a place of its textures.
fn hit_textured(material: Material, place: TexturePlace) -> Material {
    var there = material;
    if hit_has_texture(material.base_color_texture) {
        there.base_color *= hit_texture(material.base_color_texture, place).xyz;
    }
    if hit_has_texture(material.metallic_roughness_texture) {
        let texel = hit_texture(material.metallic_roughness_texture, place);
        there.roughness *= texel.y;
        there.metallic *= texel.z;
    }
    if hit_has_texture(material.emission_texture) {
        there.emission *= hit_texture(material.emission_texture, place).xyz;
    }
    if HAS_SPECULAR {
        if hit_has_texture(material.specular_texture) {
            there.specular *= hit_texture(material.specular_texture, place).w;
        }
        if hit_has_texture(material.specular_color_texture) {
            there.specular_color *= hit_texture(material.specular_color_texture, place).xyz;
        }
    }
    if HAS_COATS {
        there.coat = hit_coat(material, place);
    }
    return there;
}

// The surface that a ray of the camera sees on a triangle. `depth_m` is written beside it.
fn hit_surface_point(triangle: u32, ray: vec3f, depth_m: ptr<function, f32>) -> SurfacePoint {
    let a = vertices[3u * triangle];
    let b = vertices[3u * triangle + 1u];
    let c = vertices[3u * triangle + 2u];
    let bary = surface_barycentric(frame.camera_m, ray, a.position_m, b.position_m, c.position_m);
    let position_m = a.position_m + (b.position_m - a.position_m) * bary.x + (c.position_m - a.position_m) * bary.y;
    let depth = dot(position_m - frame.camera_m, frame.forward);
    *depth_m = depth;
    let view = HitView(ray, depth, frame.per_px_x, frame.per_px_y, frame.footprint_std_px, MIN_FOOTPRINT_COS, false);
    var point = hit_surface(triangle, bary, view);
    point.distance_m = depth * length(ray);
    return point;
}

// The surface at a place of a triangle; `distance_m` is left to the caller.
fn hit_surface(triangle: u32, bary: vec2f, view: HitView) -> SurfacePoint {
    let a = vertices[3u * triangle];
    let b = vertices[3u * triangle + 1u];
    let c = vertices[3u * triangle + 2u];
    let geometric = cross(b.position_m - a.position_m, c.position_m - a.position_m);
    let to_viewer = -normalize(view.ray);
    // Either side of a sheet is a surface of its own.
    let side = select(1.0, -1.0, dot(geometric, to_viewer) < 0.0);
    let weights = vec3f(1.0 - bary.x - bary.y, bary);
    let interpolated = a.normal * weights.x + b.normal * weights.y + c.normal * weights.z;
    let smooth_normal = surface_normalize_or(interpolated, normalize(geometric));

    var point: SurfacePoint;
    point.position_m = a.position_m + (b.position_m - a.position_m) * bary.x + (c.position_m - a.position_m) * bary.y;

    var material = material_at(a.material & ~VERTEX_BITANGENT_FLIPPED);
    if HAS_COLORS {
        material.base_color *= (vertex_color(a) * weights.x + vertex_color(b) * weights.y + vertex_color(c) * weights.z).xyz;
    }
    let uv = vec2f(a.u, a.v) * weights.x + vec2f(b.u, b.v) * weights.y + vec2f(c.u, c.v) * weights.z;
    let smooth_x = hit_axis(view, side * smooth_normal, view.right) * view.stds;
    let smooth_y = hit_axis(view, side * smooth_normal, view.down) * view.stds;
    let uv_a = vec2f(a.u, a.v);
    let place = TexturePlace(
        uv,
        hit_texture_footprint(vec2f(b.u, b.v) - uv_a, vec2f(c.u, c.v) - uv_a, geometric, smooth_x, smooth_y),
        a.other_uv * weights.x + b.other_uv * weights.y + c.other_uv * weights.z,
        hit_texture_footprint(b.other_uv - a.other_uv, c.other_uv - a.other_uv, geometric, smooth_x, smooth_y),
    );

    let there = hit_textured(material, place);
    // A coat with a normal map of its own turns another way than what is under it.
    let as_turns = HAS_BUMPS && view.bumps_turn && !hit_has_coat_normals(material);
    let mapped = hit_normal(material.normal_texture, material.normal_scale, a, b, c, weights, place, smooth_normal, as_turns);
    point.slope_std = mapped.w;
    var normal = surface_face_viewer(side * mapped.xyz, to_viewer);
    point.under_coat = UNDER_COAT_ALIKE;
    point.coat_slope_std = point.slope_std;
    if HAS_COAT_NORMALS && unpack2x16unorm(there.coat).x > 0.0 {
        let mapped_coat = hit_normal(material.coat_normal_texture, material.coat_normal_scale, a, b, c, weights, place, smooth_normal, false);
        point.coat_slope_std = mapped_coat.w;
        let of_coat = surface_face_viewer(side * mapped_coat.xyz, to_viewer);
        if any(of_coat != normal) {
            point.under_coat = under_coat_pack(normal);
            normal = of_coat;
        }
    }
    point.leaves = SURFACE_BENDS + 2.0 * distance(normal, side * surface_normalize_or(geometric, normal));
    hit_turn(&point, normal, to_viewer, view);
    hit_paint(&point, there);
    if HAS_ANISOTROPY && material.anisotropy > 0.0 {
        hit_brush(&point, there, place, hit_tangents(a, b, c, weights, smooth_normal));
    }
    point.open = 1.0;
    if hit_has_texture(material.occlusion_texture) {
        point.open += material.occlusion_strength * (hit_texture(material.occlusion_texture, place).x - 1.0);
    }
    let e1 = b.position_m - a.position_m;
    let e2 = c.position_m - a.position_m;
    let step_x = hit_barycentric_step(e1, e2, geometric, smooth_x);
    let step_y = hit_barycentric_step(e1, e2, geometric, smooth_y);
    var turn_x = side * hit_normal_turn(a, b, c, interpolated, step_x);
    var turn_y = side * hit_normal_turn(a, b, c, interpolated, step_y);
    if as_turns && hit_has_texture(material.normal_texture) {
        turn_x += side * hit_bump_turn(material.normal_texture, material.normal_scale, a, b, c, weights, place, smooth_normal, step_x);
        turn_y += side * hit_bump_turn(material.normal_texture, material.normal_scale, a, b, c, weights, place, smooth_normal, step_y);
    }
    point.turn_x = vec2f(dot(turn_x, point.axis_x), dot(turn_x, point.axis_y));
    point.turn_y = vec2f(dot(turn_y, point.axis_x), dot(turn_y, point.axis_y));
    return point;
}

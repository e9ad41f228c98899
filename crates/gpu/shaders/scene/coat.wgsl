// A clear layer over the base, in which scratches lie. Twin: cpu/src/shade_base.rs.
// Needs: bindings, fresnel, contents, surface_point.

// Needs, beside its modules: fresnel_curves.

// Reflectance at normal incidence by its refractive index, COAT_IOR of crates/scene.
const COAT_F0: vec3f = vec3f(0.04);

// The share of the surface that it covers, and its roughness: 16 bits each, as of materials. Beside normals of its own 12 bits each, and 8 to spare.
fn coat_pack(of_material: u32) -> u32 {
    if !HAS_COAT_NORMALS {
        return of_material;
    }
    let bits = vec2u(round(4095.0 * unpack2x16unorm(of_material)));
    return bits.x | (bits.y << 12u);
}

fn surface_coat(coat: u32) -> vec2f {
    if HAS_COAT_NORMALS {
        return vec2f(vec2u(coat & 0xfffu, (coat >> 12u) & 0xfffu)) / 4095.0;
    }
    return select(vec2f(0.0), unpack2x16unorm(coat), HAS_COATS);
}

// Mark of a surface under the coat with the coat's normal. No packed normal is this one.
const UNDER_COAT_ALIKE: u32 = 0x80008000u;

// A unit vector as a point of an octahedron that is folded open: 16 bits each. Z. Cigolle et al., "A Survey of Efficient Representations for
// Independent Unit Vectors", 2014.
fn under_coat_pack(normal: vec3f) -> u32 {
    let on_octahedron = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let folded = (1.0 - abs(on_octahedron.yx)) * select(vec2f(-1.0), vec2f(1.0), on_octahedron.xy >= vec2f(0.0));
    return pack2x16snorm(select(folded, on_octahedron.xy, on_octahedron.z >= 0.0));
}

fn under_coat_normal(packed: u32) -> vec3f {
    let unfolded = unpack2x16snorm(packed);
    let z = 1.0 - abs(unfolded.x) - abs(unfolded.y);
    let below = max(-z, 0.0);
    return normalize(vec3f(unfolded - below * select(vec2f(-1.0), vec2f(1.0), unfolded >= vec2f(0.0)), z));
}

// The surface under the coat, in its own frame. Twin: SurfacePoint::under_coat.
fn surface_under_coat(point: SurfacePoint) -> SurfacePoint {
    var under = point;
    if HAS_COAT_NORMALS && point.under_coat != UNDER_COAT_ALIKE {
        let to_viewer = world_from_surface(point, point.wo);
        let normal = under_coat_normal(point.under_coat);
        under.normal = normal;
        under.axis_x = surface_normalize_or(to_viewer - normal * dot(normal, to_viewer), surface_any_across(normal));
        under.axis_y = cross(normal, under.axis_x);
        let cos_view = dot(normal, to_viewer);
        under.wo = vec3f(sqrt(max(1.0 - cos_view * cos_view, 0.0)), 0.0, cos_view);
        let turn_x = world_from_surface(point, vec3f(point.turn_x, 0.0));
        let turn_y = world_from_surface(point, vec3f(point.turn_y, 0.0));
        under.turn_x = vec2f(dot(turn_x, under.axis_x), dot(turn_x, under.axis_y));
        under.turn_y = vec2f(dot(turn_y, under.axis_x), dot(turn_y, under.axis_y));
    }
    return under;
}

// The coat alone, which is no metal: its spread of slopes in the place of that of what is under it.
fn surface_of_coat(point: SurfacePoint) -> SurfacePoint {
    var coat = point;
    coat.metallic = 0.0;
    if HAS_COAT_NORMALS {
        coat.slope_std = point.coat_slope_std;
    }
    return coat;
}

fn coat_fresnel() -> FresnelRgb {
    return FresnelRgb(COAT_F0, 1.0, COAT_CURVE);
}

// Reflectance of the surface in which scratches lie: the layer, where it is.
fn coated_reflectance(base: FresnelRgb, coat: u32, cos_theta: f32) -> vec3f {
    var reflectance = fresnel_eval(fresnel_curves, base, cos_theta);
    if HAS_COATS {
        reflectance = mix(reflectance, fresnel_eval(fresnel_curves, coat_fresnel(), cos_theta), surface_coat(coat).x);
    }
    return reflectance;
}

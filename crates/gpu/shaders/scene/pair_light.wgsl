// Light that a pair sends of one kind of area lights. Twin: cpu/src/shade_scratches/scratch_light.rs.
// Needs: pairs, lights, scratch_picture.

// Kind of light for which the pass is compiled.
override SCRATCH_LIGHTS: u32 = 0u;
const SCRATCH_LIGHTS_SPHERES: u32 = 0u;
const SCRATCH_LIGHTS_QUADS: u32 = 1u;
const SCRATCH_LIGHTS_OUTLINES: u32 = 2u;
const SCRATCH_LIGHTS_TUBES: u32 = 3u;
const SCRATCH_LIGHTS_PICTURES: u32 = 4u;
const SCRATCH_LIGHTS_ENVIRONMENT: u32 = 5u;
// No kind: scratches are picked by the energy that they take of the base. Light of other objects goes by way of
// them.
const SCRATCH_LIGHTS_NONE: u32 = 6u;

// Whether the pass is for light from all around.
fn lights_are_around() -> bool {
    return SCRATCH_LIGHTS == SCRATCH_LIGHTS_ENVIRONMENT;
}

fn lights_are_none() -> bool {
    return SCRATCH_LIGHTS == SCRATCH_LIGHTS_NONE;
}

// Whether a light may reach a pair.
fn pair_meets(pair: Pair, light_index: u32) -> bool {
    let around = light_around(light_index);
    let center_m = (around.xyz - pair.position_m) * pair.surface;
    return scratch_meets(pair.point, pair.seen, center_m, around.w);
}

// The light of a pair by an area light, Fresnel left out.
fn pair_light(pair: Pair, light_index: u32) -> vec3f {
    let point = pair.point;
    let seen = pair.seen;
    let light = light_at(light_index);
    let sent = light_radiance(light, pair.position_m);
    let center_m = (light.center_m - pair.position_m) * pair.surface;
    if SCRATCH_LIGHTS == SCRATCH_LIGHTS_SPHERES {
        return sent * scratch_sphere(scratch_tables, point, seen, center_m, light.radius_m);
    }
    if SCRATCH_LIGHTS == SCRATCH_LIGHTS_QUADS || SCRATCH_LIGHTS == SCRATCH_LIGHTS_PICTURES {
        let last = select(light.first_vertex + 3u, light.first_vertex, light.vertex_count == 3u);
        let quad = QuadLight(
            (light_corner_m(light.first_vertex) - pair.position_m) * pair.surface,
            (light_corner_m(light.first_vertex + 1u) - pair.position_m) * pair.surface,
            (light_corner_m(light.first_vertex + 2u) - pair.position_m) * pair.surface,
            (light_corner_m(last) - pair.position_m) * pair.surface,
            light.vertex_count,
            light.normal * pair.surface,
            center_m,
            light.radius_m,
            light.two_sided != 0u,
        );
        if SCRATCH_LIGHTS == SCRATCH_LIGHTS_PICTURES {
            let plane = light_picture_plane(light, pair.position_m, pair.surface);
            let with_picture = PictureLight(quad, plane, light_picture(light));
            return sent * scratch_picture(scratch_tables, point, seen, with_picture);
        }
        return sent * scratch_quad(scratch_tables, point, seen, quad);
    }
    let view = outline_view(lights, outline_light(light, SCRATCH_LIGHTS == SCRATCH_LIGHTS_TUBES), pair.position_m, pair.surface, seen.tangent);
    return sent * scratch_outline(scratch_tables, lights, point, seen, view, center_m, light.radius_m);
}

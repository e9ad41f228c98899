// Light that rays found in a pixel, as the host has it. Twin: image/src/traced.rs.
// Needs: traced.

// Number in the place of the object: samples see several.
const TRACED_SEVERAL_OBJECTS: u32 = 0xffffffffu;

fn traced_rgb(rgb: array<f32, 3>) -> vec3f {
    return vec3f(rgb[0], rgb[1], rgb[2]);
}

fn traced_plus(rgb: array<f32, 3>, more: vec3f) -> array<f32, 3> {
    return array(rgb[0] + more.x, rgb[1] + more.y, rgb[2] + more.z);
}

// The light that is left, with that of other objects.
fn traced_light(light: TracedLight) -> vec3f {
    return traced_left(traced_rgb(light.open), traced_share(traced_rgb(light.weight), traced_rgb(light.seen))) + traced_rgb(light.bounced);
}

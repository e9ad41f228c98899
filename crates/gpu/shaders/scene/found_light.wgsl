// Light that rays found in a pixel, as the host has it. Twin: image/src/found.rs.
// Needs: found.

// Number in the place of the object: samples see several.
const FOUND_SEVERAL_OBJECTS: u32 = 0xffffffffu;

fn found_rgb(rgb: array<f32, 3>) -> vec3f {
    return vec3f(rgb[0], rgb[1], rgb[2]);
}

fn found_plus(rgb: array<f32, 3>, more: vec3f) -> array<f32, 3> {
    return array(rgb[0] + more.x, rgb[1] + more.y, rgb[2] + more.z);
}

// The light that is left, with that of other objects.
fn found_light(light: FoundLight) -> vec3f {
    return found_left(found_rgb(light.open), found_share(found_rgb(light.weight), found_rgb(light.seen))) + found_rgb(light.bounced);
}

// What the passes share that draw rays to other objects: docs/model.md, section 11. Twin: cpu/src/bounces.rs.

// How often the ray of a sample goes by way of its scratches, which take so much of the base. The camera's samples send rays both ways by turns;
// what those meet sends one, where the CPU's sends both.
fn bounce_by_scratches(taken: vec3f, which: ShadowRound) -> f32 {
    if which.depth == 0u {
        return f32(which.by_scratches);
    }
    let share = rgb_luminance(taken);
    return select(0.0, clamp(share, 0.1, 0.9), share > 0.0);
}

// What of light that a sample sends reaches the camera.
fn bounce_throughput(ray: BounceRay, which: ShadowRound) -> vec3f {
    return select(ray.throughput, vec3f(1.0), which.depth == 0u);
}

// A ray as it sets out.
fn bounce_ray(direction: vec3f, throughput: vec3f, solid_angle_sr: f32, start: vec2f) -> BounceRay {
    return BounceRay(direction, SHADOW_FAR_M, throughput, solid_angle_sr, start, 0u, 0u);
}

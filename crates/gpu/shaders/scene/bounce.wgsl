// What the passes share that draw rays to other objects: docs/model.md, section 11. Twin: cpu/src/bounces.rs.

// The ways by which the ray of a sample leaves it. Twin: src/strip_rays.rs.
const BOUNCE_BY_BASE: u32 = 0u;
const BOUNCE_BY_SCRATCHES: u32 = 1u;
const BOUNCE_BY_GRATINGS: u32 = 2u;

// The part of the rays of a sample that goes one way: those whose number is from `low` on and below `low + share`.
struct BounceWay {
    low: f32,
    share: f32,
}

// How often the ray of a sample goes by way of its scratches and its gratings, which take so much of the base. The camera's samples send rays all
// ways by turns; what those meet sends one, where the CPU's sends all.
fn bounce_way(way: u32, by_scratches: vec3f, by_gratings: vec3f, which: ShadowRound) -> BounceWay {
    if which.depth == 0u {
        return BounceWay(0.0, f32(way == which.way));
    }
    let scratches = bounce_share(by_scratches);
    if way == BOUNCE_BY_SCRATCHES {
        return BounceWay(0.0, scratches);
    }
    let gratings = (1.0 - scratches) * bounce_share(by_gratings);
    if way == BOUNCE_BY_GRATINGS {
        return BounceWay(scratches, gratings);
    }
    return BounceWay(scratches + gratings, 1.0 - scratches - gratings);
}

fn bounce_share(taken: vec3f) -> f32 {
    let share = rgb_luminance(taken);
    return select(0.0, clamp(share, 0.1, 0.9), share > 0.0);
}

fn bounce_goes(way: BounceWay, number: f32) -> bool {
    return number >= way.low && number < way.low + way.share;
}

// What of light that a sample sends reaches the camera.
fn bounce_throughput(ray: BounceRay, which: ShadowRound) -> vec3f {
    return select(ray.throughput, vec3f(1.0), which.depth == 0u);
}

// A ray as it sets out.
fn bounce_ray(direction: vec3f, throughput: vec3f, solid_angle_sr: f32, start: vec2f) -> BounceRay {
    return BounceRay(direction, SHADOW_FAR_M, throughput, solid_angle_sr, start, 0u, 0u);
}

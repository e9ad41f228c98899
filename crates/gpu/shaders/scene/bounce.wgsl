// Functions that the passes share that draw rays to other objects: docs/model.md, section 11. Twin: cpu/src/bounces.rs.
// Needs: shadow.

// The part of the rays of a sample that goes one way: those whose number is from `low` on and below `low + share`.
struct BounceWay {
    low: f32,
    share: f32,
}

// Probability with which the ray of a sample goes by way of its scratches and its gratings, which take so much of the base. The camera's samples
// send rays all ways in turn; hits send one, where the CPU's send all.
fn bounce_way(way: u32, by_scratches: vec3f, by_gratings: vec3f, which: ShadowRound) -> BounceWay {
    if which.depth == 0u {
        return BounceWay(0.0, f32(way == which.way));
    }
    let scratches = bounce_share(by_scratches);
    if way == SHADOW_BY_SCRATCHES {
        return BounceWay(0.0, scratches);
    }
    let gratings = (1.0 - scratches) * bounce_share(by_gratings);
    if way == SHADOW_BY_GRATINGS {
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

// A ray of a sample as it sets out; of one that the camera sees it is the first. `last` has led to the sample, which sends the part
// `sent` of it; `body` is beside it for the first ray.
fn bounce_ray(last: BounceRay, direction: vec3f, sent: vec3f, body: vec3f, solid_angle_sr: f32, start: vec2f, which: ShadowRound) -> BounceRay {
    var ray = BounceRay(direction, SHADOW_FAR_M, vec3f(1.0), solid_angle_sr, sent, 0u, body, 0u, start);
    if which.depth > 0u {
        ray.throughput = last.throughput * sent;
        ray.specular = last.specular;
        ray.body = last.body;
    }
    return ray;
}

// Pass: for each sample a ray to one source of the base's light. A workgroup a group. Twin: cpu/src/shadows/base.rs, which casts two rays a round
// where this one keeps one of several candidates with the probability of its part in their sum (J. Talbot, 2005).
// Needs: base_lobes, light_sampling, shadow, film, pixel_point.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read_write> rays: array<ShadowRay>;
@group(3) @binding(3) var<uniform> shadow_round: ShadowRound;

// Candidates for the environment, which no table tells where it is bright.
const AROUND_CANDIDATES: u32 = 8u;

// One of the candidates that were offered.
struct Candidate {
    direction: vec3f,           // in the surface's frame
    distance_m: f32,
    weight: BaseRadiance,
    total: f32,                 // luminance of all candidates
    left: f32,                  // of the number that chooses
}

fn candidate_offer(kept: ptr<function, Candidate>, direction: vec3f, distance_m: f32, weight: BaseRadiance) {
    let own = rgb_luminance(weight.specular + weight.diffuse);
    if !(own > 0.0) {
        return;
    }
    (*kept).total += own;
    let share = own / (*kept).total;
    if (*kept).left < share {
        (*kept).left /= share;
        (*kept).direction = direction;
        (*kept).distance_m = distance_m;
        (*kept).weight = weight;
    } else {
        (*kept).left = ((*kept).left - share) / max(1.0 - share, 1e-30);
    }
}

fn candidate_scaled(weight: BaseRadiance, factor: vec3f) -> BaseRadiance {
    return BaseRadiance(weight.specular * factor, weight.diffuse * factor);
}

// Radiance from a direction of the picture on a light, if it has one.
fn light_picture_toward(point: SurfacePoint, light: Light, direction: vec3f) -> vec3f {
    var radiance = vec3f(1.0);
    if HAS_PICTURES && (light.extras & LIGHT_PICTURE) != 0u {
        let corner = light_corner_m(light.first_vertex);
        let plane = PicturePlane(
            surface_from_world(point, corner - point.position_m),
            surface_from_world(point, light_corner_m(light.first_vertex + 1u) - corner),
            surface_from_world(point, light_corner_m(light.first_vertex + 3u) - corner),
        );
        radiance = picture_radiance(light_picture(light), picture_uv(plane, direction), 0.0, vec2f(0.0), 1.0);
    }
    return radiance;
}

// A direction by the lobes and one to the light, with the weights of multiple importance sampling (E. Veach, 1997).
fn offer_light(kept: ptr<function, Candidate>, point: SurfacePoint, lobes: BaseLobes, seed: u32, pick: f32) {
    let light = light_at(shadow_round.source);
    let even = light_radiance(light, point.position_m);
    let drawn = light_draw(point, light, shadow_random(seed, shadow_round, SHADOW_LIGHT));
    if !(drawn.whole > 0.0) {
        return;
    }
    let met = light_meets(point, light, drawn.direction);
    // Within rounding of the outline it may be missed.
    let is_lit = met.distance_m > 0.0 || met.covers == 0.0;
    if is_lit && base_lobes_above(lobes, drawn.direction) && drawn.distance_m > 0.0 && drawn.distance_m < SHADOW_FAR_M {
        let density = max(met.covers, 1.0) / drawn.whole + base_lobes_pdf(lobes, drawn.direction);
        let radiance = even * light_picture_toward(point, light, drawn.direction);
        let weight = candidate_scaled(base_lobes_eval(lobes, drawn.direction), radiance / density);
        candidate_offer(kept, drawn.direction, drawn.distance_m, weight);
    }
    let wi = base_lobes_sample(lobes, pick, shadow_random(seed, shadow_round, SHADOW_LOBE));
    if base_lobes_above(lobes, wi) {
        let along = light_meets(point, light, wi);
        if along.distance_m > 0.0 {
            let density = along.covers / drawn.whole + base_lobes_pdf(lobes, wi);
            let radiance = even * light_picture_toward(point, light, wi);
            candidate_offer(kept, wi, along.distance_m, candidate_scaled(base_lobes_eval(lobes, wi), radiance / density));
        }
    }
}

// Directions by the lobes. Suns are lights.
fn offer_around(kept: ptr<function, Candidate>, point: SurfacePoint, lobes: BaseLobes, seed: u32, pick: f32) {
    for (var i = 0u; i < AROUND_CANDIDATES; i += 1u) {
        // The choice of a lobe is even over the candidates.
        let wi = base_lobes_sample(lobes, fract(pick + f32(i) / f32(AROUND_CANDIDATES)), shadow_random(seed, shadow_round, SHADOW_LOBE + i));
        if base_lobes_above(lobes, wi) {
            let in_map = frame.environment_from_world * world_from_surface(point, wi);
            let radiance = environment_prefiltered_lod(environment_levels, in_map, 0.0) * frame.environment_texel_radiance;
            let density = f32(AROUND_CANDIDATES) * base_lobes_pdf(lobes, wi);
            candidate_offer(kept, wi, SHADOW_FAR_M, candidate_scaled(base_lobes_eval(lobes, wi), radiance / density));
        }
    }
}

@compute @workgroup_size(8, 8)
fn shadow_base_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    if points[at].object == 0u {
        return;
    }
    let point = surface_point_from(points[at], paints[at]);
    let lobes = base_lobes(point);
    let seed = shadow_seed(point.position_m, shadow_round);
    let choice = shadow_random(seed, shadow_round, SHADOW_CHOICE);
    var kept: Candidate;
    kept.left = choice.y;
    if shadow_round.source < frame.light_count {
        offer_light(&kept, point, lobes, seed, choice.x);
    } else if HAS_ENVIRONMENT {
        offer_around(&kept, point, lobes, seed, choice.x);
    }
    // The kept source stands for all.
    let own = rgb_luminance(kept.weight.specular + kept.weight.diffuse);
    let weight = candidate_scaled(kept.weight, vec3f(kept.total / max(own, 1e-30)));
    let start = shadow_normals(shadow_random(seed, shadow_round, SHADOW_START));
    let direction = world_from_surface(point, kept.direction);
    var clear_m = kept.distance_m;
    if shadow_round.source < frame.light_count && clear_m > 0.0 {
        clear_m = light_clear_m(light_at(shadow_round.source), point.position_m, direction, clear_m, shadow_round.extent_m);
    }
    rays[at] = ShadowRay(direction, clear_m, weight.specular, start.x, weight.diffuse, start.y);
}

// Pass: adds the light of what the rays have met to the light that rays found for the camera's samples. A workgroup a group.
// Twins: cpu/src/bounces.rs, cpu/src/found.rs.
// Needs: found, film.

@group(3) @binding(0) var<storage, read> rays: array<BounceRay>;
// Light of what the rays met.
@group(3) @binding(1) var<storage, read> hit_base_light: array<BaseLight>;
@group(3) @binding(2) var<storage, read> hit_found: array<FoundRays>;
@group(3) @binding(3) var<storage, read_write> found: array<FoundRays>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;

fn radiance_at(at: u32) -> vec3f {
    var radiance = base_emission(hit_base_light[at]);
    for (var layer = 0u; layer < found_layers(); layer += 1u) {
        let i = found_at(at, layer);
        radiance += found_left(hit_found[i].open, found_share(hit_found[i].weight, hit_found[i].seen));
    }
    return max(found_finite(radiance), vec3f(0.0));
}

// `noise` is what the light says by itself, without what the sample makes of it.
fn add_light(i: u32, light: vec3f, noise: vec3f) {
    found[i].bounced += light;
    found[i].round_bounced += rgb_luminance(noise);
    if shadow_round.ends_round != 0u {
        let all = found[i].round_bounced;
        found[i].bounced_moments += vec3f(1.0, all, all * all);
        found[i].round_bounced = 0.0;
    }
}

@compute @workgroup_size(8, 8)
fn bounce_light(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) workgroups: vec3u, @builtin(local_invocation_index) lane: u32) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    if group >= frame.group_count || !group_has(group, lane) {
        return;
    }
    let at = group_point(group, lane);
    let ray = rays[at];
    var light = vec3f(0.0);
    if ray.distance_m > 0.0 {
        light = found_finite(ray.throughput * radiance_at(at));
    }
    if shadow_round.way == SHADOW_BY_BASE {
        let specular = found_finite(ray.specular * light);
        let body = found_finite(ray.body * light);
        add_light(found_at(at, FOUND_SPECULAR), specular, specular);
        add_light(found_at(at, FOUND_BODY), body, body);
        return;
    }
    let layer = found_at(at, found_by(shadow_round.way));
    if shadow_round.depth == 0u {
        found[layer].open += found_finite(ray.specular);
        found[layer].around += found_finite(ray.body);
    }
    add_light(layer, found_finite(ray.specular * light), light);
}

// Pass: adds the light of what the rays have met to the light that rays found for the camera's samples. A workgroup a group.
// Twins: cpu/src/bounces.rs, cpu/src/traced.rs.
// Needs: traced, film.

@group(3) @binding(0) var<storage, read> rays: array<BounceRay>;
// Light of what the rays met.
@group(3) @binding(1) var<storage, read> hit_base_light: array<BaseLight>;
@group(3) @binding(2) var<storage, read> hit_traced: array<TracedRays>;
@group(3) @binding(3) var<storage, read_write> traced: array<TracedRays>;
@group(3) @binding(4) var<uniform> shadow_round: ShadowRound;

fn radiance_at(at: u32) -> vec3f {
    var radiance = base_emission(hit_base_light[at]);
    for (var layer = 0u; layer < traced_layers(); layer += 1u) {
        let i = traced_at(at, layer);
        radiance += traced_left(hit_traced[i].open, traced_share(hit_traced[i].weight, hit_traced[i].seen));
    }
    return max(traced_finite(radiance), vec3f(0.0));
}

// `noise` is what the light says by itself, without what the sample makes of it.
fn add_light(i: u32, light: vec3f, noise: vec3f) {
    traced[i].bounced += light;
    traced[i].round_bounced += rgb_luminance(noise);
    if shadow_round.ends_round != 0u {
        let all = traced[i].round_bounced;
        traced[i].bounced_moments += vec3f(1.0, all, all * all);
        traced[i].round_bounced = 0.0;
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
        light = traced_finite(ray.throughput * radiance_at(at));
    }
    if shadow_round.way == SHADOW_BY_BASE {
        let specular = traced_finite(ray.specular * light);
        let body = traced_finite(ray.body * light);
        add_light(traced_at(at, TRACED_SPECULAR), specular, specular);
        add_light(traced_at(at, TRACED_BODY), body, body);
        return;
    }
    let layer = traced_at(at, traced_by(shadow_round.way));
    if shadow_round.depth == 0u {
        traced[layer].open += traced_finite(ray.specular);
        traced[layer].around += traced_finite(ray.body);
    }
    add_light(layer, traced_finite(ray.specular * light), light);
}
